"""A scenario file as plain data that remembers where every value was written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from slosh_cli.errors import Problem
from slosh_cli.scenario.base import Path
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.tree import value_at
from slosh_cli.scenario.units import plain


@dataclass(frozen=True)
class Origin:
    """Where a value comes from: a line of the file, or an override as the user wrote it; of a preset, of its `use`."""

    line: int | None = None
    override: str = ""
    preset: str = ""


@dataclass
class Document:
    """Mappings, lists and scalars with their `origins` by path, the `problems` and `overrides` so far.

    `original` is a copy of the data before any override. Parts at `unfilled` paths name a preset that there is not.
    `written` is a copy of the data without usual values, where there are such.
    """

    data: Any = None
    original: Any = None
    written: Any = None
    origins: dict[Path, Origin] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    overrides: list[str] = field(default_factory=list)
    unfilled: list[Path] = field(default_factory=list)

    def origin(self, path: Path) -> Origin:
        """Origin of the value at `path`, or of the nearest mapping around it."""
        for end in range(len(path), -1, -1):
            if path[:end] in self.origins:
                return self.origins[path[:end]]
        return Origin()

    def overridden(self, path: Path) -> bool:
        """Whether an override gave the value at `path`, the mapping around it or anything below it."""
        below = (origin for place, origin in self.origins.items() if place[: len(path)] == path)
        return bool(self.origin(path).override) or any(origin.override for origin in below)

    def add(self, finding: Finding) -> None:
        """Keep a finding as a problem with its place; what an unknown preset may have brought is not missed."""
        origin, given = self.origin(finding.path), finding.given
        if given == "nothing":
            if any(finding.path[: len(path)] == path for path in self.unfilled):
                return
        elif origin.preset:
            given += f" from the preset `{origin.preset}`"
        key = ".".join(str(step) for step in finding.path)
        self.problems.append(Problem(origin.line, key, finding.rule, given, finding.fix, origin.override))

    def sorted_problems(self) -> tuple[Problem, ...]:
        """All problems, those of the file by line, then those of overrides as they were given."""
        rank = {place: index for index, place in enumerate(self.overrides)}

        def place(problem: Problem) -> tuple[bool, int]:
            return bool(problem.override), rank.get(problem.override, 0) if problem.override else problem.line or 0

        return tuple(sorted(self.problems, key=place))

    def replace(self, path: Path, value: Any, override: str) -> None:
        """Put `value` at `path`, making mappings on the way; a problem instead where that cannot be."""
        obstacle = self._obstacle(path)
        if obstacle is not None:
            key = ".".join(str(step) for step in path)
            self.problems.append(Problem(None, key, *obstacle, override=override))
            return
        parent = self.data
        for depth, step in enumerate(path[:-1], start=1):
            if isinstance(parent, list):
                parent = parent[int(step)]
                continue
            if step not in parent:
                self.origins[path[:depth]] = Origin(override=override)
            parent = parent.setdefault(step, {})
        last = int(path[-1]) if isinstance(parent, list) else path[-1]
        parent[last] = value
        place = self.normal(path)
        if place in self.origins:  # and with it the places below
            for known in [known for known in self.origins if known[: len(place)] == place]:
                del self.origins[known]
        self.origins[place] = Origin(override=override)

    def remove(self, path: Path) -> None:
        """Take the key at `path` out of its mapping, if it is there."""
        mapping = self._at(path[:-1])
        if path[-1] in mapping:
            del mapping[path[-1]]
            self.origins.pop(path, None)

    def normal(self, path: Path) -> Path:
        """`path` with the indices into lists as integers, as far as it leads."""
        found: list[str | int] = []
        for step in path:
            listed = isinstance(value_at(self.data, tuple(found)), list) and str(step).isdecimal()
            found.append(int(step) if listed else step)
        return tuple(found)

    def _at(self, path: Path) -> Any:
        value = self.data
        for step in path:
            value = value[int(step)] if isinstance(value, list) else value[step]
        return value

    def _obstacle(self, path: Path) -> tuple[str, str, str] | None:
        """(rule, given, fix) where `path` leads nowhere."""
        value = self.data
        for depth, step in enumerate(path):
            above = ".".join(str(entry) for entry in path[:depth])
            if isinstance(value, list):
                if not (str(step).isascii() and str(step).isdecimal() and int(step) < len(value)):
                    rule = f"must name an item of the list `{above}` by its number from 0 to {len(value) - 1}"
                    return rule, f"`{step}`", f"write `{above}.0`, or replace the list as a whole"
                value = value[int(step)]
            elif isinstance(value, dict):
                if step not in value:
                    return None
                value = value[step]
            else:
                rule = f"must lead through mappings, but `{above}` is a single value"
                return (
                    rule,
                    plain(value),
                    f"give `{above}` as a whole: `{above}=...`",
                )
        return None
