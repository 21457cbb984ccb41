"""Blocks: values that compiled kernels take as one pointer, with fields, parts and methods.

A kernel that takes a wagon and its liquid as tuples of some hundred arrays hands each of them on in every call, and is
made again for each combination. A block is its address: calls are short, a kernel is made once for each class, and
blocks of one class may differ in their sizes, so that vehicles make a list. A method that is a kernel is chosen by the
class of the block, when a caller is compiled. What kernels may change are numbers and what is in arrays.
"""

from __future__ import annotations

import operator
from functools import cache
from types import MappingProxyType
from typing import Any, ClassVar, Self, cast, dataclass_transform, get_type_hints

import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.imputils import lower_getattr_generic, lower_setattr_generic
from numba.core.registry import CPUDispatcher
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import NativeValue, lower_builtin, register_model, typeof_impl, unbox

from slosh_cli.arrays import Kind

_WORD = 8


@dataclass_transform(kw_only_default=True)
class Block:
    """Base of all blocks: annotations are the fields, given by keyword.

    A field is a `float`, an `int`, an array of `slosh_cli.arrays`, another block, or a tuple of blocks of one class.
    Numbers may be set afterwards, from Python and in kernels.
    """

    _memory: np.ndarray[Any, np.dtype[np.int64]]
    _numbers: np.ndarray[Any, np.dtype[np.float64]]
    _type: BlockType
    address: ClassVar[int]

    def __init_subclass__(cls) -> None:
        for name, value in vars(cls).items():
            if isinstance(value, CPUDispatcher):
                _let_kernels_call(name)

    def __init__(self, **given: Any) -> None:
        own: Any = type(self)
        hints = _hints(own)
        if given.keys() != hints.keys():
            raise TypeError(f"{type(self).__name__} takes {', '.join(hints)}, but {', '.join(given)} were given")
        values = {name: _as_field(hint, given[name]) for name, hint in hints.items()}
        kinds = tuple((name, _type_of(hints[name], value)) for name, value in values.items())
        layout = _layout(kinds)
        memory = np.zeros(layout.size, dtype=np.int64)
        put = object.__setattr__
        put(self, "_memory", memory)
        put(self, "_numbers", memory.view(np.float64))
        put(self, "_type", BlockType(type(self), kinds))
        put(self, "address", memory.ctypes.data)
        for name, value in values.items():
            place = layout.places[name]
            if isinstance(value, (float, int)):
                (self._numbers if isinstance(value, float) else memory)[place] = value
                continue
            words = _words(value)
            memory[place : place + len(words)] = words
            put(self, name, value)

    def __getattr__(self, name: str) -> Any:
        place, view = self._number(name)
        return view[place].item()

    def __setattr__(self, name: str, value: float) -> None:
        place, view = self._number(name)
        view[place] = value

    def _number(self, name: str) -> tuple[int, Any]:
        kinds = {} if name.startswith("_") else dict(self._type.kinds)
        if not isinstance(kinds.get(name), types.Number):
            raise AttributeError(f"{type(self).__name__} has no number {name!r}")
        view = self._numbers if kinds[name] is types.float64 else self._memory
        return _layout(self._type.kinds).places[name], view

    @classmethod
    def blank(cls, size: int = 0, **given: Any) -> Self:
        """A block whose numbers are zero and whose vectors hold `size` zeros, but for what is `given`."""
        own: Any = cls
        for name, hint in _hints(own).items():
            if name not in given:
                kind = _kind(hint)
                given[name] = hint(0) if kind is None else np.zeros(kind.dimensions * (size,), dtype=kind.dtype)
        return cls(**given)

    def replaced(self, **changes: Any) -> Self:
        """A copy with other values of some fields; arrays and parts that stay are shared."""
        return type(self)(**{name: changes.get(name, getattr(self, name)) for name, _ in self._type.kinds})


class _Row(tuple[Block, ...]):
    """Blocks of one class beside the list of their addresses, led by their number."""

    addresses: np.ndarray[Any, np.dtype[np.int64]]

    def __new__(cls, blocks: tuple[Block, ...]) -> Self:
        row = super().__new__(cls, blocks)
        if len({block._type for block in blocks}) != 1:
            raise TypeError("a tuple of blocks holds one or more of the same kind")
        row.addresses = np.array([len(blocks), *(block.address for block in blocks)], dtype=np.int64)
        return row


class _Layout:
    """Where a block's fields stand in its memory, in words."""

    def __init__(self, kinds: tuple[tuple[str, Any], ...]) -> None:
        places, size = {}, 0
        for name, kind in kinds:
            places[name] = size
            size += 5 + 2 * kind.ndim if isinstance(kind, types.Array) else 1  # the members of numba's own array
        self.places, self.size = MappingProxyType(places), size


@cache
def _layout(kinds: tuple[tuple[str, Any], ...]) -> _Layout:
    return _Layout(kinds)


@cache
def _hints(cls: Any) -> dict[str, Any]:
    hints = get_type_hints(cls, include_extras=True)
    return {name: hints[name] for name in hints if not name.startswith("_") and name != "address"}


def _kind(hint: Any) -> Kind | None:
    """The kind of array that an annotation asks for; None where it asks for something else."""
    return next((note for note in getattr(hint, "__metadata__", ()) if isinstance(note, Kind)), None)


def _as_field(hint: Any, value: Any) -> Any:
    """The value as it is kept: an array of the kind that is asked for, a number, a block, a row of blocks."""
    kind = _kind(hint)
    if kind is not None:
        array = np.require(value, kind.dtype, ("C", "A"))
        if array.ndim != kind.dimensions:
            raise TypeError(f"an array of {kind.dimensions} dimensions is needed, but it has {array.ndim}")
        return array
    if hint in (float, int):
        return hint(value)
    return _Row(tuple(value)) if isinstance(value, tuple) else value


def _type_of(hint: Any, value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return types.Array(getattr(types, str(value.dtype) if value.dtype != np.bool_ else "bool_"), value.ndim, "C")
    if isinstance(value, _Row):
        return RowType(value[0]._type)
    if isinstance(value, Block):
        return value._type
    return types.float64 if hint is float else types.int64


def _words(value: Any) -> list[int]:
    if isinstance(value, np.ndarray):
        return [0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
    return [value.addresses.ctypes.data if isinstance(value, _Row) else value.address]


class BlockType(types.Type):
    """numba's type of a block: its class, and the types of its parts where these are open."""

    def __init__(self, cls: type[Block], kinds: tuple[tuple[str, Any], ...]) -> None:
        self.cls, self.kinds = cls, kinds
        parts = [str(kind) for _, kind in kinds if isinstance(kind, (BlockType, RowType))]
        super().__init__(name=f"{cls.__module__}.{cls.__qualname__}" + (f"({', '.join(parts)})" if parts else ""))


class RowType(types.Type):
    """numba's type of a tuple of blocks of one class; their number is data."""

    def __init__(self, element: BlockType) -> None:
        self.element = element
        super().__init__(name=f"row of {element}")


register_model(BlockType)(models.OpaqueModel)
register_model(RowType)(models.OpaqueModel)


@typeof_impl.register(Block)
def _typeof_block(value: Block, context: Any) -> BlockType:
    return value._type


@unbox(BlockType)
def _unbox_block(kind: BlockType, block: Any, c: Any) -> NativeValue:
    address = c.pyapi.object_getattr_string(block, "address")
    pointer = c.pyapi.long_as_voidptr(address)
    c.pyapi.decref(address)
    return NativeValue(pointer, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@infer_getattr
class _Fields(AttributeTemplate):
    """Types of what a block has: its fields, and its kernels as methods."""

    key = BlockType

    def generic_resolve(self, block: Any, name: str) -> Any:  # type: ignore[override]
        kind = dict(block.kinds).get(name)
        if kind is not None:
            return kind
        if not isinstance(getattr(block.cls, name, None), CPUDispatcher):
            return None

        def generic(template: Any, args: Any, kws: Any) -> Any:
            return _kernel_type(block, name).get_call_type(template.context, (block, *args), kws).as_method()

        return types.BoundFunction(
            type(name, (AbstractTemplate,), {"key": (BlockType, name), "generic": generic}), block
        )


def _kernel_type(block: BlockType, name: str) -> Any:
    return types.Dispatcher(getattr(block.cls, name))


def _pointer_to(context: Any, builder: Any, block: BlockType, value: Any, name: str) -> tuple[Any, Any]:
    """The model of a field, and a pointer to it."""
    place = _layout(block.kinds).places[name]
    model = context.data_model_manager[dict(block.kinds)[name]]
    pointer = cgutils.pointer_add(builder, value, place * _WORD, model.get_data_type().as_pointer())
    return model, pointer


@lower_getattr_generic(BlockType)
def _get_field(context: Any, builder: Any, block: BlockType, value: Any, name: str) -> Any:
    model, pointer = _pointer_to(context, builder, block, value, name)
    return model.load_from_data_pointer(builder, pointer)


@lower_setattr_generic(BlockType)
def _set_field(context: Any, builder: Any, sig: Any, args: Any, name: str) -> None:
    model, pointer = _pointer_to(context, builder, sig.args[0], args[0], name)
    builder.store(model.as_data(builder, args[1]), pointer)


@cache
def _let_kernels_call(name: str) -> None:
    """Let kernels call the method `name` of a block."""

    @lower_builtin((BlockType, name), BlockType, types.VarArg(types.Any))
    def _method(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = _kernel_type(sig.args[0], name)
        own = kind.get_call_type(context.typing_context, sig.args, {})
        call = context.get_function(kind, own)
        context.add_linking_libs(getattr(call, "libs", ()))
        return call(builder, args)


@infer_global(operator.getitem)
class _Element(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        row, place = args
        if isinstance(row, RowType) and isinstance(place, types.Integer):
            return signature(row.element, row, types.intp)
        return None


@infer_global(len)
class _Length(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.intp, *args) if isinstance(args[0], RowType) else None


@lower_builtin(operator.getitem, RowType, types.intp)
def _get_element(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    row, place = args
    pointers = builder.bitcast(row, cgutils.voidptr_t.as_pointer())
    return builder.load(builder.gep(pointers, [builder.add(place, place.type(1))]))


@lower_builtin(len, RowType)
def _get_length(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.load(builder.bitcast(args[0], cast(Any, cgutils.intp_t).as_pointer()))
