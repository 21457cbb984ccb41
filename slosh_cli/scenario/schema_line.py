"""The line under a stop: its gradient, and the unevenness of its rails."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal

import numpy as np
from pydantic import Field

from slosh_cli.arrays import Matrix
from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.csv_table import Table, read_table
from slosh_cli.scenario.leaves import Count, Leaf, Number, Quantity, Range
from slosh_cli.scenario.points import NumberOrPoints, Points
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.units import plain, shown
from slosh_cli.scenario.words import Choice

SMOOTH_START: Final = 20.0
"""Unevenness sets in smoothly over this first part of a vehicle's way, m."""
LEVEL_BAND: Final = (3.0, 25.0)
"""Wavelengths (m) of the band D1 of EN 13848, in which railways state the longitudinal level."""
_SHORTEST, _LONGEST = 0.1, 200.0
_HEAD: Final = ("x_m", "z_m")
_CONTENT: Final = f"{','.join(_HEAD)} "
"""What begins the content of a file where that stands in place of its name."""
_MOST_POINTS: Final = 20_000
_HIGHEST: Final = 0.1
_STEEPEST: Final = 0.1
_GRADIENT: Final = Number(Range(-_STEEPEST, _STEEPEST), "0.010")
GRADIENT: Final = NumberOrPoints(
    _GRADIENT,
    Points(
        Quantity("length", Range(-1e6, 1e6), "300 m"),
        _GRADIENT,
        "[[0 m, 0], [300 m, 0.01]]",
        most=_MOST_POINTS,
        apart=1.0,
    ),
)
"""A gradient, or points [position, gradient]."""


@dataclass(frozen=True)
class _Waveband(Leaf):
    """The shortest and the longest of the wavelengths, m."""

    length: ClassVar[Quantity] = Quantity("length", Range(_SHORTEST, _LONGEST), "1.5 m")

    def sample(self) -> str:
        return "[1.5 m, 30 m]"

    def written(self, value: Any, *, as_text: bool) -> Any:
        return [self.length.written(entry, as_text=as_text) for entry in value]

    def parse(self, value: object) -> Any:
        return self._ordered(value, self.length.parse)

    def parse_python(self, value: object) -> Any:
        return self._ordered(value, self.length.parse_python)

    def _ordered(self, value: object, read: Any) -> tuple[float, float]:
        rule = "must be the shortest and the longest wavelength"
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ValueRefused(rule, plain(value), f"write them as in `{self.sample()}`")
        short, long = read(value[0]), read(value[1])
        if not short < long:
            given = f"`{shown(short)} m`, then `{shown(long)} m`"
            fix = f"write `[{shown(long)} m, {shown(short)} m]`" if short > long else "write two different ones"
            raise ValueRefused(f"{rule}, in this order", given, fix)
        return short, long

    def json_schema(self) -> dict[str, Any]:
        return {"type": "array", "items": self.length.json_schema(), "minItems": 2, "maxItems": 2}


@dataclass(frozen=True)
class _MeasuredRail(Leaf):
    """A CSV file with the columns x_m and z_m, taken in as its content: a scenario depends on no other file then."""

    def sample(self) -> str:
        return "measured.csv"

    def parse(self, value: object) -> str:
        if not isinstance(value, str) or not value.strip():
            rule = f"must be the name of a CSV file with the columns {' and '.join(_HEAD)}"
            raise ValueRefused(rule, plain(value), f"write a name such as `{self.sample()}`")
        if value.startswith(_CONTENT):
            return _checked_content(value)
        try:
            written = Path(value).stat().st_mtime_ns
        except (OSError, ValueError):  # the reader of tables says why
            written = 0
        return _content(Path(value), written)

    def json_schema(self) -> dict[str, Any]:
        return {"type": "string", "minLength": 1}


def file_beside(name: str, folder: Path) -> str:
    """A measured file that is named from `folder`; what is its content already stays."""
    return name if name.startswith(_CONTENT) else str(folder / name)


@lru_cache(maxsize=8)
def _content(path: Path, _written: int) -> str:
    table = read_table(path, _HEAD, _judge)
    pairs = zip(*(table.columns[name] for name in _HEAD), strict=True)
    return _CONTENT + " ".join(f"{x!r},{z!r}" for x, z in pairs)


@lru_cache(maxsize=8)
def _checked_content(text: str) -> str:
    try:
        points = measured_points(text)
    except ValueError:
        points = np.zeros((0, 2))
    table = Table("", list(range(1, len(points) + 1)), dict(zip(_HEAD, points.T.tolist(), strict=True)))
    _judge(table)
    if table.problems:
        first = table.problems[0]
        place = f" (point {first.line})" if first.line else ""
        raise ValueRefused(f"{first.rule}{place}", first.given, first.fix)
    return text


def _judge(table: Table) -> None:
    """Refuse what no rail looks like, and what no step could resolve."""
    if not 4 <= len(table.lines) <= _MOST_POINTS:
        fix = "measure it at more places" if len(table.lines) < 4 else "leave out rows, or what the stop does not need"
        table.refuse(None, "", f"must have from 4 to {_MOST_POINTS} rows", f"{len(table.lines)}", fix)
        return
    if table.columns["x_m"][0] > 0.0:
        given, fix = f"{shown(table.columns['x_m'][0])}", "begin where the middle of the first vehicle stands, at 0"
        table.refuse(table.lines[0], "x_m", "must begin at 0 or before", given, fix)
    before = -math.inf
    for line, x, z in zip(table.lines, *(table.columns[name] for name in _HEAD), strict=True):
        if x - before < 0.01:
            rule, given = "must rise by 0.01 m or more from row to row", f"{shown(x)} after {shown(before)}"
            table.refuse(line, "x_m", rule, given, "sort the rows by x_m, and leave out what is too close")
        if abs(z) > _HIGHEST:
            rule = f"must be from -{_HIGHEST} to {_HIGHEST}, in metres"
            fix = "write metres, not millimetres" if abs(z) < 1e3 * _HIGHEST else "leave the row out"
            table.refuse(line, "z_m", rule, f"{shown(z)}", fix)
        before = x if math.isfinite(x) else before


def measured_points(text: str) -> Matrix:
    """Places and heights, (n, 2) m, in the content of a measured file."""
    return np.array([pair.split(",") for pair in text.removeprefix(_CONTENT).split()], dtype=np.float64).reshape(-1, 2)


class Dip(Part):
    """A dip of the rail, z = -depth (1 - cos(2 pi (x - position)/length))/2; a hump where the depth is negative."""

    position: Annotated[float, Quantity("length", Range(0.0, 1e6), "50 m")] = Field(
        description="Where the dip begins, from the middle of the first vehicle at the start of the run, m."
    )
    length: Annotated[float, Quantity("length", Range(_SHORTEST, _LONGEST), "1 m")] = Field(
        description="Length of the dip, m."
    )
    depth: Annotated[float, Quantity("length", Range(-_HIGHEST, _HIGHEST), "2 mm", nonzero=True)] = Field(
        description="Depth of the dip in its middle, m."
    )


def _what_goes_together(v: Values) -> Iterator[Finding]:
    """Keys that say something only of a spectrum stand beside one."""
    for key, hosts in (("shape", ("sigma",)), *((key, ("sigma", "spectrum")) for key in _OF_SPECTRA)):
        found = [name for name in ("sigma", "spectrum", "file", "dips") if v.get(name) is not None]
        if v.wrote(key) and found and not set(found) & set(hosts):
            rule = f"must stand beside {' or '.join(f'`{host}`' for host in hosts)}"
            yield Finding((key,), rule, f"it beside `{found[0]}`", "leave it out")
    band = v.get("wavelengths")
    if v.get("sigma") is not None and band and not (band[0] <= LEVEL_BAND[0] and LEVEL_BAND[1] <= band[1]):
        rule = "must reach from 3 m or less to 25 m or more beside `sigma`, the standard deviation in D1 (3-25 m)"
        given = f"`{shown(band[0])} m` to `{shown(band[1])} m`"
        yield Finding(("wavelengths",), rule, given, "write a wider band, or an absolute `spectrum`")


_OF_SPECTRA: Final = ("seed", "wavelengths", "lines")


class Unevenness(Part):
    """How the unloaded rail deviates from a straight line: one of a standard deviation, a spectrum, a file, dips."""

    exactly_one: ClassVar[tuple[tuple[str, ...], ...]] = (("sigma", "spectrum", "file", "dips"),)
    rules = (_what_goes_together,)

    sigma: Annotated[float | None, Quantity("length", Range(0.0, 0.02, above=True), "1.2 mm")] = Field(
        default=None,
        description="Standard deviation of the longitudinal level in D1 (wavelengths from 3 m to 25 m, EN 13848), m.",
    )
    spectrum: Annotated[str | None, Choice((*(f"fra-{number}" for number in range(1, 7)), "erri-low", "erri-high"))] = (
        Field(
            default=None,
            description="A spectrum at its own level: FRA class 1 to 6 or ERRI B176, low or high disturbance.",
        )
    )
    file: Annotated[str | None, _MeasuredRail()] = Field(
        default=None,
        description="A CSV file with the columns x_m and z_m (place and height of the rail), beside the scenario.",
    )
    dips: Annotated[tuple[Dip, ...], Field(min_length=1)] | None = Field(default=None, description="Single dips.")
    shape: Annotated[Literal["erri", "fra"], Choice(("erri", "fra"))] = Field(
        default="erri", description="Shape of the spectrum that `sigma` scales."
    )
    seed: Annotated[int, Count(0, 2**32 - 1)] = Field(default=1, description="Seed of the lines' phases.")
    wavelengths: Annotated[tuple[float, float], _Waveband()] = Field(
        default=(1.5, 30.0), description="Shortest and longest wavelength of the spectrum, m."
    )
    lines: Annotated[int, Count(1, 10_000)] = Field(default=400, description="Number of the spectrum's lines.")

    def unwritten(self, *, as_text: bool) -> Collection[str]:  # noqa: ARG002 - the same for both
        """What says nothing beside the one key that is given."""
        spectral = self.sigma is not None or self.spectrum is not None
        return [*(() if spectral else _OF_SPECTRA), *(() if self.sigma is not None else ("shape",))]
