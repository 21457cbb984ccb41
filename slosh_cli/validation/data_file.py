"""The data file of a case: what it asks, where the reference comes from, how near is near enough and why."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from importlib.resources import files
from typing import Any


class Deviation(StrEnum):
    """What the deviation of a row is."""

    RELATIVE = "relative"
    ABSOLUTE = "absolute"
    LIMIT = "limit"


@dataclass(frozen=True)
class Tolerance:
    """How near is near enough, and the reason; `kind` says what the deviation is."""

    value: float
    kind: Deviation
    reason: str


@dataclass(frozen=True)
class Sabotage:
    """A deliberate error in the code under test that turns the case red; `test` names the test that shows it."""

    error: str
    test: str


@dataclass(frozen=True)
class CaseData:
    """A case's data file.

    `needs` is the module of an optional extra without which the case cannot run; `quick` cases take seconds.
    `reference` holds numbers as the source prints them.
    """

    name: str
    title: str
    question: str
    method: str
    source: str
    tolerances: Mapping[str, Tolerance]
    errata: tuple[str, ...]
    catches: tuple[Sabotage, ...]
    needs: str
    quick: bool
    reference: Mapping[str, Any]


def read_case(name: str) -> CaseData:
    """Read ``data/<name>.toml``. Raises KeyError or TypeError where it is incomplete."""
    text = files("slosh_cli.validation").joinpath("data", f"{name}.toml").read_text(encoding="utf-8")
    content = tomllib.loads(text)
    tolerances = {
        key: Tolerance(float(entry["value"]), Deviation(entry["kind"]), " ".join(entry["reason"].split()))
        for key, entry in content["tolerance"].items()
    }
    return CaseData(
        name=name,
        title=content["title"],
        question=" ".join(content["question"].split()),
        method=" ".join(content["method"].split()),
        source=" ".join(content["source"].split()),
        tolerances=tolerances,
        errata=tuple(" ".join(text.split()) for text in content.get("errata", ())),
        catches=tuple(Sabotage(**entry) for entry in content.get("catches", ())),
        needs=content.get("needs", ""),
        quick=content["quick"],
        reference=content.get("reference", {}),
    )


def data_rows(name: str) -> list[dict[str, str]]:
    """Rows of ``data/<name>`` (CSV with a heading; lines that start with # are remarks)."""
    import csv

    lines = files("slosh_cli.validation").joinpath("data", name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))
