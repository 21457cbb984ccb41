"""What the paper says of its Figure 3, held against a study of its wagon."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

from slosh_cli.scenario import Scenario
from slosh_cli.study.plan import LIQUID, SOLID, SPEED, TORQUE, Study

_LINEAR: Final = "modal"
"""The model of the liquid that the paper has."""
_SPEEDS: Final = (80.0, 160.0)
"""The speeds of Figure 3, km/h."""
_OPTIMUM: Final = (15.0, 20.0)
"""Where the paper sees the most effective torque, kN m."""
_LARGE_TORQUE: Final = 15.0
"""From here on, in kN m, a torque counts as large: the upper half of the figure's range."""
_ABOUT_15_PERCENT: Final = (1.10, 1.20)
"""What we take "about 15 % longer" for."""
_NAMED_POINT: Final = (160.0, 20.0)
"""The speed in km/h and the torque in kN m of that claim."""


class Judgement(StrEnum):
    """Whether a claim holds."""

    HOLDS = "holds"
    IN_PART = "holds in part"
    FAILS = "does not hold"
    OPEN = "no answer"


@dataclass(frozen=True)
class Verdict:
    """A claim of the paper, whether it holds here, and the figures that say so."""

    claim: str
    text: str
    finding: Judgement
    evidence: str


@dataclass(frozen=True)
class _Point:
    """One stop of the figure: braking distance in m, None without an answer."""

    distance: float | None
    status: str
    liquid_in_range: bool


_Curve = dict[float, _Point]
"""Torque in kN m -> stop."""


def applies(study: Study, paper: Scenario) -> bool:
    """Whether the study is the paper's Figure 3: its wagon, its two speeds, several torques, liquid and solid."""
    axes = {axis.key: axis for axis in study.axes}
    if not isinstance(study.base, Scenario):
        return False
    if any(len(axis.values) > 1 and key not in (SPEED, TORQUE, LIQUID) for key, axis in axes.items()):
        return False
    models = set(axes[LIQUID].values)
    if SPEED not in axes or TORQUE not in axes or SOLID not in models or models == {SOLID}:
        return False
    speeds = {study.conditions(index)["v0_km_h"] for index in range(study.size)}
    return set(_SPEEDS) <= speeds and len(axes[TORQUE].values) > 1 and _same_wagon(study.base, paper)


def _same_wagon(base: Scenario, paper: Scenario) -> bool:
    tank = base.with_({LIQUID: str(paper.tank.liquid.model)}).tank
    return (base.wagon, tank, base.track, base.contact) == (paper.wagon, paper.tank, paper.track, paper.contact)


def verdicts(rows: Iterable[Mapping[str, Any]], liquid: str = _LINEAR) -> list[Verdict]:
    """The claims about Figure 3 for one model of the `liquid`, from the rows of a study's table."""
    curves: dict[tuple[float, str], _Curve] = {}
    for row in rows:
        point = _Point(row.get("braking_distance_m"), str(row["status"]), bool(row.get("liquid_in_range")))
        curves.setdefault((row["v0_km_h"], row["liquid"]), {})[row["torque_kN_m"]] = point
    return [_optimum(curves, liquid), _longer(curves, liquid), _fifteen_percent(curves, liquid)]


def _most_effective(curve: _Curve) -> tuple[float, _Point] | None:
    """The torque with the shortest braking distance, and that stop; None where no stop has an answer."""
    answered = [(point.distance, torque, point) for torque, point in curve.items() if point.distance is not None]
    if not answered:
        return None
    _, torque, point = min(answered, key=lambda entry: entry[:2])
    return torque, point


def _optimum(curves: Mapping[tuple[float, str], _Curve], liquid: str) -> Verdict:
    found: list[bool | None] = []
    parts: list[str] = []
    for speed in _SPEEDS:
        for load in (liquid, SOLID):
            curve = curves.get((speed, load), {})
            best = _most_effective(curve)
            lost = [f"{torque:g}" for torque, point in curve.items() if point.distance is None]
            gaps = f"; without an answer at {', '.join(lost)} kN m" if lost else ""
            if best is None:
                parts.append(f"{speed:g} km/h {load}: no stop has an answer")
                found.append(None)
                continue
            torque, point = best
            where = "" if point.liquid_in_range else f", {_outside(load)}"
            parts.append(f"{speed:g} km/h {load}: {torque:g} kN m ({point.distance:.1f} m{where}){gaps}")
            found.append(_OPTIMUM[0] <= torque <= _OPTIMUM[1])
    text = "the most effective torque lies between 15 and 20 kN m at 80 and at 160 km/h"
    torques = [torque for curve in curves.values() for torque in curve]
    if not (min(torques) < _OPTIMUM[0] and max(torques) > _OPTIMUM[1]):
        found, parts = [], ["the study's torques do not reach beyond that range on both sides", *parts]
    return Verdict("fig3-optimum", text, _overall(found), ". ".join(parts))


def _longer(curves: Mapping[tuple[float, str], _Curve], liquid: str) -> Verdict:
    ratios: dict[tuple[float, float], float] = {}
    for speed in _SPEEDS:
        solid = curves.get((speed, SOLID), {})
        for torque, point in curves.get((speed, liquid), {}).items():
            other = solid[torque].distance if torque in solid else None
            if point.distance is not None and other is not None:
                ratios[speed, torque] = point.distance / other
    text = "liquid increases the braking distance, most at high speed and/or large torque"
    if not ratios:
        return Verdict("fig3-longer", text, Judgement.OPEN, "no pair of stops has both answers")
    longer = [place for place, ratio in ratios.items() if ratio > 1.0]
    most = max(ratios, key=lambda place: ratios[place])
    large = most[0] == max(_SPEEDS) or most[1] >= _LARGE_TORQUE
    shorter = ", ".join(f"{speed:g} km/h {torque:g} kN m" for speed, torque in ratios if ratios[speed, torque] <= 1.0)
    evidence = (
        f"longer at {len(longer)} of {len(ratios)} points with both answers"
        + (f" (not at {shorter})" if shorter else "")
        + f". Most at {most[0]:g} km/h {most[1]:g} kN m: {_percent(ratios[most])}"
    )
    return Verdict("fig3-longer", text, _overall([len(longer) == len(ratios), large]), evidence)


def _fifteen_percent(curves: Mapping[tuple[float, str], _Curve], liquid: str) -> Verdict:
    text = "about 15 % longer at 160 km/h and 20 kN m"
    speed, torque = _NAMED_POINT
    wet, solid = (curves.get((speed, load), {}).get(torque) for load in (liquid, SOLID))
    if wet is None or solid is None:
        return Verdict("fig3-15-percent", text, Judgement.OPEN, "the study has no such pair of stops")
    evidence = f"liquid: {_told(wet, liquid)}, solid: {_told(solid, SOLID)}"
    if wet.distance is None or solid.distance is None:
        return Verdict("fig3-15-percent", text, Judgement.OPEN, evidence)
    ratio = wet.distance / solid.distance
    low, high = _ABOUT_15_PERCENT
    finding = Judgement.HOLDS if low <= ratio <= high else Judgement.FAILS
    return Verdict("fig3-15-percent", text, finding, f"{evidence}, {_percent(ratio)}")


def _told(point: _Point, load: str) -> str:
    if point.distance is None:
        return point.status
    return f"{point.distance:.1f} m{'' if point.liquid_in_range else f' ({_outside(load)})'}"


def _outside(load: str) -> str:
    return "outside linear theory" if load == _LINEAR else "outside its theory"


def _percent(ratio: float) -> str:
    return f"{abs(100.0 * (ratio - 1.0)):.1f} % {'longer' if ratio >= 1.0 else 'shorter'}"


def _overall(parts: Iterable[bool | None]) -> Judgement:
    known = [part for part in parts if part is not None]
    if not known:
        return Judgement.OPEN
    if all(known):
        return Judgement.HOLDS
    return Judgement.IN_PART if any(known) else Judgement.FAILS
