"""Quantities: what is accepted, what it is worth in SI, what is refused."""

import itertools
import math
import pickle
import random
import subprocess
import sys
import time
from contextlib import suppress
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
    # numbers
    ("21 300 kg", "mass", 21300.0),
    ("21\u202f300 kg", "mass", 21300.0),
    ("21\u00a0300\u00a0kg", "mass", 21300.0),
    ("21'300 kg", "mass", 21300.0),
    ("21’300.5 kg", "mass", 21300.5),
    ("1 234 567,8 N", "force", 1234567.8),
    ("2,5 m", "length", 2.5),
    ("0,460 m", "length", 0.46),
    ("1234,567 m", "length", 1234.567),
    ("1.234,5 m", "length", 1234.5),
    ("1,234.5 kg", "mass", 1234.5),
    ("1,234,567 kg", "mass", 1234567.0),
    ("1.234.567 kg", "mass", 1234567.0),
    ("\u221268461 kg m", "first_moment", -68461.0),
    ("2.1·10¹¹ Pa", "modulus", 2.1e11),
    ("2,1 x 10^11 N/m2", "modulus", 2.1e11),
    ("3.06 × 10⁻⁵ m⁴", "second_moment", 3.06e-5),
    ("10⁵ MPa", "modulus", 1e11),
    # units as engineers write them
    ("21.3 tonnes", "mass", 21300.0),
    ("21.3 metric tons", "mass", 21300.0),
    ("20 short tons", "mass", 20 * 2000 * 0.45359237),
    ("1 slug", "mass", 4.4482216152605 / 0.3048),
    ("5 kN-m", "torque", 5000.0),
    ("5 kN⋅m", "torque", 5000.0),
    ("5 kN.m", "torque", 5000.0),
    ("5 kilonewton metres", "torque", 5000.0),
    ("5 Nmm", "torque", 5e-3),
    ("5 ft-lbf", "torque", 5 * 0.3048 * 4.4482216152605),
    ("830 kg/m3", "density", 830.0),
    ("830 kg·m⁻³", "density", 830.0),
    ("830 kg m-3", "density", 830.0),
    ("830 kg m^{-3}", "density", 830.0),
    ("0.83 kg/l", "density", 830.0),
    ("0.83 t/m3", "density", 830.0),
    ("7 lb/US gal", "density", 7 * 0.45359237 / (231 * 0.0254**3)),
    ("22.2 m·s⁻¹", "speed", 22.2),
    ("50 knots", "speed", 50 * 1852 / 3600),
    ("80 km/hr", "speed", 80 / 3.6),
    ("3060 cm4", "second_moment", 3.06e-5),
    ("73.5 in^4", "second_moment", 73.5 * 0.0254**4),
    ("206 kN/mm2", "modulus", 2.06e11),
    ("210000 N/mm²", "modulus", 2.1e11),
    ("30000 ksi", "modulus", 3e7 * 4.4482216152605 / 0.0254**2),
    ("136 lb/yd", "mass_per_length", 136 * 0.45359237 / 0.9144),
    ("1700 kgm2", "moment_of_inertia", 1700.0),
    ("1700 kg*m**2", "moment_of_inertia", 1700.0),
    ("15 kNs/m", "damping", 15000.0),
    ("15 kN/(m/s)", "damping", 15000.0),
    ("1.2 N/(m/s)²", "quadratic_resistance", 1.2),
    ("2 kp", "force", 2 * 9.80665),
    ("3 kips", "force", 3000 * 4.4482216152605),
    ("90 °/s", "angular_frequency", math.pi / 2),
    ("6 rev/min", "angular_frequency", math.pi / 5),
    ("5 µm", "length", 5e-6),
    ("0.2·g", "acceleration", 1.962),
    ("2.1·10¹¹·N/m²", "modulus", 2.1e11),
    ("0.4 kN·s²/m²", "quadratic_resistance", 400.0),
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
    ("0.2 m", "acceleration", "which is a length", "such as `1 m/s^2`"),
    ("0.2 kg", "acceleration", "which is a mass", "such as `1 m/s^2`"),
    ("3 G", "mass", "`G` is no unit known here", "such as `1 kg`"),
    ("5 T", "mass", "`T` is no unit known here", "such as `1 kg`"),
    ("5 mt", "mass", "`mt` is no unit known here", "such as `1 kg`"),
    ("5 mN m", "torque", "`mN` is no unit known here", "such as `1 kN m`"),
    ("5 KN m", "torque", "`KN` is no unit known here", "write `5 kN m`"),
    ("5 KNm", "torque", "`KNm` is no unit known here", "write `5 kNm`"),
    ("50 KM/H", "speed", "`KM` is no unit known here", "such as `1 km/h`"),
    ("5 Dm", "length", "`Dm` is no unit known here", "such as `1 m`"),
    ("5 decametres", "length", "`decametres` is no unit known here", "such as `1 m`"),
    ("20 degC", "mass", "`degC` is no unit known here", "such as `1 kg`"),
    ("20 °C", "mass", "`degC` is no unit known here", "such as `1 kg`"),
    ("3.8 bar", "torque", "which is a pressure", "such as `1 kN m`"),
    ("1e999 m", "length", "which overflows", "a finite number and a unit, such as `1 m`"),
    ("1e308 g", "acceleration", "which overflows", "a finite number and a unit"),
    ("1e308 kN-m", "torque", "`1e308 kN-m`, which overflows", "a finite number and a unit"),
    ("60 %", "mass", "which is a pure number", "such as `1 kg`"),
    ("0.2 grams", "acceleration", "which is a mass", "such as `1 m/s^2`"),
    ("5 m percent", "length", "`percent` is no unit known here", "such as `1 m`"),
    ("1,000 kg", "mass", "whose comma can part thousands or decimals", "write `1000 kg` or `1.000 kg`, whichever"),
    ("-2,500 m", "length", "thousands or decimals", "write `-2500 m` or `-2.500 m`, whichever is meant"),
    ("21,300", "mass", "without a unit", "write `21300 kg`, `21300 t`, `21.300 kg` or `21.300 t`"),
    ("20 tons", "mass", "can be several", "write `20 metric tons`, `20 short tons` or `20 long tons`, whichever"),
    ("7 lb/gal", "density", "can be several units", "write `7 lb/US gal` or `7 lb/imperial gal`, whichever is meant"),
    ("60 1/min", "angular_frequency", "turns to some people", "write `60 rpm` or `60 rad/min`, whichever is meant"),
    ("80 km/h-1", "speed", "`km/h-1` cannot be read", "such as `1 km/h`"),
    ("5 Nms", "shear_damping", "`Nms` is no unit known here", "such as `1 N s`"),
    ("5 kg/m 3", "density", "`kg/m 3` cannot be read", "such as `1 kg/m^3`"),
    ("5 ft 3 in", "length", "`ft 3 in` cannot be read", "such as `1 m`"),
    ("10-12 m", "length", "`-12 m` cannot be read", "such as `1 m`"),
    ("1½ m", "length", "`½ m` cannot be read", "such as `1 m`"),
    ("1 00 m", "length", "`00 m` cannot be read", "such as `1 m`"),
    ("1,23,456 m", "length", "`1,23,456 m`", "a finite number and a unit, such as `1 m`"),
    ("1_000 m", "length", "`1_000 m`", "a finite number and a unit, such as `1 m`"),
    ("1.5.2 m", "length", "`1.5.2 m`", "a finite number and a unit"),
    ("0x10 m", "length", "`x` is no unit known here", "such as `1 m`"),
    ("9**9**9 m", "length", "cannot be read", "such as `1 m`"),
    ("2 m^99999999", "length", "cannot be read", "such as `1 m`"),
    ("2 " + "(" * 150 + "m", "length", "cannot be read", "such as `1 m`"),
    ("2 __import__('os')", "length", "cannot be read", "such as `1 m`"),
    ("1 " + "m" * 1000, "length", "...`", "a finite number and a unit"),
    ("1 m\n2 m", "length", "cannot be read", "such as `1 m`"),
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
    with pytest.raises(ValueRefused) as caught:
        parse_quantity("21.3", "mass", lambda value: value > 1e6, "80 t")
    assert caught.value.fix == "write a number and a unit, such as `80 t`"


@pytest.mark.parametrize("name", DIMENSIONS)
def test_every_suggested_unit_can_be_read_and_the_si_unit_is_exactly_one(name: str) -> None:
    kind = DIMENSIONS[name]
    assert kind.unit in kind.units
    assert all(parse_quantity(f"1 {unit}", name) > 0.0 for unit in kind.units)
    assert parse_quantity(f"0.1 {kind.unit}", name) == 0.1


TABLED = [(kind.name, unit) for kind in DIMENSIONS.values() for unit in kind.factors]
TABLED.remove(("acceleration", "g"))  # the one unit with a meaning of its own


@pytest.mark.parametrize(("dimension", "unit"), TABLED)
def test_the_table_agrees_with_pint_to_the_last_bit(dimension: str, unit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tabled = parse_quantity(f"0.7 {unit}", dimension)
    monkeypatch.setitem(DIMENSIONS, dimension, replace(DIMENSIONS[dimension], factors={}))
    assert parse_quantity(f"0.7 {unit}", dimension) == tabled


ALPHABET = "kKmMgGNsthlbPa%°µ 0123456789.,'^-*/()·⁻³¹×xe\u202f\u2212"


def test_whatever_is_written_is_read_or_refused_at_once() -> None:
    chance = random.Random(10)
    texts = ["".join(chance.choices(ALPHABET, k=chance.randrange(1, 20))) for _ in range(3000)]
    texts += ["5 " + "KN " * 60, "5 " + "km^9 " * 30, "5 " + "mm^9.9 " * 20, "1" + " " * 150 + "x", "5 " + "(m)" * 60]
    started = time.perf_counter()
    for text, dimension in zip(texts, itertools.cycle(DIMENSIONS), strict=False):
        with suppress(ValueRefused):
            assert math.isfinite(parse_quantity(f"5{text}" if chance.random() < 0.5 else text, dimension))
    assert time.perf_counter() - started < 10.0


def test_the_packaged_scenarios_are_read_without_pint() -> None:
    code = (
        "import sys; from slosh_cli.scenario import load_any_scenario, packaged_scenarios as found; "
        "print(len([load_any_scenario(file) for file in found().values()]), 'pint' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    count, loaded = run.stdout.split()
    assert int(count) >= 4
    assert loaded == "False"
