"""What the expressions in `data/documented_numbers.toml` may use, beside the command's answer `a`."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path

from slosh_cli import load_scenario, simulate

ROOT = Path(__file__).parents[1]
FIGURE_3 = "docs/what-stays-of-figure-3.md"


def gives(expression, answer):
    """The value of an expression of the list."""
    names = {name: value for name, value in globals().items() if callable(value)}
    return eval(expression, names | {"a": answer, "math": math})


def text_of(document: str) -> str:
    return (ROOT / document).read_text(encoding="utf-8")


def row(answer, words):
    """Value of the row of a validation case with `words` in its quantity."""
    return the_row(answer, words)["value"]


def the_row(answer, words):
    rows = [one for case in answer["cases"] for one in case["rows"]]
    exactly = [one for one in rows if one["quantity"] == words]
    (found,) = exactly or [one for one in rows if words in one["quantity"]]
    return found


def excess(answer, words):
    """How far the value of that row lies above its reference, as a part of it."""
    found = the_row(answer, words)
    return found["value"] / found["reference"] - 1


def percent(text):
    """The last percentage in a sentence."""
    return float(re.findall(r"([\d.]+) %", text)[-1])


def check(answer, name):
    """A verdict's value."""
    return next(one["value"] for one in answer["checks"] if one["check"] == name)


def limit(answer, name):
    """And its limit."""
    return next(one["limit"] for one in answer["checks"] if one["check"] == name)


def leaf(answer, kind, key):
    """A key of the schema."""
    return answer["$defs"][kind]["properties"][key]


def too_high(answer):
    """How far the printed frequency lies above the computed one, in per cent."""
    return answer["deviations_percent"][0]["omega_rad_s"]


def densities(answers):
    """Densities that lambda_1 and mu of water tanks were printed for: lambda_1 ~ rho, mu ~ rho/omega^2."""
    found = []
    for answer in answers:
        printed, computed = answer["given"][0], answer["modes"][0]
        found.append(998.2 * printed["lambda_1_kg"] / computed["lambda_1_kg"])
        slower = (printed["omega_rad_s"] / computed["omega_rad_s"]) ** 2
        found.append(998.2 * printed["mu_kg"] / computed["mu_kg"] * slower)
    return found


def agreement_with_the_plain_code():
    """Largest differences from the stored stops of the plain code: distance as a part, wheel loads in kN."""
    distance, load = [], []
    with (ROOT / "tests/data/plain_stops.csv").open(encoding="utf-8", newline="") as file:
        stored = [stop for stop in csv.DictReader(file) if float(stop["step_s"]) == 0.0005]
    for stop in stored:
        overrides = [text.strip() for text in stop["overrides"].split(";") if text.strip()]
        result = simulate(load_scenario(ROOT / "scenarios/paper_80.yaml", overrides))
        distance.append(abs(result.braking_distance_m / float(stop["distance_m"]) - 1))
        for i in range(4):
            load.append(abs(result.min_wheel_load_N[i] - float(stop[f"min_load_{i + 1}_N"])) / 1e3)
            load.append(abs(result.max_wheel_load_N[i] - float(stop[f"max_load_{i + 1}_N"])) / 1e3)
    return {"distance": max(distance), "load_kN": max(load)}


# The tables of "What stays of Figure 3": speed -> torque -> heading -> cell.


def figure_3_tables():
    tables = {}
    for speed, table in re.findall(r"^(\d+) km/h\n\n((?:\|.*\n)+)", text_of(FIGURE_3), re.MULTILINE):
        heading, _, *lines = ([cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines())
        heading[6:] = ["least modal computed", "least shallow"]
        tables[int(speed)] = {float(line[0]): dict(zip(heading, line, strict=True)) for line in lines}
    return tables


def number(cell):
    """A distance; None where the stop has no answer."""
    return None if cell == "pitch-limit" else float(cell.removesuffix(" *"))


def best(speed, load):
    """Most effective torque and its distance."""
    found = {torque: number(line[load]) for torque, line in figure_3_tables()[speed].items()}
    torque = min((torque for torque in found if found[torque] is not None), key=found.get)
    return torque, found[torque]


def more(speed, load, *torques):
    """How much longer than the solid's a distance is at each torque, in per cent."""
    table = figure_3_tables()[speed]
    return [100 * (number(table[torque][load]) / number(table[torque]["rigid"]) - 1) for torque in torques]


def tipped(speed, load):
    """Torques without an answer."""
    return [torque for torque, line in figure_3_tables()[speed].items() if number(line[load]) is None]


def upright(load):
    """How many stops have an answer."""
    return sum(number(line[load]) is not None for table in figure_3_tables().values() for line in table.values())


def least(words, low, high):
    """Least wheel loads from one torque to another, at both speeds."""
    tables = figure_3_tables().values()
    return [
        float(line[f"least {words}"]) for table in tables for torque, line in table.items() if low <= torque <= high
    ]


def in_range():
    """Torque that keeps every linear stop in its range; torque and speed of the one more with computed coefficients."""
    inside = {
        (load, torque, speed)
        for speed, table in figure_3_tables().items()
        for torque, line in table.items()
        for load in ("modal, printed", "modal, computed")
        if "*" not in line[load] and number(line[load]) is not None
    }
    (gentle,) = {torque for load, torque, _ in inside if load == "modal, printed"}
    (other,) = {place for place in inside if place[1] != gentle}
    return gentle, *other[1:]
