"""A still liquid stays still, and hard braking neither empties, overfills nor energises the tank."""

import numpy as np
import pytest
from shallow_tools import BOX, CIRCLE, HEXAGON, SECTIONS, TROUGH, G, areas, dam, liquid_in, moving, places

TILTED = {"slightly": 0.04, "strongly": 0.3}
"""Rise at a wall over the height of the section."""


@pytest.mark.parametrize("tilt", TILTED)
@pytest.mark.parametrize("name", SECTIONS)
def test_a_still_tilted_surface_stays_still(name, tilt):
    """Acceptance: well balanced to 1e-12, over ten seconds of constant acceleration."""
    section = SECTIONS[name]
    liquid = liquid_in(section, 80, 0.5 * section.height)
    slope = TILTED[tilt] * section.height / 7.75
    tank = moving(liquid, liquid.still_depth - slope * places(liquid))
    area = tank.area.copy()
    impulse, _, work, _ = tank.advance(G * slope, 10.0)
    wave = np.sqrt(G * section.height)
    assert np.abs(tank.flow).max() < 1e-12 * wave * section.area(section.height)
    assert np.abs(tank.area - area).max() < 1e-12 * section.area(section.height)
    assert abs(work) < 1e-12 * tank.energy
    # the walls push the liquid along with the tank; the cells' mass by Simpson's rule, hence not to rounding
    carried = -liquid.density * liquid.spacing * area.sum() * G * slope * 10.0
    assert impulse == pytest.approx(carried, rel=1e-4)


STEPS = [(name, fill, G) for name in SECTIONS for fill in (0.1, 0.2, 0.5, 0.8, 0.98)]
STEPS += [(name, 0.8, 1.5) for name in SECTIONS]


def stepped(section, fill, deceleration, cells, outputs, duration):
    """A liquid under a step of deceleration: the tank, its energies, and at every output what the work missed (J)."""
    tank = moving(liquid_in(section, cells, fill * section.height))
    mass, energies, losses = tank.area.sum(), [tank.energy], []
    for _ in range(outputs):
        work = tank.advance(-deceleration, duration / outputs)[2]
        energies.append(tank.energy)
        losses.append(work - (energies[-1] - energies[-2]))
        assert tank.area.sum() == pytest.approx(mass, rel=1e-12)
    return tank, np.array(energies), np.array(losses)


@pytest.mark.parametrize(("name", "fill", "deceleration"), STEPS)
def test_dry_bed_and_full_pipe_survive_a_1_g_step(name, fill, deceleration):
    """Acceptance. Nothing but work feeds the energy: `loss >= 0` to the truncation error of a step.

    A tenth of the trough's height is a hundredth of its area and needs twice the cells for that.
    """
    section = SECTIONS[name]
    cells = 240 if (name, fill) == ("trough", 0.1) else 120
    tank, energies, losses = stepped(section, fill, deceleration, cells, 80, 8.0)
    assert losses.min() > -3e-4 * energies.max()
    assert losses.sum() > 0.0
    if fill == 0.1:
        assert tank.area.min() < 1e-3 * section.area(section.height)
    if fill == 0.98 or deceleration < G:
        assert tank.depth.max() > section.height


THIN = [(BOX, 0.02), (HEXAGON, 0.1), (CIRCLE, 0.02), (TROUGH, 0.1)]


@pytest.mark.parametrize(("section", "fill"), THIN)
def test_a_thin_layer_gains_no_energy_from_a_1_g_step(section, fill):
    """The still tilt (g over g) drops by more than the layer's depth within one cell; what is missed is truncation."""
    missed = []
    for cells in (60, 120, 240):
        tank, energies, losses = stepped(section, fill, G, cells, 80, 4.0)
        # no part of the liquid can have fallen further than from the rear wall to the front one
        assert energies.max() < tank.liquid.mass * G * (15.5 + 2 * section.height)
        missed.append(-losses.min() / energies.max())
    assert np.all(np.array(missed) < [1e-3, 3e-4, 6e-5]), missed
    assert missed[0] > 2 * missed[1] > 6 * missed[2]


def test_negative_losses_are_truncation_and_vanish_with_the_cells():
    gains = []
    for cells in (60, 120, 240):
        tank = moving(liquid_in(CIRCLE, cells, 1.5))
        energy, gain = tank.energy, 0.0
        for _ in range(60):
            work = tank.advance(-G, 0.1)[2]
            gain -= min(work - (tank.energy - energy), 0.0)
            energy = tank.energy
        gains.append(gain / energy)
    assert gains[1] < 1e-4
    assert gains[0] > 2.0 * gains[1] or gains[0] < 1e-6
    assert gains[1] > 2.0 * gains[2] or gains[1] < 1e-6


FREE = [(0.9, 0.1), (0.6, 0.0), (1.2, 0.3), (0.98, 0.95)]


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize(("behind", "before"), FREE)
def test_energy_of_an_unforced_tank_never_rises(name, behind, before):
    """Acceptance: at every output, from dry beds to heads above the roof; mass to 1e-12."""
    section = SECTIONS[name]
    tank = dam(liquid_in(section, 120, 0.5 * section.height), behind * section.height, before * section.height)
    mass, energies = tank.area.sum(), [tank.energy]
    for _ in range(120):
        tank.advance(0.0, 0.05)
        energies.append(tank.energy)
    assert np.all(np.diff(energies) <= 1e-15 * energies[0])
    assert energies[-1] < energies[0]
    assert tank.area.sum() == pytest.approx(mass, rel=1e-12)


def test_an_empty_cell_holds_still():
    liquid = liquid_in(CIRCLE, 60, 1.5)
    depth = np.where(places(liquid) < 0, 1.0, 0.0)
    tank = moving(liquid, depth)
    tank.advance(0.0, 0.2)
    far = places(liquid) > 2 * np.sqrt(G * areas(liquid, 1.0)[0] / 2.83) * 0.2 * 2
    assert np.all(tank.flow[far] == 0.0)
    assert np.all(tank.depth[far] == 0.0)
