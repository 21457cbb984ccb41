"""Which of the paper's claims hold over which ranges of what it does not publish: a finding, not a fit.

`python docs/identifiability.py` calls `slosh sweep --set ...` for one assumed value after the other, which computes the
grid of Figure 3 into a folder of `outputs/identifiability`, adds the two stops of Figure 2, and lets the code behind
`slosh sweep` and `slosh validate figure2` judge the claims. It writes ``identifiability.md``, its figure and
``identifiability.csv`` beside itself. A few minutes; what was computed before is taken from the studies' journals.
"""

from __future__ import annotations

import csv
import io
import re
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from slosh_cli.cli import main as slosh
from slosh_cli.report.saving import STYLE
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import find_packaged, load_scenario
from slosh_cli.study.claims import verdicts
from slosh_cli.study.plan import SOLID
from slosh_cli.validation.case import Findings
from slosh_cli.validation.cases.figure2 import claim_verdicts
from slosh_cli.validation.data_file import read_case

HERE = Path(__file__).parent
STUDIES = HERE.parent / "outputs" / "identifiability"
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
CLAIMS = {
    "fig2-oscillation": "oscillates much more",
    "fig2-front-bogie": "front bogie carries more",
    "fig2-lead-wheel": "leading wheel carries more",
    "fig3-optimum": "optimum 15 to 20 kN m",
    "fig3-longer": "liquid longer",
    "fig3-15-percent": "15 % at 160 km/h, 20 kN m",
}
"""What a claim says, in a heading's words."""
FINDINGS = {
    "holds": ("yes", "#4a98c9"),
    "holds in part": ("in part", "#c6dbef"),
    "does not hold": ("no", "#f4a582"),
    "no answer": ("no answer", "#e4e4e4"),
}
"""Its short form and its colour."""

HEADING = """# How far the paper's claims depend on what it does not publish

The paper leaves open pivot spacing, heights, suspension, adhesion and whether 30.5 t is the car body or the whole tare.
Here one value at a time differs from what `scenarios/paper_80.yaml` assumes. The same code judges the claims on the two
stops of Figure 2 and on the grid of Figure 3. This is a finding and no fit: no value was adjusted to make a claim hold.

Every row is one study. The row of 9 m pivot spacing is

    slosh sweep --set 'wagon.pivot_spacing=9 m'

The column `changed` of `identifiability.csv` has the keys of the other rows. `python docs/identifiability.py` makes all
of them, this page, its figure and that file. Where a stop of a claim ends as `pitch-limit`, there is no answer.
"""
COLUMNS = (
    "varied", "value", *CLAIMS.values(), "best torque 80 km/h (solid) / kN m", "best torque 160 km/h (solid) / kN m",
    "ratio at 160 km/h, 20 kN m", "stops with liquid without answer",
)  # fmt: skip


def studied(folder: Path, changes: tuple[str, ...]) -> list[dict[str, Any]]:
    """The table of `slosh sweep --set ...` over the grid of Figure 3."""
    words = [word for change in changes for word in ("--set", change)]
    with redirect_stdout(io.StringIO()):
        slosh(["sweep", *words, "-o", str(folder)])
    table = pd.read_csv(folder / "braking_distance.csv")
    rows: list[dict[str, Any]] = table.astype(object).where(table.notna(), None).to_dict("records")
    return rows


def examined(folder: Path, changes: tuple[str, ...]) -> dict[str, Any]:
    """Verdict on every claim, the most effective torques and the ratio at 160 km/h and 20 kN m."""
    figure2, paper = read_case("figure2"), find_packaged("paper-80-liquid")
    liquid = simulate(load_scenario(paper, changes))
    solid = simulate(load_scenario(paper, (*changes, "tank.liquid.model=rigid")))
    row: dict[str, Any] = claim_verdicts(figure2, Findings(figure2), "", liquid, solid)
    table = studied(folder, changes)
    row |= {verdict.claim: str(verdict.finding) for verdict in verdicts(table)}
    distance = {(a["v0_km_h"], a["torque_kN_m"], a["liquid"]): a["braking_distance_m"] for a in table}
    for speed in (80.0, 160.0):
        for model in ("modal", SOLID):
            reached = {at[1]: metres for at, metres in distance.items() if (at[0], at[2]) == (speed, model) and metres}
            row[f"best_torque_{speed:g}_{model}_kN_m"] = min(reached, key=reached.__getitem__)
    pair = [distance[160.0, 20.0, model] for model in ("modal", SOLID)]
    row["ratio_160_20"] = "" if None in pair else f"{pair[0] / pair[1]:.3f}"
    row["liquid_without_answer"] = sum(a["liquid"] != SOLID and a["braking_distance_m"] is None for a in table)
    return row


def page(rows: list[dict[str, Any]]) -> str:
    """The page of the documentation."""
    lines = [HEADING, "| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        cells = [row["varied"], row["value"], *(FINDINGS[row[claim]][0] for claim in CLAIMS)]
        for speed in (80, 160):
            liquid, solid = (float(row[f"best_torque_{speed}_{model}_kN_m"]) for model in ("modal", SOLID))
            cells.append(f"{liquid:g} ({solid:g})")
        lines.append("| " + " | ".join([*cells, row["ratio_160_20"], str(row["liquid_without_answer"])]) + " |")
    lines += ["", "![Verdicts and most effective torques](images/identifiability.png)", "", *conclusions(rows)]
    return "\n".join(lines) + "\n"


def conclusions(rows: list[dict[str, Any]]) -> list[str]:
    """What the table says, counted."""
    lines = [
        f"How many of the {len(rows)} rows have each verdict, and which do not share the verdict of the first row:"
    ]
    lines += ["", "| claim | " + " | ".join(FINDINGS) + " | another verdict at |", "|" + "---|" * (2 + len(FINDINGS))]
    for claim, words in CLAIMS.items():
        counts = [str(sum(row[claim] == finding for row in rows)) for finding in FINDINGS]
        others = [f"{row['varied']} {row['value']}" for row in rows if row[claim] != rows[0][claim]]
        lines.append(f"| {words} | " + " | ".join([*counts, ", ".join(others) or "no row"]) + " |")
    return lines


def figure(rows: list[dict[str, Any]]) -> Figure:
    """One line per row: the verdicts in colours, and the most effective torques at both speeds."""
    drawn = Figure(figsize=(15.0, 1.6 + 0.3 * len(rows)), dpi=110, layout="constrained")
    drawn.suptitle(
        "What the paper's claims depend on: one assumption changed at a time", fontweight="bold", fontsize=16
    )
    claims, slow, fast = drawn.subplots(1, 3, sharey=True, width_ratios=(1.5, 1, 1))
    _draw_claims(claims, rows)
    for axes, speed in ((slow, 80), (fast, 160)):
        for model, style in (
            (
                SOLID,
                {"marker": "s", "color": "#c1440e", "markersize": 9, "fillstyle": "none", "label": "equivalent solid"},
            ),
            ("modal", {"marker": "o", "color": "#08306b", "markersize": 6, "label": "liquid"}),
        ):
            torques = [float(row[f"best_torque_{speed}_{model}_kN_m"]) for row in rows]
            axes.plot(torques, range(len(rows)), linestyle="none", **style)
        axes.axvspan(15, 20, color="#f0f0f0", zorder=0)
        axes.set_title(f"most effective torque, {speed} km/h", fontsize=12)
        axes.set_xlabel("kN m (grey: 15 to 20)")
    slow.legend(loc="upper left", fontsize=10, frameon=True)
    return drawn


def _draw_claims(axes: Axes, rows: list[dict[str, Any]]) -> None:
    for place, row in enumerate(rows):
        for column, claim in enumerate(CLAIMS):
            word, colour = FINDINGS[row[claim]]
            axes.barh(place, 0.96, left=column, height=0.92, color=colour)
            axes.text(column + 0.48, place, word, ha="center", va="center", fontsize=9)
    axes.set_yticks(range(len(rows)), [f"{row['varied']}: {row['value']}" for row in rows], fontsize=10)
    axes.set_xticks([k + 0.48 for k in range(len(CLAIMS))], CLAIMS.values(), rotation=25, ha="right", fontsize=10)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.grid(visible=False)


def write(rows: list[dict[str, Any]]) -> None:
    """Table, page and figure beside this file."""
    with (HERE / "identifiability.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    with mpl.rc_context(STYLE):
        figure(rows).savefig(HERE / "images" / "identifiability.png")
    (HERE / "identifiability.md").write_text(page(rows), encoding="utf-8")


def main() -> None:
    """Run every study, then write what they say."""
    rows = []
    for varied, values in VARIED.items():
        for value, changes in values:
            folder = STUDIES / re.sub(r"[^a-z0-9.]+", "-", f"{varied} {value}".lower()).strip("-")
            rows.append({"varied": varied, "value": value, "changed": "; ".join(changes), **examined(folder, changes)})
    write(rows)


if __name__ == "__main__":
    main()
