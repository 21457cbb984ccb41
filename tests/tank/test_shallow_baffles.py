"""Baffles: transverse walls with an opening, a partial reflection and a quadratic loss."""

import numpy as np
import pytest
from cut_surface import cornered_widths, still_plane
from scipy.optimize import curve_fit
from shallow_tools import BOX, CIRCLE, LENGTH, G, history, liquid_in, moving, places

from slosh_cli.errors import SloshError
from slosh_cli.scenario import Liquid, Rectangular
from slosh_cli.scenario.schema_tank import Baffle
from slosh_cli.solver.excite import Deceleration, excite
from slosh_cli.tank.still import baffle_loss, frequency_excess, longest_section

WAVE = np.sqrt(G * CIRCLE.area(1.5) / 3.0)


def walled(opening, cells=120, section=CIRCLE):
    loss = {} if opening is None else {cells // 2: baffle_loss(opening)}
    return liquid_in(section, cells, 1.5, loss=loss)


def test_loss_of_a_sharp_edged_opening():
    """Idelchik's thin orifice: none when open, 18.5 at 0.3 (diagram 4-10), without bound when closed."""
    assert baffle_loss(1.0) == 0.0
    assert baffle_loss(0.3) == pytest.approx(18.2, rel=0.03)
    assert baffle_loss(0.0) == baffle_loss(1e-200) == np.inf
    openings = np.linspace(0.01, 1.0, 100)
    assert np.all(np.diff([baffle_loss(opening) for opening in openings]) < 0)


def test_an_opening_of_the_whole_wall_is_no_wall():
    with_wall, without = moving(walled(1.0)), moving(walled(None))
    assert np.array_equal(with_wall.advance(-1.0, 5.0), without.advance(-1.0, 5.0))
    assert np.array_equal(with_wall.area, without.area)
    assert np.array_equal(with_wall.flow, without.flow)


def test_a_wall_that_is_nearly_open_tends_to_none_with_its_loss():
    without = moving(walled(None))
    without.advance(-1.0, 4.0)
    gaps = []
    for opening in (0.99, 0.999, 0.9999):
        with_wall = moving(walled(opening))
        with_wall.advance(-1.0, 4.0)
        gaps.append(np.abs(with_wall.depth - without.depth).mean() / baffle_loss(opening))
    assert gaps == pytest.approx([gaps[2]] * 3, rel=0.1)
    assert gaps[2] < 0.2


def test_a_nearly_closed_wall_makes_two_tanks_of_half_the_period():
    liquid = walled(0.01)
    time, force, _ = history(moving(liquid), -0.02 * G, 20.0, 0.05)
    force /= liquid.mass * 0.02 * G
    odd = np.arange(1, 40, 2)

    def series(time, frequency, share):
        return 1 - share * sum(8 / (np.pi * n) ** 2 * np.cos(n * frequency * time) for n in odd)

    halves = 2 * np.pi * WAVE / LENGTH
    (frequency, share), _ = curve_fit(series, time, force, p0=[halves, 1.0])
    assert frequency == pytest.approx(halves, rel=5e-3)
    assert share > 0.7


def swinging(liquid, speed):
    """The first mode as it passes through level, `speed` m/s in the middle of the tank."""
    tank = moving(liquid)
    tank.flow[:] = tank.area * speed * np.cos(np.pi * places(liquid) / LENGTH)
    return tank


def lost_in_a_period(opening, speed):
    tank = swinging(walled(opening), speed)
    before, level = tank.energy, moving(tank.liquid).energy
    tank.advance(0.0, 2 * LENGTH / WAVE)
    return (before - tank.energy) / (before - level)


def test_loss_grows_with_a_smaller_opening():
    """Acceptance; down to where the wall holds so much back that the tank falls into two."""
    losses = [lost_in_a_period(opening, 0.2) for opening in (None, 0.9, 0.7, 0.5, 0.3, 0.2)]
    assert np.all(np.diff(losses[1:]) > 0)
    assert losses[1] == pytest.approx(losses[0], abs=0.02)
    assert losses[-1] > 0.5


def test_loss_of_a_wide_opening_is_that_of_the_quadratic_law():
    """A weak baffle takes `INT rho K A |u|^3/2 dt = (2/3 pi) rho K A u^3 T` per period; u in the middle of the tank."""
    speed, opening, period = 0.3, 0.7, 2 * LENGTH / WAVE
    extra = lost_in_a_period(opening, speed) - lost_in_a_period(0.999999, speed)
    energy = CIRCLE.area(1.5) * LENGTH * speed**2 / 4
    expected = 2 / (3 * np.pi) * baffle_loss(opening) * CIRCLE.area(1.5) * speed**3 * period / energy
    assert extra == pytest.approx(expected, rel=0.15)


@pytest.mark.parametrize("walls", [{}, {60: 18.0}, {40: 250.0, 80: 250.0}, {2: 3e4, 117: 0.1}])
def test_momentum_and_mass_balance_with_baffles(walls):
    """In a box, whose cells hold exactly their mass; what the walls push is what the liquid lost, to rounding."""
    liquid = liquid_in(BOX, 120, 1.2, loss=walls)
    tank = moving(liquid)
    mass = tank.area.sum()
    impulse = tank.advance(-1.0, 4.0)[0]
    lost = liquid.mass * 4.0 - liquid.density * liquid.spacing * tank.flow.sum()
    assert impulse == pytest.approx(lost, rel=1e-11)
    assert tank.area.sum() == pytest.approx(mass, rel=1e-12)


@pytest.mark.parametrize("opening", [0.9, 0.3, 0.01, 1e-4, 0.0])
def test_a_baffle_never_feeds_energy(opening):
    tank = swinging(walled(opening), 1.5)
    energies = [tank.energy]
    for _ in range(150):
        tank.advance(0.0, 0.05)
        energies.append(tank.energy)
    assert np.all(np.diff(energies) <= 0.0)


def test_a_still_tilted_surface_stays_still_across_a_baffle():
    liquid = walled(0.3)
    tank = moving(liquid, 1.5 - 0.05 * places(liquid))
    area = tank.area.copy()
    tank.advance(0.05 * G, 10.0)
    assert np.abs(tank.flow).max() < 1e-11
    assert np.abs(tank.area - area).max() < 1e-11


def test_the_smaller_an_opening_the_longer_levels_take_to_meet():
    """Two still halves of a box, 1.4 and 1.0 m deep: Torricelli's outflow `A f' sqrt(2 g dh)`, f' = 1/sqrt(loss)."""
    for opening in (0.01, 0.003):
        liquid = liquid_in(BOX, 40, 1.2, loss={20: baffle_loss(opening)})
        tank = moving(liquid, np.where(places(liquid) < 0, 1.4, 1.0))
        tank.advance(0.0, 0.3 / opening)
        left = tank.depth[:20].mean() - tank.depth[20:].mean()
        # d(dh)/dt = -2 Q/(B L/2), Q = B h sqrt(2 g dh/loss) with h the narrower side's 1.0 to 1.2 m
        fall = 2.0 * 1.1 / (LENGTH / 2) * np.sqrt(2 * G / baffle_loss(opening)) * 0.3 / opening
        assert left == pytest.approx((np.sqrt(0.4) - fall / 2) ** 2, rel=0.1)
        assert 0.05 < left < 0.35


def test_a_closed_bulkhead_lets_nothing_pass_and_makes_separate_tanks():
    """Not a drop passes; each part does what a tank of its own does, and the wagon feels the sum."""
    liquid = liquid_in(CIRCLE, 120, 1.5, loss={40: np.inf, 90: np.inf})
    whole = moving(liquid)
    parts = [liquid_in(CIRCLE, cells, 1.5, length=LENGTH * cells / 120) for cells in (40, 50, 30)]
    alone = [moving(part) for part in parts]
    middles = (np.array([20.0, 65.0, 105.0]) - 60.0) * LENGTH / 120
    for _ in range(40):
        sums = whole.advance(-1.0, 0.1)
        each = np.array([tank.advance(-1.0, 0.1) for tank in alone])
        weights = np.array([part.mass for part in parts]) * G * 0.1
        assert sums[0] == pytest.approx(each[:, 0].sum(), abs=0.02 * 0.1 * liquid.mass)
        assert sums[1] == pytest.approx(each[:, 1].sum() + weights @ middles, abs=0.02 * 0.1 * 1.5 * liquid.mass)
    held = [whole.area[:40].sum(), whole.area[40:90].sum(), whole.area[90:].sum()]
    assert held == pytest.approx([tank.area.sum() for tank in alone], rel=1e-13)
    assert whole.depth == pytest.approx(np.concatenate([tank.depth for tank in alone]), abs=0.02)


@pytest.mark.parametrize("fill", [0.5, 0.95])
def test_closed_sections_under_a_slow_ramp_are_still_tanks_of_their_own(fill):
    """Under the roof, too: the moment of three cut surfaces of a third of the length, weights apart, within 1 %."""
    section, third = cornered_widths([0.0, 3.0], [2.5, 2.5]), LENGTH / 3
    plane = still_plane(section, third, fill, 830.0, 0.2 * G)
    liquid = liquid_in(BOX, 120, fill * 3.0, loss={40: np.inf, 80: np.inf})
    for way in (1.0, -1.0):
        tank = moving(liquid)
        for k in range(200):
            tank.advance(-way * 0.2 * G * (k + 0.5) / 200, 0.1)
        tank.advance(-way * 0.2 * G, 10.0)
        impulse, turning = tank.advance(-way * 0.2 * G, 10.0)[:2] / 10.0
        assert way * turning == pytest.approx(3 * plane.moment, rel=0.01)
        assert way * impulse == pytest.approx(liquid.mass * 0.2 * G, rel=1e-3)


def test_a_still_tilted_surface_stays_still_at_a_closed_bulkhead():
    liquid = liquid_in(CIRCLE, 120, 1.5, loss={60: np.inf})
    half = np.where(places(liquid) < 0, places(liquid) + LENGTH / 4, places(liquid) - LENGTH / 4)
    tank = moving(liquid, 1.5 - 0.2 * half)
    area = tank.area.copy()
    tank.advance(0.2 * G, 10.0)
    assert np.abs(tank.flow).max() < 1e-11
    assert np.abs(tank.area - area).max() < 1e-11


def test_the_first_frequency_is_that_of_the_longest_part(shipped):
    """Baffles with an opening leave the tank whole, closed ones part it."""
    walls = "[{position: 5 m, opening: 0}, {position: 7 m, opening: 0.2}]"
    parted = shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.baffles={walls}").tank
    whole = shipped("paper_80", "tank.liquid.model=shallow-water").tank
    part = shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.length={LENGTH * 81 / 120} m").tank
    assert longest_section(whole) == LENGTH
    assert longest_section(parted) == pytest.approx(LENGTH * 81 / 120)  # 5 m lies at face 38.7 of 120
    assert frequency_excess(parted, G) == pytest.approx(frequency_excess(part, G), rel=1e-6)
    assert frequency_excess(parted, G) > 1.9 * frequency_excess(whole, G)


def test_a_tank_alone_with_three_closed_sections(shipped):
    """A box 9 m long, half of 2 m full, 0.1 g: m g s l^2/(12 h) + m a z_c with l = 3 m, s = a/g: 22.1 kN m."""
    walls = (Baffle(position=3.0, opening=0.0), Baffle(position=6.0, opening=0.0))
    liquid = Liquid(model="shallow-water", density=1000.0, cells=90)
    tank = Rectangular(width=2.0, height=2.0, length=9.0, fill=0.5, liquid=liquid, baffles=walls)
    found = excite(tank, Deceleration.ramped(0.1 * G, 30.0), 60.0, 0.1)
    mass, tilt, length = 18e3, 0.1, 3.0
    exact = mass * G * tilt * length**2 / 12 + mass * 0.1 * G * (0.5 + tilt**2 * length**2 / 24)
    assert found.moment[-200:].mean() == pytest.approx(exact, rel=0.01)


def test_the_modal_liquid_refuses_baffles(shipped):
    with pytest.raises(SloshError, match="modal"):
        shipped("paper_80", "tank.baffles=[{position: 5 m, opening: 0.3}]")
    shallow = shipped("paper_80", "tank.liquid.model=shallow-water", "tank.baffles=[{position: 5 m, opening: 0.3}]")
    assert len(shallow.tank.baffles) == 1


@pytest.mark.parametrize("position", ["0 m", "0.05 m", "15.49 m", "20 m"])
def test_a_baffle_in_an_end_wall_or_outside_is_refused(shipped, position):
    with pytest.raises(SloshError, match="position"):
        shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.baffles=[{{position: {position}, opening: 0.3}}]")
