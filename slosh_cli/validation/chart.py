"""What a figure of a case shows, as plain data; drawing is the report's business."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, eq=False)
class Curve:
    """One line; `exact` curves are drawn beneath the others as what they are compared with, `marks` as points."""

    label: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    exact: bool = False
    marks: bool = False


def curve(label: str, x: ArrayLike, y: ArrayLike, *, exact: bool = False, marks: bool = False) -> Curve:
    """A curve from anything that holds numbers."""
    return Curve(label, np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), exact, marks)


@dataclass(frozen=True, eq=False)
class Panel:
    """Curves over one pair of axes; labels carry the unit, the title what tells panels of one chart apart."""

    x_label: str
    y_label: str
    curves: Sequence[Curve] = field(default_factory=tuple)
    log_x: bool = False
    log_y: bool = False
    title: str = ""


@dataclass(frozen=True, eq=False)
class Chart:
    """Panels side by side."""

    panels: Sequence[Panel]
