"""Texts as other programs and people write them: JSON, tabs, anchors, half characters, far too much."""

import json
import time
from pathlib import Path

import pytest
import yaml
from malformed_case import BASE, edited

from slosh_cli.errors import MOST_SHOWN, ScenarioError
from slosh_cli.scenario import (
    Scenario,
    load_any_scenario,
    load_document,
    load_scenario,
    parse_scenario,
    scenario_to_yaml,
)
from slosh_cli.scenario.scalars import plain_number, plain_scalar

SOUND = parse_scenario(BASE)


def refusal(text: str, overrides: tuple[str, ...] = ()) -> ScenarioError:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(text, "f.yaml")
    return caught.value


def as_json(indent: str | int | None = "\t", **changes: object) -> str:
    data = yaml.safe_load(BASE)
    data["solver"]["tolerance"] = 1e-4
    return json.dumps(data | changes, indent=indent)


# ---------------------------------------------------------------------------------------------------- JSON and tabs


@pytest.mark.parametrize("indent", ["\t", "\t\t", " \t", 4, None])
def test_json_reads_whatever_it_is_indented_by(indent: str | int | None) -> None:
    assert parse_scenario(as_json(indent)) == SOUND
    assert parse_scenario("\t" + as_json(indent) + "\t\n") == SOUND


def test_places_in_json_are_its_lines() -> None:
    text = as_json().replace('"5 kN m"', '"5 kN"')
    line = text[: text.index('"5 kN"')].count("\n") + 1
    (problem,) = refusal(text).problems
    assert (problem.line, problem.key) == (line, "braking.torque")


def test_a_key_twice_in_json_is_refused() -> None:
    text = as_json().replace('"onset": "0.5 s"', '"onset": "0.5 s",\n\t\t"onset": "9 s"')
    (problem,) = refusal(text).problems
    assert (problem.key, problem.rule) == ("braking.onset", "must be given once")


@pytest.mark.parametrize("number", ["1e-4", "1E-4", "0.0001", "1.0e-4"])
def test_numbers_of_json_are_numbers(number: str) -> None:
    assert parse_scenario(as_json().replace("0.0001", number)).solver.tolerance == 1e-4


def test_json_writes_characters_as_pairs() -> None:
    assert parse_scenario(as_json(description="a \U0001f683 wagon")).description == "a \U0001f683 wagon"


TABS = {
    "flow mapping over lines": ("output: {interval: 10 ms}", "output: {\n\tinterval:\t10 ms\t}"),
    "flow list": ("output: {interval: 10 ms}", "output: {\t'interval':\t'10 ms'\t,\t}"),
    "after the colon": ("  onset: 0.5 s", "  onset:\t0.5 s"),
    "behind a value": ("  onset: 0.5 s", "  onset: 0.5 s\t"),
    "before a comment": ("  onset: 0.5 s", "  onset: 0.5 s\t# the brakes"),
    "on a line of its own": ("  onset: 0.5 s", "\t\n  onset: 0.5 s\n \t "),
    "before a comment of its own": ("  onset: 0.5 s", "\t# the brakes\n  onset: 0.5 s"),
    "between number and unit": ("  onset: 0.5 s", "  onset: 0.5\ts"),
}


@pytest.mark.parametrize("name", TABS)
def test_tabs_part_what_they_may_part(name: str) -> None:
    assert parse_scenario(edited(TABS[name])) == SOUND


@pytest.mark.parametrize("line", ["\tonset: 0.5 s", " \tonset: 0.5 s"])
def test_tabs_do_not_indent_a_block(line: str) -> None:
    (problem,) = refusal(edited(("  onset: 0.5 s", line))).problems
    assert (problem.line, problem.rule) == (47, "must be valid YAML")
    assert "'\\t'" in problem.given
    assert problem.fix == "indent with spaces, not tabs"


# ----------------------------------------------------------------------------------------------------------- x-keys

ANCHORED = "x-own: &unit {stiffness: 2.6e6 N/m, damping: 1.5e4 N s/m}\n" + edited(
    ("primary_suspension: {stiffness: 2.6e6 N/m, damping: 1.5e4 N s/m}", "primary_suspension: *unit")
)


def test_top_level_keys_of_ones_own_are_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(ANCHORED, encoding="utf-8")
    scenario = load_scenario(file, ["x-foo=1", "x-own.stiffness=3"])
    assert scenario == SOUND
    assert "x-" not in scenario_to_yaml(scenario)
    alone = "format: 1\nname: a\nx-l: &l {model: rigid, density: 830 kg/m^3}\ntank: {shape: rectangular, width: 1 m, "
    file.write_text(alone + "height: 1 m, length: 3 m, fill: 0.5, liquid: *l}\n", encoding="utf-8")
    assert load_any_scenario(file).tank.liquid.density == 830.0
    file.write_text("x-a: &a [dry, wet]\nbase: b.yaml\nvary: {contact.adhesion: *a}\n", encoding="utf-8")
    assert load_document(file).data == {"base": "b.yaml", "vary": {"contact.adhesion": ["dry", "wet"]}}


def test_a_mistake_in_an_anchor_is_placed_where_it_is_written() -> None:
    (problem,) = refusal(ANCHORED.replace("1.5e4 N s/m}\n", "1.5e4 N s}\n", 1)).problems
    assert (problem.line, problem.key) == (1, "wagon.primary_suspension.damping")


@pytest.mark.parametrize("text", [BASE + "y-foo: 1\n", edited(("  onset:", "  x-foo: 1\n  onset:"))])
def test_other_unknown_keys_stay_refused(text: str) -> None:
    assert "is not a key of" in refusal(text).problems[0].rule


def test_a_study_cannot_vary_what_nobody_reads() -> None:
    with pytest.raises(ScenarioError, match="is not a key of a scenario"):
        SOUND.with_({"x-foo": "1"})


# --------------------------------------------------------------------------------------------------- half characters

WRITABLE = "must be text that can be written as UTF-8"


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("A wagon to break", r'"half \ud83d of one"', 3),
        ("A wagon to break", r'"\udc00\ud800"', 3),
        ("fill: 0.5", r'fill: "\ud83d"', 24),
        ("  onset: 0.5 s", r'  "on\ud83dset": 0.5 s', 47),
        ("    - frequency:", '    - "\\udfff": 1\n      frequency:', 28),
    ],
)
def test_half_a_character_is_refused_with_its_line(old: str, new: str, line: int) -> None:
    problem = refusal(edited((old, new))).problems[0]
    assert (problem.line, problem.rule) == (line, WRITABLE)
    refusal(edited((old, new))).args[0].encode("utf-8")


def test_half_a_character_in_an_override(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(BASE, encoding="utf-8")
    for text in (
        "\udcff=1",
        "tank.\udcff=1",
        "x-\udcff=1",
        "description=\udcff",
        'description="\\ud800"',
        "tank.fill=\udcff",
        "tank.liquid={model: \udcff}",
    ):
        with pytest.raises(ScenarioError, match=WRITABLE):
            load_scenario(file, [text])
    for key in ("name", "description", "tank.\udcff", "\udcff"):
        with pytest.raises(ScenarioError, match=WRITABLE) as caught:
            SOUND.with_({key: "a\udcff"})
        str(caught.value).encode("utf-8")


# ---------------------------------------------------------------------------------------------------------- too much


def many(text: str) -> str:
    began = time.process_time()
    error = refusal(text)
    assert time.process_time() - began < 2.0
    message = str(error)
    assert len(message.splitlines()) <= MOST_SHOWN + 1
    assert len(message) < 20_000
    return message.splitlines()[-1]


def test_ninety_thousand_unknown_keys_are_soon_refused() -> None:
    assert "more" in many(BASE + "".join(f"k{i}: 1\n" for i in range(90_000)))


def test_nine_thousand_unknown_keys_are_counted() -> None:
    assert many(BASE + "".join(f"fil{i}: 1\n" for i in range(9_000))) == "and 8,980 more problems"


def test_the_same_key_again_and_again() -> None:
    assert many(BASE + "name: again\n" * 9_000) == "and 8,980 more problems"
    many(BASE + "name: again\n" * 20_000)


def test_bad_items_of_a_list() -> None:
    def baffles(item: str, count: int) -> str:
        return edited(("  fill: 0.5", f"  baffles: [{', '.join([item] * count)}]\n  fill: 0.5"))

    assert many(baffles("x", 9_000)) == "and 8,980 more problems"
    assert many(baffles("{position: 3 m, opning: 0.2}", 2_000)) == "and 1,980 more problems"
    many(baffles("x", 90_000))


def test_a_merge_of_thousands_of_keys() -> None:
    keys = "".join(f"  k{i}: 1\n" for i in range(9_000))
    assert many(f"x-many: &many\n{keys}{BASE}<<: *many\n") == "and 8,980 more problems"


def test_a_key_of_a_megabyte_makes_no_message_of_one() -> None:
    many(f"{BASE}? {'k' * 900_000}\n: 1\n")


def test_one_problem_more_is_one() -> None:
    text = BASE + "".join(f"k{i}: 1\n" for i in range(MOST_SHOWN + 1))
    assert str(refusal(text)).endswith("\nand 1 more problem")


def test_thousands_of_overrides(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(BASE, encoding="utf-8")
    began = time.process_time()
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file, [f"braking.k{i}=1" for i in range(3_000)])
    assert time.process_time() - began < 2.0
    assert len(caught.value.problems) == 3_000
    assert str(caught.value).endswith("and 2,980 more problems")


# ----------------------------------------------------------------------------------------------------------- numbers


@pytest.mark.parametrize("text", ["1", "-1", "+.5", "1.", "1e5", "1.5E-3", "007"])
def test_a_number_of_a_table_is_a_number_of_a_scenario(text: str) -> None:
    assert plain_number(text) == plain_scalar(text) == float(text)


@pytest.mark.parametrize("text", ["1_000", "1 000", "nan", "inf", ".inf", "1e999", "0x10", "١", "1,5", "", "--1", "1e"])
def test_what_is_no_number(text: str) -> None:
    assert plain_number(text) is None


def test_a_scenario_is_still_a_scenario() -> None:
    assert isinstance(SOUND, Scenario)
