"""The error shell: one message, the right exit code, never a traceback."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from plausible import unfinished_run
from stand_ins import PAPER, Slosh, Solver

from slosh_cli.cli import main
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.errors import SloshError


def fail_with(error: BaseException) -> object:
    def answer(_: object) -> object:
        raise error

    return answer


def test_the_exit_codes_are_those_of_the_contract() -> None:
    assert [int(code) for code in ExitCode] == [0, 1, 2, 3, 130]


USAGE = {
    "no such command": (["rnu"], "No such command 'rnu'"),
    "no such option": (["run", "x.yaml", "--quick"], "No such option: --quick"),
    "argument missing": (["run"], "Missing argument 'SCENARIO'"),
    "value missing": (["run", "x.yaml", "--set"], "requires an argument"),
    "schema of nothing known": (["schema", "tank"], "'tank' is not one of 'scenario', 'study', 'train'"),
    "one argument too many": (["schema", "scenario", "now"], "unexpected extra argument"),
}


@pytest.mark.parametrize(("arguments", "message"), USAGE.values(), ids=USAGE)
def test_a_wrong_command_line_is_the_users_matter(slosh: Slosh, arguments: list[str], message: str) -> None:
    outcome = slosh(*arguments)
    assert outcome.code == ExitCode.BAD_INPUT
    assert message.lower() in outcome.err.lower()
    assert "--help`" in outcome.err
    assert outcome.out == ""


@pytest.mark.parametrize(("arguments", "message"), USAGE.values(), ids=USAGE)
def test_with_json_a_wrong_command_line_is_one_object(slosh: Slosh, arguments: list[str], message: str) -> None:
    command, *rest = arguments
    outcome = slosh(command, "--json", *rest)
    assert outcome.code == ExitCode.BAD_INPUT
    error = json.loads(outcome.out)["error"]
    assert list(error) == ["code", "message", "where"]
    assert error["code"] == "usage"
    assert error["where"].startswith("slosh")


def test_json_behind_two_dashes_is_a_name(slosh: Slosh) -> None:
    outcome = slosh("run", "--", "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert outcome.out == ""


def test_a_missing_scenario_is_named(slosh: Slosh) -> None:
    outcome = slosh("run", "nowhere.yaml")
    assert outcome.code == ExitCode.BAD_INPUT
    assert outcome.err.startswith("nowhere.yaml: ")
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize("given", ["paper_80", "paper_80.yaml", "paper-80-liquid", "paper_08"])
@pytest.mark.parametrize("command", ["run", "check"])
def test_a_packaged_scenario_that_may_be_meant_is_named(slosh: Slosh, command: str, given: str) -> None:
    outcome = slosh(command, given)
    assert outcome.code == ExitCode.BAD_INPUT
    assert "`slosh init paper-80-liquid` writes the packaged one to paper-80-liquid.yaml" in outcome.err


def test_an_error_of_the_program_reaches_the_user_as_it_is(slosh: Slosh, solver: Solver) -> None:
    solver.answer = fail_with(SloshError("the mass matrix is not positive definite", "tank.coefficients"))
    outcome = slosh("run", PAPER)
    assert outcome.code == ExitCode.BAD_INPUT
    assert outcome.err == "error: the mass matrix is not positive definite\n"
    error = json.loads(slosh("run", PAPER, "--json").out)["error"]
    assert error == {
        "code": "error",
        "message": "the mass matrix is not positive definite",
        "where": "tank.coefficients",
    }


def test_an_unexpected_error_asks_for_a_report(slosh: Slosh, solver: Solver) -> None:
    solver.answer = fail_with(ZeroDivisionError("division by zero"))
    outcome = slosh("run", PAPER)
    assert outcome.code == ExitCode.NO_ANSWER
    assert "ZeroDivisionError: division by zero" in outcome.err
    assert "Please report this" in outcome.err
    assert "Traceback" not in outcome.err
    outcome = slosh("run", PAPER, "--json")
    assert outcome.code == ExitCode.NO_ANSWER
    assert json.loads(outcome.out)["error"]["code"] == "internal"


def test_an_unexpected_error_shows_its_place_on_request(
    slosh: Slosh, solver: Solver, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SLOSH_DEBUG", "1")
    solver.answer = fail_with(ZeroDivisionError("division by zero"))
    assert "Traceback" in slosh("run", PAPER).err


def test_an_interrupt_is_told_apart(slosh: Slosh, solver: Solver) -> None:
    solver.answer = fail_with(KeyboardInterrupt())
    outcome = slosh("run", PAPER)
    assert outcome.code == ExitCode.INTERRUPTED == 130
    assert outcome.err.endswith("interrupted\n")
    assert json.loads(slosh("run", PAPER, "--json").out)["error"]["code"] == "interrupted"


def test_an_interrupt_stops_the_solver_and_writes_nothing(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    events = []
    simulate = solver.simulate

    def watched(scenario: object, *, progress: object, cancel: object) -> object:
        events.append(cancel)
        return simulate(scenario, progress=progress, cancel=cancel)

    sys.modules["slosh_cli.results.simulate"].simulate = watched  # type: ignore[attr-defined]
    solver.answer = fail_with(KeyboardInterrupt())
    slosh("run", PAPER)
    assert events[0].is_set()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="pipes of the shell")
@pytest.mark.parametrize("arguments", ["schema", "--help", "check scenarios/paper_80.yaml --json"])
def test_a_reader_that_goes_away_is_no_error(arguments: str) -> None:
    root = Path(__file__).parents[2]
    code = "import sys, time; time.sleep(0.2); from slosh_cli.cli import main; sys.exit(main())"
    command = [sys.executable, "-c", code, *arguments.split()]
    process = subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    complaints = process.stderr.read()
    process.stderr.close()
    assert process.wait() == ExitCode.DONE
    assert complaints == b""


def test_a_reader_that_goes_away_does_not_hide_that_a_run_had_no_answer(
    solver: Solver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Gone(io.StringIO):
        def write(self, text: str) -> int:
            if text:
                raise BrokenPipeError
            return 0

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("slosh_cli.cli.output.close_stdout", lambda: None)
    monkeypatch.setattr(sys, "stdout", Gone())
    solver.answer = unfinished_run
    assert main(["run", str(PAPER), "--no-figures"]) == ExitCode.NO_ANSWER
    assert "failed on its own account" not in capsys.readouterr().err


def test_a_poor_terminal_is_no_error() -> None:
    """Characters that the terminal lacks are replaced; the command goes on."""
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    code = "from slosh_cli.cli import main; from slosh_cli.cli.output import say; main(['--version']); say('ü')"
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, check=False)
    assert run.returncode == 0
    assert run.stdout.endswith(b"?\n")


STREAMS = {"out closed": (">&-", 0), "err closed": ("2>&-", 0), "all closed": ("<&- >&- 2>&-", 0),
           "out full": (">/dev/full", 2), "both full": (">/dev/full 2>/dev/full", 2)}  # fmt: skip


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="streams of Linux")
@pytest.mark.parametrize(("streams", "code"), STREAMS.values(), ids=STREAMS)
@pytest.mark.parametrize("arguments", ["check scenarios/paper_80.yaml --json", "run --help"])
def test_streams_that_take_nothing_are_no_crash(arguments: str, streams: str, code: int) -> None:
    """Closed streams are silence; an answer that could not be told is no success, and no crash either."""
    start = f"'{sys.executable}' -c 'import sys; from slosh_cli.cli import main; sys.exit(main())' {arguments}"
    root = Path(__file__).parents[2]
    run = subprocess.run(["bash", "-c", f"{start} {streams}"], cwd=root, capture_output=True, text=True, check=False)
    assert run.returncode == code, run.stderr
    told = "error: cannot write to standard output: No space left on device\n" if streams == ">/dev/full" else ""
    assert run.stderr == told


@pytest.mark.parametrize("backend", ["nonsense", "TkAgg"])
def test_the_users_matplotlib_backend_is_no_matter(backend: str, tmp_path: Path) -> None:
    """An unknown one keeps matplotlib from being imported at all."""
    code = (
        "import sys; sys.path[:0] = sys.argv[1:3]; from slosh_cli.cli import main; from plausible import plausible_run;"
        "import slosh_cli.results.simulate as s; s.simulate = lambda scenario, **_: plausible_run(scenario);"
        "import slosh_cli.report; sys.exit(main(sys.argv[3:]))"
    )
    root = Path(__file__).parents[1]
    words = [str(root / "results"), str(root / "cli"), "run", str(PAPER), "-o", str(tmp_path / "here")]
    run = subprocess.run(
        [sys.executable, "-c", code, *words], env=os.environ | {"MPLBACKEND": backend}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert len(list((tmp_path / "here").iterdir())) == 10
