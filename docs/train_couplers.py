"""Does slosh make a train's couplers suffer? Trains of tank wagons behind a locomotive, braked along the pipe.

`python docs/train_couplers.py` computes 192 stops of trains and writes ``train-couplers.md``, its figure and
``train-couplers.csv`` beside itself. Some twenty minutes.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import matplotlib as mpl
from matplotlib.figure import Figure
from rich.progress import track

from slosh_cli.report.saving import STYLE
from slosh_cli.results.simulate import simulate_train
from slosh_cli.scenario.train_file import TrainScenario, load_train

HERE = Path(__file__).parent
LENGTHS = (10, 20, 30, 40)
FILLS = (0.3, 0.5, 0.7, 0.95)
APPLICATIONS = ("P", "G")
COUPLINGS = ("screw", "automatic")
LIQUIDS = ("rigid", "modal", "shallow-water")
FIELDS = (
    "wagons", "fill", "application", "coupling", "liquid", "status", "braking_distance_m", "max_compression_N",
    "compression_at", "compression_s", "max_tension_N", "tension_at", "tension_s", "max_wheel_unloading",
    "max_surface_m", "energy_residual", "steps",
)  # fmt: skip
CONDITIONS = FIELDS[:4]
SLOWING = 0.9
"""Deceleration of every vehicle under its full brake, m/s^2."""
PIPE = 280.0
"""Speed of the brake wave, m/s."""
TRAIN = """format: 1
name: {wagons}-wagons
vehicles:
  - scenario: tank-wagon
    set:
      name: locomotive
      tank.liquid.model: rigid
      tank.fill: 0.02
      tank.length: 12 m
      wagon.car_body.mass: 70 t
      wagon.bogie.mass: 3 t
      wagon.length_over_buffers: 19 m
      braking.deceleration: {slowing} m/s^2
      braking.application: {application}
  - scenario: tank-wagon
    count: {wagons}
    set:
      tank.fill: {fill}
      tank.liquid.model: {liquid}
      braking.deceleration: {slowing} m/s^2
      braking.application: {application}
coupling: {coupling}
brake_pipe: {{speed: {pipe} m/s}}
braking: {{initial_speed: 80 km/h, onset: 0.5 s}}
solver: {{tolerance: 5.0e-5}}
output: {{interval: 1 s}}
"""
HEADING = """# Does slosh make a train's couplers suffer?

In a train the brake reaches the last wagon seconds after the first, the wagons run up against each other, and every
tank answers with its own wave. A locomotive with 10 to 40 tank wagons brakes from 80 km/h on a level line. Every
vehicle slows down by 0.9 m/s^2 under its full brake, whatever its load: so the wave along the pipe, the couplings and
the liquid make the forces, not brakes that do not fit. Cylinders fill by P or G, the wave runs at 280 m/s. Couplings
are screw couplings with buffers, or automatic ones with 50 mm of slack. Tanks are 30 to 95 % full; the liquid is
shallow water, modal (three computed modes), or the equivalent solid.

`python docs/train_couplers.py` computes every stop, and makes this page, its figure and `train-couplers.csv`. Stops of
the modal liquid beyond its theory count too.
"""


def settings() -> list[dict[str, object]]:
    """Every stop of the study, the longest trains first."""
    found = product(sorted(LENGTHS, reverse=True), FILLS, APPLICATIONS, COUPLINGS, LIQUIDS)
    return [dict(zip((*CONDITIONS, "liquid"), each, strict=True)) for each in found]


def train_of(setting: dict[str, object], folder: Path) -> TrainScenario:
    """The train with these values."""
    file = folder / ("-".join(str(value) for value in setting.values()) + ".yaml")
    file.write_text(TRAIN.format(**setting, slowing=SLOWING, pipe=PIPE), encoding="utf-8")
    return load_train(file)


def examined(setting: dict[str, object], train: TrainScenario) -> dict[str, str]:
    """A stop's answers."""
    result = simulate_train(train)
    pushed = max(enumerate(result.couplings, 1), key=lambda one: one[1].max_compression_N)
    pulled = max(enumerate(result.couplings, 1), key=lambda one: one[1].max_tension_N)
    wagons = result.vehicles[1:]
    row = setting | {
        "status": str(result.status), "braking_distance_m": result.braking_distance_m,
        "max_compression_N": result.max_compression_N, "compression_at": pushed[0],
        "compression_s": pushed[1].max_compression_s, "max_tension_N": result.max_tension_N,
        "tension_at": pulled[0], "tension_s": pulled[1].max_tension_s,
        "max_wheel_unloading": max(one.max_wheel_unloading for one in wagons),
        "max_surface_m": max(one.max_surface_m for one in wagons),
        "energy_residual": result.energy_residual, "steps": result.steps,
    }  # fmt: skip
    return {
        name: f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
        for name, value in row.items()
    }


def computed() -> list[dict[str, str]]:
    """Every row, on all cores, in the order of the conditions."""
    stops = settings()
    with TemporaryDirectory() as folder, ThreadPoolExecutor() as pool:
        trains = [train_of(stop, Path(folder)) for stop in stops]
        rows = list(track(pool.map(examined, stops, trains), "trains", total=len(stops)))
    return sorted(rows, key=lambda row: (int(row["wagons"]), row["fill"], row["application"], row["coupling"]))


Row = dict[str, str]


def only(rows: Iterable[Row], **wanted: object) -> list[Row]:
    """Rows with these values."""
    return [row for row in rows if all(row[name] == str(value) for name, value in wanted.items())]


def changes(rows: Sequence[Row], liquid: str, answer: str) -> dict[tuple[str, ...], float]:
    """What a liquid makes of an answer of the equivalent solid, as a part of it, by the conditions."""
    solid = {conditions(row): float(row[answer]) for row in only(rows, liquid="rigid")}
    found = only(rows, liquid=liquid)
    return {conditions(row): float(row[answer]) / solid[conditions(row)] - 1.0 for row in found}


def conditions(row: Row) -> tuple[str, ...]:
    """What tells the stop of a row apart but for its liquid."""
    return tuple(row[name] for name in CONDITIONS)


def read() -> list[Row]:
    """The table beside this file."""
    with (HERE / "train-couplers.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write(rows: list[Row]) -> None:
    """Table, page and figure beside this file."""
    with (HERE / "train-couplers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    (HERE / "train-couplers.md").write_text(page(rows), encoding="utf-8")
    with mpl.rc_context(STYLE):
        figure(rows).savefig(HERE / "images" / "train-couplers.png")


def page(rows: list[Row]) -> str:
    """The page of the documentation."""
    return "\n".join([HEADING, *_findings(rows), *_claims(rows), *_table(rows), *_limits(rows)]) + "\n"


FLOWING = LIQUIDS[1:]
MATTERS = 0.02
"""A change of a force that matters."""


def _signs(rows: Sequence[Row], answer: str, **wanted: object) -> tuple[int, int, int]:
    """How often a liquid raises and lowers an answer of the solid by more than what matters, and of how many stops."""
    chosen = only(rows, **wanted)
    found = [change for liquid in FLOWING for change in changes([*chosen], liquid, answer).values()]
    return sum(change > MATTERS for change in found), sum(change < -MATTERS for change in found), len(found)


def _extreme(rows: Sequence[Row], answer: str, way: float) -> tuple[float, str]:
    """The largest change (`way` 1) or the least (-1) of an answer by a liquid, and where."""
    found = [
        (way * change, f"{where[0]} wagons, {100 * float(where[1]):g} % full, {where[2]}, {where[3]}, {liquid}")
        for liquid in FLOWING
        for where, change in changes(rows, liquid, answer).items()
    ]
    change, where = max(found)
    return way * change, where


def _findings(rows: list[Row]) -> list[str]:
    """What the table says, in figures and plain words."""
    up, down, total = _signs(rows, "max_compression_N")
    most, where = _extreme(rows, "max_compression_N", -1.0)
    worst, worst_where = _extreme(rows, "max_compression_N", 1.0)
    middle = {liquid: median(changes(rows, liquid, "max_compression_N").values()) for liquid in FLOWING}
    pulled = {name: _signs(rows, "max_tension_N", application="P", coupling=name) for name in COUPLINGS}
    way = [_extreme(rows, "braking_distance_m", sign)[0] for sign in (-1.0, 1.0)]
    pushes = all(float(row["max_compression_N"]) > float(row["max_tension_N"]) for row in only(rows, liquid="rigid"))
    return [
        "## Findings",
        "",
        f"- **The liquid eases the couplers' largest compression**: by more than {100 * MATTERS:g} % in {down} of "
        f"{total} stops, in the middle by {-100 * middle['modal']:.0f} % (modal) and "
        f"{-100 * middle['shallow-water']:.0f} % (shallow water), at most by {-100 * most:.0f} % ({where}). "
        "A liquid that moves is not slowed down with its wagon at once. Much of its mass loads the couplings later, "
        "when the wave of the brakes has passed.",
        f"- It raises the largest compression by more than {100 * MATTERS:g} % in {up} of them, at most by "
        f"{100 * worst:.0f} % ({worst_where}).",
        "- Tension is another matter. As the liquid comes back it pulls the train apart: with P it raises the largest "
        + " and ".join(f"tension of {name} couplings in {up} of {n} stops" for name, (up, _, n) in pulled.items())
        + f". With solid loads the largest force {'always pushes' if pushes else 'mostly pushes'}.",
        f"- The braking distance changes by {100 * way[0]:+.2f} % to {100 * way[1]:+.2f} %.",
        "",
        "![Coupler forces of trains with and without a moving liquid](images/train-couplers.png)",
        "",
    ]


def _ratio(rows: Sequence[Row], over: dict[str, object], under: dict[str, object], answer: str) -> tuple[float, float]:
    """Least and largest ratio of an answer between stops that differ in this alone."""
    names = [name for name in (*CONDITIONS, "liquid") if name not in over]
    base = {tuple(row[name] for name in names): float(row[answer]) for row in only(rows, **under)}
    found = [float(row[answer]) / base[tuple(row[name] for name in names)] for row in only(rows, **over)]
    return min(found), max(found)


def _claims(rows: list[Row]) -> list[str]:
    """What is said of slosh in trains, held against the table."""
    up, down, total = _signs(rows, "max_compression_N")
    tension_up, tension_down, _ = _signs(rows, "max_tension_N", coupling="screw", application="P")
    worst = {
        fill: sum(_heaviest(rows, row["liquid"], row) == fill for row in only(rows, fill=FILLS[0])) for fill in FILLS
    }
    slow = _ratio(rows, {"application": "G"}, {"application": "P"}, "max_compression_N")
    slack = _ratio(rows, {"coupling": "automatic"}, {"coupling": "screw"}, "max_compression_N")
    long = _ratio(only(rows, coupling="screw"), {"wagons": 40}, {"wagons": 10}, "max_compression_N")
    groups = len(only(rows, fill=FILLS[0]))
    held = [
        ("Slosh raises the largest compression.", "no", f"it does in {up} of {total} stops"),
        ("Slosh lowers the largest compression.", "yes", f"it does in {down} of {total} stops"),
        (
            "Slosh raises the largest tension.", "in part",
            f"with screw couplings and P it rises in {tension_up} and falls in {tension_down} of 32 stops",
        ),
        (
            "The half-filled tank is the worst.", "no",
            "the largest compression belongs to " + ", ".join(
                f"{100 * fill:g} % in {worst[fill]}" for fill in FILLS) + f" of {groups} trains",
        ),
        ("G instead of P eases the couplers.", "yes", f"compression falls to {slow[0]:.2f} to {slow[1]:.2f} of it"),
        ("Slack makes it worse.", "yes", f"automatic couplings have {slack[0]:.1f} to {slack[1]:.1f} times as much"),
        (
            "The force grows with the square of the train's length.", "no",
            f"four times the wagons with screw couplings have {long[0]:.1f} to {long[1]:.1f} times the force, not 16; "
            "the square belongs to couplings that are stiff beside everything else",
        ),
    ]  # fmt: skip
    lines = [f"| {claim} | {verdict} | {evidence} |" for claim, verdict, evidence in held]
    return ["## What is said of slosh in trains", "", "| claim | holds | here |", "|---|---|---|", *lines, ""]


def _heaviest(rows: Sequence[Row], liquid: str, row: Row) -> float:
    """The fill with the largest compression in the trains that are like that of a row but for it."""
    same = {name: row[name] for name in CONDITIONS if name != "fill"}
    return float(max(only(rows, liquid=liquid, **same), key=lambda one: float(one["max_compression_N"]))["fill"])


def _table(rows: list[Row]) -> list[str]:
    """Largest compression and tension of every train, in kN."""
    heads = [f"{100 * fill:g} %, {liquid}" for fill in FILLS for liquid in ("solid", "modal", "shallow water")]
    lines = []
    for application, coupling, wagons in product(APPLICATIONS, COUPLINGS, LENGTHS):
        cells = []
        for fill, liquid in product(FILLS, LIQUIDS):
            (row,) = only(rows, wagons=wagons, fill=fill, application=application, coupling=coupling, liquid=liquid)
            cells.append("/".join(f"{float(row[f'max_{way}_N']) / 1e3:.0f}" for way in ("compression", "tension")))
        lines.append(f"| {application} | {coupling} | {wagons} | {' | '.join(cells)} |")
    return [
        "## The forces", "", "Largest compression/tension in the train in kN, by fill and load:", "",
        f"| brake | coupling | wagons | {' | '.join(heads)} |", "|" + (3 + len(heads)) * "---|", *lines, "",
    ]  # fmt: skip


def _limits(rows: list[Row]) -> list[str]:
    """What the study leaves open."""
    residual = max(float(row["energy_residual"]) for row in rows)
    return [
        "## Limits", "",
        f"All {len(rows)} trains stop; the energy ledger misses {residual:.0e} of the initial energy at most. The "
        "tolerance is 5e-5. Wagons of a train are alike, and so are their brakes; a train of mixed loads or brakes has "
        "other forces. Tanks of 30 to 70 % may not run on the road without walls that divide them (ADR 4.3.2.2.4). "
        "The modal liquid is linear; where the two liquids disagree, `slosh check` says which one the tank asks for.",
    ]  # fmt: skip


COLOURS = {"rigid": "#c1440e", "modal": "#08306b", "shallow-water": "#4a98c9"}
STYLES = {"rigid": (0, (5, 1.5)), "modal": "-", "shallow-water": (0, (6, 2, 1, 2))}
NAMES = {"rigid": "equivalent solid", "modal": "liquid (modal)", "shallow-water": "liquid (shallow water)"}
SHADES = ("#9ecae1", "#4a98c9", "#08519c", "#08306b")


def figure(rows: list[Row]) -> Figure:
    """Above the forces of half-filled trains over their length; below what the liquid makes of the compression."""
    drawn = Figure(figsize=(15.0, 8.6), layout="constrained")
    grid = drawn.subplots(2, 4, sharey="row")
    for column, (application, coupling) in enumerate(product(APPLICATIONS, COUPLINGS)):
        above, below = grid[0, column], grid[1, column]
        chosen = only(rows, application=application, coupling=coupling)
        for liquid in LIQUIDS:
            for way, sign, marker in (("compression", 1.0, "o"), ("tension", -1.0, "v")):
                found = only(chosen, liquid=liquid, fill=0.5)
                forces = [sign * float(row[f"max_{way}_N"]) / 1e3 for row in found]
                above.plot(
                    LENGTHS, forces, color=COLOURS[liquid], linestyle=STYLES[liquid], marker=marker, linewidth=1.8,
                    label=NAMES[liquid] if way == "compression" else None,
                )  # fmt: skip
        above.axhline(0.0, color="#7a7a7a", linewidth=0.8)
        above.set_title(f"{application}, {coupling}", loc="left", fontweight="bold")
        above.set_xlabel("wagons")
        above.set_xticks(LENGTHS)
        for shade, wagons in zip(SHADES, LENGTHS, strict=True):
            for liquid in FLOWING:
                made = changes(only(chosen, wagons=wagons), liquid, "max_compression_N")
                values = [100.0 * made[str(wagons), str(fill), application, coupling] for fill in FILLS]
                below.plot(
                    [100.0 * fill for fill in FILLS], values, color=shade, linestyle=STYLES[liquid], marker="o",
                    markersize=4.0, label=f"{wagons} wagons" if liquid == "modal" else None,
                )  # fmt: skip
        below.axhline(0.0, color="#7a7a7a", linewidth=0.8)
        below.set_xlabel("fill / %")
    grid[0, 0].set_ylabel("half-filled: largest force / kN\ntension below zero")
    grid[1, 0].set_ylabel("compression, change by the liquid / %\nmodal solid, shallow water dashed lines")
    grid[0, 0].legend(loc="upper left")
    grid[1, 0].legend(loc="lower left", ncols=2)
    return drawn


if __name__ == "__main__":
    write(computed())
