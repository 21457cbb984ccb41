"""What real brakes make of the liquid: the paper's wagon with brakes as wagons have them.

`python docs/real_brakes.py` computes some three thousand stops, those with a locked wheel once more with slide
protection, and writes ``real-brakes.md``, its two figures and ``real-brakes.csv`` beside itself. Some ten minutes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from rich.progress import track
from scipy.optimize import brentq

from slosh_cli.report.saving import STYLE
from slosh_cli.results.point_stop import point_stop
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import Scenario, find_packaged, load_scenario

HERE = Path(__file__).parent
FILLS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97)
LAMBDAS = (50, 65, 80, 100)
BRAKES: dict[str, Callable[[float], dict[str, Any]]] = {
    "cast iron": lambda force: {"braking.blocks": {"count": 2, "force": force, "friction": "cast-iron"}},
    "K blocks": lambda force: {"braking.blocks": {"count": 2, "force": force, "friction": "composite"}},
    "discs": lambda force: {"braking.discs": {"faces": 2, "force": force, "radius": 0.247, "friction": 0.35}},
}
APPLICATIONS = ("step", "P", "G")
RAILS = ("dry", "wet")
GRADIENTS = (0.0, -0.02)
LIQUIDS = ("modal", "shallow-water", "rigid")
FIELDS = (
    "fill", "brake", "lambda", "force_N", "application", "rail", "gradient", "liquid", "status", "braking_distance_m",
    "braking_time_s", "max_surface_m", "surface_limit_m", "in_model_range", "max_wheel_unloading", "locked_time_s",
    "wheels_locked", "protected_distance_m", "protection_cycles", "not_legal",
)  # fmt: skip
SIZING = {"form": "table", "points": [[0.0, 0.0], [0.2, 0.0], [4.2, 1.0]]}
"""The build-up that belongs to a braked weight percentage."""
LEGAL = ("axle load in t", "degree of filling")
"""Checks that say whether a wagon may run so."""
HEADING = """# What real brakes make of it

The paper brakes its wagon with 10 to 30 kN m at each wheel, all at once. A wagon has 2 to 5 kN m, and its cylinders take
seconds to fill. This is the paper's wagon from 100 km/h with brakes as wagons have them: cast-iron blocks, composite (K)
blocks and discs, for braked weight percentages of 50 to 100 at the wagon's actual load, filled by P or G. A step of the
same brake stands beside them. Rails are dry or wet, the line is level or falls by 20 permille. The tank is 40 to 97 %
full, the liquid is modal (three computed modes), shallow water, or the equivalent solid.

`python docs/real_brakes.py` sizes the force of each brake on the rigid wagon, computes every stop, and makes this page,
its figures and `real-brakes.csv`. Stops of the modal liquid beyond its theory count too; the table says which.
"""  # noqa: E501 - a page of 125 columns
LEGAL_WORDS = "Limits: 22.5 t at an axle; degree of filling after ADR 4.3.2.2. The check of a scenario tells both."
MATTERS = 0.01
"""A change of the distance that matters."""


def loaded(fill: float) -> Scenario:
    """The paper's wagon from 100 km/h, filled so."""
    paper = load_scenario(find_packaged("paper-80-liquid"))
    values = {"tank.fill": fill, "tank.coefficients": "computed", "tank.modes": 3, "braking.initial_speed": 100 / 3.6}
    return paper.with_(values | {"braking.onset": 0.0, "output.interval": 1.0})


def braked(wagon: Scenario, brake: str, force: float, **more: Any) -> Scenario:
    """The wagon with this brake."""
    return wagon.with_({**BRAKES[brake](force), **more})


def force_for(wagon: Scenario, brake: str, percentage: float) -> float:
    """Force (N) of a block or face with which the rigid wagon has this braked weight percentage at its load."""
    goal = 52840.0 / (percentage + 10.0)

    def too_far(force: float) -> float:
        found = point_stop(braked(wagon, brake, force, **{"braking.application": SIZING}))
        return (found.distance if found else 1e5) - goal

    return float(brentq(too_far, 500.0, 4e5, xtol=1.0))


def settings() -> list[tuple[dict[str, Any], Scenario]]:
    """Every stop of the study with what tells it apart."""
    found = []
    for fill in FILLS:
        wagon = loaded(fill)
        for brake, percentage in product(BRAKES, LAMBDAS):
            force = force_for(wagon, brake, percentage)
            for application, rail, gradient, liquid in product(APPLICATIONS, RAILS, GRADIENTS, LIQUIDS):
                names = (fill, brake, percentage, round(force), application, rail, gradient, liquid)
                changes = {
                    "braking.application": application, "contact.adhesion": rail, "track.gradient": gradient,
                    "tank.liquid.model": liquid,
                }  # fmt: skip
                found.append((dict(zip(FIELDS, names, strict=False)), braked(wagon, brake, force, **changes)))
    return found


def examined(setting: tuple[dict[str, Any], Scenario]) -> dict[str, Any]:
    """A stop's answers; where a wheel locks, those with slide protection too."""
    names, case = setting
    result = simulate(case)
    locked = [round(time, 3) for time in result.locked_time_s]
    row = names | {
        "status": str(result.status), "braking_distance_m": result.braking_distance_m,
        "braking_time_s": result.braking_time_s, "max_surface_m": result.max_surface_m,
        "surface_limit_m": result.surface_limit_m, "in_model_range": result.in_model_range,
        "max_wheel_unloading": result.max_wheel_unloading, "locked_time_s": max(locked),
        "wheels_locked": sum(time > 0.0 for time in locked), "protected_distance_m": None, "protection_cycles": None,
        "not_legal": "; ".join(c.name for c in result.checks if c.name.startswith(LEGAL) and not c.within),
    }  # fmt: skip
    if max(locked) > 0.0:
        protected = simulate(case.with_({"braking.slide_protection": {}}))
        row |= {
            "protected_distance_m": protected.braking_distance_m,
            "protection_cycles": protected.slide_protection_cycles,
        }
    return {
        name: f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
        for name, value in row.items()
    }


def computed() -> list[dict[str, str]]:
    """Every row, on all cores."""
    stops = settings()
    with ThreadPoolExecutor() as pool:
        return list(track(pool.map(examined, stops), "stops", total=len(stops)))


Row = dict[str, str]
CONDITIONS = ("fill", "brake", "lambda", "application", "rail", "gradient")


def changes_by(rows: Sequence[Row], liquid: str) -> dict[tuple[str, ...], float]:
    """What a liquid adds to the distance of the equivalent solid, by the conditions."""
    solid = {conditions(row): row for row in rows if row["liquid"] == "rigid"}
    found = {}
    for row in rows:
        other = solid[conditions(row)]
        if row["liquid"] == liquid and row["braking_distance_m"] and other["braking_distance_m"]:
            found[conditions(row)] = float(row["braking_distance_m"]) / float(other["braking_distance_m"]) - 1.0
    return found


def conditions(row: Row) -> tuple[str, ...]:
    """What tells the stop of a row apart but for its liquid."""
    return tuple(row[name] for name in CONDITIONS)


def only(rows: Iterable[Row], **wanted: str) -> list[Row]:
    """Rows with these values."""
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def read() -> list[Row]:
    """The table beside this file."""
    with (HERE / "real-brakes.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write(rows: list[Row]) -> None:
    """Table, page and figures beside this file."""
    with (HERE / "real-brakes.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    (HERE / "real-brakes.md").write_text(page(rows), encoding="utf-8")
    with mpl.rc_context(STYLE):
        figure_of_changes(rows).savefig(HERE / "images" / "real-brakes-distance.png")
        figure_of_locks(rows).savefig(HERE / "images" / "real-brakes-locks.png")


def page(rows: list[Row]) -> str:
    """The page of the documentation."""
    return (
        "\n".join([HEADING, *_findings(rows), *_changes(rows), *_locks(rows), *_savings(rows), *_legality(rows)]) + "\n"
    )


def _findings(rows: list[Row]) -> list[str]:
    """What the table says, in figures and plain words."""
    found = {liquid: changes_by(rows, liquid) for liquid in LIQUIDS[:2]}
    every = [change for changes in found.values() for change in changes.values()]
    over, most = sum(abs(change) > MATTERS for change in every), max(map(abs, every))
    left = ", ".join(
        f"{brake} {_left(rows, brake, 'P'):.0f} % by P and {_left(rows, brake, 'G'):.0f} % by G" for brake in BRAKES
    )
    locked = {liquid: _locked(only(rows, liquid=liquid)) for liquid in LIQUIDS}
    brakes = ", ".join(f"{brake} {_locked(only(rows, brake=brake))}" for brake in BRAKES)
    free = sum(not only(rows, fill=f"{fill:g}")[0]["not_legal"] for fill in FILLS)
    return [
        "## Findings",
        "",
        f"- The liquid changes the braking distance by more than {100 * MATTERS:g} % in {over} of {len(every)} stops. "
        f"Its largest change is {100 * most:.2f} %.",
        f"- Cylinders that fill take less of the slosh away than one may hope. Of the surface's rise under the step, "
        f"tanks at most 60 % full keep: {left}. "
        "The torque of cast iron grows towards the stop and sways the liquid anew.",
        f"- Stops with a locked wheel, of {len(rows) // len(BRAKES)} each: {brakes}. Cast iron locks wheels at the end "
        f"of a stop. The liquid unloads wheels and locks more of them: {locked['modal']} stops with the modal liquid, "
        f"{locked['shallow-water']} with shallow water, {locked['rigid']} with the solid.",
        f"- Of the {len(FILLS)} fills, {free} may run. A half-filled tank without walls is not allowed, and this tank "
        "is too heavy when it is filled as it must be.",
        "",
    ]


def _left(rows: list[Row], brake: str, application: str) -> float:
    """Part (%) of the surface's mean rise under the step that an application leaves; shallow water, up to 60 % full."""
    these = [row for row in only(rows, brake=brake, liquid="shallow-water") if float(row["fill"]) < 0.65]
    rises = [_mean(float(row["max_surface_m"]) for row in only(these, application=a)) for a in (application, "step")]
    return 100 * rises[0] / rises[1]


def _locked(rows: list[Row]) -> int:
    return sum(float(row["locked_time_s"]) > 0.0 for row in rows)


def _changes(rows: list[Row]) -> list[str]:
    """Where the liquid changes the distance."""
    lines = ["## Does the liquid change the distance?", ""]
    found = {liquid: changes_by(rows, liquid) for liquid in LIQUIDS[:2]}
    lines += [
        "Changes of the distance against that of the equivalent solid:",
        "",
        "| application | liquid | stops | over 1 % | least change / % | median / % | largest change / % | where |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for application, liquid in product(APPLICATIONS, LIQUIDS[:2]):
        changes = {at: 100 * change for at, change in found[liquid].items() if at[3] == application}
        ordered = sorted(changes.values())
        where = max(changes, key=lambda at: abs(changes[at]))
        many = sum(abs(change) > 100 * MATTERS for change in ordered)
        told = f"{100 * float(where[0]):.0f} % full, {where[1]}, lambda {where[2]}, {where[4]}, {_slope(where[5])}"
        figures = f"{ordered[0]:+.2f} | {ordered[len(ordered) // 2]:+.2f} | {ordered[-1]:+.2f}"
        lines.append(f"| {application} | {liquid} | {len(ordered)} | {many} | {figures} | {told} |")
    lines += ["", "![Change of the braking distance](images/real-brakes-distance.png)", ""]
    lines += ["The rise of the surface at the end walls, mean over the stops of shallow water:", ""]
    lines += ["| fill / % | room / m | " + " | ".join(f"{name} / m" for name in APPLICATIONS) + " |", "|---" * 5 + "|"]
    for fill in FILLS:
        these = only(rows, fill=f"{fill:g}", liquid="shallow-water")
        rises = [_mean(float(row["max_surface_m"]) for row in only(these, application=a)) for a in APPLICATIONS]
        room = float(these[0]["surface_limit_m"])
        lines.append(f"| {100 * fill:.0f} | {room:.2f} | " + " | ".join(f"{rise:.2f}" for rise in rises) + " |")
    return [*lines, ""]


def _locks(rows: list[Row]) -> list[str]:
    """Where a wheel locks."""
    lines = ["## Where does a wheel lock?", ""]
    lines += [
        "Stops with a locked wheel, and the longest time that a wheel was locked:",
        "",
        "| brake | rail | " + " | ".join(f"lambda {percentage}" for percentage in LAMBDAS) + " | longest / s |",
        "|---" * (3 + len(LAMBDAS)) + "|",
    ]
    for brake, rail in product(BRAKES, RAILS):
        these = only(rows, brake=brake, rail=rail)
        counts = [_count(only(these, **{"lambda": str(percentage)})) for percentage in LAMBDAS]
        longest = max(float(row["locked_time_s"]) for row in these)
        lines.append(f"| {brake} | {rail} | " + " | ".join(counts) + f" | {longest:.2f} |")
    by_fill = [f"{100 * fill:.0f} %: {_count(only(rows, fill=f'{fill:g}'))}" for fill in FILLS]
    by_liquid = [f"{liquid}: {_count(only(rows, liquid=liquid))}" for liquid in LIQUIDS]
    lines += ["", f"By fill: {', '.join(by_fill)}. By liquid: {', '.join(by_liquid)}."]
    return [*lines, "", "![Locked wheels](images/real-brakes-locks.png)", ""]


def _savings(rows: list[Row]) -> list[str]:
    """What slide protection saves."""
    lines = ["## What does slide protection save?", ""]
    locked = [row for row in rows if float(row["locked_time_s"]) > 0.0 and row["protected_distance_m"]]
    locked = [row for row in locked if row["braking_distance_m"]]
    if not locked:
        return [*lines, "No wheel locks, so there is nothing to save.", ""]
    saved = sorted(float(row["braking_distance_m"]) - float(row["protected_distance_m"]) for row in locked)
    cycles = max(float(row["protection_cycles"]) for row in locked)
    lines.append(
        f"The {len(locked)} stops with a locked wheel, once more with it: the distance becomes shorter by "
        f"{saved[0]:+.2f} m to {saved[-1]:+.2f} m, by {saved[len(saved) // 2]:+.2f} m in the middle of them. It vents "
        f"{cycles:.0f} times at most."
    )
    return [*lines, ""]


def _legality(rows: list[Row]) -> list[str]:
    """Which points are legal."""
    lines = ["## Which of these wagons may run?", "", "| fill / % | not allowed because of |", "|---|---|"]
    for fill in FILLS:
        reasons = only(rows, fill=f"{fill:g}", liquid="shallow-water")[0]["not_legal"]
        lines.append(f"| {100 * fill:.0f} | {reasons or 'nothing: it may run'} |")
    return [*lines, "", LEGAL_WORDS, ""]


def _slope(gradient: str) -> str:
    return "level" if float(gradient) == 0.0 else f"{1000 * float(gradient):+g} permille"


def _count(rows: list[Row]) -> str:
    return f"{_locked(rows)} of {len(rows)}"


def _mean(values: Iterable[float]) -> float:
    found = list(values)
    return sum(found) / len(found)


def figure_of_changes(rows: list[Row]) -> Figure:
    """One panel per application: the change of the distance over the fill."""
    drawn = Figure(figsize=(13.5, 5.2), dpi=110, layout="constrained")
    drawn.suptitle("What the liquid adds to the braking distance, dry and level", fontweight="bold", x=0.01, ha="left")
    styles = {"cast iron": ("#08306b", "o"), "K blocks": ("#e6862c", "s"), "discs": ("#777777", "^")}
    panels = drawn.subplots(1, 3, sharey=True)
    for axes, application in zip(panels, APPLICATIONS, strict=True):
        these = only(rows, application=application, rail="dry", gradient="0")
        for (brake, (colour, marker)), percentage in product(styles.items(), (50, 100)):
            changes = changes_by(only(these, brake=brake, **{"lambda": str(percentage)}), "shallow-water")
            places = [100 * float(at[0]) for at in changes]
            dashes, face = ("-", colour) if percentage == 50 else ("--", "white")
            axes.plot(
                places, [100 * change for change in changes.values()], dashes, color=colour, marker=marker,
                markerfacecolor=face, label=f"{brake}, lambda {percentage}",
            )  # fmt: skip
        axes.axhspan(-100 * MATTERS, 100 * MATTERS, color="#f0f0f0", zorder=0)
        axes.set_title({"step": "all at once", "P": "P: 95 % after 4 s", "G": "G: 95 % after 24 s"}[application])
        axes.set_xlabel("fill / % of the height")
    panels[0].set_ylabel("change against the solid / %")
    panels[0].annotate("grey: within 1 %", (0.03, 0.03), xycoords="axes fraction", fontsize=11)
    drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawn


def figure_of_locks(rows: list[Row]) -> Figure:
    """One panel per load and rail: the longest lock over fill and lambda with cast iron in P."""
    drawn = Figure(figsize=(13.5, 6.4), dpi=110, layout="constrained")
    title = "Longest lock of a wheel / s: cast iron, P, level or 20 permille down"
    drawn.suptitle(title, fontweight="bold", x=0.01, ha="left")
    panels = drawn.subplots(len(RAILS), len(LIQUIDS), sharex=True, sharey=True)
    these = only(rows, application="P", brake="cast iron")
    top = max(float(row["locked_time_s"]) for row in these) or 1.0
    for (row_of, rail), (place, liquid) in product(enumerate(RAILS), enumerate(LIQUIDS)):
        axes = panels[row_of][place]
        for x, y in product(range(len(FILLS)), range(len(LAMBDAS))):
            asked = {"fill": f"{FILLS[x]:g}", "lambda": str(LAMBDAS[y]), "rail": rail, "liquid": liquid}
            longest = max(float(row["locked_time_s"]) for row in only(these, **asked))
            shade = 1.0 - 0.75 * (longest / top) ** 0.5
            axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=str(shade), edgecolor="white"))
            text = f"{longest:.2f}" if longest > 0.0 else "-"
            axes.text(x, y, text, ha="center", va="center", fontsize=10, color="white" if shade < 0.5 else "black")
        axes.set_title(f"{'equivalent solid' if liquid == 'rigid' else liquid}, {rail} rail")
        axes.set_xticks(range(len(FILLS)), [f"{100 * fill:.0f}" for fill in FILLS])
        axes.set_yticks(range(len(LAMBDAS)), [str(percentage) for percentage in LAMBDAS])
        axes.set_xlim(-0.5, len(FILLS) - 0.5)
        axes.set_ylim(-0.5, len(LAMBDAS) - 0.5)
        axes.grid(visible=False)
    for axes in panels[-1]:
        axes.set_xlabel("fill / % of the height")
    for axes in panels[:, 0]:
        axes.set_ylabel("lambda / %")
    return drawn


if __name__ == "__main__":
    write(computed())
