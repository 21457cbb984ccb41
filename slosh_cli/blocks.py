"""Blocks: values that compiled kernels take as one pointer, with fields, parts and methods.

A kernel that takes a wagon and its liquid as tuples of some hundred arrays hands each of them on in every call, and is
made again for each combination. A block is its address: calls are short, a kernel is made once for each class, and
blocks of one class may differ in their sizes, so that vehicles make a list. A method that is a kernel is chosen by the
class of the block, when a caller is compiled. What kernels may change are numbers and what is in arrays.
"""

from __future__ import annotations

import ctypes
import operator
import struct
from functools import cache
from typing import Any, ClassVar, NamedTuple, Self, cast, dataclass_transform, get_origin, get_type_hints

import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.errors import TypingError
from numba.core.imputils import lower_getattr_generic, lower_setattr_generic
from numba.core.registry import CPUDispatcher
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import NativeValue, lower_builtin, register_model, typeof_impl, unbox
from numba.np import numpy_support as np_support

from slosh_cli.arrays import ArrayKind
from slosh_cli.kernel_store import known_as

_WORD = 8
_FLOAT, _BITS = struct.Struct("d"), struct.Struct("q")


@dataclass_transform(kw_only_default=True)
class Block:
    """Base of all blocks: annotations are the fields, given by keyword.

    A field is a `float`, an `int`, an array of `slosh_cli.arrays`, another block, or a tuple of blocks of one class.
    Numbers may be set afterwards, from Python and in kernels. Raises TypeError for fields that do not fit.
    """

    address: ClassVar[int]

    def __init_subclass__(cls) -> None:
        for name, value in vars(cls).items():
            if isinstance(value, CPUDispatcher):
                _let_kernels_call(name)

    def __init__(self, **given: Any) -> None:
        cls: Any = type(self)
        plan = _plan(cls)
        if given.keys() != plan.keys():
            raise TypeError(f"{cls.__name__} takes {', '.join(plan)}, but {', '.join(given)} were given")
        own: dict[str, Any] = self.__dict__
        words: list[int] = []
        parts = []
        for name, field in plan.items():
            value = given[name]
            if field.hint is float:
                words.append(_BITS.unpack(_FLOAT.pack(float(value)))[0])
            elif field.hint is int:
                words.append(operator.index(value))
            elif field.array is not None:
                own[name] = array = _fitting(name, field.array, value)
                words += (0, 0, array.size, array.itemsize, _address(array), *array.shape, *array.strides)
            else:
                own[name] = part = _as_part(name, field, value)
                parts.append(part.kind)
                words.append(part.address)
        own["_memory"] = memory = np.array(words, dtype=np.int64)
        own["_integers"], own["address"] = memoryview(cast(Any, memory)), _address(memory)
        own["_floats"] = own["_integers"].cast("B").cast("d")
        own["kind"] = _kind_of(cls, tuple(parts))

    def __getattr__(self, name: str) -> Any:
        place, view = self._number(name)
        return view[place]

    def __setattr__(self, name: str, value: float) -> None:
        place, view = self._number(name)
        view[place] = value

    def __reduce__(self) -> Any:
        raise TypeError(f"{type(self).__name__} is its address, which no copy and no other process has: use `replaced`")

    def _number(self, name: str) -> tuple[int, Any]:
        cls: Any = type(self)
        field = _plan(cls).get(name)
        if field is None or field.hint not in (float, int):
            raise AttributeError(f"{cls.__name__} has no number {name!r}")
        return field.place, self.__dict__["_floats" if field.hint is float else "_integers"]

    @classmethod
    def blank(cls, size: int = 0, **given: Any) -> Self:
        """A block whose numbers are zero and whose vectors hold `size` zeros, but for what is `given`."""
        own: Any = cls
        for name, field in _plan(own).items():
            if name not in given:
                array = field.array
                given[name] = 0 if array is None else np.zeros(array.dimensions * (size,), dtype=array.dtype)
        return cls(**given)

    def replaced(self, **changes: Any) -> Self:
        """A copy with other values of some fields; arrays and parts that stay are shared."""
        cls: Any = type(self)
        return type(self)(**{name: changes.get(name, getattr(self, name)) for name in _plan(cls)})


class _Row(tuple[Block, ...]):
    """Blocks of one class; `address` is where the list of their addresses begins, led by their number."""

    def __init__(self, blocks: tuple[Block, ...]) -> None:
        if len({block.kind for block in blocks}) != 1:
            raise TypeError("a tuple of blocks holds one or more of the same kind")
        self._list = np.array([len(blocks), *(block.address for block in blocks)], dtype=np.int64)
        self.address, self.kind = _address(self._list), _RowType(blocks[0].kind)


class _Field(NamedTuple):  # what is annotated, and its place in a block's memory, in words
    hint: Any
    array: ArrayKind | None
    place: int


@cache
def _plan(cls: Any) -> dict[str, _Field]:
    """The fields of a class of blocks."""
    fields, size = {}, 0
    for name, hint in get_type_hints(cls, include_extras=True).items():
        if name != "address":
            array = next((note for note in getattr(hint, "__metadata__", ()) if isinstance(note, ArrayKind)), None)
            fields[name] = _Field(hint, array, size)
            size += 5 + 2 * array.dimensions if array else 1  # the members of numba's own array
    return fields


def _address(array: Any) -> int:
    return array.ctypes.data if array.size == 0 else ctypes.addressof(ctypes.c_char.from_buffer(array))


def _as_part(name: str, field: _Field, value: Any) -> Any:
    """The value as a block, or as a row of blocks where one is asked for."""
    row = isinstance(value, tuple)
    blocks = all(isinstance(one, Block) for one in (value if row else [value]))
    if row != (get_origin(field.hint) is tuple) or not blocks:
        raise TypeError(f"{name} must be {field.hint}, but is {value!r}")
    return _Row(value) if row else value


def _fitting(name: str, wanted: ArrayKind, value: Any) -> Any:
    """The value as an array of the kind that is asked for; its numbers are not rounded to fit."""
    array = value
    if not (isinstance(value, np.ndarray) and value.dtype is wanted.dtype and value.flags.carray):
        array = np.asarray(value)
        if not np.can_cast(array.dtype, wanted.dtype, "same_kind"):
            raise TypeError(f"{name} must be of {wanted.dtype}, but is of {array.dtype}")
        array = np.require(array, wanted.dtype, ("C", "A", "W"))
    if array.ndim != wanted.dimensions:
        raise TypeError(f"{name} must have {wanted.dimensions} dimensions, but has {array.ndim}")
    return array


@cache
def _kind_of(cls: Any, parts: tuple[Any, ...]) -> _BlockType:
    """numba's type of a block of `cls` with such parts."""
    kinds: dict[str, Any] = {}
    rest = iter(parts)
    for name, field in _plan(cls).items():
        if array := field.array:
            kinds[name] = types.Array(np_support.from_dtype(array.dtype), array.dimensions, "C")
        elif field.hint in (float, int):
            kinds[name] = types.float64 if field.hint is float else types.int64
        else:
            kinds[name] = next(rest)
    return _BlockType(cls, kinds)


class _BlockType(types.Type):
    """numba's type of a block: its class, and the types of its parts; `chosen` names those of a class of their own."""

    def __init__(self, cls: Any, kinds: dict[str, Any]) -> None:
        self.cls, self.kinds = cls, kinds
        hints = {name: field.hint for name, field in _plan(cls).items()}
        blocks = [(hints[name], kind.cls) for name, kind in kinds.items() if isinstance(kind, _BlockType)]
        own = [f"-{cls.__name__}" for hint, cls in blocks if cls is not hint]
        self.chosen = "".join([*own, *(getattr(kind, "chosen", "") for kind in kinds.values())])
        parts = [str(kind) for kind in kinds.values() if isinstance(kind, (_BlockType, _RowType))]
        super().__init__(name=known_as(cls) + (f"({', '.join(parts)})" if parts else ""))


class _RowType(types.Type):
    """numba's type of a tuple of blocks of one class; their number is data."""

    def __init__(self, element: _BlockType) -> None:
        self.element, self.chosen = element, element.chosen
        super().__init__(name=f"row of {element}")


register_model(_BlockType)(models.OpaqueModel)
register_model(_RowType)(models.OpaqueModel)


@typeof_impl.register(Block)
def _typeof_block(value: Block, context: Any) -> Any:
    return value.kind


@unbox(_BlockType)
def _unbox_block(kind: _BlockType, block: Any, c: Any) -> NativeValue:
    address = c.pyapi.object_getattr_string(block, "address")
    pointer = c.pyapi.long_as_voidptr(address)
    c.pyapi.decref(address)
    return NativeValue(pointer, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@infer_getattr
class _Fields(AttributeTemplate):
    """Types of what a block has: its fields, and its kernels as methods."""

    key = _BlockType

    def generic_resolve(self, block: Any, name: str) -> Any:  # type: ignore[override]
        kind = block.kinds.get(name)
        if kind is not None:
            return kind
        if not isinstance(getattr(block.cls, name, None), CPUDispatcher):
            return None

        def generic(template: Any, args: Any, kws: Any) -> Any:
            return _kernel_type(block, name).get_call_type(template.context, (block, *args), kws).as_method()

        return types.BoundFunction(
            type(name, (AbstractTemplate,), {"key": (_BlockType, name), "generic": generic}), block
        )


def _kernel_type(block: _BlockType, name: str) -> Any:
    return types.Dispatcher(getattr(block.cls, name))


def _pointer_to(context: Any, builder: Any, block: _BlockType, value: Any, name: str) -> tuple[Any, Any]:
    """The model of a field, and a pointer to it."""
    place = _plan(block.cls)[name].place
    model = context.data_model_manager[block.kinds[name]]
    pointer = cgutils.pointer_add(builder, value, place * _WORD, model.get_data_type().as_pointer())
    return model, pointer


@lower_getattr_generic(_BlockType)
def _get_field(context: Any, builder: Any, block: _BlockType, value: Any, name: str) -> Any:
    model, pointer = _pointer_to(context, builder, block, value, name)
    return model.load_from_data_pointer(builder, pointer)


@lower_setattr_generic(_BlockType)
def _set_field(context: Any, builder: Any, sig: Any, args: Any, name: str) -> None:
    if not isinstance(sig.args[1], types.Number):
        raise TypingError(f"{name} is no number: a kernel cannot put another in its place")
    model, pointer = _pointer_to(context, builder, sig.args[0], args[0], name)
    builder.store(model.as_data(builder, args[1]), pointer)


@cache
def _let_kernels_call(name: str) -> None:
    """Let kernels call the method `name` of a block."""

    @lower_builtin((_BlockType, name), _BlockType, types.VarArg(types.Any))
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
        fits = isinstance(row, _RowType) and isinstance(place, types.Integer)
        return signature(row.element, row, types.intp) if fits else None


@infer_global(len)
class _Length(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.intp, *args) if isinstance(args[0], _RowType) else None


@lower_builtin(operator.getitem, _RowType, types.intp)
def _get_element(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    pointers = builder.bitcast(args[0], cgutils.voidptr_t.as_pointer())
    return builder.load(builder.gep(pointers, [builder.add(args[1], args[1].type(1))]))


@lower_builtin(len, _RowType)
def _get_length(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.load(builder.bitcast(args[0], cast(Any, cgutils.intp_t).as_pointer()))
