"""The tornado chart: what a stop depends on, the largest effect on top."""

from __future__ import annotations

from typing import Any, Final

from matplotlib.figure import Figure
from matplotlib.patches import Patch

from slosh_cli.report.saving import INK, MUTED
from slosh_cli.study.sensitivity import DISTANCE, LOCK, SMALL, UNLOADING

_FEWEST: Final = 5
"""Values that are drawn where none matters."""
_LOW, _HIGH = "#6baed6", "#08306b"
_PANELS: Final = (
    (DISTANCE, "braking distance / m", 1.0),
    (UNLOADING, "largest unloading / %", 100.0),
    (LOCK, "speed at first lock / (km/h)", 3.6),
)


def tornado(found: Any) -> Figure:
    """Bars from the answer at the low end of a value to that at its high end, about the scenario's own; three panels.

    `found` is a `Sensitivity`. Shaded: what counts as small. Where one end locks no wheel and the other does, it is
    said in words.
    """
    mattering = found.mattering
    told = mattering or list(found.effects)[:_FEWEST]
    figure = Figure(figsize=(13.0, 2.4 + 0.42 * max(len(told), 3)), dpi=150, layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    for axes, (name, label, factor) in zip(panels, _PANELS, strict=True):
        _draw(axes, found, told, name, factor)
        axes.set_xlabel(label)
    panels[0].set_yticks(range(len(told)), [f"{one.doubt.key} ({one.doubt.standing})" for one in told], fontsize=10)
    panels[0].set_ylim(max(len(told), 1) - 0.4, -0.6)
    hidden = sum(not one.matters(found.base) and not one.refusal for one in found.effects)
    under = f"{hidden}{' other' if mattering else ''} values change none of the three by more than the shaded band"
    title = f"{found.scenario.name}: what the stop depends on\n{under}"
    figure.suptitle(title, x=0.01, ha="left", fontsize=13, color=INK, parse_math=False)
    marks = [Patch(color=_LOW, label="low end of the value"), Patch(color=_HIGH, label="high end")]
    figure.legend(handles=marks, loc="outside lower center", ncols=2)
    return figure


def _draw(axes: Any, found: Any, told: list[Any], name: str, factor: float) -> None:
    own = found.base.get(name)
    if own is not None:
        width = SMALL[name] * (own if name == DISTANCE else 1.0)
        axes.axvspan((own - width) * factor, (own + width) * factor, color="#f0f0f0", zorder=0)
        axes.axvline(own * factor, color=MUTED, linewidth=1.0, zorder=3)
    else:
        axes.set_title("the scenario itself locks no wheel", fontsize=10, color=MUTED)
        axes.set_xticks([])
    for place, effect in enumerate(told):
        for row, colour, offset in zip(effect.rows, (_LOW, _HIGH), (-0.2, 0.2), strict=True):
            value = (row or {}).get(name)
            if own is not None and value is not None:
                axes.barh(place + offset, (value - own) * factor, 0.36, left=own * factor, color=colour, zorder=2)
            words = _words(row, name, own)
            if words:
                axes.text(0.02, place + offset, words, transform=axes.get_yaxis_transform(), fontsize=9, va="center")
    axes.grid(visible=False, axis="y")


def _words(row: Any, name: str, own: float | None) -> str:
    """What no bar can show."""
    if row is None:
        return "not possible" if name == DISTANCE else ""
    if row["status"] != "stopped":
        return str(row["status"]) if name == DISTANCE else ""
    if name == LOCK and (row.get(LOCK) is None) != (own is None):
        return "locks none" if row.get(LOCK) is None else f"locks at {row[LOCK] * 3.6:.0f} km/h"
    return ""
