"""Where text goes: results to stdout, everything else to stderr, JSON in its strict form."""

import json
import math
import numbers
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from rich.console import RenderableType


def say(text: str) -> None:
    """Print a line that belongs to the answer, to stdout."""
    _to_stdout(text + "\n")


def note(text: str) -> None:
    """Print a line about the work, to stderr."""
    typer.echo(text, err=True)


def warn(text: str) -> None:
    """Print a warning, to stderr; coloured on a terminal."""
    typer.secho(f"warning: {text}", err=True, fg="yellow")


def complain(text: str) -> None:
    """Print an error, to stderr; coloured on a terminal."""
    typer.secho(text, err=True, fg="red")


def say_json(value: Mapping[str, Any]) -> None:
    """Print one JSON object to stdout: plain ASCII, no NaN or infinity (null stands for them)."""
    _to_stdout(json.dumps(strict(value), allow_nan=False, indent=2) + "\n")


def show(*renderables: "RenderableType") -> None:
    """Print tables and other things of rich to stdout."""
    from rich.console import Console

    console = Console(highlight=False)
    with console.capture() as capture:
        console.print(*renderables, sep="\n")
    _to_stdout(capture.get())


def strict(value: Any) -> Any:
    """A value as strict JSON knows it: numbers that are not finite become None, paths become strings.

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
        return {str(key): strict(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [strict(item) for item in value]
    raise TypeError(f"A value for JSON must be a plain Python value, but {type(value).__name__} was given.")


def close_stdout() -> None:
    """Send what follows nowhere: the reader of stdout (`head`, say) has gone, and that is no error."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


def _to_stdout(text: str) -> None:
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        close_stdout()
