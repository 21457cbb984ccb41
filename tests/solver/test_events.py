"""Events met at any nearness and any speed: whatever a step leaves before one, the next steps get past it.

The runs start a hair before the event, so that the outcome does not hang on where the step control happened to land.
"""

import numpy as np
import pytest

from slosh_cli.solver import advance as loop
from slosh_cli.solver.events import EVENT_COUNT
from slosh_cli.solver.record import SLOSH_COLUMN
from slosh_cli.solver.setup import problem
from slosh_cli.solver.state import EVENTS, REJECTED, TIME, new_scratch, new_state
from slosh_cli.wagon.coordinates import WHEEL_HEAVE, WHEEL_SPIN

NEARNESS = [0.0, 1e-8, 3e-7, 9e-7, 1.1e-6, 1.5e-6, 3e-6, 1e-5, 1e-4, 1e-2]


@pytest.fixture
def near_event(shipped):
    """A stop of a rigid wagon at 80 km/h whose brakes set in at once or later."""

    def build(torque, *overrides, onset=0.0):
        given = (f"braking.torque={torque} kN m", f"braking.onset={onset} s", "output.interval=100 s", *overrides)
        return problem(shipped("paper_80_solid", *given))

    return build


def march(stop, steps, airborne=(), first_step=1e-3):
    """State after `steps` steps and the loop's last word."""
    model, start = stop.model, stop.start
    state = new_state(start, stop.cells, EVENT_COUNT, first_step)
    state.airborne[list(airborne)] = True
    scratch = new_scratch(stop.model.rail, start.slosh.size, stop.cells.area.size)
    assert loop.begin(model, scratch, state)
    rows = np.zeros((8, SLOSH_COLUMN + 2 * start.slosh.size))
    return state, loop.advance(model, scratch, state, rows, steps)


@pytest.mark.parametrize("speed", NEARNESS)
@pytest.mark.parametrize("inertia", [5.0, 30.0, 120.0, 400.0])
def test_wheel_about_to_stop_locks(near_event, speed, inertia):
    """A brake of 50 kN m against a wheel that turns at next to nothing: up to a kilometre a second squared."""
    stop = near_event(50, f"wagon.wheelset.spin_inertia={inertia} kg m^2", "contact.adhesion=wet")
    model, start = stop.model, stop.start
    start.v[WHEEL_SPIN] = speed / model.wagon.wheel_radius
    state, outcome = march(stop, 30)
    assert outcome == loop.RUNNING
    assert state.clock[TIME] > 1e-3
    assert state.locked[0]
    assert state.start.v[WHEEL_SPIN] == 0.0


@pytest.mark.parametrize("gap", NEARNESS)
@pytest.mark.parametrize("fall", [1e-4, 0.01, 0.3, 3.0])
def test_wheel_about_to_land_lands(near_event, gap, fall):
    """Gaps relative to the static approach of 0.1 mm, speeds in m/s."""
    stop = near_event(5)
    model, start = stop.model, stop.start
    place = WHEEL_HEAVE + 1
    start.q[place] = start.rail[model.rail.contact[1]] + gap * model.control.approach_scale
    start.v[place] = -fall
    start.normal[1] = 0.0
    state, outcome = march(stop, 60, airborne=[1])
    assert outcome == loop.RUNNING
    assert state.clock[TIME] > 1e-4
    assert state.lifted[0] >= 1  # or nobody would be warned
    assert state.largest[1] > 0.0
    closed = state.start.rail[model.rail.contact[1]] > state.start.q[place]
    assert closed != state.airborne[1]


@pytest.mark.parametrize("pressed", NEARNESS)
@pytest.mark.parametrize("rise", [1e-3, 0.01, 0.3, 3.0])
def test_wheel_about_to_lift_lifts(near_event, pressed, rise):
    stop = near_event(5)
    model, start = stop.model, stop.start
    place = WHEEL_HEAVE + 1
    approach = pressed * model.control.approach_scale
    start.q[place] = start.rail[model.rail.contact[1]] - approach
    start.v[place] = rise
    start.normal[1] = model.contact.stiffness * approach**1.5
    state, outcome = march(stop, 60)
    assert outcome == loop.RUNNING
    assert state.clock[TIME] > 1e-4
    if rise >= 0.3:  # a slower one is pushed back down before it is up
        assert state.least[1] == 0.0
    assert np.all(state.start.normal >= 0.0)
    open_gap = state.start.rail[model.rail.contact[1]] < state.start.q[place]
    assert open_gap == state.airborne[1]


@pytest.mark.parametrize("step", [1e-3, 3e-3, 1e-2, 2e-2])
@pytest.mark.parametrize("gap", [0.1, 1.0, 10.0, 40.0])
@pytest.mark.parametrize("fall", [1e-3, 0.03, 0.3, 1.0])
def test_landing_inside_a_long_step_is_found(near_event, step, gap, fall):
    """The search for the landing must not creep: pressed into the rail for most of a step, a wheel hardly sinks in.

    At the coarsest tolerance such a step passes the error test, so the event has to end it.
    """
    stop = near_event(5, "solver.tolerance=1e-2", onset=10.0)
    model, start = stop.model, stop.start
    place = WHEEL_HEAVE + 1
    start.q[place] = start.rail[model.rail.contact[1]] + gap * model.control.approach_scale
    start.v[place] = -fall
    start.normal[1] = 0.0
    state, outcome = march(stop, 40, airborne=[1], first_step=step)
    assert outcome == loop.RUNNING
    assert state.lifted[0] >= 1
    assert state.counts[REJECTED] < 12 * max(state.work[EVENTS], 1) + 20
