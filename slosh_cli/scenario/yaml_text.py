"""YAML texts to documents and back. The only module that imports yaml."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final

import yaml

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.scenario.base import OWN, Path
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.scalars import plain_scalar, well_formed
from slosh_cli.scenario.units import plain

_MOST_VALUES: Final = 20_000
"""Values of a file, with its aliases written out; stops a few lines from unfolding into gigabytes."""


_KNOWN_TAGS = {
    f"tag:yaml.org,2002:{name}"
    for name in ("null", "bool", "int", "float", "str", "timestamp", "map", "seq", "value", "merge")
}
_MERGE = "tag:yaml.org,2002:merge"
_TREE = f"must be a tree of at most {_MOST_VALUES} values"
_WRITE_OUT = "write the values out where they belong"


class _TooManyValuesError(yaml.MarkedYAMLError):
    """The text has more keys and values than a file may have."""


class _Loader(yaml.SafeLoader):
    """Tabs part tokens where YAML 1.2, and so JSON, allows them: everywhere but in the indentation of a block."""

    composed = 0

    def scan_to_next_token(self) -> None:
        """Skip what lies between two tokens: spaces, comments, line ends, and tabs."""
        while True:
            super().scan_to_next_token()
            length = 0
            while self.peek(length) in " \t":
                length += 1
            if length == 0:
                return
            indents = self.allow_simple_key and not self.flow_level
            harmless = "\0\r\n#\x85\u2028\u2029" + ("{[" if self.indent < 0 else "")
            if indents and self.peek(length) not in harmless:
                return
            self.forward(length)

    def scan_plain_spaces(self, indent: int, start_mark: yaml.Mark) -> list[str]:
        """Blanks inside or after an unquoted text."""
        length = 0
        while self.peek(length) in " \t":
            length += 1
        if self.peek(length) in "\r\n\x85\u2028\u2029":
            self.forward(length)
            return super().scan_plain_spaces(indent, start_mark) or []
        blanks = self.prefix(length)
        self.forward(length)
        return [blanks] if blanks else []

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Compose one node; gives up where a file has too many, before all of it has been read."""
        self.composed += 1
        if self.composed > _MOST_VALUES:
            raise _TooManyValuesError(problem="too many values", problem_mark=self.get_mark())
        return super().compose_node(parent, index)


class _Builder:
    """Builds a Document from YAML nodes. Scalars follow YAML 1.2, so `on` is a word and `1e5` a number."""

    def __init__(self, document: Document, override: str = "") -> None:
        self.document = document
        self.override = override
        self.open: set[int] = set()
        self.count = 0

    def problem(self, node: yaml.Node, path: Path, rule: str, given: str, fix: str) -> None:
        line = None if self.override else node.start_mark.line + 1
        key = ".".join(str(step) for step in path)
        self.document.problems.append(Problem(line, key, rule, given, fix, self.override))

    def build(self, node: yaml.Node, path: Path, written_at: yaml.Node) -> Any:
        """Plain data of `node`; its origin is the line of `written_at`, the key that names it."""
        self.count += 1
        line = None if self.override else written_at.start_mark.line + 1
        self.document.origins[path] = Origin(line, self.override)
        looped = id(node) in self.open
        if looped or self.count > _MOST_VALUES:
            if looped or self.count == _MOST_VALUES + 1:
                given = "an alias that contains itself" if looped else "more, by aliases or written out"
                self.problem(written_at, path, _TREE, given, _WRITE_OUT)
            return None
        if node.tag not in _KNOWN_TAGS:
            rule = "must be plain text, number, list or mapping"
            self.problem(node, path, rule, f"the tag `{node.tag}`", "leave out the tag")
            return None
        self.open.add(id(node))
        try:
            if isinstance(node, yaml.MappingNode):
                return self._mapping(node, path)
            if isinstance(node, yaml.SequenceNode):
                return [self.build(item, (*path, index), item) for index, item in enumerate(node.value)]
            quoted = isinstance(node, yaml.ScalarNode) and node.style is not None
            text = self._text(node, path)
            return text if quoted else plain_scalar(text)
        finally:
            self.open.discard(id(node))

    def _text(self, node: yaml.Node, path: Path) -> str:
        """The text of a scalar or key; a problem where no file can hold it."""
        text, lone = well_formed(str(node.value))
        if lone:
            rule = "must be text that can be written as UTF-8"
            given, fix = f"half of a surrogate pair, `{lone}`", "write the character itself"
            self.problem(node, path, rule, given, fix)
        return text

    def _mapping(self, node: yaml.MappingNode, path: Path) -> dict[str, Any]:
        result: dict[str, Any] = {}
        first: dict[str, int] = {}
        merged: list[yaml.Node] = []
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                given = "a key that is a list or mapping"
                self.problem(key, path, "must have words as keys", given, "write a word before the colon")
                continue
            name, line = self._text(key, path), key.start_mark.line + 1
            if not path and name.startswith(OWN):
                continue
            if name in first:
                given = f"`{name}` again" if self.override else f"`{name}` on lines {first[name]} and {line}"
                self.problem(key, (*path, name), "must be given once", given, "keep one of them")
            elif key.tag == _MERGE:
                merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
            else:
                result[name] = self.build(value, (*path, name), key)
            first.setdefault(name, line)
        for source in merged:
            self._merge(source, path, result)
        return result

    def _merge(self, source: yaml.Node, path: Path, result: dict[str, Any]) -> None:
        """YAML's `<<`: the keys of `source` that are not there yet, each from its own line."""
        if not isinstance(source, yaml.MappingNode) or id(source) in self.open:
            rule, fix = "must be an alias of another mapping", "write `<<: *name` for an anchor `&name` above"
            self.problem(source, (*path, "<<"), rule, "something else", fix)
            return
        inner = _Builder(Document(), self.override)
        inner.open, inner.count = self.open, self.count
        values = inner.build(source, path, source) or {}
        self.count = inner.count
        self.document.problems += inner.document.problems
        new = {name: value for name, value in values.items() if name not in result}
        result.update(new)
        depth = len(path)
        for place, origin in inner.document.origins.items():
            if len(place) > depth and place[depth] in new:
                self.document.origins[place] = origin


def parse(text: str, file: str) -> Document:
    """The document of a YAML text; ScenarioError where the text is no YAML.

    A text that is YAML but no mapping has that among its problems.
    """
    document = Document()
    node = _composed(text)
    if not isinstance(node, Problem) and node is not None:
        try:
            document.data = _Builder(document).build(node, (), node)
        except RecursionError as error:
            node = Problem(None, "", *_syntax(error, text)[1:])
    if isinstance(node, Problem):  # raised out here, without the context: a RecursionError's is too deep to be pickled
        raise ScenarioError(file, (node,))
    if not isinstance(document.data, dict) and not document.problems:
        given = "an empty file" if node is None else plain(document.data)
        fix = "write `format: 1`, `name: ...` and so on, or start from `slosh init`"
        rule = "must be a mapping of keys to values"
        document.problems.append(Problem(None if node is None else node.start_mark.line + 1, "", rule, given, fix))
    return document


def parse_override(text: str, path: Path, place: str) -> tuple[Any, list[Problem]]:
    """The value of an override's text, meant for `path`, and what is wrong with it.

    `place` is the override as problems name it. The value is None, with a problem, where the text is no YAML.
    """
    inner = Document()
    try:
        node = _node_of(text)
        value = _Builder(inner, place).build(node, path, node) if node is not None else None
    except (yaml.YAMLError, RecursionError) as error:
        key = ".".join(str(step) for step in path)
        return None, [Problem(None, key, *_syntax(error, text)[1:], place)]
    return value, inner.problems


def dump(data: Mapping[str, Any]) -> str:
    """Plain data as YAML."""
    return yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)


@lru_cache(maxsize=2)
def _composed(text: str) -> yaml.Node | Problem | None:
    """The node of a file's text, or why it is no YAML. A command asks several times: what kind of file it is, too."""
    try:
        return _Loader(text).get_single_node()
    except (yaml.YAMLError, RecursionError) as error:
        line, *words = _syntax(error, text)
        return Problem(line, "", *words)


@lru_cache(maxsize=256)
def _node_of(text: str) -> yaml.Node | None:
    """The node of a value's text; a study gives the same few texts again and again."""
    return _Loader(text).get_single_node()


def _syntax(error: Exception, text: str) -> tuple[int | None, str, str, str]:
    """(line, rule, given, fix) of text that is not YAML."""
    rule = "must be valid YAML"
    if isinstance(error, yaml.reader.ReaderError):
        return _unprintable(error, text)
    if not isinstance(error, yaml.MarkedYAMLError):
        return None, rule, "lists or mappings nested too deeply", _WRITE_OUT
    mark = error.problem_mark or error.context_mark
    begun = error.context_mark
    line = mark.line + 1 if mark else None
    if isinstance(error, _TooManyValuesError):
        return line, _TREE, "more up to this line", "leave out what does not belong here"
    given = " ".join(str(error.problem or error.context).split())
    if begun and mark and begun.line != mark.line:
        given += f" ({error.context}, begun on line {begun.line + 1})"
    fix = "close what was opened and check colons, quotes and indentation"
    if "'\\t'" in given:
        fix = "indent with spaces, not tabs"
    elif "single document" in str(error.context):
        fix = "write one scenario per file"
    elif "undefined alias" in given:
        fix = "define the anchor (`&name`) before it is used"
    return line, rule, given, fix


def _unprintable(error: yaml.reader.ReaderError, text: str) -> tuple[int, str, str, str]:
    """(line, rule, given, fix) of a character that no YAML may hold."""
    character = error.character if isinstance(error.character, str) else chr(error.character)
    line = text.count("\n", 0, error.position) + 1
    if "\ud800" <= character <= "\udfff":
        given, fix = f"the byte or half character {character!r}", "write it in UTF-8"
        return line, "must be text that can be written as UTF-8", given, fix
    return line, "must be valid YAML", f"the control character {character!r}", "take it out"
