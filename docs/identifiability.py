"""Which of the paper's claims hold over which ranges of what it does not publish: a finding, not a fit.

`python docs/identifiability.py` repeats, for one assumed value after the other, the two stops of Figure 2 and the
whole grid of Figure 3 that `slosh sweep` computes, and lets the same code judge the claims. It writes
``identifiability.md``, its figure and ``identifiability.csv`` beside itself. About five minutes.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from slosh_cli.report.validation_figures import draw_case
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import find_packaged, load_scenario
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.claims import verdicts
from slosh_cli.study.outcome import solve
from slosh_cli.study.plan import SOLID
from slosh_cli.validation.case import Findings
from slosh_cli.validation.cases.figure2 import claim_verdicts
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import read_case

HERE = Path(__file__).parent
COMPUTED = ("tank.coefficients=computed",)
VARIED: dict[str, tuple[tuple[str, tuple[str, ...]], ...]] = {
    "as assumed": (("paper's scenario", ()),),
    "coefficients": (("computed", COMPUTED),),
    "pivot spacing": tuple((f"{m} m", (f"wagon.pivot_spacing={m} m",)) for m in (9, 10, 11, 13, 14)),
    "tank bottom above rail": tuple((f"{m} m", (f"tank.bottom_height={m} m",)) for m in (0.9, 1.3, 1.5)),
    "traction height": tuple((f"{m} m", (f"wagon.traction_height={m} m",)) for m in (0.6, 0.75, 1.05)),
    "centre of the car body": tuple((f"{m} m", (f"wagon.car_body.centre_height={m} m",)) for m in (1.8, 2.6)),
    "pitch inertia of the car body": tuple(
        (f"{value} kg m^2", (f"wagon.car_body.pitch_inertia={value} kg m^2",)) for value in ("3e5", "7e5")
    ),
    "primary suspension": tuple(
        (f"{value} N/m", (f"wagon.primary_suspension.stiffness={value} N/m",)) for value in ("1.3e6", "5.2e6")
    ),
    "secondary suspension": tuple(
        (f"{value} N/m", (f"wagon.secondary_suspension.stiffness={value} N/m",)) for value in ("3e6", "1.2e7")
    ),
    "adhesion": (
        ("wet", ("contact.adhesion=wet",)),
        ("mu0 0.45", ("contact.adhesion.mu0=0.45",)),
        ("mu0 0.65", ("contact.adhesion.mu0=0.65",)),
    ),
    "30.5 t is": (("the car body", ("wagon.car_body.mass=30.5 t",)),),
    "running resistance": (
        (
            "none",
            (
                "wagon.running_resistance.constant=0 N",
                "wagon.running_resistance.linear=0 N s/m",
                "wagon.running_resistance.quadratic=0 N s^2/m^2",
            ),
        ),
    ),
}
CLAIMS = (
    "fig2-oscillation", "fig2-front-bogie", "fig2-lead-wheel", "fig3-optimum", "fig3-longer", "fig3-15-percent",
)  # fmt: skip

HEADING = """# How far the paper's claims depend on what it does not publish

The paper leaves open pivot spacing, heights, suspension, adhesion and whether 30.5 t is the car body or the whole tare.
Here one value at a time is changed from what `scenarios/paper_80.yaml` assumes, the two stops of Figure 2 and the grid
of Figure 3 are computed again as `slosh sweep` does, and the same code judges the claims. It is a finding, not a fit:
nothing was adjusted to make a claim hold. Made by `python docs/identifiability.py`; the numbers are in
`identifiability.csv`.
"""
COLUMNS = (
    "varied",
    "value",
    "oscillates much more",
    "front bogie carries more",
    "leading wheel carries more",
    "optimum 15 to 20 kN m",
    "liquid longer",
    "15 % at 160 km/h, 20 kN m",
    "best torque 80 km/h (solid)",
    "best torque 160 km/h (solid)",
    "ratio at 160 km/h, 20 kN m",
)


def examined(changes: tuple[str, ...]) -> dict[str, Any]:
    """Verdict on every claim, the most effective torques and the ratio at 160 km/h and 20 kN m."""
    figure2 = read_case("figure2")
    paper = find_packaged("paper-80-liquid")
    liquid = simulate(load_scenario(paper, changes))
    solid = simulate(load_scenario(paper, (*changes, "tank.liquid.model=rigid")))
    row: dict[str, Any] = claim_verdicts(figure2, Findings(figure2), "", liquid, solid)
    study = build(Wishes(overrides=changes))
    answers = [solve(study.stop(index)).answer for index in range(study.size)]
    row |= {verdict.claim: str(verdict.finding) for verdict in verdicts(answers)}
    distance = {(a["v0_km_h"], a["torque_kN_m"], a["liquid"]): a.get("braking_distance_m") for a in answers}
    for speed in (80.0, 160.0):
        for model in ("modal", SOLID):
            reached = {at[1]: metres for at, metres in distance.items() if (at[0], at[2]) == (speed, model) and metres}
            row[f"best_torque_{speed:g}_{model}_kN_m"] = min(reached, key=reached.__getitem__)
    pair = [distance[160.0, 20.0, model] for model in ("modal", SOLID)]
    row["ratio_160_20"] = "" if None in pair else f"{pair[0] / pair[1]:.3f}"
    row["liquid_without_answer"] = sum(a["liquid"] != SOLID and a.get("braking_distance_m") is None for a in answers)
    return row


def page(rows: list[dict[str, Any]]) -> str:
    """The page of the documentation."""
    short = {"holds": "yes", "holds in part": "in part", "does not hold": "no", "no answer": "no answer"}
    lines = [HEADING, "| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        cells = [row["varied"], row["value"], *(short[row[claim]] for claim in CLAIMS)]
        cells += [f"{row[f'best_torque_{v}_modal_kN_m']:g} ({row[f'best_torque_{v}_rigid_kN_m']:g})" for v in (80, 160)]
        lines.append("| " + " | ".join([*cells, row["ratio_160_20"]]) + " |")
    lines += ["", "![Most effective torque for each variation](images/identifiability.png)", "", *conclusions(rows)]
    return "\n".join(lines) + "\n"


def conclusions(rows: list[dict[str, Any]]) -> list[str]:
    """What the table says, counted."""
    words = ("holds", "holds in part", "does not hold", "no answer")
    lines = ["In how many of the variations each claim holds:", "", "| claim | " + " | ".join(words) + " |"]
    lines.append("|" + "---|" * (1 + len(words)))
    for claim in CLAIMS:
        counts = [str(sum(row[claim] == word for row in rows)) for word in words]
        lines.append(f"| {claim} | " + " | ".join(counts) + " |")
    return lines


def chart(rows: list[dict[str, Any]]) -> Chart:
    """Most effective torques, variation by variation."""
    places = list(range(1, len(rows) + 1))
    panels = []
    for speed in (80, 160):
        curves = [
            curve(label, places, [row[f"best_torque_{speed}_{model}_kN_m"] for row in rows], marks=True)
            for label, model in (("liquid", "modal"), ("equivalent solid", "rigid"))
        ]
        panels.append(Panel("row of the table", f"most effective torque at {speed} km/h / kN m", curves))
    return Chart(panels)


def main() -> None:
    """Compute everything, then write table, page and figure."""
    rows = []
    for varied, values in VARIED.items():
        for value, changes in values:
            rows.append({"varied": varied, "value": value, **examined(changes)})
    with (HERE / "identifiability.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw_case(
        "identifiability", "Most effective torque, one assumption changed at a time", chart(rows), HERE / "images"
    )
    (HERE / "images" / "identifiability.svg").unlink()
    (HERE / "identifiability.md").write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
