"""The kinds of arrays that the program's numbers are kept in."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class ArrayKind(NamedTuple):
    """Element type and number of dimensions of an array; rows are contiguous."""

    dtype: np.dtype[Any]
    dimensions: int


Array = NDArray[np.float64]
"""Numbers in any shape."""
Vector = Annotated[NDArray[np.float64], ArrayKind(np.dtype("float64"), 1)]
Matrix = Annotated[NDArray[np.float64], ArrayKind(np.dtype("float64"), 2)]
Cube = Annotated[NDArray[np.float64], ArrayKind(np.dtype("float64"), 3)]
Tesseract = Annotated[NDArray[np.float64], ArrayKind(np.dtype("float64"), 4)]
Flags = Annotated[NDArray[np.bool_], ArrayKind(np.dtype("bool"), 1)]
Integers = Annotated[NDArray[np.int64], ArrayKind(np.dtype("int64"), 1)]
Unsigned = Annotated[NDArray[np.uint64], ArrayKind(np.dtype("uint64"), 2)]
