"""Imports point one way, each outside library has one home, and only the command line prints."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "slosh_cli"

ORDER = [
    {"version", "errors", "compiled", "kernel_store", "arrays", "blocks", "friction", "method", "vectors"}
    | {"section", "outline"},
    {"scenario"},
    {"tank"},
    {"wagon"},
    {"track"},
    {"train"},
    {"solver"},
    {"results"},
    {"study"},
    {"validation"},
    {"report"},
    {"application"},
    {"cli"},
]
"""What may import what stands to its left; members of one set do not import each other's packages."""

RANK = {name: rank for rank, names in enumerate(ORDER) for name in names}

ONE_HOME = {
    "yaml": "scenario/yaml_text.py",
    "h5py": "results/hdf5.py",
    "matplotlib": "report/",
    "jinja2": "report/html.py",
    "pint": "scenario/conversion.py",
    "sqlite3": "study/journal.py",
    "distributed": "study/cluster.py",
}
"""The module, or the package, that a library is imported in and nowhere else."""

MODULES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))


def imported(module: str) -> Iterator[str]:
    """Absolute names of all that a module imports, anywhere in it but for type checkers."""
    tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
    for_checkers = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
        for statement in node.body
        for inner in ast.walk(statement)
    }
    home = ["slosh_cli", *Path(module).parts[:-1]]
    for node in ast.walk(tree):
        if id(node) in for_checkers:
            continue
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = home[: len(home) - node.level + 1] if node.level else []
            yield ".".join([*base, *([node.module] if node.module else [])])
            if node.module is None or node.module == "slosh_cli":
                yield from (".".join([*(base or ["slosh_cli"]), alias.name]) for alias in node.names)


def part(module: str) -> str:
    """The part of the program that a module belongs to: its folder, or its name at the top."""
    return Path(module).parts[0].removesuffix(".py")


def parts_imported(module: str) -> set[str]:
    """The parts of the program that a module imports."""
    names = (name.split(".") for name in imported(module))
    return {name[1] for name in names if name[0] == "slosh_cli" and len(name) > 1}


@pytest.mark.parametrize("module", [module for module in MODULES if module != "__init__.py"])
def test_every_module_has_a_place_and_imports_only_from_its_left(module: str) -> None:
    mine = part(module)
    assert mine in RANK, f"{mine} has no place in the order of the program"
    for other in parts_imported(module) - {mine}:
        assert other in RANK, f"{module} imports {other}, which has no place in the order of the program"
        assert RANK[other] < RANK[mine] or (RANK[other] == RANK[mine] == 0), f"{module} imports {other}"


def test_the_package_itself_imports_its_version_and_nothing_else() -> None:
    assert parts_imported("__init__.py") <= {"version"}


@pytest.mark.parametrize("library", ONE_HOME)
def test_a_library_has_one_home(library: str) -> None:
    users = {module for module in MODULES if library in {name.split(".")[0] for name in imported(module)}}
    assert users
    assert all(user.startswith(ONE_HOME[library]) for user in users)


@pytest.mark.parametrize("module", [module for module in MODULES if part(module) != "cli"])
def test_only_the_command_line_prints_and_exits(module: str) -> None:
    tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
    calls = {ast.unparse(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    forbidden = {"print", "exit", "quit", "sys.exit", "os._exit", "sys.stdout.write", "sys.stderr.write"}
    assert not calls & forbidden
    assert "typer" not in {name.split(".")[0] for name in imported(module)}


def test_importing_the_package_imports_nothing_heavy() -> None:
    heavy = ["numba", "scipy", "pandas", "matplotlib", "pint", "h5py", "numpy", "yaml", "typer", "pydantic"]
    code = f"import sys, slosh_cli; print(*set({heavy!r}) & set(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.split() == []


OFFERED = (
    "Result", "Scenario", "__version__", "coefficients", "excite", "load_scenario", "plot", "simulate", "sweep",
    "validate",
)  # fmt: skip


@pytest.mark.parametrize("name", OFFERED)
def test_the_package_offers_its_interface(name: str) -> None:
    import slosh_cli

    assert name in slosh_cli.__all__
    assert name in dir(slosh_cli)
    assert getattr(slosh_cli, name) is not None


def test_the_package_offers_nothing_else() -> None:
    import slosh_cli

    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        slosh_cli.simulat  # noqa: B018
