"""Where text goes: results to stdout, everything else to stderr, JSON in its _strict form."""

import json
import math
import numbers
import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TextIO

import typer

from slosh_cli.errors import printable

if TYPE_CHECKING:
    from rich.console import RenderableType


_KEPT: Final = "\n\t\u00a0"
"""What a text may hold besides letters. Control characters, which may be of a file, would steer the terminal."""


def say(text: str) -> None:
    """Print a line that belongs to the answer, to stdout."""
    _to_stdout(printable(text, _KEPT) + "\n")


def note(text: str) -> None:
    """Print a line about the work, to stderr."""
    _to_stderr(text)


def warn(text: str) -> None:
    """Print a warning, to stderr; coloured on a terminal."""
    _to_stderr(f"warning: {text}", "yellow")


def complain(text: str) -> None:
    """Print an error, to stderr; coloured on a terminal."""
    _to_stderr(text, "red")


def say_json(value: Mapping[str, Any]) -> None:
    """Print one JSON object to stdout: plain ASCII, no NaN or infinity (null stands for them)."""
    _to_stdout(json.dumps(_strict(value), allow_nan=False, indent=2) + "\n")


def default_lines(values: Mapping[str, str]) -> Iterator[str]:
    """What a scenario leaves to the program, by key paths: a line for each part."""
    parts: dict[str, list[str]] = {}
    for key, text in values.items():
        part, _, name = key.rpartition(".")
        parts.setdefault(part, []).append(f"{name} {text}")
    yield from ["Values that are the defaults of the program (`slosh presets default`)"] if parts else []
    for part, told in parts.items():
        yield f"  {part}: {', '.join(told)}"
    yield from [""] if parts else []


def show(*renderables: "RenderableType", whole: bool = False) -> None:
    """Print tables and other things of rich to stdout; `whole`: rather too wide than wrapped.

    Columns of numbers, which stand to the right, are never cut nor wrapped: rather the table is too wide.
    """
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    try:
        free = console.options.update(max_width=10_000)
        for column in (column for one in renderables if isinstance(one, Table) for column in one.columns):
            column.no_wrap = column.no_wrap or column.justify == "right"
        sizes = [console.measure(one, options=free) for one in renderables]
        console.width = max([console.width, *(size.maximum if whole else size.minimum for size in sizes)])
        with console.capture() as capture:
            console.print(*renderables, sep="\n")
    except OSError as error:  # rich looks whether stdout is still there
        refused(error)
        return
    shown = capture.get()
    _to_stdout(shown if console.is_terminal else printable(shown, _KEPT))


def _strict(value: Any) -> Any:
    """A value as _strict JSON knows it: numbers that are not finite become None, paths become strings.

    Raises TypeError for what has no place in JSON.
    """
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Mapping):
        return {str(key): _strict(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_strict(item) for item in value]
    raise TypeError(f"A value for JSON must be a plain Python value, but {type(value).__name__} was given.")


_unheard: list[OSError] = []
"""Why stdout took no more text, where that is a loss and not the reader's choice."""


def open_streams() -> None:
    """Put the null device where standard streams were closed (`>&-`): the work goes on, as with nobody listening.

    Without it the next file that is opened would take the place of a stream, and what is printed would end in it.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
    sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  (lives as long as the process)
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def flush_streams() -> OSError | None:
    """Write out what waits; returns why not all of the answer could be told, None where it was.

    Streams that refuse are left without a word to say, or the interpreter would complain at its end.
    """
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError as error:
            if stream is sys.stdout:
                refused(error)
            else:
                _silence(stream)
    return _unheard.pop() if _unheard else None


def close_stdout() -> None:
    """Send what follows nowhere: the reader of stdout (`head`, say) has gone, and that is no error."""
    _silence(sys.stdout)


def _silence(stream: TextIO) -> None:
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def refused(error: OSError) -> None:
    """Note that stdout takes no more: a loss, unless its reader has gone by choice."""
    if not isinstance(error, BrokenPipeError):
        _unheard[:] = [error]
    close_stdout()


def _to_stdout(text: str) -> None:
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        refused(error)


def _to_stderr(text: str, colour: str | None = None) -> None:
    try:
        typer.secho(printable(text, _KEPT), err=True, fg=colour)
    except OSError:  # nobody can be told
        _silence(sys.stderr)
