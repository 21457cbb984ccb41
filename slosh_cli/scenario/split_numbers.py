"""Decimal commas in braces: YAML ends a value at a comma there, so `{mass: 21,3 t}` has a key `3 t`."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Path
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.units import numeral_of, plain


def rejoined(
    findings: Iterable[Finding], mapping_at: Callable[[Path], Any], leaf_at: Callable[[Path], Leaf | None]
) -> list[Finding]:
    """The findings with one about the whole number in place of those about its halves."""
    known = list(findings)
    split: dict[Path, str] = {}
    halves: set[Path] = set()
    for above in {finding.path[:-1] for finding in known}:
        mapping = mapping_at(above)
        for key, rest, number in _split(mapping) if isinstance(mapping, Mapping) else ():
            split[*above, key] = number
            halves |= {(*above, key), (*above, rest)}
    whole = [_finding(path, number, leaf_at(path)) for path, number in split.items()]
    return [finding for finding in known if finding.path not in halves] + whole


def _split(mapping: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """(key, the key that the rest of its number has become, the number) of every number that was split."""
    keys = list(mapping)
    for key, rest in itertools.pairwise(keys):
        value = mapping[key]
        whole = isinstance(value, int) and not isinstance(value, bool)
        if whole and mapping[rest] is None and rest[:1].isdigit():
            yield key, rest, f"{value},{rest}"


def _finding(path: Path, number: str, leaf: Leaf | None) -> Finding:
    fix = "write the number with a decimal point"
    if leaf is not None:
        try:
            leaf.parse(number)
        except ValueRefused as refused:
            fix = refused.fix
        else:
            numeral = numeral_of(number)
            assert numeral is not None  # it has been read
            fix = f"write `{numeral.readings[0]} {numeral.rest}`"
    return Finding(path, "must be one value, but a comma in braces ends it", plain(number), fix)
