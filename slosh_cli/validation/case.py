"""What a case finds: rows of value, reference, deviation and tolerance."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from slosh_cli.validation.chart import Chart
from slosh_cli.validation.data_file import CaseData, Deviation

_Value = float | str | None


@dataclass(frozen=True)
class Row:
    """One comparison; the unit is part of the quantity's name. Without a tolerance it is for information only.

    `deviation` is never negative: relative, absolute or, for a limit, the value itself.
    """

    quantity: str
    value: _Value
    reference: _Value
    deviation: float | None
    tolerance: float | None
    source: str
    kind: str = ""

    @property
    def passed(self) -> bool:
        """Whether the deviation keeps within the tolerance; what cannot be compared does not."""
        if self.tolerance is None:
            return True
        return self.deviation is not None and self.deviation <= self.tolerance


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a case's computation returns."""

    rows: tuple[Row, ...]
    chart: Chart


@dataclass(frozen=True, eq=False, repr=False)
class CaseResult:
    """A case that was run; `chart` is None where it broke down."""

    data: CaseData
    rows: tuple[Row, ...]
    chart: Chart | None
    seconds: float

    def __repr__(self) -> str:
        return f"CaseResult({self.name}: {'passed' if self.passed else 'fell short'}, {len(self.rows)} rows)"

    @property
    def name(self) -> str:
        """Name of the case."""
        return self.data.name

    @property
    def passed(self) -> bool:
        """Whether every row keeps within its tolerance, and there is one that could fail."""
        return all(row.passed for row in self.rows) and any(row.tolerance is not None for row in self.rows)

    def as_dict(self) -> dict[str, Any]:
        """The result as the JSON object of `slosh validate` has it."""
        keys = ("quantity", "value", "reference", "deviation", "tolerance", "source")
        rows = [{key: getattr(row, key) for key in keys} for row in self.rows]
        return {"name": self.name, "passed": self.passed, "seconds": self.seconds, "rows": rows}


@dataclass
class Findings:
    """Collects the rows of a case under the tolerances of its data file."""

    data: CaseData
    rows: list[Row] = field(default_factory=list)

    def compare(self, quantity: str, value: float | None, reference: float, tolerance: str, source: str = "") -> None:
        """A number beside its reference; `tolerance` names an entry of the data file."""
        allowed = self.data.tolerances[tolerance]
        deviation: float | None = None
        if value is not None and math.isfinite(value):
            deviation = abs(value - reference)
            if allowed.kind is Deviation.RELATIVE:
                deviation /= abs(reference)
        elif value is not None:
            value = None
        self._add(quantity, value, reference, deviation, allowed.value, source, str(allowed.kind))

    def limit(self, quantity: str, value: float, tolerance: str, source: str = "") -> None:
        """A number that must not exceed the tolerance."""
        allowed = self.data.tolerances[tolerance]
        deviation = abs(value) if math.isfinite(value) else None
        self._add(quantity, value if math.isfinite(value) else None, 0.0, deviation, allowed.value, source, "limit")

    def verdict(self, quantity: str, found: str, stated: str, source: str = "") -> None:
        """A verdict in words beside the one that the data file states."""
        self._add(quantity, found, stated, float(found != stated), 0.0, source, "verdict")

    def note(self, quantity: str, value: _Value, reference: _Value = None, source: str = "") -> None:
        """Something worth knowing that decides nothing."""
        deviation = None
        if isinstance(value, float) and isinstance(reference, float) and reference:
            deviation = abs(value / reference - 1.0)
        self._add(quantity, value, reference, deviation, None, source, "")

    def _add(
        self,
        quantity: str,
        value: _Value,
        reference: _Value,
        deviation: float | None,
        tolerance: float | None,
        source: str,
        kind: str,
    ) -> None:
        self.rows.append(Row(quantity, value, reference, deviation, tolerance, source or self.data.source, kind))

    def outcome(self, chart: Chart) -> Outcome:
        """Rows and chart together."""
        return Outcome(tuple(self.rows), chart)


Compute = Callable[[CaseData], Outcome]


def run_case(data: CaseData, compute: Compute) -> CaseResult:
    """Run a case. One that breaks down is a case that fell short, and its row says why."""
    began = time.perf_counter()
    try:
        outcome = compute(data)
    except Exception as error:  # whatever it is, it belongs into the report and must not hide the other cases
        row = Row(
            "the case runs to its end", f"{type(error).__name__}: {error}", "yes", 1.0, 0.0, data.source, "verdict"
        )
        return CaseResult(data, (row,), None, time.perf_counter() - began)
    return CaseResult(data, outcome.rows, outcome.chart, time.perf_counter() - began)
