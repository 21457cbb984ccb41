"""Figure 2 of the paper: what it says of the wheel loads at 80 km/h and 5 kN m."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from slosh_cli.arrays import Array
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Result
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows
from slosh_cli.validation.runs import stop

HOLDS, IN_PART, FAILS = "holds", "holds in part", "does not hold"


def compute(data: CaseData) -> Outcome:
    """Each claim by its numbers, with the printed coefficients and with computed ones."""
    found = Findings(data)
    claims = {row["id"]: row["claim"] for row in data_rows("claims.csv")}
    solid = stop("paper-80-solid")
    for words, changes in data.reference["coefficients"].items():
        liquid = stop("paper-80-liquid", *changes)
        for claim, verdict in claim_verdicts(data, found, words, liquid, solid).items():
            found.verdict(f"{claims[claim]} [{words} coefficients]", verdict, data.reference["stated"][claim])
    return found.outcome(_chart(stop("paper-80-liquid"), solid))


def _braking_loads(data: CaseData, result: Result) -> Array:
    """Wheel loads (4, n) in N from the onset's settling to the stop."""
    begin = result.onset_s + data.reference["settling"]
    end = result.onset_s + (result.braking_time_s or 0.0)
    during = (result.time > begin) & (result.time < end)
    return np.array([result.channels[wheel(i, "normal_force")][during] for i in WHEELS])


def claim_verdicts(data: CaseData, found: Findings, words: str, liquid: Result, solid: Result) -> dict[str, str]:
    """Verdict on each claim about Figure 2 from a stop with liquid and one with the equivalent solid."""
    moving, frozen = _braking_loads(data, liquid), _braking_loads(data, solid)
    swing = float((moving.std(axis=1) / frozen.std(axis=1)).min())
    found.note(f"least ratio of standard deviations of wheel loads, liquid over solid, {words}", swing)
    apart = moving[:2].min(axis=0) > moving[2:].max(axis=0)
    means = moving.mean(axis=1)
    found.note(f"part of the stop with both front wheels above both rear ones, {words}", float(apart.mean()))
    found.note(
        f"mean load of the lighter front wheel over that of the heavier rear one, {words}",
        float(means[:2].min() / means[2:].max()),
    )
    leading = np.minimum(moving[0] - moving[1], moving[2] - moving[3]) > 0
    found.note(
        f"part of the stop with the leading wheel above the trailing one in both bogies, {words}", float(leading.mean())
    )
    return {
        "fig2-oscillation": HOLDS if swing > data.reference["much_more"] else FAILS,
        "fig2-front-bogie": _always(apart, bool(means[:2].min() > means[2:].max())),
        "fig2-lead-wheel": _always(leading, bool(means[0] > means[1] and means[2] > means[3])),
    }


def _always(at_instants: NDArray[np.bool_], on_average: bool) -> str:
    """Holds at every instant, in part when only on average."""
    if at_instants.all():
        return HOLDS
    return IN_PART if on_average else FAILS


def _chart(liquid: Result, solid: Result) -> Chart:
    panels = []
    for words, result in (("liquid", liquid), ("equivalent solid", solid)):
        loads = [curve(f"wheel {i}", result.time, result.channels[wheel(i, "normal_force")] / 1e3) for i in WHEELS]
        panels.append(Panel("time / s", "wheel load / kN", loads, title=words))
    return Chart(panels)
