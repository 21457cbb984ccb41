"""Figures of a train show what its couplings bear."""

import numpy as np
import pytest

from slosh_cli.report.train_figures import train_figures
from slosh_cli.results.train_result import StoredPart, TrainHistory

ROWS = 2501


@pytest.fixture
def blow() -> TrainHistory:
    """Two couplings; the second one has a blow that lasts one row, where only every second row finds room."""
    time = np.linspace(0.0, 25.0, ROWS)
    forces = np.zeros((2, ROWS))
    forces[1, 1001], forces[1, 1501] = 300e3, -200e3
    extremes = [
        {"max_compression_N": push, "max_tension_N": pull, "max_compression_s": 10.01, "max_tension_s": 15.01}
        for push, pull in ((0.0, 0.0), (300e3, 200e3))
    ]
    vehicles = tuple(
        StoredPart(
            {"onset_s": 0.5 + 0.1 * k, "liquid_model": "rigid", "distance_m": 100.0},
            {"brake_application": np.clip(time - 0.5 - 0.1 * k, 0.0, 1.0), "speed": 20.0 - 0.8 * time},
        )
        for k in range(3)
    )
    couplings = tuple(StoredPart(told, {"force": force}) for told, force in zip(extremes, forces, strict=True))
    return TrainHistory("blow", time, vehicles, couplings)


def test_no_blow_is_lost_between_the_columns_of_the_brake_wave(blow: TrainHistory) -> None:
    axes = train_figures(blow)["brake_wave"]().axes[0]
    drawn = np.asarray(axes.collections[0].get_array())
    assert drawn.shape[0] == 2
    assert drawn.shape[1] < ROWS
    assert (drawn.max(), drawn.min()) == (300.0, -200.0)
    assert not drawn[0].any()


def test_lines_of_the_brake_wave_are_onset_and_build_up(blow: TrainHistory) -> None:
    onset, full = train_figures(blow)["brake_wave"]().axes[0].lines
    assert onset.get_xdata() == pytest.approx([0.5, 0.6, 0.7])
    assert full.get_xdata() == pytest.approx([1.45, 1.55, 1.65], abs=0.011)


def test_a_train_without_couplings_or_liquid_has_its_speeds_alone(blow: TrainHistory) -> None:
    assert set(train_figures(blow)) == {"coupling_forces", "coupling_extremes", "brake_wave", "train_speed"}
    assert set(train_figures(TrainHistory("one", blow.time, blow.vehicles[:1], ()))) == {"train_speed"}
