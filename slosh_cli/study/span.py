"""The range of one key that a search goes through: as it was asked for, or around the file's own value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from slosh_cli.errors import ScenarioError, UsageError
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study.axis import measured
from slosh_cli.study.build import own_measure, study_along
from slosh_cli.study.plan import Study

_FEWEST: Final = 5
_MOST: Final = 1000
_SHOWN_IN: Final = {"m/s": ("km/h", 3.6), "N m": ("kN m", 1e-3), "N": ("kN", 1e-3)}
_BRAKES: Final = (
    "braking.torque", "braking.blocks.force", "braking.discs.force", "braking.deceleration",
    "braking.braked_weight.percentage",
)  # fmt: skip
_CLOSER: Final = (1.0, 0.9, 0.75, 0.5, 0.25)
"""Parts of the way to an end of a range that nobody gave, where no sound scenario has the end itself."""


@dataclass(frozen=True)
class Span:
    """From `low` to `high` in `unit` (empty for pure numbers), stops at values of `key`; `words` say what the range is.

    `base` is a study of no stops: `study` has those at the given values.
    """

    key: str
    low: float
    high: float
    unit: str
    words: str
    base: Study

    def text(self, place: float, digits: int = 12) -> str:
        """A value of the key as one writes it."""
        return f"{place:.{digits}g} {self.unit}".rstrip()

    def study(self, places: Sequence[float]) -> Study:
        """The study of stops at these values. Raises ScenarioError where one makes no sound scenario."""
        (axis,) = self.base.axes
        found = replace(self.base, axes=(replace(axis, values=tuple(map(self.text, places))),))
        found.check()
        return found


def spanned(source: Scenario | TrainScenario | str | Path, vary: str, overrides: Sequence[str] = ()) -> Span:
    """The range that ``KEY=LOW:HIGH UNIT`` or ``KEY`` asks for, of a scenario, a train or the file of one.

    Raises UsageError and ScenarioError for what cannot be used, in both ends too.
    """
    key, equals, text = (part.strip() for part in vary.partition("="))
    if not key or not all(key.split(".")):
        rule = "must be a key path, alone or with an equals sign and a range"
        raise _refused("--vary", rule, vary, "write it like `--vary 'braking.torque=2:30 kN m'`")
    empty = study_along(source, key, overrides)
    if equals:
        low, high, unit = _ends(key, text)
        span = Span(key, low, high, unit, f"{low:g} to {high:g} {unit}".rstrip(), empty)
        span.study([low, high])
        return span
    return _around(key, empty)


def checked_count(points: int) -> int:
    """The number of stops of a scan. Raises UsageError where a curve needs more, or nobody waits for them."""
    if not _FEWEST <= points <= _MOST:
        fix = "write `--points 17`"
        raise _refused("--points", f"must be from {_FEWEST} to {_MOST}", str(points), fix)
    return points


def _ends(key: str, text: str) -> tuple[float, float, str]:
    option, parts = f"--vary {key}", [part.strip() for part in text.split(":")]
    found = [measured(part) for part in parts]
    numbers = [one for one in found if one is not None and abs(one[0]) < 1e300]
    if len(parts) != 2 or len(numbers) != 2:
        fix = f"write it like `{key}=2:30 kN m`, with numbers and the unit of that key"
        raise _refused(option, "must be a range LOW:HIGH, the two ends of the search", text, fix)
    (low, first), (high, unit) = numbers
    if first and first != unit:
        raise _refused(option, "must have one unit in a range", text, f"write `{low:.12g}:{high:.12g} {unit or first}`")
    if low >= high:
        turned = f"{high:.12g}:{low:.12g} {unit}".rstrip()
        fix = f"write `{turned}`" if low > high else "write two different ends"
        raise _refused(option, "must go from the lower end to the higher one", text, fix)
    return low, high, unit


def _around(key: str, empty: Study) -> Span:
    """Half to double the file's own value, as far as scenarios are sound there."""
    own = own_measure(empty.base, key)
    option = f"--vary {key}"
    if own is None or own[0] == 0.0:
        said = "0" if own else "nothing that is a number"
        fix = f"{_brake_of(key, empty)}write `--vary {key}=LOW:HIGH` with the unit of that key"
        raise _refused(option, f"must have a range where {empty.file} itself has {said} there", key, fix)
    braking = "braking" in key.split(".")
    unit, factor = _SHOWN_IN.get(own[1], (own[1], 1.0)) if braking else (own[1], 1.0)
    value = float(f"{own[0] * factor:.12g}")
    whole = Span(key, value, value, unit, "", empty)
    ends = [_sound_end(whole, value, end) for end in (0.5 * value, 2.0 * value)]
    low, high = sorted(ends)
    words = f"{f'{low:g} to {high:g} {unit}'.rstrip()}, around the file's own {whole.text(value, 6)}"
    return Span(key, low, high, unit, words, empty)


def _brake_of(key: str, empty: Study) -> str:
    """What the brake of a wagon is told by, where another key of it was asked for; else nothing."""
    if not key.startswith("braking."):
        return ""
    known = [one for one in _BRAKES if own_measure(empty.base, one) is not None]
    return f"its brake is told by `{known[0]}`, so write `--vary {known[0]}`, or for another brake " if known else ""


def _sound_end(whole: Span, own: float, end: float) -> float:
    """The end, or what is as near to it as sound scenarios go. Raises ScenarioError where none is."""
    for part in _CLOSER:
        place = float(f"{own + part * (end - own):.12g}")
        try:
            whole.study([place])
        except ScenarioError:
            if part == _CLOSER[-1]:
                raise
        else:
            return place
    return own


def _refused(option: str, rule: str, given: str, fix: str) -> UsageError:
    return UsageError(f"{option} {rule}; given `{given}`; {fix}", option)
