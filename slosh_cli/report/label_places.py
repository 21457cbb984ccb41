"""Where the names of points stand in a figure: near their point, over no other name and no other point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

_PLACES: Final[Sequence[tuple[float, float]]] = tuple(
    (x, sign * y) for y in (13.0, 30.0, 48.0) for x in (0.0, 25.0, -25.0, 50.0, -50.0, 70.0, -70.0) for sign in (-1, 1)
)
"""Offsets in points that are tried, from the point to the name's middle; below and above."""

_ROOM: Final = 8.0
"""Points left free around a name, for the marker of another point."""


def spread(axes: Axes, names: Sequence[Annotation], points: Sequence[tuple[float, float | None]]) -> None:
    """Move the `names` (offset in points) to where they hide neither each other nor one of the `points` (data).

    Each keeps its side, above or below, and its nearness where it can. The figure must have its final layout.
    """
    on_screen = axes.transData.transform([(x, y) for x, y in points if y is not None])
    taken: list[Bbox] = []
    for name in names:
        side, at_point = name.xyann[1], _put(name, (0.0, 0.0))

        def cost(place: tuple[float, float], at_point: Bbox = at_point, side: float = side) -> float:
            box = at_point.translated(*(axes.figure.dpi / 72.0 * offset for offset in place))
            box = box.translated(0.0, -box.height) if place[1] < 0 else box
            outside = not (axes.bbox.contains(box.x0, box.y0) and axes.bbox.contains(box.x1, box.y1))
            covered = sum(box.overlaps(other) for other in taken)
            hidden = box.padded(_ROOM * axes.figure.dpi / 72.0).count_contains(on_screen)
            away = abs(place[0]) + abs(place[1]) + (10.0 if place[1] * side < 0 else 0.0)
            return 1e4 * covered + 1e3 * hidden + 1e3 * outside + away

        taken.append(_put(name, min(_PLACES, key=cost)))


def _put(name: Annotation, place: tuple[float, float]) -> Bbox:
    name.set_position(place)
    name.set_verticalalignment("top" if place[1] < 0 else "bottom")
    return name.get_window_extent()
