"""Ctrl-C, SIGTERM, SIGHUP at any time: exit code 130, one sentence, nothing half-written, what was there stays."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"
MAIN = "import sys\nfrom slosh_cli.cli import main\nsys.exit(main())\n"
SENDS = "import os, signal, sys, time\nsend = lambda: os.kill(os.getpid(), getattr(signal, os.environ['SENT']))\n"

WHILE_LOADING = "import slosh_cli.cli as entry\nentry._hurry = send\n"
WHILE_IMPORTING = """
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "slosh_cli.scenario":
            send()
sys.meta_path.insert(0, Finder())
"""
IN_A_FINALISER = """
import slosh_cli.cli.init
class Dying:
    def __del__(self):
        send()
        time.sleep(0.05)
def packaged(name, output):
    Dying()
    time.sleep(60.0)
slosh_cli.cli.init._of_packaged = packaged
"""
IN_A_LIBRARY = """
import hashlib, threading
from pathlib import Path
import slosh_cli.cli.init
from slosh_cli.results.files import replacing, staging
def packaged(name, output):
    with replacing(Path("file")) as temporary, staging(Path("folder")) as stage:
        temporary.write_text("half")
        (stage / "other").write_text("half")
        threading.Timer(0.2, send).start()
        hashlib.pbkdf2_hmac("sha256", b"", b"", 2_000_000_000)  # deaf for a quarter of an hour
slosh_cli.cli.init._of_packaged = packaged
"""
IN_AN_OPEN_FILE = """
from pathlib import Path
import slosh_cli.cli.init
from slosh_cli.results.files import replacing
def packaged(name, output):
    with replacing(Path("file")) as temporary:
        temporary.write_text("half")
        send()
        time.sleep(60.0)
slosh_cli.cli.init._of_packaged = packaged
"""
TWICE = """
import threading
import slosh_cli.cli.init
def packaged(name, output):
    try:
        send()
        time.sleep(60.0)
    finally:
        send()  # at once: struck twice by mistake
        threading.Timer(1.3, send).start()
        while True:
            time.sleep(1.0)
slosh_cli.cli.init._of_packaged = packaged
"""
PLACES = {
    "a closing that never ends": TWICE,
    "loading": WHILE_LOADING,
    "importing": WHILE_IMPORTING,
    "finaliser": IN_A_FINALISER,
    "library": IN_A_LIBRARY,
    "open file": IN_AN_OPEN_FILE,
}


def interrupted(folder: Path, code: str, sent: str, *arguments: object) -> "subprocess.CompletedProcess[str]":
    """Run the command with `code` that sends it the signal `sent`."""
    command = [sys.executable, "-c", SENDS + code + MAIN, *map(str, arguments)]
    environment = os.environ | {"SENT": sent}
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=100
    )


@pytest.mark.parametrize("place", PLACES)
def test_a_signal_ends_the_command_with_one_word_and_nothing_half_written(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("old")
    sent = "SIGTERM" if place in ("importing", "open file") else "SIGINT"
    run = interrupted(tmp_path, PLACES[place], sent, "init")
    assert (run.returncode, run.stdout, run.stderr.strip()) == (130, "", "interrupted")
    left = {file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*")} - {"folder"}
    assert left == {"file"}
    assert (tmp_path / "file").read_text() == "old"


def test_scripts_are_told_too(tmp_path: Path) -> None:
    heard = "signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"  # also where the tests themselves run under `nohup`
    run = interrupted(tmp_path, heard + WHILE_LOADING, "SIGHUP", "run", PAPER, "--json")
    assert run.returncode == 130
    assert '"code": "interrupted"' in run.stdout


def test_what_the_parent_ignores_stays_ignored(tmp_path: Path) -> None:
    """As `nohup` does, and a shell for what it starts in the background."""
    ignored = "signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
    run = interrupted(tmp_path, ignored + WHILE_LOADING, "SIGHUP", "--version")
    assert run.returncode == 0, run.stderr


def test_a_signal_at_the_very_end_does_not_change_the_exit_code(tmp_path: Path) -> None:
    run = interrupted(tmp_path, "import atexit\natexit.register(lambda: (send(), time.sleep(0.1)))\n", "SIGINT", "oops")
    assert run.returncode == 2
    assert "Traceback" not in run.stderr
    assert "interrupted" not in run.stderr


def test_a_command_in_a_process_of_somebody_else_leaves_his_signals_alone() -> None:
    from slosh_cli.cli import main

    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    assert main(["--version"]) == 0
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before
