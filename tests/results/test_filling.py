"""What the law for dangerous goods says of a filling (ADR 4.3.2.2), as a verdict with its source."""

import math

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
        (("limits.part_volume=8 m^3",), "[{from: 0.1 m, to: 0.3 m}, {from: 1.6 m, to: 1.99 m}]", True),
        (
            ("limits.part_volume=8 m^3",),
            "[{from: 0.1 m, to: 0.3 m}, {from: 1.6 m, to: 2 m}, {from: 1 m, to: 1.02 m}]",
            False,
        ),
        (("limits.part_volume=8 m^3", "limits.wall_opening=0.5"), "0.31", True),
        ((), "0", False),
        (("limits.filling_low=0.5",), "", True),
        (("limits.filling_high=0.5",), "", True),
    ],
)
def test_walls_thick_liquids_and_other_limits(shipped, overrides, opening, allowed):
    """Four walls leave parts of 8 m^3."""
    walls = WALLS.replace("opening", "openings") if opening.startswith("[") else WALLS
    surge, _ = told(boxed(shipped, 0.5, *overrides, baffles=walls.replace("OPEN", opening) if opening else ""))
    assert surge.within is allowed


@pytest.mark.parametrize("share", [0.2, 0.8])
def test_a_volume_of_just_the_allowed_share_is_allowed(shipped, share):
    """The fill that belongs to a volume is found by iteration; its last digits decide nothing."""
    for radius in (1.07, 1.21, 1.33, 1.48, 1.57):
        volume = share * math.pi * radius**2 * 15.5
        size = (f"tank.radius={radius} m", "tank.liquid.model=rigid")
        just = shipped("tank_wagon", *size, f"tank.volume={volume!r} m^3")
        assert told(just)[0].within
        inside = volume * (1.001 if share < 0.5 else 0.999)
        assert not told(shipped("tank_wagon", *size, f"tank.volume={inside!r} m^3"))[0].within


@pytest.mark.parametrize("own", ["filling_low=0.3", "filling_high=0.7", "part_volume=9 m^3", "wall_opening=0.2"])
def test_a_limit_of_the_scenario_is_not_called_the_law_s(shipped, own):
    surge, room = told(boxed(shipped, 0.5, f"limits.{own}"))
    assert surge.standing == "assumed"
    assert surge.source.startswith(f"limits.{own.partition('=')[0]} of the scenario; usual: ADR 4.3.2.2.4")
    assert surge.source in surge.meaning
    assert room.source.startswith("ADR 4.3.2.2.1")


@pytest.mark.parametrize(("degree", "standing"), [(0.98, "indicative"), (0.95, "indicative"), (0.9, "assumed")])
def test_the_law_knows_four_degrees(shipped, degree, standing):
    _, room = told(boxed(shipped, 0.5, f"limits.filling_degree={degree}"))
    assert room.standing == standing


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
