"""What a search asks of a stop: an answer, the value it is to have, the limits it has to keep."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.results.answers import Answer, Answers
from slosh_cli.results.result import Result, Status
from slosh_cli.results.train_result import TrainResult, VehicleResult
from slosh_cli.scenario.units import DIMENSIONS, numeral_of, parse_quantity, percentage

LOCK: Final = "first_lock"
"""The question at which value a wheel begins to lock."""
_LOCKED: Final = "locked_time"
_NOT_ASKED: Final = ("solve_seconds", "steps", "rejected_steps")
_FORM: Final = re.compile(r"\s*([^<>=]*?)\s*(<=|>=|=|<|>|$)(.*)", re.DOTALL)


@dataclass(frozen=True)
class Asked:
    """An answer that a search asks for: of a stop, or the worst of its wheels or vehicles.

    `words` are as a person wrote it; `sign` is ``=``, ``<=``, ``>=`` or empty, `target` the SI value after it.
    """

    words: str
    name: str
    answer: Answer
    sign: str = ""
    target: float = 0.0

    @property
    def unit(self) -> str:
        """The SI unit, ``1`` without one."""
        return self.answer.unit

    @property
    def label(self) -> str:
        """The answer with its unit, for people."""
        what = "longest lock" if self.name == LOCK else self.name.replace("_", " ")
        return f"{what} / {self.unit}" if self.unit != "1" else what

    def value(self, result: Result | TrainResult) -> float | None:
        """Its SI value; None where the stop has none: it did not come to its end, or there is none of the kind.

        A wheel that locked has locked, however the stop ended.
        """
        found = _value_in(result, self.answer)
        if result.status is not Status.STOPPED and not (self.name == LOCK and found):
            return None
        return found

    def keeps(self, value: float | None) -> bool:
        """Whether a value is within this limit; what has no value is not."""
        if value is None:
            return False
        return value <= self.target if self.sign == "<=" else value >= self.target


def asked_value(text: str, train: bool, option: str) -> Asked:
    """What ``first_lock`` or ``max_wheel_unloading=0.6`` asks for. Raises UsageError for what cannot be asked."""
    name, sign, value = _parts(text)
    if name == LOCK:
        if sign:
            raise _refused(option, "must be `first_lock` alone", text, f"write `{LOCK}`")
        return Asked(text, LOCK, _table(train)[_LOCKED])
    answer = _known(name, train, option, LOCK)
    if sign != "=":
        fix = f"write `{_short(answer)}={_example(answer)}`"
        raise _refused(option, "must be an answer, an equals sign and the value it is to have", text, fix)
    return Asked(text.strip(), _short(answer), answer, "=", _target(answer, value, name, option))


def asked_limit(text: str, train: bool, option: str) -> Asked:
    """What ``max_wheel_unloading<=0.6`` asks to keep. Raises UsageError for what cannot be asked."""
    name, sign, value = _parts(text)
    answer = _known(name, train, option)
    if sign not in ("<=", ">="):
        fix = f"write `{_short(answer)}<={_example(answer)}` or `{_short(answer)}>={_example(answer)}`"
        raise _refused(option, "must be an answer, `<=` or `>=`, and the value it is to keep to", text, fix)
    return Asked(text.strip(), _short(answer), answer, sign, _target(answer, value, name, option))


def asked_answer(text: str, train: bool, option: str) -> Asked:
    """The answer of a name. Raises UsageError for an unknown one."""
    answer = _known(text.strip(), train, option)
    return Asked(_short(answer), _short(answer), answer)


def _parts(text: str) -> tuple[str, str, str]:
    match = _FORM.fullmatch(text)
    assert match is not None  # it takes any text
    return match[1], match[2], match[3].strip()


def _table(train: bool) -> dict[str, Answer]:
    """Every number that can be asked for, by its name without a unit; of a train, what it has none of itself is that of
    its vehicles."""
    classes: Sequence[type[Answers]] = (TrainResult, VehicleResult) if train else (Result,)
    found: dict[str, Answer] = {}
    for one in (one for kind in classes for one in kind.table()):
        if one.unit and not one.given and one.name not in _NOT_ASKED:
            found.setdefault(_short(one), one)
    return found


def _short(answer: Answer) -> str:
    """``braking_distance`` for ``braking_distance_m``."""
    return answer.name.removesuffix("_" + re.sub(r"[ /]", "_", answer.unit))


def _known(name: str, train: bool, option: str, *others: str) -> Answer:
    table = _table(train)
    found = table.get(name) or next((one for one in table.values() if one.name == name), None)
    if found is not None:
        return found
    names = [*others, *table]
    near = difflib.get_close_matches(name.lower().replace("-", "_").replace(" ", "_"), names, 1, 0.5)
    fix = f"write `{near[0]}`; the" if near else "the"
    raise _refused(option, "must be an answer of a stop", name, f"{fix} answers are {', '.join(names)}")


def _example(answer: Answer) -> str:
    return "0.6" if answer.unit == "1" else f"700 {answer.unit}"


def _target(answer: Answer, text: str, name: str, option: str) -> float:
    """The SI value of `text`, which needs no unit where the answer's name has it (``braking_distance_m``)."""
    try:
        if answer.unit == "1":
            return _pure(text)
        numeral = numeral_of(text)
        if name == answer.name and name != _short(answer) and numeral and not numeral.rest:
            text = f"{text} {answer.unit}"
        dimension = next(one.name for one in DIMENSIONS.values() if one.unit == answer.unit)
        return parse_quantity(text, dimension, example=_example(answer))
    except ValueRefused as refused:
        raise UsageError(f"{option} {_short(answer)} {refused}", option) from None


def _pure(text: str) -> float:
    share, numeral = percentage(text), numeral_of(text)
    if share is None and numeral and not numeral.rest and len(numeral.readings) == 1:
        share = float(numeral.readings[0])
    if share is None or not math.isfinite(share):
        raise ValueRefused("must be a number without a unit", f"`{text}`", "write such as `0.6` or `60 %`")
    return share


def _refused(option: str, rule: str, given: str, fix: str) -> UsageError:
    return UsageError(f"{option} {rule}; given `{given}`; {fix}", option)


def _value_in(result: Any, answer: Answer) -> float | None:
    """The number itself, or the worst of wheels and vehicles: the least of what is a least, else the largest."""
    holders = [result] if hasattr(result, answer.name) else result.vehicles
    found: list[float] = []
    for value in (getattr(one, answer.name) for one in holders):
        found += value if isinstance(value, tuple) else [] if value is None else [value]
    if not found or not all(map(math.isfinite, found)):
        return None
    return float(min(found) if answer.name.startswith("min_") else max(found))
