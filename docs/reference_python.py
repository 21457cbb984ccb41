"""The page of the Python interface, from the sources of what the package offers and of what that returns."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

import slosh_cli
from slosh_cli.results.answers import Answers
from slosh_cli.scenario.base import Part

PYTHON = """# The Python interface

Made by `make pages` from the code itself.

The functions are imported from `slosh_cli`. [From Python](python.md) shows each in use. An `Amount` is a text with a
unit or a number in SI units.
"""
HOOKS = ("after_overrides", "unwritten")
"""Public methods of scenarios that the program's own reader alone calls."""


def python_page() -> str:
    """``api.md``."""
    offered = {name: getattr(slosh_cli, name) for name in slosh_cli.__all__ if not name.startswith("_")}
    functions = {name: one for name, one in offered.items() if inspect.isfunction(one)}
    returned = {one.__name__: one for function in functions.values() for one in returns(function)}
    classes = {name: one for name, one in (offered | returned).items() if inspect.isclass(one)}
    texts = [PYTHON, "\n## Functions\n", *(function_text(functions[name]) for name in sorted(functions))]
    texts += ["\n## What they take and return\n", *(class_text(name, classes[name]) for name in sorted(classes))]
    return "".join(texts)


@cache
def parsed(module: ModuleType) -> ast.Module:
    """The source of a module."""
    return ast.parse(inspect.getsource(module))


def node_of(one: Any) -> Any:
    """The definition of a function or a class in its module's source."""
    found = parsed(import_module(one.__module__))
    return next(node for node in ast.walk(found) if getattr(node, "name", "") == one.__name__)


def returns(function: Any) -> Iterator[type]:
    """The package's classes in what a function returns."""
    imports = {
        alias.name: node.module
        for node in ast.walk(parsed(import_module(function.__module__)))
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("slosh_cli")
        for alias in node.names
    }
    for name in (node.id for node in ast.walk(node_of(function).returns) if isinstance(node, ast.Name)):
        home = imports.get(name, function.__module__)
        one = getattr(import_module(home), name, None)
        if inspect.isclass(one) and one.__module__.startswith("slosh_cli"):
            yield one


class Resolved(ast.NodeTransformer):
    """Puts what a module's private names stand for in their place."""

    def __init__(self, module: ModuleType) -> None:
        assigned = [node for node in parsed(module).body if isinstance(node, ast.Assign | ast.AnnAssign)]
        targets = [
            (node, target) for node in assigned for target in getattr(node, "targets", [getattr(node, "target", 0)])
        ]
        self.values = {target.id: node.value for node, target in targets if isinstance(target, ast.Name)}

    def visit_Name(self, node: ast.Name) -> ast.AST:
        found = self.values.get(node.id) if node.id.startswith("_") else None
        return node if found is None else found


def signature(node: Any, *, method: bool = False) -> str:
    """What a function takes and returns, as its source has it."""
    taken = [ast.unparse(one) for one in node.args.posonlyargs + node.args.args]
    values = [f" = {ast.unparse(one)}" for one in node.args.defaults]
    taken = [one + value for one, value in zip(taken, [""] * (len(taken) - len(values)) + values, strict=True)]
    if node.args.vararg:
        taken.append(f"*{ast.unparse(node.args.vararg)}")
    elif node.args.kwonlyargs:
        taken.append("*")
    for one, value in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
        taken.append(ast.unparse(one) + ("" if value is None else f" = {ast.unparse(value)}"))
    given = taken[1:] if method else taken
    lines = f"({', '.join(given)})"
    if len(lines) + len(node.name) > 90:
        lines = "(\n    " + ",\n    ".join(given) + ",\n)"
    return f"{node.name}{lines} -> {ast.unparse(node.returns)}"


def text_of(one: Any) -> str:
    """A docstring as paragraphs."""
    parts = inspect.cleandoc(one.__doc__ or "").split("\n\n")
    return "\n\n".join(" ".join(part.split()) for part in parts)


def function_text(function: Any) -> str:
    """A function: signature and docstring."""
    resolved = Resolved(import_module(function.__module__)).visit(deepcopy(node_of(function)))
    return f"\n### {function.__name__}\n\n```python\n{signature(resolved)}\n```\n\n{text_of(function)}\n"


def class_text(name: str, one: type) -> str:
    """A class: docstring, fields, properties, methods."""
    homes = [base for base in reversed(one.__mro__) if base.__module__.startswith("slosh_cli") and base is not Part]
    rows = {row.key: row for base in homes for row in members(base)}
    said = {answer.name: answer.meaning for answer in one.table()} if issubclass(one, Answers) else {}
    if issubclass(one, Part):
        said = {key: entry.description or "" for key, entry in one.model_fields.items()}
    told = [f"| `{row.shown}` | {row.kind} | {row.said or said.get(row.key, '')} |\n" for row in rows.values()]
    table = "\n| member | type | meaning |\n|---|---|---|\n" + "".join(told) if told else ""
    return f"\n### {name}\n\n{text_of(one)}\n{table}"


@dataclass(frozen=True)
class Member:
    """A row of the table of members: name, as it is shown, type, meaning."""

    key: str
    shown: str
    kind: str
    said: str


def members(one: type) -> Iterator[Member]:
    """Public fields, properties and methods that a class itself defines."""
    for node in node_of(one).body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            if not node.target.id.startswith("_") and "ClassVar" not in ast.unparse(node.annotation):
                yield Member(node.target.id, node.target.id, kind_of(node.annotation), "")
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_") and node.name not in HOOKS:
            notes = [ast.unparse(note) for note in node.decorator_list]
            if "classmethod" in notes:
                continue
            said = " ".join((ast.get_docstring(node) or "").split("\n\n")[0].split())
            plain = any("property" in note for note in notes)
            shown = node.name if plain else " ".join(signature(node, method=True).rpartition(" -> ")[0].split())
            yield Member(node.name, in_table(shown), kind_of(node.returns), in_table(said))


def kind_of(annotation: ast.expr | None) -> str:
    """A type without what is annotated to it."""
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        annotation = ast.parse(annotation.value, mode="eval").body
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "Annotated":
        return kind_of(annotation.slice.elts[0])  # type: ignore[attr-defined]
    return f"`{in_table(ast.unparse(annotation))}`" if annotation else ""


def in_table(text: str) -> str:
    """A text as it may stand in a table."""
    return text.replace("|", "\\|")
