"""Dam breaks: Ritter's, Stoker's, and a full one in a closed round tank beside an independent solver."""

import numpy as np
import pytest
from shallow_tools import BOX, CIRCLE, LENGTH, dam, history, liquid_in, moving, places, ritter, stoker

from tests.reference_code.plain_shallow import PlainTank, circle, rectangle

BEHIND, BEFORE, TIME = 2.0, 0.5, 1.1
FORMULAS = {
    "Ritter, dry bed": (0.0, lambda x: ritter(x, TIME, BEHIND)),
    "Stoker, wet bed": (BEFORE, lambda x: stoker(x, TIME, BEHIND, BEFORE)),
}


def error(name, cells):
    """L1 error over the tank, per metre of it and of the depth behind the dam."""
    before, exact = FORMULAS[name]
    tank = dam(liquid_in(BOX, cells, 1.0, length=20.0), BEHIND, before)
    tank.advance(0.0, TIME)
    return float(np.abs(tank.depth - exact(places(tank.liquid))).mean()) / BEHIND


@pytest.mark.parametrize("name", FORMULAS)
def test_dam_break_in_a_rectangular_section(name):
    """Acceptance: size and order of the L1 error. A bore and a front allow first order, no method more."""
    cells = np.array([50, 100, 200, 400])
    errors = np.array([error(name, count) for count in cells])
    assert errors[1] < 6e-3
    assert errors[3] < 1.5e-3
    order = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
    assert 0.9 < order < 1.2


@pytest.mark.parametrize("name", FORMULAS)
def test_mass_is_conserved_and_energy_only_lost(name):
    tank = dam(liquid_in(BOX, 200, 1.0, length=20.0), BEHIND, FORMULAS[name][0])
    mass, energies = tank.area.sum(), [tank.energy]
    for _ in range(100):
        tank.advance(0.0, 0.05)
        energies.append(tank.energy)
    assert tank.area.sum() == pytest.approx(mass, rel=1e-12)
    assert np.all(np.diff(energies) <= 0.0)


TANKS = {"circle": (CIRCLE, circle(1.5)), "box": (BOX, rectangle(2.5, 3.0))}


def plain_dam(section, cells, behind, before):
    place = (np.arange(cells) + 0.5) / cells - 0.5
    area = np.where(place < 0, *(np.interp(depth, section.depth, section.area) for depth in (behind, before)))
    return PlainTank(section, LENGTH / cells, area, np.zeros(cells))


@pytest.mark.parametrize("name", TANKS)
def test_whole_dam_break_in_a_closed_tank_beside_the_plain_solver(name):
    """Bore to the far wall and back (2.5 s): the plain solver closes in on the program as its mesh is refined."""
    section, plain = TANKS[name]
    tank = dam(liquid_in(section, 400, 1.5), 2.7, 0.5)
    impulse, turning, *_ = tank.advance(0.0, 2.5)
    gaps = []
    for cells in (400, 800, 1600):
        other = plain_dam(plain, cells, 2.7, 0.5)
        pushed, turned = 830.0 * np.array(other.advance(2.5))
        gaps.append(np.abs(other.depth.reshape(400, -1).mean(axis=1) - tank.depth).mean() / 2.7)
    assert gaps[2] < 2.5e-3
    assert np.all(np.divide(gaps[:2], gaps[1:]) > 1.4)
    assert pushed == pytest.approx(impulse, rel=5e-3)
    assert turned == pytest.approx(turning, rel=2e-3)


@pytest.mark.parametrize("deceleration", [0.6, 1.5])
def test_braked_round_tank_beside_the_plain_solver(deceleration):
    """The liquid runs against the roof at 1.5 m/s^2; force and moment over 8 s."""
    liquid = liquid_in(CIRCLE, 240, 1.5)
    _, force, moment = history(moving(liquid), -deceleration, 8.0, 0.1)
    gaps = []
    for cells in (400, 800):
        area = np.interp(1.5, TANKS["circle"][1].depth, TANKS["circle"][1].area)
        other = PlainTank(TANKS["circle"][1], LENGTH / cells, np.full(cells, area), np.zeros(cells))
        rows = 8300.0 * np.array([other.advance(0.1 * (k + 1), -deceleration) for k in range(80)])
        gaps.append(np.sqrt(np.mean((rows[:, 0] - force) ** 2)) / (liquid.mass * deceleration))
        turn = np.sqrt(np.mean((rows[:, 1] - moment) ** 2)) / moment.max()
    assert gaps[1] < 1.2e-2
    assert gaps[0] / gaps[1] > 1.4
    assert turn < 2.5e-3
    assert rows[:, 1].max() == pytest.approx(moment.max(), rel=3e-3)
