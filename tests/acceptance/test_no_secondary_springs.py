"""Bogies without secondary springs (theory section 2): a second method, ever stiffer springs, every load and brake."""

import numpy as np
import pytest
import second_wagon
from second_wagon import BOGIES, Brake, SecondWagon
from test_second_wagon import RIGID, deviations

from slosh_cli.errors import SloshError
from slosh_cli.results.wagon_range import braked_wheel_loads

NONE = "wagon.secondary_suspension=none"


class _Reduced(SecondWagon):
    """The second wagon's matrices on the coordinates that are left: `q = E p`, a bogie's heave that of its pivot."""

    def __init__(self, scenario, brake):
        sprung = scenario.wagon.model_copy(update={"secondary_suspension": scenario.wagon.primary_suspension})
        super().__init__(scenario.model_copy(update={"wagon": sprung}), brake)  # springs that never move
        span = np.eye(second_wagon.SIZE)
        for (heave, _), pivot in zip(BOGIES, (0.5, -0.5), strict=True):
            span[heave] = 0.0
            span[heave, 1], span[heave, 2] = 1.0, -pivot * self.wagon.pivot_spacing
        left = [i for i in range(second_wagon.SIZE) if i not in (3, 5)]
        self.span = span[:, left]
        self.inverse = self.span @ np.linalg.inv(self.span.T @ self.mass @ self.span) @ self.span.T

    def settled(self):
        state = super().settled()
        state[1] = state[3]
        on_wheel = -(self.weight[1] / 2 + self.weight[3]) / 2
        state[[1, 3, 5]] = state[7] - on_wheel / self.wagon.primary_suspension.stiffness
        return state


def test_a_stop_against_the_reduced_equations_in_scipy(stop, monkeypatch):
    """Wheels lock and turn again in it."""
    ours = stop(
        "paper_80_solid",
        *RIGID,
        NONE,
        "braking.initial_speed=60 km/h",
        "braking.torque=12 kN m",
        "contact.adhesion=wet",
    )
    monkeypatch.setattr(second_wagon, "SecondWagon", _Reduced)
    theirs = second_wagon.second_stop(ours.scenario, Brake(lambda _, share: 12e3 * share), ours.time, rtol=1e-7)
    assert theirs.changes
    found = deviations(ours, theirs)
    assert max(found.values()) < 1e-3, found
    assert ours.braking_distance_m == pytest.approx(theirs.distance, rel=1e-6)
    for bogie, (heave, pitch) in enumerate(BOGIES, 1):
        for name, place in (("heave", heave), ("pitch", pitch)):
            mine, other = ours.channels[f"bogie_{bogie}_{name}"][: theirs.time.size], theirs.states[place]
            assert np.abs(mine - other).max() < 2e-3 * np.abs(other).max(), (bogie, name)


def test_stiffer_and_stiffer_springs_come_to_it_as_one_over_their_stiffness(stop):
    def loads(*more):
        found = stop("paper_80_solid", "solver.tolerance=1e-6", "braking.stop_speed=20 m/s", *more)
        n = 60
        return np.array([found.channels[f"wheel_{i}_normal_force"][:n] for i in (1, 2, 3, 4)])

    exact = loads(NONE)
    softer, stiffer = (
        np.abs(loads(f"wagon.secondary_suspension={{stiffness: {k} N/m, damping: {0.01 * k} N s/m}}") - exact).max()
        for k in (4e8, 1.6e9)
    )
    assert softer < 0.02 * exact.mean()
    assert 3.0 < softer / stiffer < 5.0, (softer, stiffer)


def test_bogies_rise_and_sink_with_their_pivots(stop):
    run = stop("paper_80_solid", NONE)
    heave, pitch, arm = run.channels["car_heave"], run.channels["car_pitch"], 0.5 * run.scenario.wagon.pivot_spacing
    for bogie, ahead in ((1, arm), (2, -arm)):
        assert np.array_equal(run.channels[f"bogie_{bogie}_heave"], heave - ahead * pitch)


@pytest.mark.parametrize("liquid", ["rigid", "modal", "shallow-water"])
def test_the_ledger_closes_and_the_weight_is_carried(stop, liquid):
    run = stop("paper_80", "tank.coefficients=computed", f"tank.liquid.model={liquid}", NONE)
    assert abs(run.energy_residual) < 1e-4


def test_braked_wheel_loads_are_those_of_springs_that_hardly_give(shipped):
    exact = braked_wheel_loads(shipped("paper_80_solid", NONE))
    gaps = [
        np.abs(braked_wheel_loads(shipped("paper_80_solid", f"wagon.secondary_suspension.stiffness={k} N/m")) - exact)
        for k in (1e8, 1e9)
    ]
    assert gaps[0].max() / gaps[1].max() == pytest.approx(10.0, rel=0.02)


def test_no_springs_is_written_and_read_as_a_word(shipped):
    assert shipped("paper_80", NONE).model_dump()["wagon"]["secondary_suspension"] == "none"
    for given in ("non", "3", "null"):
        with pytest.raises(SloshError, match="must be `none` or a mapping of stiffness and damping"):
            shipped("paper_80", f"wagon.secondary_suspension={given}")
