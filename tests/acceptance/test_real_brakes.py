"""Runs with real brakes: ledger, order of the integrator, work per stop, histories (theory sections 9 to 13)."""

import numpy as np
import pytest

from slosh_cli.results.channels import wheel

CAST_IRON = "braking.blocks={count: 2, force: 25 kN, friction: cast-iron}"
BRAKES = {
    "cast iron": CAST_IRON,
    "composite": "braking.blocks={count: 1, force: 22 kN, friction: composite}",
    "discs": "braking.discs={faces: 2, force: 20 kN, radius: 0.247 m, friction: [[0 km/h, 0.4], [60 km/h, 0.3]]}",
    "strong cast iron": "braking.blocks={count: 2, force: 60 kN, friction: cast-iron}",
}
FINE = "output.interval=1 ms"
APPLICATIONS = {
    "step": "step",
    "P": "P",
    "late": "{form: filling, time_95: 5 s, delay: 1 s, jump: 0}",
    "linear": "{form: linear, time: 4 s}",
    "released": "{form: table, points: [[0 s, 0], [2 s, 1], [6 s, 1], [7 s, 0.1], [9 s, 0.1], [11 s, 1]]}",
}


@pytest.mark.parametrize("name", ["paper_80", "paper_80_solid", "tank_wagon"])
@pytest.mark.parametrize("brake", BRAKES)
@pytest.mark.parametrize("application", APPLICATIONS)
def test_ledger_closes(stop, name, brake, application):
    found = stop(name, BRAKES[brake], f"braking.application={APPLICATIONS[application]}", "contact.adhesion=wet")
    assert found.status == "stopped"
    assert found.energy_residual < 1e-4
    assert found.mean_total_wheel_load_N == pytest.approx(found.weight_N, rel=1e-6)


def test_order_of_the_integrator_stays_two(stop):
    """A smooth application: the distance errs as the tolerance does, which the steps follow with order 2."""
    keys = (CAST_IRON, "braking.application={form: filling, time_95: 4 s, jump: 0}", "braking.onset=0 s")
    fine = stop("paper_80_solid", *keys, "solver.tolerance=1e-7").braking_distance_m
    errors, steps = [], []
    for tolerance in (1e-2, 1e-3, 1e-4):
        found = stop("paper_80_solid", *keys, f"solver.tolerance={tolerance}")
        errors.append(abs(found.braking_distance_m / fine - 1.0))
        steps.append(found.steps)
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order > 1.8
    assert errors[-1] < 1e-4


def test_filling_costs_at_most_half_more_steps_than_the_step(stop):
    at_once, filled = (
        stop("paper_80_solid", CAST_IRON, "braking.initial_speed=100 km/h", f"braking.application={form}")
        for form in ("step", "P")
    )
    assert filled.steps <= 1.5 * at_once.steps


def test_histories_tell_the_application_friction_and_torques(stop):
    found = stop("paper_80_solid", BRAKES["strong cast iron"], "braking.application=P", "contact.adhesion=0.1", FINE)
    time, applied = found.time, found.channels["brake_application"]
    since = time - 0.5
    expected = np.where(since > 1e-9, 1.0 - 0.9 * np.exp(-np.log(0.9 / 0.05) / 4.0 * since), 0.0)
    np.testing.assert_allclose(applied, expected, atol=1e-12)
    speed, friction = 3.6 * found.channels[wheel(4, "speed")], found.channels[wheel(4, "friction")]
    force = 60.0 * applied
    law = 0.6 * (1.62 * force + 100) / (8.1 * force + 100) * (speed + 100) / (5 * speed + 100)
    np.testing.assert_allclose(friction, law, rtol=1e-12)
    held, transmitted = found.channels[wheel(4, "held_torque")], found.channels[wheel(4, "brake_torque")]
    np.testing.assert_allclose(held, 2 * 1e3 * force * friction * 0.46, rtol=1e-9, atol=1e-6)
    locked = (speed < 1e-6) & (found.channels["speed"] > 0.01)
    assert locked.any()
    np.testing.assert_allclose(
        transmitted[locked], 0.46 * found.channels[wheel(4, "tangential_force")][locked], rtol=1e-9
    )
    np.testing.assert_allclose(transmitted[~locked], held[~locked], rtol=1e-6, atol=1.0)
    assert transmitted.max() <= found.brake_torque_max_N_m[3] * (1.0 + 1e-9)
    assert found.brake_torque_max_N_m[3] == pytest.approx(transmitted.max(), rel=2e-2)


def test_a_brake_has_its_figure_where_there_is_something_to_see(stop):
    from slosh_cli import plot

    assert "brake" not in plot(stop("paper_80_solid"))
    drawn = plot(stop("paper_80_solid", CAST_IRON, "braking.application=P", "braking.slide_protection={}"))["brake"]
    labels = [axes.get_ylabel().replace("\n", " ") for axes in drawn.axes]
    assert labels == ["part of the full force / %", "friction coefficient", "brake torque per wheel / kN m"]
    assert len(plot(stop("paper_80_solid", "braking.application=P"))["brake"].axes) == 2


def test_a_changeover_is_less_force_in_the_run_too(stop):
    """The light wagon with a changeover is that with 0.58 of the force, the full one is as without."""
    changeover = "braking.load_changeover={gross_mass: 48 t, empty_share: 0.58}"
    weak = "braking.blocks={count: 2, force: 14.5 kN, friction: cast-iron}"
    for fill, brakes in (("0.1", (CAST_IRON, weak)), ("0.5", (CAST_IRON, CAST_IRON))):
        light, other = (
            stop("paper_80_solid", brake, f"tank.fill={fill}", "braking.application=P", *more)
            for brake, more in zip(brakes, ([changeover], []), strict=True)
        )
        assert light.braking_distance_m == pytest.approx(other.braking_distance_m, rel=1e-5)  # other steps
        assert light.brake_torque_max_N_m == pytest.approx(other.brake_torque_max_N_m, rel=1e-4)
