"""Names of points stand where they hide nothing."""

from itertools import combinations

import pytest
from matplotlib.figure import Figure

from slosh_cli.report.label_places import spread


@pytest.fixture
def crowd():
    """Three points so near each other that their names overlap, and a crowd below them."""
    figure = Figure(figsize=(6.0, 4.0), dpi=100)
    axes = figure.subplots()
    points = [(20.0, 81.0), (22.5, 93.0), (25.0, 101.0), *((10.0 + k, 60.0) for k in range(20))]
    axes.plot(*zip(*points, strict=True), "o")
    axes.set(xlim=(0, 35), ylim=(0, 200))
    names = [
        axes.annotate(f"{x} kN m\n{y} m", (x, y), xytext=(0, -13), textcoords="offset points", ha="center", va="top")
        for x, y in points[:3]
    ]
    figure.draw_without_rendering()
    return axes, names, points


def hidden(axes, names, points):
    boxes = [name.get_window_extent() for name in names]
    on_screen = axes.transData.transform(points)
    return sum(a.overlaps(b) for a, b in combinations(boxes, 2)), sum(box.count_contains(on_screen) for box in boxes)


def test_names_are_moved_apart_and_off_the_points(crowd):
    axes, names, points = crowd
    assert min(hidden(axes, names, points)) > 0
    spread(axes, names, points)
    assert hidden(axes, names, points) == (0, 0)
    for name in names:
        box = name.get_window_extent()
        assert axes.bbox.contains(box.x0, box.y0)
        assert axes.bbox.contains(box.x1, box.y1)


def test_a_name_with_room_stays_where_it_is(crowd):
    axes, names, _ = crowd
    spread(axes, names[:1], [names[0].xy])
    assert names[0].xyann == (0.0, -13.0)
