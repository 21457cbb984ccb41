"""Baffles: transverse walls with an opening, a partial reflection and a quadratic loss."""

import numpy as np
import pytest
from cut_surface import cornered_widths, still_plane
from scipy.integrate import quad, solve_ivp
from scipy.optimize import curve_fit
from shallow_tools import BOX, CIRCLE, LENGTH, SECTIONS, G, history, liquid_in, moving, places

from slosh_cli.errors import SloshError
from slosh_cli.scenario import Liquid, Rectangular
from slosh_cli.scenario.loader import scenario_to_yaml
from slosh_cli.scenario.schema_tank import Baffle
from slosh_cli.solver.excite import Deceleration, excite
from slosh_cli.tank.baffle import baffle_loss, discharge, solid_height
from slosh_cli.tank.still import frequency_excess, longest_section, shallow_liquid

WAVE = np.sqrt(G * CIRCLE.area(1.5) / 3.0)


def perforated(share, height=3.0):
    """The openings of an evenly perforated wall."""
    return ((0.0, height, share),) if share else ()


def loss_of(opening):
    """The loss coefficient of an evenly perforated wall."""
    liquid = walled(opening)
    return baffle_loss(liquid.baffles, liquid.baffles.at[60], liquid.table, 1.5)


def walled(opening, cells=120, section=CIRCLE):
    return liquid_in(section, cells, 1.5, walls={} if opening is None else {cells // 2: perforated(opening)})


def test_loss_of_a_sharp_edged_opening():
    """Idelchik's thin orifice: none when open, 18.5 at 0.3 (diagram 4-10), without bound when closed."""
    assert loss_of(1.0) < 1e-15
    assert loss_of(0.3) == pytest.approx(18.2, rel=0.03)
    assert loss_of(1e-200) == np.inf
    openings = np.linspace(0.01, 1.0, 100)
    assert np.all(np.diff([loss_of(opening) for opening in openings]) < 0)


def test_an_opening_of_the_whole_wall_is_no_wall():
    with_wall, without = moving(walled(1.0)), moving(walled(None))
    assert with_wall.advance(-1.0, 5.0) == pytest.approx(without.advance(-1.0, 5.0), rel=1e-12)
    assert with_wall.area == pytest.approx(without.area, rel=1e-12)
    assert with_wall.flow == pytest.approx(without.flow, abs=1e-12)


def test_a_wall_that_is_nearly_open_tends_to_none_with_its_loss():
    without = moving(walled(None))
    without.advance(-1.0, 4.0)
    gaps = []
    for opening in (0.99, 0.999, 0.9999):
        with_wall = moving(walled(opening))
        with_wall.advance(-1.0, 4.0)
        gaps.append(np.abs(with_wall.depth - without.depth).mean() / loss_of(opening))
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


WALLS = {
    **{str(share): perforated(share) for share in (0.9, 0.3, 0.01, 1e-4, 0.0)},
    "slot at the bottom": ((0.0, 0.5, 1.0),),
    "above the level": ((1.6, 2.2, 1.0),),
    "open on top": ((1.0, 3.0, 1.0),),
    "ring": ((0.4, 2.6, 0.8),),
}


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
    expected = 2 / (3 * np.pi) * loss_of(opening) * CIRCLE.area(1.5) * speed**3 * period / energy
    assert extra == pytest.approx(expected, rel=0.15)


@pytest.mark.parametrize(
    "walls",
    [
        {},
        {60: perforated(0.3)},
        {40: ((0.0, 0.2, 1.0),), 80: ((0.5, 1.0, 0.5), (2.0, 3.0, 1.0))},
        {2: perforated(0.01), 117: perforated(0.8)},
    ],
)
def test_momentum_and_mass_balance_with_baffles(walls):
    """In a box, whose cells hold exactly their mass; what the walls push is what the liquid lost, to rounding."""
    liquid = liquid_in(BOX, 120, 1.2, walls=walls)
    tank = moving(liquid)
    mass = tank.area.sum()
    impulse = tank.advance(-1.0, 4.0)[0]
    lost = liquid.mass * 4.0 - liquid.density * liquid.spacing * tank.flow.sum()
    assert impulse == pytest.approx(lost, rel=1e-11)
    assert tank.area.sum() == pytest.approx(mass, rel=1e-12)


@pytest.mark.parametrize("openings", WALLS.values(), ids=list(WALLS))
def test_a_baffle_never_feeds_energy(openings):
    tank = swinging(liquid_in(CIRCLE, 120, 1.5, walls={60: openings}), 1.5)
    energies = [tank.energy]
    for _ in range(150):
        tank.advance(0.0, 0.05)
        energies.append(tank.energy)
    assert np.all(np.diff(energies) <= 0.0)


@pytest.mark.parametrize("openings", WALLS.values(), ids=list(WALLS))
def test_a_still_tilted_surface_stays_still_across_a_baffle(openings):
    liquid = liquid_in(CIRCLE, 120, 1.5, walls={60: openings})
    tank = moving(liquid, 1.5 - 0.05 * places(liquid))
    area = tank.area.copy()
    tank.advance(0.05 * G, 10.0)
    assert np.abs(tank.flow).max() < 1e-11
    assert np.abs(tank.area - area).max() < 1e-11


EVENING = {
    "perforated": ((0.0, 3.0, 0.01),),
    "slot at the bottom": ((0.0, 0.02, 1.0),),
    "slot between the levels": ((1.0, 1.03, 1.0),),
    "wetted on one side": ((0.9, 1.05, 0.5),),
    "open on top": ((1.15, 3.0, 0.15),),
    "two": ((0.1, 0.11, 1.0), (0.8, 0.83, 0.5)),
}


def discharged(section, openings, higher, lower):
    """Discharge (m^3/s) under two levels, by quadrature of the speed of the jet over the openings."""

    def open_width(z):
        return section.surface_width(z) * sum(share for low, high, share in openings if low < z < high)

    def over(integrand, low, high):
        edges = [z for band in openings for z in band[:2] if low < z < high]
        return quad(integrand, low, high, points=edges, limit=200)[0] if high > low else 0.0

    def part(level):
        return over(open_width, 0.0, level) / section.area(level)

    contraction = 1.0 + 0.707 * np.sqrt(1.0 - part(higher))
    free = over(lambda z: open_width(z) * np.sqrt(2 * G * (higher - z)), lower, higher)
    below = min(part(higher), part(lower))
    submerged = over(open_width, 0.0, lower) * np.sqrt(2 * G * (higher - lower))
    whole = free / np.sqrt(contraction**2 - part(higher) ** 2)
    return whole + submerged / (1.0 + 0.707 * np.sqrt(1.0 - below) - below)


@pytest.mark.parametrize("name", EVENING)
def test_levels_even_out_in_the_time_of_the_discharge_equation(name):
    """Two still halves of a box, 1.4 and 0.7 m deep."""
    openings, area = EVENING[name], 2.5 * LENGTH / 2
    tank = moving(liquid_in(BOX, 40, 1.05, walls={20: openings}), np.where((np.arange(40) - 19.5) < 0, 1.4, 0.7))

    def falling(_, levels):
        flow = discharged(BOX, openings, *levels)
        return [-flow / area, flow / area]

    duration = 0.15 * area / discharged(BOX, openings, 1.4, 0.7)
    exact = solve_ivp(falling, (0.0, duration), [1.4, 0.7], rtol=1e-8).y[0, -1]
    tank.advance(0.0, duration)
    assert 1.24 < exact < 1.33
    assert 1.4 - tank.depth[:20].mean() == pytest.approx(1.4 - exact, rel=0.02)
    assert tank.area.sum() == pytest.approx(40 * 2.5 * 1.05, rel=1e-13)


@pytest.mark.parametrize("name", SECTIONS)
def test_discharge_is_the_quadrature_of_the_jet_in_every_section(name):
    section = SECTIONS[name]
    height = section.height
    for bands in (((0.1, 0.35, 1.0), (0.5, 0.9, 0.3)), ((0.4, 0.95, 1.0),)):
        openings = tuple((low * height, high * height, share) for low, high, share in bands)
        liquid = liquid_in(section, 40, 0.5 * height, walls={20: openings})
        for lower, higher in ((0.0, 0.3), (0.05, 0.45), (0.3, 0.7), (0.5, 0.95), (0.6, 0.62), (0.2, 0.95)):
            found = discharge(liquid.baffles, 1, liquid.table, G, lower * height, (higher - lower) * height)
            exact = discharged(section, openings, higher * height, max(lower, 1e-9) * height)
            assert found == pytest.approx(exact, rel=5e-3)


@pytest.mark.parametrize("name", SECTIONS)
def test_a_wall_is_pushed_where_it_is_solid(name):
    section = SECTIONS[name]
    height = section.height
    openings = ((0.1 * height, 0.35 * height, 1.0), (0.5 * height, 0.9 * height, 0.3))
    liquid = liquid_in(section, 40, 0.5 * height, walls={20: openings})
    for lower, higher in ((0.2, 0.45), (0.45, 0.95), (0.6, 0.6)):

        def pushed(z, lower=lower, higher=higher):
            head = min(higher - lower, higher - z / height) if higher > lower else 1.0
            return head * section.surface_width(z) * (1 - sum(share for low, high, share in openings if low < z < high))

        edges = [lower * height, *(z for band in openings for z in band[:2] if z < higher * height)]
        force = quad(pushed, 0.0, higher * height, points=edges, limit=200)[0]
        moment = quad(lambda z, pushed=pushed: z * pushed(z), 0.0, higher * height, points=edges, limit=200)[0]
        for depths in ((lower, higher), (higher, lower)):
            found = solid_height(liquid.baffles, 1, liquid.table, *(height * depth for depth in depths))
            assert found == pytest.approx(moment / force, rel=5e-3)


def test_any_walls_in_any_section_keep_the_mass_and_only_take_energy():
    """Walls, openings, levels and flows by chance; parts that are dry or run full among them."""
    chance = np.random.default_rng(5)
    for _ in range(25):
        section = SECTIONS[chance.choice(list(SECTIONS))]
        walls = {}
        for face in chance.choice(np.arange(1, 40), chance.integers(1, 4), replace=False):
            edges = np.sort(chance.uniform(0.0, section.height, 2 * chance.integers(0, 4)))
            walls[int(face)] = tuple(
                (float(low), float(high), float(chance.choice([1.0, 0.5, 0.05])))
                for low, high in zip(edges[::2], edges[1::2], strict=True)
            )
        liquid = liquid_in(section, 40, chance.uniform(0.05, 0.95) * section.height, walls=walls)
        levels = liquid.still_depth + chance.normal(0.0, 0.3, 40) * section.height
        levels[: chance.choice([0, 20])] = 0.0
        tank = moving(liquid, np.clip(levels, 0.0, 1.1 * section.height))
        tank.flow[:] = tank.area * chance.normal(0.0, 2.0) * np.cos(np.pi * places(liquid) / LENGTH)
        mass, energies = tank.area.sum(), [tank.energy]
        for _ in range(20):
            tank.advance(0.0, 0.1)
            energies.append(tank.energy)
        assert np.all(np.diff(energies) < 0.0), walls
        assert tank.area.sum() == pytest.approx(mass, rel=1e-13)


def test_a_wall_that_the_liquid_does_not_reach_is_none():
    """Of its openings, what is wetted counts: a slot as high as the liquid lets all pass, one above it nothing."""
    open_, closed, none = (
        liquid_in(BOX, 60, 0.5, walls=walls) for walls in ({30: ((0, 1, 1),)}, {30: ((2, 3, 1),)}, {})
    )
    tanks = [moving(liquid) for liquid in (open_, closed, none)]
    for tank in tanks:
        tank.advance(-0.3, 4.0)
    assert tanks[0].depth == pytest.approx(tanks[2].depth, abs=1e-12)
    assert tanks[1].area[:30].sum() == pytest.approx(30 * 2.5 * 0.5, rel=1e-13)


def test_a_wall_open_on_top_lets_liquid_fall_into_an_empty_part():
    tank = moving(
        liquid_in(BOX, 40, 0.7, walls={20: ((1.0, 3.0, 1.0),)}), np.where((np.arange(40) - 19.5) < 0, 1.4, 0.0)
    )
    energies = [tank.energy]
    for _ in range(100):
        tank.advance(0.0, 0.2)
        energies.append(tank.energy)
    assert np.all(np.diff(energies) <= 0.0)
    # d(head)/dt = -(2/3) mu sqrt(2 g) head^1.5/(L/2)
    head = (0.4**-0.5 + 20.0 / LENGTH * 2 / 3 * np.sqrt(2 * G) / 1.65) ** -2
    assert tank.area[:20].mean() / 2.5 == pytest.approx(1.0 + head, abs=0.015)
    assert tank.area[20:].mean() / 2.5 == pytest.approx(0.4 - head, abs=0.015)


def test_a_closed_bulkhead_lets_nothing_pass_and_makes_separate_tanks():
    """Not a drop passes; each part does what a tank of its own does, and the wagon feels the sum."""
    liquid = liquid_in(CIRCLE, 120, 1.5, walls={40: (), 90: ()})
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
    liquid = liquid_in(BOX, 120, fill * 3.0, walls={40: (), 80: ()})
    for way in (1.0, -1.0):
        tank = moving(liquid)
        for k in range(200):
            tank.advance(-way * 0.2 * G * (k + 0.5) / 200, 0.1)
        tank.advance(-way * 0.2 * G, 10.0)
        impulse, turning = tank.advance(-way * 0.2 * G, 10.0)[:2] / 10.0
        assert way * turning == pytest.approx(3 * plane.moment, rel=0.01)
        assert way * impulse == pytest.approx(liquid.mass * 0.2 * G, rel=1e-3)


def test_a_still_tilted_surface_stays_still_at_a_closed_bulkhead():
    liquid = liquid_in(CIRCLE, 120, 1.5, walls={60: ()})
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


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ("openings: []", "at least one opening"),
        ("openings: [{from: 0 m, to: 0.6 m}], opening: 0.2", "beside `opening`"),
        ("openings: [{from: 0.6 m, to: 0.2 m}]", "above `from`"),
        ("openings: [{from: 2 m, to: 3.2 m}]", "3 m high tank"),
        ("openings: [{from: 0.5 m, to: 1 m}, {from: 0 m, to: 0.6 m}]", "overlap"),
        ("openings: [{from: 0 m}]", "to"),
        ("openings: [{from: -1 m, to: 1 m}]", "from"),
        ("openings: 0.6 m", "openings"),
    ],
)
def test_openings_that_cannot_be_are_refused(shipped, wall, message):
    with pytest.raises(SloshError, match=message) as refused:
        shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.baffles=[{{position: 5 m, {wall}}}]")
    assert "tank.baffles" in str(refused.value)


def test_openings_are_read_and_written(shipped):
    walls = "[{position: 5 m, openings: [{from: 2.9 m, to: 3 m}, {from: 0 m, to: 0.6 m}]}]"
    scenario = shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.baffles={walls}")
    assert scenario.tank.baffles[0].bands == ((2.9, 3.0), (0.0, 0.6))
    assert "from: 0.0 m" in scenario_to_yaml(scenario)
    liquid, _ = shallow_liquid(scenario.tank, G, 0.5)
    assert liquid.baffles.at[39] == 1
    assert liquid.baffles.low[0] == pytest.approx([0.0, 2.9])


@pytest.mark.parametrize("position", ["0 m", "0.05 m", "15.49 m", "20 m"])
def test_a_baffle_in_an_end_wall_or_outside_is_refused(shipped, position):
    with pytest.raises(SloshError, match="position"):
        shipped("paper_80", "tank.liquid.model=shallow-water", f"tank.baffles=[{{position: {position}, opening: 0.3}}]")
