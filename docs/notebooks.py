"""The notebooks: cells as plain text here, run and written with their outputs into ``notebooks``.

`python docs/notebooks.py` does both. A cell that ends with an expression shows its value: a table, or a figure as PNG.
"""

from __future__ import annotations

import ast
import contextlib
import io
import os
import tempfile
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import nbformat
from gallery import reduced
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from nbformat import v4
from PIL import Image

FOLDER = Path(__file__).parent / "notebooks"
WIDTH = 640
"""Pixels of a picture: a notebook stays small."""
A_STOP = """
# A stop, and what the liquid does

A tank wagon that is half full brakes. What does the moving liquid change, compared with a solid load of the same mass
in the same place? [From Python](../python.md) has every function; [which liquid](../which-liquid.md) says which model
suits which question.

---
from slosh_cli import load_scenario, plot, simulate

wagon = load_scenario("tank-wagon", ["braking.torque=8 kN m", "tank.liquid.model=shallow-water"])
liquid = simulate(wagon)
solid = simulate(wagon.with_({"tank.liquid.model": "rigid"}))
print(liquid.status, solid.status)

---
## The answers

Every answer has its unit in its name; [answers and channels](../answers.md) tells what each means.

---
import pandas as pd

asked = ["braking_distance_m", "braking_time_s", "max_wheel_unloading", "speed_at_first_lock_m_s", "max_surface_m"]
pd.DataFrame({"liquid": liquid.summary(), "solid": solid.summary()}).loc[asked]

---
## The wheel loads

The liquid runs to the front wall and takes its weight with it: the leading wheels carry more, the trailing ones less.
Wheel four is the last of the wagon.

---
force = "wheel_4_normal_force"
loads = pd.DataFrame({"liquid": liquid.to_frame()[force], "solid": solid.to_frame()[force]}) / 1e3
axes = loads.plot(figsize=(9, 4), xlabel="time / s", ylabel="normal force of wheel 4 / kN", grid=True)
axes

---
## The liquid

The figures of `slosh run` are here, too. This one shows the surface at both end walls and the force on the tank.

---
figures = plot(liquid)
print(sorted(figures))
figures["slosh"]

---
## May it be believed?

Checks hold the run against the range of its models and against limits. The energy ledger says what the integration
lost.

---
print("energy residual:", f"{liquid.energy_residual:.0e}", "of the initial kinetic energy")
pd.DataFrame([check.as_dict() for check in liquid.checks])[["check", "value", "limit", "within"]].round(3)

---
## What would a baffle do?

A perforated wall in the middle of the tank; three tenths of its area are open.

---
baffle = simulate(wagon.with_({"tank.baffles": [{"position": "7.75 m", "opening": 0.3}]}))
pd.DataFrame({"open tank": liquid.summary(), "one baffle": baffle.summary()}).loc[asked]
"""
A_STUDY = """
# A study, and a search

How do braking distance and wheel unloading depend on the fill, and from which torque does a wheel lock?
[Studies](../studies.md) and [find](../find.md) describe both.

---
from slosh_cli import find, load_scenario, plot, sweep

wagon = load_scenario("tank-wagon", ["tank.liquid.model=shallow-water", "braking.initial_speed=40 km/h"])
study = sweep(wagon, {"tank.fill": "0.3:0.9:0.2", "braking.torque": "4,8 kN m"})
table = study.to_frame()
print(len(table), "stops,", len(study.failed), "without an answer")

---
## The table

One row a stop, the unit in the column's name. Each stop with a liquid has its solid twin.

---
unloading = table.pivot_table(index="fill", columns=["torque_kN_m", "liquid"], values="max_wheel_unloading")
unloading.round(3)

---
axes = unloading.plot(figsize=(9, 4), marker="o", xlabel="fill", ylabel="largest wheel unloading", grid=True)
axes

---
## The figure of `slosh sweep`

---
figures = plot(study)
print(sorted(figures))
figures[sorted(figures)[0]]

---
## From which torque does a wheel lock?

`find` scans the range, then closes in on the model itself. `optimum` seeks the best value in the same way.

---
lock = find(wagon, "braking.torque=4:16 kN m", "first_lock", points=5)
print("a wheel locks from", lock.text, "on:", lock.kind)
next(iter(plot(lock).values()))
"""
NOTEBOOKS: Mapping[str, str] = {"a-stop.ipynb": A_STOP, "a-study.ipynb": A_STUDY}


def cells(text: str) -> Iterator[tuple[str, str]]:
    """Kind and text of every cell; prose begins as prose does in Markdown."""
    for part in text.strip().split("\n\n---\n"):
        yield ("markdown" if part.startswith("#") else "code"), part.strip()


def run(code: str, names: dict[str, Any]) -> list[Any]:
    """Run a cell; what it prints and what its last expression is, as a notebook keeps them."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(compile(tree, "cell", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if isinstance(last, ast.Expr) else None
    printed = [v4.new_output("stream", name="stdout", text=said.getvalue())] if said.getvalue() else []
    shown = [] if value is None else [v4.new_output("execute_result", data=data_of(value))]
    return printed + shown


def data_of(value: Any) -> dict[str, str]:
    """A value by the kinds of its views."""
    if isinstance(value, Axes):
        value = value.figure
    if isinstance(value, Figure):
        drawn, png = io.BytesIO(), io.BytesIO()
        value.savefig(drawn, format="png", dpi=200)
        pyplot.close("all")
        with Image.open(drawn) as found:
            reduced(found, WIDTH).save(png, format="PNG", optimize=True)
        return {"text/plain": "a figure", "image/png": b64encode(png.getvalue()).decode("ascii")}
    table = getattr(value, "_repr_html_", None)
    return {"text/plain": repr(value)} | ({"text/html": table()} if table else {})


def written(parts: Sequence[tuple[str, str]]) -> Any:
    """The notebook of some cells, run in their order in the current folder."""
    notebook, names = v4.new_notebook(), {}
    notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    for number, (kind, text) in enumerate(parts):
        if kind == "markdown":
            one = v4.new_markdown_cell(text, id=f"cell-{number}")
        else:
            outputs = run(text, names)
            count = sum(kind == "code" for kind, _ in parts[: number + 1])
            for output in outputs:
                if output.output_type == "execute_result":
                    output.execution_count = count
            one = v4.new_code_cell(text, id=f"cell-{number}", outputs=outputs, execution_count=count)
        notebook.cells.append(one)
    nbformat.validate(notebook)
    return notebook


if __name__ == "__main__":
    pyplot.switch_backend("agg")
    FOLDER.mkdir(exist_ok=True)
    for name, text in NOTEBOOKS.items():
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            made = written(list(cells(text)))
            os.chdir(FOLDER)
        (FOLDER / name).write_text(nbformat.writes(made) + "\n", encoding="utf-8")
