"""The scenarios that come with the program."""

from __future__ import annotations

import difflib
import re
from pathlib import Path

from slosh_cli.errors import UsageError

_NAME = re.compile(r"^name:\s*([^\s#]+)", re.MULTILINE)


def _folder() -> Path:
    """Inside the package once installed, beside it in a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "scenarios"
    return installed if installed.is_dir() else package.parent / "scenarios"


def packaged_scenarios() -> dict[str, Path]:
    """Name (as written in the file) to path of every scenario that comes with the program, sorted by name."""
    return _named(_folder())


def packaged_trains() -> dict[str, Path]:
    """The same of trains."""
    return _named(_folder() / "trains")


def _named(folder: Path) -> dict[str, Path]:
    found = {packaged_text(path)[0]: path for path in folder.glob("*.yaml")}
    return dict(sorted(found.items()))


def packaged_text(path: Path, name: str = "") -> tuple[str, str]:
    """Name and text of a packaged scenario; with a `name` the text says that instead of its own."""
    text = path.read_text(encoding="utf-8")
    if not name:
        found = _NAME.search(text)
        return (found.group(1) if found else path.stem), text
    return name, _NAME.sub(f"name: {name}", text, count=1)


def find_packaged(name: str, *, trains: bool = False) -> Path:
    """The path of a packaged scenario (or train) by its name or by its file name, with or without ``.yaml``.

    Raises UsageError with the names there are.
    """
    known = packaged_scenarios() | (packaged_trains() if trains else {})
    for key, path in known.items():
        if name in (key, path.stem, path.name):
            return path
    near = difflib.get_close_matches(name, known, 1)
    listed = ", ".join(known) or "none"
    hint = f"write `{near[0]}`" if near else f"write one of {listed}"
    raise UsageError(f"must be the name of a packaged scenario; given `{name}`; {hint}", where=name)
