"""All cases, by name. A new case is a module in `cases`, a data file of its name, and a line here."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from importlib.util import find_spec
from typing import Final, cast

from slosh_cli.errors import UsageError
from slosh_cli.validation.case import CaseResult, Compute, run_case
from slosh_cli.validation.data_file import CaseData, read_case
from slosh_cli.version import install_command

NAMES: Final = (
    "kolaei",
    "rectangular-tank",
    "v-trough",
    "circular-cylinder",
    "moving-load",
    "moving-load-damped",
    "critical-speed",
    "mem-vs-fem",
    "interfoam",
    "cfd",
    "measured",
    "hertz",
    "polach",
    "point-mass",
    "gradient",
    "uneven-rail",
    "wheel-flat",
    "brakes",
    "stopping-table",
    "couplings",
    "momentum",
    "energy",
    "second-code",
    "figure2",
    "figure3",
)
"""From the parts to the whole, then what the paper says of the whole."""


def chosen(names: Sequence[str]) -> list[CaseData]:
    """Data of the named cases in their own order, each once; of all that can run here without names.

    Raises UsageError for an unknown name, and for one that needs an extra that is not installed.
    """
    for name in names:
        if name not in NAMES:
            near = get_close_matches(name, NAMES, 1)
            hint = f"write `{near[0]}`" if near else f"write one of {', '.join(NAMES)}"
            raise UsageError(f"must be the name of a validation case; given `{name}`; {hint}", where=name)
    cases = [read_case(name) for name in NAMES if name in names or not names]
    if not names:
        return [data for data in cases if is_available(data)]
    for data in cases:
        if not is_available(data):
            remedy = f"install it with `{install_command('validation')}`"
            raise UsageError(f"the case {data.name} needs {data.needs}, which is not installed; {remedy}", data.name)
    return cases


def left_out() -> list[CaseData]:
    """Cases that need an extra that is not installed."""
    return [data for data in map(read_case, NAMES) if not is_available(data)]


def is_available(data: CaseData) -> bool:
    """Whether what the case needs is installed."""
    return not data.needs or find_spec(data.needs) is not None


def compute_of(name: str) -> Compute:
    """The function that computes a case."""
    module = import_module(f"slosh_cli.validation.cases.{name.replace('-', '_')}")
    return cast(Compute, module.compute)


def case_result(data: CaseData) -> CaseResult:
    """Run one case."""
    return run_case(data, compute_of(data.name))
