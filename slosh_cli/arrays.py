"""The kinds of arrays that the program's numbers are kept in."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Kind(NamedTuple):
    """Element type and number of dimensions of an array; rows are contiguous."""

    dtype: str
    dimensions: int


Vector = Annotated[NDArray[np.float64], Kind("float64", 1)]
Matrix = Annotated[NDArray[np.float64], Kind("float64", 2)]
Cube = Annotated[NDArray[np.float64], Kind("float64", 3)]
Tesseract = Annotated[NDArray[np.float64], Kind("float64", 4)]
Flags = Annotated[NDArray[np.bool_], Kind("bool", 1)]
Integers = Annotated[NDArray[np.int64], Kind("int64", 1)]
Unsigned = Annotated[NDArray[np.uint64], Kind("uint64", 2)]
