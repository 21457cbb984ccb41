"""The one way kernels are compiled: without the interpreter lock, cached on disk, never stale.

numba notices a changed file but not a changed *callee* in another file, and would go on running the old
machine code: a wrong number that looks right. So the cache lives in a folder named after a digest of every
source file that a kernel can be made of; any change there starts a fresh folder.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])


def _digest_of_sources() -> str:
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    root = Path(__file__).parent
    for source in sorted(root.rglob("*.py")):
        text = source.read_bytes()
        # kernels say so in their imports; the constants and types they use live in these packages
        if source.parent.name in ("wagon", "track", "solver") or b"from slosh_cli.compiled import" in text:
            digest.update(source.relative_to(root).as_posix().encode())
            digest.update(text)
    return digest.hexdigest()[:16]


def _cache_home() -> Path:
    if "NUMBA_CACHE_DIR" in os.environ:
        return Path(os.environ["NUMBA_CACHE_DIR"])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home())) / "slosh" / "kernels"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "slosh" / "kernels"


CACHE_FOLDER = _cache_home() / _digest_of_sources()
numba.config.CACHE_DIR = str(CACHE_FOLDER)  # type: ignore[attr-defined]


def _compile(function: F, **options: Any) -> F:
    # without numba's memory manager (_nrt) a kernel cannot allocate: one that tries does not compile
    # (numba's type stubs know only the public options)
    jit: Any = numba.njit
    return cast(
        F, jit(cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True, _nrt=False, **options)(function)
    )


def kernel(function: F) -> F:
    """Compile `function`: nopython, GIL released, cached on disk, IEEE division, unable to allocate."""
    return _compile(function)


def vector_kernel(function: F) -> F:
    """Like `kernel` for work on vectors: terms may be summed in another order, products and sums fused."""
    return _compile(function, fastmath={"reassoc", "contract"})


def inner_kernel(function: F) -> F:
    """Like `kernel` for functions that only other kernels call; they compile in a fraction of the time."""
    return _compile(function, no_cpython_wrapper=True)


def part_kernel(function: F) -> F:
    """Like `inner_kernel` for functions with one caller, which they become part of.

    A call hands over an array as seven numbers and a state as a thousand, which costs more than the shorter kernels do.
    """
    return _compile(function, no_cpython_wrapper=True, forceinline=True)


def is_cached() -> bool:
    """True when the time loop was compiled before by this very version of the sources."""
    return any(CACHE_FOLDER.rglob("*advance*.nbc"))
