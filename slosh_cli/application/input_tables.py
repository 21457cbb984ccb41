"""Tables of inputs for reports: every value with its unit, its standing and its source."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from slosh_cli.application.differing import listed
from slosh_cli.report.html import page_table
from slosh_cli.scenario.standing import standings

_NOTE: Final = (
    "As resolved, with units. Yours: the file says it, and the program does not know how sure it is. Default: the "
    "program's own value. Measured, published, assumed: of a preset. Computed: by the program from the other values."
)
_HEAD: Final = ("key", "value", "standing", "source")
_OF_TRAIN: Final = ("braking.initial_speed", "braking.onset", "braking.stop_speed")
"""Keys of a vehicle that the train's own file says."""


def inputs_table(text: str, title: str = "Inputs") -> dict[str, Any]:
    """The inputs of a scenario, from its resolved text."""
    rows = [(key, str(one.value), one.standing, one.source) for key, one in standings(text).items()]
    return page_table(title, _HEAD, rows, _NOTE)


def vehicle_inputs_table(texts: Sequence[str]) -> dict[str, Any]:
    """The inputs of a train's vehicles, from their resolved texts: a row for all vehicles that are alike in a value."""
    alike: dict[str, list[int]] = {}
    for place, text in enumerate(texts, 1):
        alike.setdefault(_without_onset(text), []).append(place)
    rows: dict[str, dict[tuple[str, str, str], list[int]]] = {}
    for text, places in alike.items():
        for key, one in standings(text).items():
            if key not in _OF_TRAIN:
                told = (str(one.value), one.standing, one.source)
                rows.setdefault(key, {}).setdefault(told, []).extend(places)
    cells = [
        (key, *told, "all" if len(places) == len(texts) else listed(sorted(places)))
        for key, values in rows.items()
        for told, places in values.items()
    ]
    return page_table("Inputs of the vehicles", (*_HEAD, "vehicles"), cells, "Vehicles are counted from the front.")


def _without_onset(text: str) -> str:
    """A vehicle's text without when the brake wave reaches it, by which alone most vehicles differ."""
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith("  onset: "))
