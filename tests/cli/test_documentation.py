"""Every command and every option says what it is for, and `--help` is quick."""

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
from stand_ins import Slosh

from slosh_cli import __version__
from slosh_cli.cli.app import tree
from slosh_cli.cli.exit_codes import ExitCode

HEAVY = ["numba", "scipy", "pandas", "matplotlib", "pint", "h5py", "numpy", "yaml", "rich"]


def _tree(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    yield path, command
    for name, child in getattr(command, "commands", {}).items():
        yield from _tree(child, (*path, name))


COMMANDS = dict(_tree(typer.main.get_command(tree())))


def test_the_commands_are_those_that_scripts_rely_on() -> None:
    assert {path[0] for path in COMMANDS if path} >= {"run", "check", "schema", "init", "plot"}


@pytest.mark.parametrize("path", COMMANDS, ids=" ".join)
def test_every_command_and_parameter_is_documented(path: tuple[str, ...]) -> None:
    command = COMMANDS[path]
    assert command.help, path
    for parameter in command.params:
        assert parameter.help, (path, parameter.name)


@pytest.mark.parametrize("path", COMMANDS, ids=" ".join)
def test_every_command_shows_its_help(slosh: Slosh, path: tuple[str, ...]) -> None:
    outcome = slosh(*path, "--help")
    assert outcome.code == ExitCode.DONE
    assert outcome.out.startswith(" ".join(["Usage: slosh", *path]))
    assert outcome.err == ""


@pytest.mark.parametrize("path", COMMANDS, ids=" ".join)
def test_the_first_line_of_a_help_fits_the_list_of_commands(slosh: Slosh, path: tuple[str, ...]) -> None:
    first = COMMANDS[path].help.splitlines()[0]
    assert len(first) <= 68
    assert first.endswith(".")


def test_the_help_names_pages_that_exist(slosh: Slosh) -> None:
    told = re.findall(r"docs/[\w-]+\.md", " ".join(slosh("--help").out.split()))
    assert "docs/tutorial.md" in told
    assert all((Path(__file__).parents[2] / page).is_file() for page in told)


def test_without_a_command_slosh_shows_its_help(slosh: Slosh) -> None:
    outcome = slosh()
    assert outcome.code == ExitCode.DONE
    assert "Commands:" in outcome.out


def test_the_help_names_the_exit_codes(slosh: Slosh) -> None:
    text = " ".join(slosh("--help").out.split())
    assert "2 the input is wrong, 3 a run ended without an answer" in text


def test_version(slosh: Slosh) -> None:
    assert slosh("--version").out == f"slosh {__version__}\n"


@pytest.mark.parametrize("arguments", [["--help"], ["run", "--help"], ["--version"]], ids=" ".join)
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    code = (
        "import sys; from slosh_cli.cli import main; main(sys.argv[2:]); "
        "print(*set(sys.argv[1].split(',')) & set(sys.modules), file=sys.stderr)"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, ",".join(HEAVY), *arguments], check=True, capture_output=True, text=True
    )
    assert run.stderr.split() == []


def test_the_end_of_the_process_looks_for_no_garbage() -> None:
    """A search through all that pydantic built took a sixth of `slosh check`."""
    code = (
        "import atexit, gc; atexit.register(lambda: print(gc.get_freeze_count(), len(gc.get_objects()))); "
        "from slosh_cli.cli import main; main(['--version']); print(gc.get_freeze_count())"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    before, at_the_end = run.stdout.splitlines()[1:]
    frozen, watched = map(int, at_the_end.split())
    assert before == "0"
    assert frozen > 100 * watched


def test_help_is_as_quick_as_the_library_it_needs() -> None:
    commands = {"ours": "from slosh_cli.cli import main; main(['--help'])", "library": "import typer"}
    best = dict.fromkeys(commands, float("inf"))
    for _ in range(7):  # in turns, so that another program's burst hits both
        for name, code in commands.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
            best[name] = min(best[name], time.perf_counter() - start)
    assert best["ours"] < 2.0 * best["library"]


def test_one_command_alone_is_the_same_as_in_the_whole_tree() -> None:
    """The command line sets up only the command it is given."""
    for name in {path[0] for path in COMMANDS if path}:
        alone = dict(_tree(typer.main.get_command(tree(name))))
        whole = {path for path in COMMANDS if path[:1] in ((), (name,))}
        assert set(alone) == whole
        for path in whole - {()}:
            assert [one.name for one in alone[path].params] == [one.name for one in COMMANDS[path].params]
            assert alone[path].help == COMMANDS[path].help
