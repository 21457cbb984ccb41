"""Messages follow from the models alone: lists of mappings and unions that no scenario has yet are known at once."""

from typing import Annotated, Literal

import pytest
from pydantic import Discriminator, Field, Tag

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.diagnosis import diagnose
from slosh_cli.scenario.leaves import Number, Quantity, Range
from slosh_cli.scenario.loader import Root
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.schema import Scenario, TankScenario
from slosh_cli.scenario.tree import Spot


class Axle(Part):
    load: Annotated[float, Quantity("force", Range(0.0, 1e6), "100 kN")]
    wear: Annotated[float, Number(Range(0.0, 1.0), "0.5")] = 0.0


class Steam(Part):
    kind: Literal["steam"] = "steam"
    name: Annotated[float, Number(Range(0.0, 1.0), "0.5")]
    pressure: Annotated[float, Number(Range(0.0, 99.0), "12")]
    axles: tuple[Axle, ...] = ()


class Diesel(Part):
    kind: Literal["diesel"] = "diesel"
    name: Annotated[float, Number(Range(0.0, 1.0), "0.5")]
    cylinders: Annotated[float, Number(Range(0.0, 99.0), "12")]


def which(value: object) -> str:
    return "word" if isinstance(value, str) else "axles"


class Engine(Root):
    """A model with every form that a scenario may have."""

    drive: Annotated[Steam | Diesel, Field(discriminator="kind")]
    axles: list[Axle]
    spare: Axle | None = None
    either: Annotated[
        Annotated[Literal["none"], Tag("word")] | Annotated[tuple[Axle, ...], Tag("axles")], Discriminator(which)
    ] = "none"
    free: float | Axle | list[Axle] = 0.0


SOUND = {
    "format": 1, "name": "engine", "drive": {"kind": "steam", "name": 0.5, "pressure": 12}, "axles": [{"load": "1 kN"}],
}  # fmt: skip


def findings(**changes: object) -> dict[str, Finding]:
    return {".".join(map(str, finding.path)): finding for finding in diagnose(Engine, {**SOUND, **changes})[1]}


def test_the_sound_one_is_sound() -> None:
    assert findings() == {}


AXLES = [{"load": "1 kN"}, {"laod": "1 kN"}]


@pytest.mark.parametrize(
    ("key", "value", "path"),
    [
        ("axles", AXLES, "axles.1.laod"),
        ("either", AXLES, "either.1.laod"),
        ("spare", AXLES[1], "spare.laod"),
        ("drive", {**SOUND["drive"], "axles": AXLES}, "drive.axles.1.laod"),
        ("free", AXLES[1], "free.laod"),
    ],
)
def test_a_misspelt_key_is_answered_with_the_keys_of_its_own_mapping(key: str, value: object, path: str) -> None:
    found = findings(**{key: value})[path]
    assert (found.given, found.fix) == ("`laod`", "write `load`")
    assert found.rule == f"is not a key of `{path.rpartition('.')[0]}`"


def test_an_item_of_another_form_is_answered_with_the_keys_of_an_item() -> None:
    found = findings(axles=["1 kN", {"load": "1 kN"}])["axles.0"]
    assert "with the keys load and wear" in found.rule
    assert found.fix == "write the item as `{load: ...}`"


def test_a_mapping_in_place_of_a_list() -> None:
    found = findings(axles={"load": "1 kN"})["axles"]
    assert (found.rule, found.given, found.fix) == ("must be a list", "a mapping", "write each item as `- {load: ...}`")


def test_a_missing_list_and_a_missing_union() -> None:
    found = {".".join(map(str, finding.path)): finding for finding in diagnose(Engine, {"format": 1, "name": "a"})[1]}
    assert found["axles"].fix == "write `axles:` with items such as `- {load: ...}` under it"
    assert found["drive"].fix == "write `drive:` with the keys kind, name and those of its kind under it"


def test_a_union_names_its_branches() -> None:
    assert findings(drive={"name": 1})["drive.kind"].fix == "write `kind: steam` or `kind: diesel`"
    assert findings(drive={"kind": "stean", "name": 1, "pressure": 2})["drive.kind"].fix == "write `steam`"
    belongs = findings(drive={**SOUND["drive"], "cylinders": 3})["drive.cylinders"]
    assert belongs.rule == "is not a key of a drive of kind steam"
    assert belongs.given == "`cylinders`, which belongs to kind diesel"


def test_a_misspelt_branch_does_not_hide_the_rest() -> None:
    found = findings(drive={"kind": "dieesel", "name": 1, "cylinders": "many"})
    assert list(found) == ["drive.kind", "drive.cylinders"]
    by_its_key = findings(drive={"kind": "x", "pressure": "high", "name": 1})
    assert "drive.pressure" in by_its_key


def test_scenarios_in_terms_of_the_tree() -> None:
    data = {"tank": {"shape": "rectangular", "baffles": [{}], "coefficients": [{}]}}
    root = Spot(part=Scenario)
    names = {path: root.part_at(data, path) for path in [("tank",), ("tank", "baffles", 0), ("wagon", "bogie")]}
    assert [part.__name__ for part in names.values() if part] == ["Rectangular", "Baffle", "Bogie"]
    assert [path for path, spot, _ in root.inner(data) if spot.parts] == [("tank",)]
    assert list(Spot(part=TankScenario).places("density", {})) == [("tank", "liquid", "density")]
    assert list(Spot(part=TankScenario).places("radius", {})) == []
