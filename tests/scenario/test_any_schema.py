"""A schema that no scenario has: line, guess and keys of every message follow from its classes alone."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import Field

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import scenario_to_yaml
from slosh_cli.scenario.base import Alias, Aliased, Part
from slosh_cli.scenario.leaves import Count, Number, Quantity, Range
from slosh_cli.scenario.loader import Root, read
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.short import Short
from slosh_cli.scenario.words import Text
from slosh_cli.scenario.yaml_text import parse

SHARE = Number(Range(0.0, 1.0), "0.4")
FORCE = Quantity("force", Range(0.0, 1e6), "20 kN")
TIME = Quantity("time", Range(0.0, 100.0), "4 s")


def falling(v: Values) -> Iterator[Finding]:
    if v.has("first", "last") and v["last"] >= v["first"]:
        yield Finding(("last",), "must be below the first", f"`{v['last']}`", "write a lower one")


class Crew(Part):
    rules = (falling,)
    first: Annotated[float, SHARE]
    last: Annotated[float, SHARE]


class Sudden(Part):
    form: Literal["sudden"] = "sudden"


class Rising(Part):
    form: Literal["rising"] = "rising"
    time: Annotated[float, TIME]
    delay: Annotated[float, TIME] = 0.0


class Grip(Part):
    level: Annotated[float, SHARE]
    fade: Annotated[float, SHARE] = 0.0


class Block(Part):
    kind: Literal["block"] = "block"
    force: Annotated[float, FORCE]
    rise: Annotated[Sudden | Rising, Field(discriminator="form")]


class Disc(Aliased):
    aliases = (Alias("diameter", "radius", 2.0, "0.8 m", "Diameter."),)
    kind: Literal["disc"] = "disc"
    radius: Annotated[float, Quantity("length", Range(0.1, 1.0), "0.4 m")]


class Ship(Root):
    noun = "ship"
    exactly_one = (("oars", "sail"),)
    oars: Annotated[int, Count(1, 200)] | None = None
    sail: Crew | None = None
    crews: tuple[Crew, ...] = Field(min_length=1)
    brakes: tuple[Annotated[Block | Disc, Field(discriminator="kind")], ...] = ()
    grip: Annotated[
        Grip,
        Short(
            {"dry": Grip(level=0.5), "wet": Grip(level=0.2)}, SHARE, lambda level: Grip(level=level), "a share", "0.3"
        ),
    ] = Grip(level=0.5)
    start: Annotated[Sudden | Rising, Field(discriminator="form"), Short({"now": Sudden(), "P": Rising(time=4.0)})] = (
        Sudden()
    )
    spare: Block | None = None
    load: Annotated[float, FORCE] | tuple[Crew, ...] = 0.0
    cargo: dict[str, Annotated[Block | Disc, Field(discriminator="kind")]] = Field(default={})
    words: dict[str, Annotated[str, Text(10)]] = Field(default={})


SOUND = """\
format: 1
name: argo
oars: 50
crews:
  - {first: 0.9, last: 0.1}
  - {first: 0.8, last: 0.2}
brakes:
  - {kind: block, force: 20 kN, rise: {form: rising, time: 4 s}}
  - {kind: disc, diameter: 0.8 m}
  - kind: block
    force: 10 kN
    rise: {form: sudden}
grip: dry
start: P
load: 3 kN
cargo: {bow: {kind: disc, radius: 0.5 m}}
words: {a.b: c}
"""

GRIP = "must be `dry`, `wet`, a share or a mapping of level and fade"
KINDS = "must be `block` or `disc`"
CASES: dict[str, tuple[str, str, list[str]]] = {
    "key of the root": ("oars:", "oras:", ["3: oras: is not a key of a ship; given `oras`; write `oars`"]),
    "key of an item": (
        "{first: 0.8,", "{frist: 0.8,", ["6: crews.1.frist: is not a key of `crews.1`; given `frist`; write `first`"],
    ),
    "key of a branch in a list": (
        "    force: 10", "    forse: 10",
        ["11: brakes.2.forse: is not a key of `brakes.2`, of kind block; given `forse`; write `force`"],
    ),
    "key of the other branch": (
        "{kind: disc, dia", "{force: 3 kN, kind: disc, dia",
        ["9: brakes.1.force: is not a key of `brakes.1`, of kind disc; given `force`, which belongs to kind block; "
         "take it out; the keys here are kind, radius and diameter"],
    ),
    "key of a union inside a branch": (
        "rising, time: 4 s", "rising, tmie: 4 s",
        ["8: brakes.0.rise.tmie: is not a key of a rise of form rising; given `tmie`; write `time`"],
    ),
    "wrong tag in a list": (
        "- kind: block", "- kind: blok", [f"10: brakes.2.kind: {KINDS}; given `blok`; write `block`"],
    ),
    "wrong tags, one inside the other": (
        "- {kind: block, force: 20 kN, rise: {form: rising,", "- {kind: clock, force: 20 kg, rise: {form: rise,",
        [f"8: brakes.0.kind: {KINDS}; given `clock`; write `block`",
         "8: brakes.0.force: must be a force with its unit, such as `N` or `kN`; given `20 kg`, which is a mass; write",
         "8: brakes.0.rise.form: must be `sudden` or `rising`; given `rise`; write `rising`"],
    ),
    "no tag, but a telling key": (
        "- {kind: disc, diameter: 0.8 m}", "- {diameter: 9 m}",
        ["9: brakes.1.kind: is required; given nothing; write `kind: block` or `kind: disc`",
         "9: brakes.1.diameter: must be a length from 0.2 m to 2 m; given `9 m`; write a value within"],
    ),
    "wrong value in the third item": (
        "    force: 10 kN", "    force: 10 MN",
        ["11: brakes.2.force: must be a force from 0 N to 1e6 N; given `10 MN` = 1e7 N; write a value within"],
    ),
    "word for an item": (
        "- {kind: disc, diameter: 0.8 m}", "- disc",
        ["9: brakes.1: must be a mapping; given `disc`; write the item as `{kind: block, force: ..., rise: ...}`"],
    ),
    "mapping for a list": (
        "crews:\n  - {first: 0.9, last: 0.1}\n  - {first: 0.8, last: 0.2}", "crews: {first: 0.9, last: 0.1}",
        ["4: crews: must be a list; given a mapping; write each item as `- {first: ..., last: ...}`"],
    ),
    "empty list": (
        "crews:\n  - {first: 0.9, last: 0.1}\n  - {first: 0.8, last: 0.2}", "crews: []",
        ["4: crews: must have at least 1 entry; given none; write each as `- {first: ..., last: ...}`"],
    ),
    "rule of an item": ("last: 0.2}", "last: 0.9}", ["6: crews.1.last: must be below the first; given `0.9`"]),
    "rule of an item beside a broken one": (
        "{first: 0.9, last: 0.1}\n  - {first: 0.8, last: 0.2}", "{first: 9, last: 0.1}\n  - {first: 0.8, last: 0.9}",
        ["5: crews.0.first: must be a number from 0 to 1; given `9`", "6: crews.1.last: must be below the first"],
    ),
    "misspelt word": ("grip: dry", "grip: drie", [f"13: grip: {GRIP}; given `drie`; write `dry`"]),
    "no word at all": (
        "grip: dry", "grip: icy",
        [f"13: grip: {GRIP}; given `icy`; write `dry` or `wet`, or something such as `0.3` or `{{level: 0.4}}`"],
    ),
    "key in a mapping that may be a word": (
        "grip: dry", "grip: {levl: 0.4}", ["13: grip.levl: is not a key of `grip`; given `levl`; write `level`"],
    ),
    "word for a union": (
        "start: P", "start: Q",
        ["14: start: must be `now`, `P` or a mapping with its `form`; given `Q`; "
         "write `now` or `P`, or something such as `{form: sudden}`"],
    ),
    "tag of a union that may be a word": (
        "start: P", "start: {form: risen, time: 4}",
        ["14: start.form: must be `sudden` or `rising`; given `risen`; write `rising`",
         "14: start.time: must be a time with its unit, such as `s` or `ms`; given `4` without a unit; write `4 s` or"],
    ),
    "part or nothing": (
        "load:", "spare: {kind: block, farce: 3 kN, rise: {form: sudden}}\nload:",
        ["15: spare.farce: is not a key of `spare`; given `farce`; write `force`"],
    ),
    "value or list": (
        "load: 3 kN", "load: {first: 1}",
        ["15: load: must be a single value or a list; given a mapping; write `20 kN` or `[{first: ..., last: ...}]`"],
    ),
    "item of a value or list": (
        "load: 3 kN", "load: [{first: 1, lost: 0}]",
        ["15: load.0.lost: is not a key of `load.0`; given `lost`; write `last`"],
    ),
    "unit of a value or list": (
        "load: 3 kN", "load: 3",
        ["15: load: must be a force with its unit, such as `N` or `kN`; given `3` without a unit"],
    ),
    "under a key of one's own": (
        "disc, radius", "disc, radios",
        ["16: cargo.bow.radios: is not a key of `cargo.bow`, of kind disc; given `radios`; write `radius`"],
    ),
    "value under a key of one's own": (
        "a.b: c", "a.b: ccccccccccc",
        ["17: words.a.b: must be text of at most 10 characters; given 11 characters"],
    ),
    "both of two keys": (
        "load:", "sail: {first: 1, last: 0}\nload:",
        ["15: sail: must not be given beside `oars`; given both"],
    ),
    "none of two keys": (
        "oars: 50\n", "",
        ["1: must have one of the keys oars and sail; given none; write one of them"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_mistake_is_told_with_its_line_its_guess_and_the_keys_of_its_class(name: str) -> None:
    old, new, expected = CASES[name]
    assert SOUND.count(old) == 1
    with pytest.raises(ScenarioError) as caught:
        Ship.of(parse(SOUND.replace(old, new), "f"), "f")
    messages = str(caught.value).splitlines()
    assert [message.startswith(f"f:{start}") for message, start in zip(messages, expected, strict=True)] == [
        True
    ] * len(expected), messages


def test_the_sound_one_is_read_and_written_out() -> None:
    ship = Ship.of(parse(SOUND, "f"), "f")
    assert isinstance(ship.brakes[1], Disc)
    assert (ship.brakes[1].radius, ship.start, ship.load) == (0.4, Rising(time=4.0), 3000.0)
    assert Ship.of(parse(scenario_to_yaml(ship), "g"), "g") == ship
    assert list(Ship.editor_schema()["$defs"]["Block"]["required"]) == ["kind", "force", "rise"]


CHANGES: dict[str, tuple[dict[str, object], str]] = {
    "item": ({"brakes.0.rise.time": "5 s", "crews.1.last": 0.0}, "brakes.0.rise.time"),
    "word written out": ({"start.delay": 1.0, "grip.fade": "10 %"}, "start.delay"),
    "another branch": ({"start": {"form": "sudden"}}, "start.form"),
    "rival key": ({"sail": {"first": 1.0, "last": 0.0}}, "sail.first"),
    "key of a rival": ({"sail.first": 1, "sail.last": "0 %"}, "sail.last"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_values_are_replaced_wherever_they_stand(name: str, tmp_path: Path) -> None:
    changes, key = CHANGES[name]
    ship = Ship.of(parse(SOUND, "f"), "f")
    changed = ship.with_(changes)
    assert changed != ship
    assert ship == Ship.of(parse(SOUND, "f"), "f")
    with pytest.raises(ScenarioError, match=rf"^{key}: "):
        ship.with_({**changes, key: "9 kg"})


def test_of_keys_that_exclude_each_other_an_override_leaves_its_own(tmp_path: Path) -> None:
    (tmp_path / "ship.yaml").write_text(SOUND, encoding="utf-8")
    document = read(tmp_path / "ship.yaml", ["sail.first=0.9", "sail.last=0.1"], lambda _: Ship)
    assert Ship.of(document, "f").oars is None
    document = read(tmp_path / "ship.yaml", ["sail={first: 1, last: 0}", "oars=3"], lambda _: Ship)
    with pytest.raises(ScenarioError, match=r"^--set sail: must not be given beside `oars`"):
        Ship.of(document, "f")
