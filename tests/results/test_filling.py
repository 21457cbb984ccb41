"""What the law for dangerous goods says of a filling (ADR 4.3.2.2), as a verdict with its source."""

import pytest

from slosh_cli.results.filling import degree_of_filling, filling_checks

BOX = "tank={shape: rectangular, width: 2 m, height: 2 m, length: 10 m, bottom_height: 1 m, "
WALLS = ", ".join(f"{{position: {k} m, opening: OPEN}}" for k in (2, 4, 6, 8))


def boxed(shipped, fill, *overrides, baffles=""):
    """A box of 40 m^3 on the packaged wagon."""
    liquid = "liquid: {model: shallow-water, density: 800 kg/m^3}"
    return shipped("tank_wagon", f"{BOX}fill: {fill}, {liquid}, baffles: [{baffles}]}}", *overrides)


def told(scenario):
    surge, room = filling_checks(scenario.tank, scenario.limits)
    return surge, room


@pytest.mark.parametrize(("fill", "allowed"), [(0.1, True), (0.2, True), (0.21, False), (0.79, False), (0.8, True)])
def test_a_large_undivided_shell_is_nearly_full_or_nearly_empty(shipped, fill, allowed):
    surge, _ = told(boxed(shipped, fill))
    assert surge.within is allowed
    assert (surge.standing, surge.kind) == ("indicative", "operation")
    for text in (surge.meaning, surge.source):
        assert "ADR 4.3.2.2.4" in text
        assert "for RID tank-wagons the corresponding rule could not be verified" in text
    assert "40 m^3, over 7.5 m^3" in surge.meaning


@pytest.mark.parametrize(
    ("overrides", "opening", "allowed"),
    [
        (("limits.viscosity=2680 mm^2/s",), "", True),
        (("limits.viscosity=2679 mm^2/s",), "", False),
        (("limits.viscosity=100 mm^2/s", "limits.exempt_viscosity=90 mm^2/s"), "", True),
        (("limits.part_volume=40 m^3",), "", True),
        (("limits.part_volume=8 m^3",), "0.3", True),
        (("limits.part_volume=8 m^3",), "0", True),
        (("limits.part_volume=8 m^3",), "0.31", False),
        (("limits.part_volume=8 m^3", "limits.wall_opening=0.5"), "0.31", True),
        ((), "0", False),
        (("limits.filling_low=0.5",), "", True),
        (("limits.filling_high=0.5",), "", True),
    ],
)
def test_walls_thick_liquids_and_other_limits(shipped, overrides, opening, allowed):
    """Four walls leave parts of 8 m^3."""
    surge, _ = told(boxed(shipped, 0.5, *overrides, baffles=WALLS.replace("OPEN", opening) if opening else ""))
    assert surge.within is allowed


def test_the_liquid_keeps_room_to_expand(shipped):
    _, room = told(boxed(shipped, 0.9))
    assert room.value == pytest.approx(0.9)
    assert room.limit == pytest.approx(1 / (1 + 1.2e-3 * 35))
    other = ("limits.filling_degree=95 %", "limits.filling_celsius=30", "limits.expansion_per_kelvin=0.001")
    _, tighter = told(boxed(shipped, 0.94, *other))
    assert tighter.limit == pytest.approx(0.95 / 1.02)
    assert not tighter.within
    assert "at most 93.1%" in tighter.meaning


def test_a_degree_of_filling_counts_volumes_not_depths(shipped):
    assert degree_of_filling(shipped("tank_wagon", "tank.fill=0.25").tank) == pytest.approx(0.1955, abs=1e-4)
