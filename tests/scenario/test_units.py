"""Quantities: what is accepted, what it is worth in SI, what is refused."""

import math
import pickle
import subprocess
import sys
from dataclasses import replace

import pytest

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.units import DIMENSIONS, parse_quantity

ACCEPTED = [
    ("21.3 t", "mass", 21300.0),
    ("21.3t", "mass", 21300.0),
    ("  21.3   t  ", "mass", 21300.0),
    ("250 g", "mass", 0.25),
    ("80 km/h", "speed", 80 / 3.6),
    ("80 kmh", "speed", 80 / 3.6),
    ("50 mph", "speed", 22.352),
    ("0.2 g", "acceleration", 1.962),
    ("2 m/s^2", "acceleration", 2.0),
    ("2 m/s**2", "acceleration", 2.0),
    ("2 m s^-2", "acceleration", 2.0),
    ("2 m/s²", "acceleration", 2.0),
    ("2 s", "time", 2.0),
    ("10 ms", "time", 0.01),
    ("2 min", "time", 120.0),
    ("5 kN m", "torque", 5000.0),
    ("5 kN*m", "torque", 5000.0),
    ("5 kN·m", "torque", 5000.0),
    ("5 kNm", "torque", 5000.0),
    ("5 kJ", "torque", 5000.0),
    ("5 N m/rad", "torque", 5.0),
    ("0.69 rad/s", "angular_frequency", 0.69),
    ("0.69 1/s", "angular_frequency", 0.69),
    ("2 Hz", "angular_frequency", 4 * math.pi),
    ("90 deg/s", "angular_frequency", math.pi / 2),
    ("60 rpm", "angular_frequency", 2 * math.pi),
    ("200 GPa", "modulus", 2e11),
    ("2.1e11 N/m^2", "modulus", 2.1e11),
    ("2.6e6 N/m", "stiffness", 2.6e6),
    ("2.6 kN/mm", "stiffness", 2.6e6),
    ("1.5E+4 N s/m", "damping", 1.5e4),
    ("1.244 N s^2/m^2", "quadratic_resistance", 1.244),
    ("4.6e5 kg m^2", "moment_of_inertia", 4.6e5),
    ("3060 cm^4", "second_moment", 3.06e-5),
    ("9.4e10 N/m^1.5", "contact_stiffness", 9.4e10),
    ("0.83 kg/L", "density", 830.0),
    ("0.83 g/cm^3", "density", 830.0),
    ("-68461 kg m", "first_moment", -68461.0),
    (".6 s/m", "inverse_speed", 0.6),
    ("1. m", "length", 1.0),
    ("1 kg/(m s^2) m^2", "force", 1.0),
]


@pytest.mark.parametrize(("text", "dimension", "value"), ACCEPTED)
def test_accepted(text: str, dimension: str, value: float) -> None:
    assert parse_quantity(text, dimension) == pytest.approx(value, rel=1e-14)


REFUSED = [
    (80, "speed", "`80` without a unit", "write `80 km/h` or `80 m/s`"),
    ("80", "speed", "`80` without a unit", "write `80 km/h` or `80 m/s`"),
    (0.0, "time", "`0.0` without a unit", "write `0.0 s`"),
    (True, "time", "`true`, which is a truth value", "a number and a unit"),
    (None, "time", "nothing", "a number and a unit"),
    (math.nan, "time", "`nan`", "a finite number"),
    (["1 s"], "time", "a list of 1", "a number and a unit"),
    ("0.2 m", "acceleration", "which is a length", "write `0.2 m/s^2` or `0.2 g`"),
    ("0.2 kg", "acceleration", "which is a mass", "write `0.2 m/s^2`"),
    ("3 G", "mass", "`G` is no unit known here", "write `3 g`"),
    ("5 N-mm", "torque", "`N-mm` cannot be read", "write `5 N mm`"),
    ("5 kgm", "first_moment", "`kgm` is no unit known here", "write `5 kg m`"),
    ("0.8 g/cm3", "density", "`g/cm3` cannot be read", "write `0.8 g/cm^3`"),
    ("5 T", "mass", "`T` is no unit known here", "write `5 t`"),
    ("5 mt", "mass", "`mt` is no unit known here", "write `5 "),
    ("20 degC", "mass", "`degC` is no unit known here", "write `20 kg`"),
    ("20 °C", "mass", "`C` is no unit known here", "write `20 kg`"),
    ("1,5 m", "length", "`1,5 m`", "decimal point"),
    ("1 000 m", "length", "`000 m` cannot be read", "write `1 m`"),
    ("1_000 m", "length", "`_000 m` cannot be read", "write `1 m`"),
    ("1.5.2 m", "length", "`1.5.2 m`", "a finite number and a unit"),
    ("0x10 m", "length", "`x` is no unit known here", "write `0 m`"),
    ("9**9**9 m", "length", "cannot be read", "write `9 m`"),
    ("2 m^99999999", "length", "cannot be read", "write `2 m`"),
    ("2 " + "(" * 150 + "m", "length", "cannot be read", "write `2 m`"),
    ("2 __import__('os')", "length", "is no unit known here", "write `2 m`"),
    ("1 " + "m" * 1000, "length", "...`", "a finite number and a unit"),
    ("1 m\n2 m", "length", "cannot be read", "write `1 m`"),
    ("", "length", "``", "a finite number and a unit"),
]


@pytest.mark.parametrize(("text", "dimension", "given", "fix"), REFUSED)
def test_refused(text: object, dimension: str, given: str, fix: str) -> None:
    with pytest.raises(ValueRefused) as caught:
        parse_quantity(text, dimension)
    assert caught.value.rule.startswith(f"must be {DIMENSIONS[dimension].noun} with its unit, such as `")
    assert given in caught.value.given
    assert fix in caught.value.fix
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_the_suggested_unit_is_one_that_fits() -> None:
    with pytest.raises(ValueRefused) as caught:
        parse_quantity(21.3, "mass", lambda value: value > 1000.0)
    assert caught.value.fix == "write `21.3 t`"


@pytest.mark.parametrize("name", DIMENSIONS)
def test_every_suggested_unit_can_be_read_and_the_si_unit_is_exactly_one(name: str) -> None:
    kind = DIMENSIONS[name]
    assert kind.unit in kind.units
    assert all(parse_quantity(f"1 {unit}", name) > 0.0 for unit in kind.units)
    assert parse_quantity(f"0.1 {kind.unit}", name) == 0.1


TABLED = [(kind.name, unit) for kind in DIMENSIONS.values() for unit in kind.units]
TABLED.remove(("acceleration", "g"))  # the one unit with a meaning of its own


@pytest.mark.parametrize(("dimension", "unit"), TABLED)
def test_the_table_agrees_with_pint_to_the_last_bit(dimension: str, unit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tabled = parse_quantity(f"0.7 {unit}", dimension)
    monkeypatch.setitem(DIMENSIONS, dimension, replace(DIMENSIONS[dimension], factors={}))
    assert parse_quantity(f"0.7 {unit}", dimension) == tabled


def test_the_packaged_scenarios_are_read_without_pint() -> None:
    code = (
        "import sys; from slosh_cli.scenario import load_any_scenario, packaged_scenarios as found; "
        "print(len([load_any_scenario(file) for file in found().values()]), 'pint' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    count, loaded = run.stdout.split()
    assert int(count) >= 4
    assert loaded == "False"
