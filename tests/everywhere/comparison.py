"""Answers of several environments side by side: equal to 1e-9, or no further apart than by another rounding."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import say
from .answers import difference, distances_differ

SAME = 1e-9
"""Relative difference of two answers that are the same."""
SPREAD = 30.0
"""How much more than one changed rounding of one input another build may move an answer: it changes many."""
LARGEST_DISTANCE = 1e-4
"""Relative difference of two distances that no rounding excuses: the default tolerance."""


def verdict(one: dict[str, Any], other: dict[str, Any]) -> tuple[str, float, float]:
    """What is to be said of two answers of a stop, their difference, and that of their distances."""
    apart, distance = difference(one, other), distances_differ(one, other)
    if apart <= SAME:
        return "same", apart, distance
    rounding = max(one["rounding"], other["rounding"])
    if apart <= SPREAD * rounding and distance <= LARGEST_DISTANCE:
        return f"magnifies rounding: its own last digit moves it by {rounding:.1e}", apart, distance
    return "DIFFERS", apart, distance


def compared(files: Sequence[Path]) -> int:
    """Print how far the answers in all other files are from those in the first; 1 where one differs unexplained."""
    first, *others = (json.loads(file.read_text(encoding="utf-8")) for file in files)
    say(f"reference: {first['environment']}")
    wrong = False
    for other in others:
        say(f"\nagainst: {other['environment']}")
        for name, one in first["stops"].items():
            told, apart, distance = verdict(one, other["stops"][name])
            wrong |= told == "DIFFERS"
            say(f"  {name:32} distance {distance:8.1e}  all {apart:8.1e}  {told}")
    return int(wrong)
