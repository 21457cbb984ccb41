"""The one way kernels are compiled: without the interpreter lock, kept on disk, never stale.

numba notices a changed file but not a changed *callee* in another file, and would go on running the old
machine code: a wrong number that looks right. It also keeps kernels beside the sources, or wherever else it can
write, when its folder cannot be written. So kernels are kept by `kernel_store`, under a digest of every source file
that a kernel can be made of and of everything else that decides about the machine code; or they are not kept.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import llvmlite
import numba
import numpy as np
from llvmlite import binding
from numba.core import config
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from slosh_cli.kernel_store import KernelStore, digest, source_files

F = TypeVar("F", bound=Callable[..., Any])

_SETTINGS: Final = (
    "OPT", "BOUNDSCHECK", "DEBUGINFO_DEFAULT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX", "DISABLE_INTEL_SVML",
    "USING_SVML", "CPU_NAME", "CPU_FEATURES",
)  # fmt: skip
"""Settings of numba that change the machine code."""


def _sources() -> str:
    """The digest of the sources of kernels and of the compilers; empty where the sources cannot be read."""
    root = Path(__file__).parent
    try:
        return digest(source_files(root), root, numba.__version__, llvmlite.__version__, np.__version__, sys.version)
    except OSError:
        return ""


def _build() -> str:
    """`SOURCES` with the processor and the settings that machine code is made for."""
    machine = (binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten())
    return digest((), Path(), SOURCES, machine, [repr(getattr(config, name, None)) for name in _SETTINGS])


SOURCES: Final = _sources()
"""Tells one build of the solver from another."""

_STORE: Final = KernelStore(_build() if SOURCES else "")


_rebuild: Any = CompileResult._rebuild  # numba's own types end here


class _Kept(NullCache):
    """numba's view of `_STORE` for one function."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._name = f"{function.__module__}.{function.__qualname__}-{function.__code__.co_firstlineno}"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        target_context.refresh()
        kept = _STORE.load(self._name + _chosen(sig), _key(sig, target_context.codegen()))
        try:
            return None if kept is None else _rebuild(target_context, *kept)
        except Exception:  # made by a program that no longer fits, whatever it says
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        if not data.library.has_dynamic_globals and all(one.can_cache for one in data.lifted):
            _STORE.save(self._name + _chosen(sig), _key(sig, data.codegen), data._reduce(), dumps)


def _chosen(signature: Any) -> str:
    """The classes of parts that a kernel was made for, such as the kind of liquid; see `blocks`."""
    kinds = signature.args if hasattr(signature, "args") else signature
    return "".join(getattr(kind, "chosen", "") for kind in kinds)


def _key(signature: Any, codegen: Any) -> tuple[Any, ...]:
    return signature, codegen.magic_tuple()


def _compile(function: F, **options: Any) -> F:
    # without numba's memory manager (_nrt) a kernel cannot allocate: one that tries does not compile
    # (numba's type stubs know only the public options)
    jit: Any = numba.njit
    compiled = jit(nogil=True, error_model="numpy", no_cfunc_wrapper=True, _nrt=False, **options)(function)
    if compiled is not function:  # NUMBA_DISABLE_JIT leaves functions as they are
        compiled._cache = _Kept(function)
    return cast(F, compiled)


def kernel(function: F) -> F:
    """Compile `function`: nopython, GIL released, kept on disk, IEEE division, unable to allocate."""
    return _compile(function)


def vector_kernel(function: F) -> F:
    """Like `kernel` for work on vectors: terms may be summed in another order, products and sums fused."""
    return _compile(function, fastmath={"reassoc", "contract"})


def inner_kernel(function: F) -> F:
    """Like `kernel` for functions that only other kernels call; they compile in a fraction of the time."""
    return _compile(function, no_cpython_wrapper=True)


def is_cached(name: str, chosen: str = "") -> bool:
    """True when the kernel `name` (MODULE.FUNCTION) was compiled before by this very build.

    `chosen` names the classes of parts that it was made for, as in `ModalLiquid`. A kernel is kept after the ones that
    it calls, and with them.
    """
    return bool(getattr(config, "DISABLE_JIT", False)) or _STORE.holds(name, chosen)


def solver_is_cached(model: str) -> bool:
    """The same of the time loop for a load of this model of the liquid; `mixed` of a train that has several."""
    chosen = {"modal": "ModalLiquid", "shallow-water": "CellLiquid", "mixed": "MixedLiquid"}.get(model, "")
    return is_cached("advance.advance", chosen)


def not_kept() -> str:
    """Why kernels cannot be kept for the next run; empty where they can."""
    return _STORE.trouble
