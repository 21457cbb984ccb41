"""Mutation testing of one module: `python -m tests.everywhere.mutants wagon.locking [--every K] [--seconds S]`.

Each mutant is the module with one operator, comparison, constant, condition or returned value changed. It lies in a
copy of the sources, where the tests that belong to the module are run as plain Python (`NUMBA_DISABLE_JIT`): compiling
every mutant would take minutes. A mutant is killed where a test fails or does not end in time.

General tools (mutmut, cosmic-ray) were not tried: this needs the standard library only.
"""

from __future__ import annotations

import argparse
import ast
import copy
import difflib
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import NoReturn

from . import say

LIBRARIES = ("pytest", "numba", "scipy.integrate", "scipy.optimize", "scipy.sparse.linalg", "pydantic", "pint", "yaml")
"""What the tests of a mutant need not load again."""

ROOT = Path(__file__).parents[2]
TESTS = {
    "wagon.locking": ("tests/wagon/test_locking_kernels.py",),
    "wagon.brake": (
        "tests/wagon/test_brake_kernels.py", "tests/wagon/test_brakes.py", "tests/wagon/test_slide_protection.py",
        "-k", "kernels or spin or friction_table or applications or closed_forms or below_the_release",
    ),
    "wagon.torque": (
        "tests/wagon/test_brake_torque.py", "tests/scenario/test_brake_keys.py", "tests/results/test_data_sheet.py",
        "-k", "brake_torque or brake_keys or closed_form or by_hand or cast_iron or braked_weight",
    ),
    "wagon.model": ("tests/wagon/test_wagon_matrices.py", "tests/wagon/test_equations_of_motion.py"),
    "track.contact": (
        "tests/track/test_contact_kernels.py", "tests/track/test_creep_force.py", "tests/track/test_hertz_contact.py",
    ),
    "track.hertz": ("tests/track/test_creep_force.py", "tests/track/test_hertz_contact.py"),
    "train.coupling": (
        "tests/solver/test_coupling_kernels.py", "tests/solver/test_couplings.py",
        "-k", "kernels or friction_spring or turns_back or derivatives",
    ),
    "tank.modal": (
        "tests/tank/test_modal_kernels.py", "tests/tank/test_liquid_contract.py",
        "-k", "not is_whole and not same_arguments",
    ),
    "tank.baffle": (
        "tests/tank/test_baffle_kernels.py", "tests/tank/test_shallow_baffles.py",
        "-k", "kernels or sharp_edged or quadrature or solid",
    ),
    "tank.roof": ("tests/tank/test_shallow_roof.py", "tests/tank/test_shallow_roof_force.py"),
}  # fmt: skip
"""Modules, and what tells pytest the quick tests that are to notice a change of them."""

OTHER = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.And: ast.Or, ast.Or: ast.And, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip


LEFT_ALONE = (ast.Raise, ast.Import, ast.ImportFrom)
"""What an error says is nobody's answer."""


def _places(tree: ast.AST) -> list[ast.AST]:
    """Nodes of functions that can be changed: no annotations, no docstrings, no decorators."""
    found: list[ast.AST] = []

    def look(node: ast.AST) -> None:
        found.append(node)
        for name, value in ast.iter_fields(node):
            if name in {"annotation", "returns", "decorator_list", "ctx", "type_comment"}:
                continue
            for one in value if isinstance(value, list) else [value]:
                text = isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant)
                if (
                    isinstance(one, ast.AST)
                    and not text
                    and not isinstance(one, ast.Raise | ast.Import | ast.ImportFrom)
                ):
                    look(one)

    look(tree)
    return found


def _changes(node: ast.AST) -> Iterator[str]:
    """Names of the changes that can be made to a node."""
    if isinstance(node, ast.BinOp | ast.AugAssign | ast.BoolOp) and type(node.op) in OTHER:
        yield "operator"
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in OTHER:
        yield "comparison"
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        yield "constant"
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield "sign"
    elif isinstance(node, ast.If | ast.IfExp | ast.While):
        yield "condition"
    elif isinstance(node, ast.Assign) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)):
        yield "statement"


def _changed(node: ast.AST, change: str) -> ast.AST:
    """The node that takes the place of `node`."""
    new = copy.deepcopy(node)
    if change == "operator":
        new.op = OTHER[type(node.op)]()
    elif change == "comparison":
        new.ops[0] = OTHER[type(node.ops[0])]()
    elif change == "constant":
        new.value = node.value + 1 if isinstance(node.value, int) else (1.5 * node.value or 1.0)
    elif change == "sign":
        return new.operand
    elif change == "condition":
        new.test = ast.Constant(value=False)
    elif change == "statement":
        return ast.Pass()
    return new


class _Put(ast.NodeTransformer):
    """Puts `new` where `old` stands."""

    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.old else self.generic_visit(node)


def mutants(text: str, every: int = 1) -> Iterator[tuple[str, str]]:
    """A name and the text, as `ast.unparse` writes it, of every K-th mutant of a module."""
    module = ast.parse(text)
    inside = [(k, node) for k, node in enumerate(_places(module)) if node not in module.body]
    for k, change in [(k, change) for k, node in inside for change in _changes(node)][::every]:
        tree = ast.parse(text)
        old = _places(tree)[k]
        mutant = _Put(old, _changed(old, change)).visit(tree)
        yield f"line {old.lineno}: {change}", ast.unparse(ast.fix_missing_locations(mutant))


def difference(text: str, mutant: str) -> str:
    """The lines that a mutant changes."""
    lines = difflib.unified_diff(ast.unparse(ast.parse(text)).splitlines(), mutant.splitlines(), lineterm="", n=0)
    return "\n".join(f"    {line}" for line in list(lines)[2:] if not line.startswith("@@"))


def survives(copied: Path, tests: tuple[str, ...], seconds: float) -> bool:
    """Whether all tests pass in the copy of the sources, in a fork that has the libraries already."""
    child = os.fork()
    if child == 0:
        _run(copied, tests)
    ends = time.monotonic() + seconds
    while time.monotonic() < ends:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status == 0
        time.sleep(0.02)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False


def _run(copied: Path, tests: tuple[str, ...]) -> NoReturn:
    """Run the tests in this process, silently, and end it with pytest's exit code."""
    silent = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(silent, stream)
    os.chdir(copied)
    sys.path.insert(0, str(copied))
    for name in [name for name in sys.modules if name.partition(".")[0] in {"tests", "everywhere", "slosh_cli"}]:
        del sys.modules[name]
    os._exit(int(import_module("pytest").main(["-x", "-q", "-m", "not slow", "-p", "no:cacheprovider", *tests])))


def main() -> int:
    """Print the survivors; exit code 1 where fewer than 85 % are killed."""
    parser = argparse.ArgumentParser(prog="python -m tests.everywhere.mutants")
    parser.add_argument("module", choices=TESTS)
    parser.add_argument("--every", type=int, default=1, help="try every K-th mutant only")
    parser.add_argument("--lines", type=int, nargs="*", help="try the mutants of these lines only")
    parser.add_argument("--seconds", type=float, default=20.0, help="the time that the tests of a mutant may take")
    parser.add_argument("--tests", nargs="*", help="tests to run in place of the module's own")
    given = parser.parse_args()
    tests = tuple(given.tests or TESTS[given.module])
    os.environ |= {"NUMBA_DISABLE_JIT": "1", "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    for name in LIBRARIES:
        import_module(name)
    with tempfile.TemporaryDirectory() as scratch:
        copied = Path(scratch) / "sources"
        copied.mkdir()
        for name in ("slosh_cli", "tests", "scenarios"):
            shutil.copytree(ROOT / name, copied / name, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", copied)
        path = copied / "slosh_cli" / (given.module.replace(".", "/") + ".py")
        text = path.read_text(encoding="utf-8")
        if not survives(copied, tests, 20 * given.seconds):  # and leaves all compiled to bytecode
            say("the tests fail without any change")
            return 2
        sys.dont_write_bytecode = True
        wanted = {f"line {line}" for line in given.lines or ()}
        chosen = [one for one in mutants(text, given.every) if not wanted or one[0].partition(":")[0] in wanted]
        alive = 0
        for name, mutant in chosen:
            path.write_text(mutant, encoding="utf-8")
            if survives(copied, tests, given.seconds):
                alive += 1
                say(f"survived: {name}\n{difference(text, mutant)}")
            else:
                say(f"killed: {name}")
    killed = 1 - alive / len(chosen)
    say(f"{given.module}: {len(chosen)} mutants, {alive} survived, {killed:.0%} killed")
    return int(killed < 0.85)


if __name__ == "__main__":
    sys.exit(main())
