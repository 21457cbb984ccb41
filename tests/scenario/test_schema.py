"""The models themselves: built in Python, described for editors, outlines in standard form."""

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from malformed_case import BASE
from pydantic import ValidationError
from test_units import ACCEPTED

from slosh_cli.scenario import (
    Adhesion,
    Contact,
    Elliptical,
    HorizontalCylinder,
    Liquid,
    Polygon,
    Rectangular,
    Scenario,
    json_schema,
    parse_scenario,
)
from slosh_cli.scenario.base import Part

WATER = Liquid(model="modal", density=1000.0)


def descendants(model: type[Part]) -> Iterator[type[Part]]:
    """All classes derived from a model."""
    for derived in model.__subclasses__():
        yield derived
        yield from descendants(derived)


def test_python_takes_si_numbers() -> None:
    tank = HorizontalCylinder(length=5.75, fill=0.5, liquid=WATER, radius=1.2)
    assert (tank.shape, tank.height, tank.width, tank.coefficients, tank.modes) == (
        "horizontal-cylinder", 2.4, 2.4, "computed", 1,
    )  # fmt: skip
    assert Rectangular(length=5, fill=0.5, liquid=WATER, width=2, height=1).height == 1.0
    assert Elliptical(length=5, fill=0.5, liquid=WATER, width=2, height=1).width == 2.0
    assert Adhesion(mu0=0.3, A=0.4, B=0.2, kA=0.3, kS=0.1).B == 0.2


def test_python_takes_texts_with_units_too() -> None:
    steel: dict[str, Any] = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "rail_crown_radius": "300 mm"}
    contact = Contact(**steel, kalker_c11=4.12, adhesion="wet")  # type: ignore[arg-type]
    assert (contact.youngs_modulus, contact.rail_crown_radius, contact.adhesion.mu0) == (2.1e11, 0.3, 0.3)


@pytest.mark.parametrize("radius", [-1.0, 0.0, 11.0, float("nan"), float("inf"), True, None, "1.2"])
def test_python_is_checked_like_a_file(radius: Any) -> None:
    with pytest.raises(ValidationError):
        HorizontalCylinder(length=5.75, fill=0.5, liquid=WATER, radius=radius)


def test_rules_between_values_hold_in_python_too() -> None:
    sound = parse_scenario(BASE)
    short = sound.track.model_copy(update={"domain": sound.track.domain.model_copy(update={"length": 15.0})})
    values = {name: getattr(sound, name) for name in Scenario.model_fields}
    with pytest.raises(ValidationError, match=r"track\.domain\.length must hold the wheels"):
        Scenario(**{**values, "track": short})


def test_models_are_frozen() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        WATER.density = 900.0  # type: ignore[misc]


OUTLINES = {
    "clockwise": [[-1, 2], [1, 2], [1, 0], [-1, 0]],
    "closed": [[-1, 0], [1, 0], [1, 2], [-1, 2], [-1, 0]],
    "with units": [["-100 cm", 0], ["1 m", "0 mm"], [1, "200 cm"], [-1, 2]],
    "corner on a straight side": [[-1, 0], [0.3, 0], [1, 0], [1, 2], [-1, 2]],
    "almost symmetric": [[-1, 0], [1.0000005, 0], [1, 2], [-1, 2]],
    "not convex": [[-1, 0.5], [0, 0], [1, 0.5], [0.4, 1.0], [1, 2], [-1, 2], [-0.4, 1.0]],
    "pointed": [[0, 0], [1, 1], [0, 2], [-1, 1]],
}


@pytest.mark.parametrize("name", OUTLINES)
def test_outlines_have_a_standard_form(name: str) -> None:
    tank = Polygon(length=5, fill=0.5, liquid=WATER, points=OUTLINES[name])  # type: ignore[arg-type]
    points = tank.points
    assert all(isinstance(number, float) for point in points for number in point)
    following = [*points[1:], points[0]]
    assert sum(y0 * z1 - y1 * z0 for (y0, z0), (y1, z1) in zip(points, following, strict=True)) > 0.0
    assert points[0] != points[-1]
    assert (tank.height, tank.width) == (2.0, pytest.approx(2.0, rel=1e-6))


BROKEN_OUTLINES = {
    "flat": [[-1, 0], [0, 0], [1, 0]],
    "spike": [[-1, 0], [1, 0], [1, 2], [0, 2], [0, 3], [0, 2], [-1, 2]],
    "side through a corner": [[-1, 0], [1, 0], [1, 2], [0, 0], [-1, 2]],
    "figure of eight": [[-1, 0], [1, 0], [-1, 2], [1, 2]],
    "same corners, other sides": [[-1, 0], [1, 0], [2, 1], [1, 2], [0.5, 1], [-1, 2], [-2, 1], [-0.5, 1]],
    "leaning": [[-1, 0], [1, 0], [1.5, 2], [-0.5, 2]],
    "truth values": [[False, 0], [1, 0], [1, 2], [-1, 2]],
    "not a number": [[float("nan"), 0], [1, 0], [1, 2], [-1, 2]],
    "empty": [],
}


@pytest.mark.parametrize("name", BROKEN_OUTLINES)
def test_broken_outlines_are_refused(name: str) -> None:
    with pytest.raises(ValidationError):
        Polygon(length=5, fill=0.5, liquid=WATER, points=BROKEN_OUTLINES[name])  # type: ignore[arg-type]


def test_every_field_is_described() -> None:
    models = [model for model in descendants(Part) if model.__module__.startswith("slosh_cli")]
    assert len(models) > 20
    for model in models:
        assert model.__doc__
        for name, field in model.model_fields.items():
            assert field.description, f"{model.__name__}.{name}"


def test_json_schema_names_units_and_its_examples_are_texts() -> None:
    schema = json.loads(json.dumps(json_schema()))
    torque = schema["$defs"]["Braking"]["properties"]["torque"]
    assert (torque["type"], torque["x-unit"], torque["examples"]) == ("string", "N m", ["5 kN m"])
    assert schema["$defs"]["Braking"]["properties"]["stop_speed"]["default"] == "0.02 m/s"
    domain = schema["$defs"]["Domain"]
    assert "required" not in domain
    assert all(
        "default" not in entry and "Default: " in entry["description"] for entry in domain["properties"].values()
    )
    assert schema["required"] == ["format", "name", "tank"]
    assert schema["then"]["required"] == ["wagon", "braking"]
    height = [{"required": ["bottom_height"]}, {"required": ["use"]}]
    assert schema["then"]["properties"]["tank"]["anyOf"] == height
    cylinder = schema["$defs"]["HorizontalCylinder"]
    assert {"shape", "length"} <= set(cylinder["required"])
    amounts = [{"required": [key]} for key in ("fill", "volume", "mass", "gross_mass")]
    assert cylinder["allOf"] == [
        {"oneOf": [{"required": ["radius"]}, {"required": ["diameter"]}]},
        {"oneOf": amounts},
    ]
    assert schema["$defs"]["Contact"]["properties"]["adhesion"]["anyOf"][0] == {"enum": ["dry", "wet"]}
    assert all(not definition["additionalProperties"] for definition in schema["$defs"].values())


def test_json_schema_patterns_accept_their_own_examples_and_no_bare_number() -> None:
    quantities = [
        entry
        for definition in json_schema()["$defs"].values()
        for entry in definition["properties"].values()
        if "x-unit" in entry and "pattern" in entry
    ]
    assert len(quantities) > 40
    for entry in quantities:
        assert entry["x-unit"]
        assert entry["x-range"]
        assert all(re.search(entry["pattern"], example) for example in entry["examples"])
        assert not any(re.search(entry["pattern"], bare) for bare in ("12.5", "12.51", "-3", "1e5", "2.6e+6", " 7 "))
        assert all(re.search(entry["pattern"], text) for text, _, _ in ACCEPTED)


@pytest.mark.parametrize("key", ["fill", "damping_ratio", "mu0", "tolerance", "opening"])
def test_json_schema_takes_percentages_for_pure_numbers(key: str) -> None:
    found = [entry[key] for entry in (part["properties"] for part in json_schema()["$defs"].values()) if key in entry]
    assert found
    for entry in found:
        number, share = entry["anyOf"]
        assert number["type"] == "number"
        assert all(re.search(share["pattern"], text) for text in ("60 %", "60%", "0.5 per cent", "2,5 ‰"))
        assert not any(re.search(share["pattern"], text) for text in ("60", "60 m", "half"))
