"""Figures of validation cases: the legend stands within the picture, however long its labels are."""

import pytest

from slosh_cli.report.validation_figures import case_figure
from slosh_cli.validation.chart import Chart, Panel, curve


@pytest.mark.parametrize("label", ["m", "m, published", "blocks, composite: quadrature", "a label " * 6])
@pytest.mark.parametrize("count", [2, 4, 5])
def test_the_legend_is_within_the_figure(label: str, count: int) -> None:
    curves = [curve(f"{label}{k}", [0.0, 1.0], [0.0, float(k)], exact=k % 2 == 0) for k in range(count)]
    figure = case_figure("Title", Chart([Panel("x / m", "y / m", curves)]))
    figure.canvas.draw()
    legend = figure.axes[0].get_legend()
    assert legend is not None
    assert legend.get_window_extent().x1 <= figure.bbox.x1
