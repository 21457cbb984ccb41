"""The reference pages: keys, commands, presets and the Python interface, from the program's own tables.

`python docs/reference.py` writes ``keys.md``, ``commands.md``, ``presets.md`` and ``api.md`` beside itself; a test says
when that is due.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from reference_commands import commands_page, presets_page
from reference_keys import keys_page
from reference_python import python_page

FOLDER = Path(__file__).parent
PAGES: Mapping[str, Callable[[], str]] = {
    "keys.md": keys_page, "commands.md": commands_page, "presets.md": presets_page, "api.md": python_page,
}  # fmt: skip

if __name__ == "__main__":
    for name, page in PAGES.items():
        (FOLDER / name).write_text(page(), encoding="utf-8")
