"""Sizes, names and types of the package keep the house's rules; every exception has a name and a reason."""

import ast
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "slosh_cli"
MODULES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))
TEXTS = {module: (PACKAGE / module).read_text(encoding="utf-8") for module in MODULES}
TREES = {module: ast.parse(text) for module, text in TEXTS.items()}
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]

LONGEST_MODULE, LONGEST_FUNCTION, MOST_NAMES = 300, 40, 27
"""Lines, lines without the docstring, public names per 1,000 lines."""

LONG_KERNELS = {
    "carry": "one step of the liquid beside the wagon's, with the account of it: what it books hangs together",
    "fluxes": "one pass over the faces, each of which keeps what the last one found",
    "liquid_evolve": "one step of Heun's method with its repetition, on two dozen arrays",
}
"""Kernels longer than a function should be, and why."""

DEFINED_AGAIN = {
    "compute": "every validation case has one: what the registry calls",
    "critical_speed": "the same formula of a scenario's track and of its assembled rail",
    "excite": "the tank's motion, and the function of the public interface that reads its words",
    "simulate": "the integration, and the function of the public interface that takes a path",
    "simulate_train": "the same of a train",
}
"""Public names that several modules define, and why."""


def functions(module: str) -> Iterator[tuple[str, int, bool]]:
    """Name, lines without the docstring, and whether it is compiled, of every function of a module."""
    for node in ast.walk(TREES[module]):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            assert node.end_lineno is not None
            text = ast.get_docstring(node)
            size = node.end_lineno - node.lineno + 1 - (text.count("\n") + 1 if text else 0)
            yield node.name, size, any("kernel" in ast.unparse(decorator) for decorator in node.decorator_list)


def public_names(module: str) -> set[str]:
    """Functions, classes and plainly assigned values that a module defines for others."""
    names: set[str] = set()
    for node in TREES[module].body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Assign):
            names |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return {name for name in names if not name.startswith("_")}


USES = Counter(name for module in MODULES for name in public_names(module))


def test_a_module_is_a_room_one_can_overlook() -> None:
    lines = {module: text.count("\n") for module, text in TEXTS.items()}
    assert not {module: count for module, count in lines.items() if count > LONGEST_MODULE}


def test_a_function_fits_a_screen() -> None:
    found = [(module, name, size) for module in MODULES for name, size, _ in functions(module)]
    assert not [one for one in found if one[2] > LONGEST_FUNCTION and one[1] not in LONG_KERNELS]


def test_names_are_few() -> None:
    lines = sum(text.count("\n") for text in TEXTS.values())
    assert 1000 * len(USES) / lines <= MOST_NAMES, f"{len(USES)} public names in {lines} lines"


def test_a_name_means_one_thing() -> None:
    again = {name for name, count in USES.items() if count > 1} - DEFINED_AGAIN.keys()
    assert not {name: [module for module in MODULES if name in public_names(module)] for name in sorted(again)}


def test_nothing_is_caught_without_its_name() -> None:
    handlers = [
        (module, node)
        for module, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ExceptHandler)
    ]
    assert not [f"{module}:{node.lineno}" for module, node in handlers if not node.type]


def test_exceptions_are_still_needed() -> None:
    long = {
        name for module in MODULES for name, size, compiled in functions(module) if compiled and size > LONGEST_FUNCTION
    }
    assert set(LONG_KERNELS) <= long
    assert all(USES[name] > 1 for name in DEFINED_AGAIN)


def test_complexity_is_bounded_but_for_kernels() -> None:
    lint = SETTINGS["ruff"]["lint"]
    assert "C90" in lint["select"]
    assert lint["mccabe"]["max-complexity"] == 10
    for place, rules in lint["per-file-ignores"].items():
        if any(rule.startswith("C9") for rule in rules):
            assert any(compiled for _, _, compiled in functions(place.removeprefix("slosh_cli/"))), place


def test_only_kernels_are_typed_loosely() -> None:
    loose = [
        name
        for override in SETTINGS["mypy"]["overrides"]
        if not override.get("disallow_untyped_defs", True)
        for name in override["module"]
    ]
    modules = [name.removeprefix("slosh_cli.").replace(".", "/") + ".py" for name in loose]
    modules += [module for module, text in TEXTS.items() if "# mypy: disallow-untyped" in text]
    assert not [
        module
        for module in modules
        if module not in MODULES or not any(compiled for _, _, compiled in functions(module))
    ]
