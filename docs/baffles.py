"""What baffles do to a braking wagon: none, one, two and three transverse walls in a half-filled to nearly full tank.

`python docs/baffles.py` computes 132 stops of a wagon alone and 132 behind a locomotive, and writes ``baffles.md``, its
figure and ``baffles.csv`` beside itself. Some five minutes.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from rich.progress import track

from slosh_cli.report.saving import STYLE
from slosh_cli.results.simulate import simulate, simulate_train
from slosh_cli.scenario import find_packaged, load_scenario
from slosh_cli.scenario.train_file import load_train

HERE = Path(__file__).parent
FILLS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
APPLICATIONS = ("step", "P")
KINDS = {
    "perforated": "opening: 0.2",
    "slot": "openings: [{from: 0 m, to: 0.6 m}]",
    "closed": "opening: 0",
}
"""How a wall of the 3 m high cylinder is open."""
COUNTS = (1, 2, 3)
FIELDS = (
    "fill", "application", "load", "walls", "status", "braking_distance_m", "max_wheel_unloading", "max_surface_m",
    "in_model_range", "max_compression_N", "max_tension_N", "energy_residual",
)  # fmt: skip
CONDITIONS = FIELDS[:4]
WAGON = """      tank.fill: {fill}
      tank.liquid.model: {model}
      tank.baffles: [{baffles}]
      braking.deceleration: 0.9 m/s^2
      braking.application: {application}
"""
TRAIN = """format: 1
name: wagon-behind-a-locomotive
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
      braking.deceleration: 0.9 m/s^2
      braking.application: {application}
  - scenario: tank-wagon
    set:
{wagon}coupling: screw
braking: {{initial_speed: 80 km/h, onset: 0.5 s}}
output: {{interval: 1 s}}
"""
HEADING = """# What do baffles do to a braking wagon?

A tank wagon brakes from 80 km/h with 0.9 m/s^2, all at once or by P, dry and level. Its cylinder is 3 m high and 15.5 m
long, and 40 to 90 % of the height are liquid. One, two or three walls stand evenly in it. They are perforated over a
fifth of their area, open from the bottom to 0.6 m, or closed. The open tank and the equivalent solid stand beside them.

`python docs/baffles.py` computes every stop, and makes this page, its figure and `baffles.csv`. Each wagon stops alone,
and once more behind a locomotive of the same brake: the force in the screw coupling between them is what the liquid
does at the height of the couplers.
"""
Row = dict[str, str]


def settings() -> list[dict[str, Any]]:
    """Every stop of the study: the equivalent solid, the tank without walls, and every kind and number of walls."""
    loads = [("solid", 0), ("open tank", 0), *product(KINDS, COUNTS)]
    found = [(fill, application, *load) for fill, application, load in product(FILLS, APPLICATIONS, loads)]
    return [dict(zip(CONDITIONS, each, strict=True)) for each in found]


def wagon_of(setting: dict[str, Any], length: float) -> str:
    """The wagon's own values, as a train file sets them; walls stand evenly in the tank of a length (m)."""
    count, kind = setting["walls"], setting["load"]
    places = [length * (k + 1) / (count + 1) for k in range(count)]
    baffles = ", ".join(f"{{position: {place:g} m, {KINDS[kind]}}}" for place in places)
    model = "rigid" if kind == "solid" else "shallow-water"
    return WAGON.format(**setting, model=model, baffles=baffles)


def examined(setting: dict[str, Any]) -> Row:
    """The answers of the wagon alone, and of its coupling to a locomotive."""
    file = find_packaged("tank-wagon")
    wagon = wagon_of(setting, load_scenario(file).tank.length)
    words = [line.strip().replace(": ", "=", 1) for line in wagon.splitlines()]
    alone = simulate(load_scenario(file, [*words, "output.interval=1 s"]))
    with TemporaryDirectory() as folder:
        train = Path(folder) / "train.yaml"
        train.write_text(TRAIN.format(**setting, wagon=wagon), encoding="utf-8")
        coupled = simulate_train(load_train(train))
    row = setting | {
        "status": f"{alone.status} / {coupled.status}", "braking_distance_m": alone.braking_distance_m,
        "max_wheel_unloading": alone.max_wheel_unloading, "max_surface_m": alone.max_surface_m,
        "in_model_range": alone.in_model_range, "max_compression_N": coupled.max_compression_N,
        "max_tension_N": coupled.max_tension_N, "energy_residual": max(alone.energy_residual, coupled.energy_residual),
    }  # fmt: skip
    return {
        name: f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
        for name, value in row.items()
    }


def computed() -> list[Row]:
    """Every row, on all cores."""
    stops = settings()
    with ThreadPoolExecutor() as pool:
        return list(track(pool.map(examined, stops), "stops", total=len(stops)))


def only(rows: Iterable[Row], **wanted: object) -> list[Row]:
    """Rows with these values."""
    return [row for row in rows if all(row[name] == str(value) for name, value in wanted.items())]


def read() -> list[Row]:
    """The table beside this file."""
    with (HERE / "baffles.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write(rows: list[Row]) -> None:
    """Table, page and figure beside this file."""
    with (HERE / "baffles.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    (HERE / "baffles.md").write_text(page(rows), encoding="utf-8")
    with mpl.rc_context(STYLE):
        figure(rows).savefig(HERE / "images" / "baffles.png")


def page(rows: list[Row]) -> str:
    """The page of the documentation."""
    return "\n".join([HEADING, *_findings(rows), *_table(rows), *_limits(rows)]) + "\n"


def answer(rows: Sequence[Row], name: str, **wanted: object) -> float:
    """An answer of the one stop with these values."""
    (row,) = only(rows, **wanted)
    return float(row[name])


def added(rows: Sequence[Row], name: str, load: str, walls: int, application: str) -> float:
    """What the liquid of a load adds to an answer of the equivalent solid, mean over the fills."""
    found = [
        answer(rows, name, fill=fill, application=application, load=load, walls=walls)
        - answer(rows, name, fill=fill, application=application, load="solid")
        for fill in FILLS
    ]
    return sum(found) / len(found)


def left(rows: Sequence[Row], name: str, load: str, walls: int, application: str) -> float:
    """The same in % of what the liquid of the open tank adds."""
    return 100.0 * added(rows, name, load, walls, application) / added(rows, name, "open tank", 0, application)


def _findings(rows: list[Row]) -> list[str]:
    """What the table says, in figures and plain words."""
    changes = [
        answer(rows, "braking_distance_m", **{name: row[name] for name in CONDITIONS})
        / answer(rows, "braking_distance_m", fill=row["fill"], application=row["application"], load="solid")
        - 1.0
        for row in rows
    ]
    unloading, pushed = "max_wheel_unloading", "max_compression_N"
    kept = {(kind, n): left(rows, unloading, kind, n, "P") for kind, n in product(KINDS, COUNTS)}
    force = {(kind, n): left(rows, pushed, kind, n, "P") for kind, n in product(KINDS, COUNTS)}
    pull = {n: left(rows, "max_tension_N", "perforated", n, "step") for n in COUNTS}
    return [
        "## Findings",
        "",
        f"- **The braking distance does not care**: with any wall and without, it lies {100 * min(changes):+.2f} % to "
        f"{100 * max(changes):+.2f} % from that of the equivalent solid.",
        f"- **One open wall in the middle calms the coupler.** By P it leaves {force['perforated', 1]:.0f} % "
        f"(perforated) or {force['slot', 1]:.0f} % (slot) of what the open tank's liquid adds to the largest "
        f"compression. Two leave {force['perforated', 2]:.0f} % and {force['slot', 2]:.0f} %, three "
        f"{force['perforated', 3]:.0f} % and {force['slot', 3]:.0f} %. Below zero the coupling is pressed less than "
        "by the solid.",
        f"- It helps the wheels less: of the unloading that the liquid adds, it leaves {kept['perforated', 1]:.0f} % "
        f"(perforated) or {kept['slot', 1]:.0f} % (slot). Three walls leave {kept['perforated', 3]:.0f} % and "
        f"{kept['slot', 3]:.0f} %. Through openings the liquid still comes to lie askew, in the end as far as without "
        "walls. Such walls only keep it from swinging beyond that.",
        f"- **Only closed bulkheads spare the wheels**: one leaves {kept['closed', 1]:.0f} % of the added unloading, "
        f"two {kept['closed', 2]:.0f} %, three {kept['closed', 3]:.0f} %. They calm the coupler no better than open "
        f"walls: {force['closed', 1]:.0f}, {force['closed', 2]:.0f} and {force['closed', 3]:.0f} % of the added "
        "compression are left. Between closed walls the liquid sways on, and only bores take its energy.",
        f"- When the brake comes all at once, the largest tension stays: one, two and three perforated walls leave "
        f"{pull[1]:.0f}, {pull[2]:.0f} and {pull[3]:.0f} % of what the liquid adds. It comes from the first moment, "
        "when the brakes already hold the wagons and no wall yet holds the liquid.",
        "",
        "**Recommendation.** Against shocks in the train, one wall in the middle with a fifth of its area open is "
        "most of what baffles can give; a second and a third bring little. Perforated or open at the bottom makes "
        "little difference. Against unloaded wheels, part the tank by closed bulkheads: two already bring it to "
        "little more than the solid. For the braking distance, leave them out. A wall that is more than 30 % open does "
        "not count as one for the degree of filling on the road (ADR 4.3.2.2.4).",
        "",
        "![Unloading and compression with and without baffles](images/baffles.png)",
        "",
    ]


def _table(rows: list[Row]) -> list[str]:
    """Unloading and coupler force of every tank, braked by P."""
    lines = []
    for load, walls in [("solid", 0), ("open tank", 0), *product(KINDS, COUNTS)]:
        cells = []
        for fill in FILLS:
            where = {"fill": fill, "application": "P", "load": load, "walls": walls}
            unloading = 100.0 * answer(rows, "max_wheel_unloading", **where)
            forces = [answer(rows, f"max_{way}_N", **where) / 1e3 for way in ("compression", "tension")]
            cells.append(f"{unloading:.0f} / {forces[0]:.0f} / {forces[1]:.0f}")
        lines.append(f"| {f'{walls} ' if walls else ''}{load} | {' | '.join(cells)} |")
    heads = " | ".join(f"{100 * fill:g} % full" for fill in FILLS)
    return [
        "## The numbers by P", "",
        "Largest unloading of a wheel in %, largest compression and tension in kN of the coupling to the locomotive:",
        "", f"| load | {heads} |", "|" + (1 + len(FILLS)) * "---|", *lines, "",
    ]  # fmt: skip


def _limits(rows: list[Row]) -> list[str]:
    """What the study leaves open."""
    residual = max(float(row["energy_residual"]) for row in rows)
    outside = [row for row in rows if row["in_model_range"] == "False"]
    closed = sum(row["load"] == "closed" and row["fill"] != "0.9" for row in outside)
    return [
        "## Limits", "",
        f"All {len(rows)} wagons stop; the energy ledger misses {residual:.0e} of the initial energy at most. "
        f"{len(outside)} stops leave the range of shallow water: those of tanks 90 % full, where the slot stores "
        f"liquid, and {closed} with bulkheads, whose parts are short for long-wave theory (first frequency too high). "
        "What waves do over the height, the liquid that rides with the tank at once, and the strength of the walls are "
        "left out; the first tension under a brake that comes all at once is too large for it. "
        "Two-dimensional computations of a wall with holes or a slot stand beside the program in "
        "`slosh validate cfd`.",
    ]  # fmt: skip


COLOURS = ("#08306b", "#08519c", "#4a98c9", "#9ecae1")
TITLES = {"perforated": "perforated, a fifth open", "slot": "open to 0.6 m above the bottom", "closed": "closed"}


def figure(rows: list[Row]) -> Figure:
    """Above the unloading, below the compression by P over the fill, one column for each kind of wall."""
    drawn = Figure(figsize=(13.5, 7.6), dpi=110, layout="constrained")
    drawn.suptitle("Walls in a braking tank, by P", fontweight="bold", x=0.01, ha="left")
    grid = drawn.subplots(2, len(KINDS), sharex=True, sharey="row")
    names = ("max_wheel_unloading", "max_compression_N")
    for column, kind in enumerate(KINDS):
        lines = [("open tank", 0), *product([kind], COUNTS), ("solid", 0)]
        for axes, name, scale in zip(grid[:, column], names, (100, 1e-3), strict=True):
            for load, walls in lines:
                values = [
                    scale * answer(rows, name, fill=fill, application="P", load=load, walls=walls) for fill in FILLS
                ]
                solid = load == "solid"
                axes.plot(
                    [100 * fill for fill in FILLS], values, "--" if solid else "-", marker="" if solid else "o",
                    color="#c1440e" if solid else COLOURS[walls], linewidth=1.8,
                    label=f"{walls} wall{'s' if walls > 1 else ''}" if walls else load,
                )  # fmt: skip
            axes.set_ylim(bottom=0.0)
        grid[0, column].set_title(TITLES[kind])
        grid[1, column].set_xlabel("fill / % of the height")
    grid[0, 0].set_ylabel("largest unloading of a wheel / %")
    grid[1, 0].set_ylabel("largest compression\nof the coupling / kN")
    drawn.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return drawn


if __name__ == "__main__":
    write(computed())
