"""Figure 3 of the paper: braking distance over torque, liquid and solid, as `slosh sweep` computes it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from slosh_cli.study.build import Wishes, build
from slosh_cli.study.claims import verdicts
from slosh_cli.study.outcome import solve
from slosh_cli.study.plan import LIQUID, SOLID
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData

_Rows = Sequence[Mapping[str, Any]]


def compute(data: CaseData) -> Outcome:
    """The study's own verdicts on the whole grid, with printed and with computed coefficients."""
    found, tables = Findings(data), {}
    solid: list[Mapping[str, Any]] = []
    for words, changes in data.reference["coefficients"].items():
        study = build(Wishes(overrides=tuple(changes)))
        wanted = [index for index in range(study.size) if not (solid and study.values(index)[LIQUID] == SOLID)]
        rows = [solve(study.stop(index)).answer for index in wanted] + solid
        solid = [row for row in rows if row["liquid"] == SOLID]  # a frozen load has no coefficients
        tables[words] = rows
        _small_torques(found, words, rows)
        for verdict in verdicts(rows):
            stated = data.reference["stated"][words][verdict.claim]
            found.verdict(f"{verdict.text} [{words} coefficients]", str(verdict.finding), stated)
            found.note(f"evidence for {verdict.claim}, {words}", verdict.evidence)
    return found.outcome(Chart([_panel(tables, speed) for speed in (80.0, 160.0)]))


def _small_torques(found: Findings, words: str, rows: _Rows) -> None:
    """Where nothing locks and linear theory holds, liquid and solid must stop in the same distance, nearly."""
    distance = {(row["v0_km_h"], row["torque_kN_m"], row["liquid"]): row.get("braking_distance_m") for row in rows}
    for speed in (80.0, 160.0):
        liquid, solid = (distance[speed, 2.5, model] for model in ("modal", SOLID))
        ratio = None if liquid is None or solid is None else liquid / solid
        found.compare(f"distance, liquid over solid, {speed:g} km/h, 2.5 kN m, {words}", ratio, 1.0, "small_torque")


def _panel(tables: Mapping[str, _Rows], speed: float) -> Panel:
    curves = []
    for words, rows in tables.items():
        for model in ("modal", SOLID) if words == "printed" else ("modal",):
            points = sorted(
                (row["torque_kN_m"], row.get("braking_distance_m"))
                for row in rows
                if (row["v0_km_h"], row["liquid"]) == (speed, model)
            )
            distances = [np.nan if distance is None else distance for _, distance in points]
            label = "equivalent solid" if model == SOLID else f"liquid, {words} coefficients"
            curves.append(curve(label, [torque for torque, _ in points], distances))
    return Panel("brake torque per wheel / kN m", "braking distance / m", curves, title=f"{speed:g} km/h")
