"""The error shell around the commands: exceptions in, messages and exit codes out."""

import os
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from io import TextIOWrapper
from typing import Final

import typer

from slosh_cli.cli.app import tree
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.interrupts import close_in_order, end_with
from slosh_cli.cli.output import close_stdout, complain, flush_streams, open_streams, refused, say_json
from slosh_cli.errors import ScenarioError, SloshError, shortened

_DEBUG: Final = "SLOSH_DEBUG"
"""Environment variable: when set, an unexpected error shows its traceback."""
_MOST_LINES: Final = 24
_LONGEST_LINE: Final = 2000
"""Lines of an error, and letters of one; what is longer repeats what was given."""


def execute(arguments: Sequence[str] | None = None) -> int:
    """Run the command line with `arguments` (default: those of the process); returns the exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    before_dashes = words[: words.index("--")] if "--" in words else words
    open_streams()
    close_in_order()
    _forgive_encodings()
    try:
        code = _run(words)
    except Exception as error:  # the last resort: no traceback may reach the user
        code = _report(error, as_json="--json" in before_dashes)
    except KeyboardInterrupt:
        code = _interrupted(as_json="--json" in before_dashes)
    code = _told(code)
    end_with(code)
    return code


def _told(code: int) -> int:
    """The exit code, once the answer is out; one that could not be told is not a success."""
    refusal = flush_streams()
    if refusal is None:
        return code
    complain(f"error: cannot write to standard output: {refusal.strerror or refusal}")
    flush_streams()
    return code or ExitCode.BAD_INPUT


def _run(words: list[str]) -> int:
    """Run one command; a broken pipe on the way is the reader's choice and no error."""
    try:
        code = typer.main.get_command(tree(*words[:1])).main(args=words, prog_name="slosh", standalone_mode=False)
    except (SystemExit, BrokenPipeError) as end:
        if isinstance(end, BrokenPipeError) or isinstance(end.__context__, OSError):
            close_stdout()
            return ExitCode.DONE
        return end.code if isinstance(end.code, int) else ExitCode.DONE
    if code == ExitCode.INTERRUPTED:
        raise KeyboardInterrupt
    return int(code or ExitCode.DONE)


def _report(error: Exception, *, as_json: bool) -> ExitCode:
    """Tell the user of an error, once; returns the exit code that goes with it."""
    if isinstance(error, OSError) and _comes_from_printing(error):
        refused(error)
        return ExitCode.DONE
    if isinstance(error, typer.Abort):
        return _interrupted(as_json=as_json)
    if isinstance(error, SloshError):
        text = str(error) if isinstance(error, ScenarioError) else f"error: {error}"
        _say_error(text, as_json, code=error.code, message=str(error), where=error.where)
        return ExitCode.BAD_INPUT
    if isinstance(error, OSError):
        told, file = _refusal_words(error)
        _say_error(f"error: {told}", as_json, code="file", message=told, where=file)
        return ExitCode.BAD_INPUT
    # Usage errors of the command-line library word themselves; their class moves between its versions.
    wording = getattr(error, "format_message", None)
    if wording is not None:
        context = getattr(error, "ctx", None)
        command = context.command_path if context else "slosh"
        text = f"error: {wording()}\nSee `{command} --help`."
        _say_error(text, as_json, code="usage", message=wording(), where=command)
        return ExitCode.BAD_INPUT
    if os.environ.get(_DEBUG):
        traceback.print_exception(error)
    message = f"{type(error).__name__}: {error}"
    text = (
        f"slosh itself failed: {message}\n"
        f"Please report this with the command and the scenario; {_DEBUG}=1 makes slosh show where it happened."
    )
    _say_error(text, as_json, code="internal", message=message, where="")
    return ExitCode.NO_ANSWER


def _refusal_words(error: OSError) -> tuple[str, str]:
    """What the system refused, and of which file."""
    if os.environ.get(_DEBUG):
        traceback.print_exception(error)
    reason = error.strerror or str(error)
    try:
        os.getcwd()
    except OSError:
        return f"the current folder cannot be used: {reason}; change to another one and call slosh again", "."
    file = "" if error.filename is None else shortened(os.fsdecode(error.filename))
    return (f"the system refuses {file}: {reason}" if file else f"the system refuses: {reason}"), file


def _comes_from_printing(error: OSError) -> bool:
    """Whether the command-line library met the error, which prints its help itself and opens no files."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace is not None and trace.tb_frame.f_globals.get("__name__", "").partition(".")[0] in ("click", "typer")


def _interrupted(*, as_json: bool) -> ExitCode:
    _say_error("interrupted", as_json, code="interrupted", message="interrupted", where="")
    return ExitCode.INTERRUPTED


def _say_error(text: str, as_json: bool, **error: str) -> None:
    """An error for people on stderr and, when asked for, for scripts on stdout; what was given may be long."""
    if as_json:
        say_json({"error": {key: _bounded(words) for key, words in error.items()}})
    complain(_bounded(text))


def _bounded(text: str) -> str:
    """A text with its first lines, and the beginnings of these."""
    lines = text.split("\n", _MOST_LINES)[:_MOST_LINES]
    return "\n".join(line if len(line) <= _LONGEST_LINE else f"{line[:_LONGEST_LINE]}..." for line in lines)


def _forgive_encodings() -> None:
    """A terminal that lacks a character shows a stand-in for it; that is no reason to fail."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            with suppress(ValueError):
                stream.reconfigure(errors="replace")
