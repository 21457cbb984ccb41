"""The pages of keys, commands, presets and Python names are what the code gives today."""

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest
import typer

from slosh_cli.cli.app import tree
from slosh_cli.study.study_schema import study_schema

DOCS = Path(__file__).parents[1] / "docs"
PAGES = ("keys.md", "commands.md", "presets.md", "api.md")
TEXTS = {page: (DOCS / page).read_text(encoding="utf-8") for page in PAGES}
CODE = re.compile(r"```.*?```|`[^`]+`", re.DOTALL)


@pytest.fixture(scope="module")
def reference() -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(DOCS))
        before = set(sys.modules)
        yield import_module("reference")
        for name in set(sys.modules) - before:
            if name.startswith("reference"):
                del sys.modules[name]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_what_the_code_gives(reference: ModuleType, page: str) -> None:
    assert reference.PAGES.keys() == set(PAGES)
    assert reference.PAGES[page]() == TEXTS[page], f"docs/{page} is stale: make pages"


def test_every_key_that_a_study_may_vary_is_told() -> None:
    """The schema for editors has found them another way."""
    vary = study_schema()["properties"]["vary"]
    patterns = [key.strip("^$").replace("[.][0-9]+", "[]").replace("[.]", ".") for key in vary["patternProperties"]]
    found = [key.replace("\\", "") for key in (*vary["properties"], *patterns) if "vehicles" not in key]
    keys = {re.sub(r"\.0\b", "[]", key) for key in found}
    told = set(re.findall(r"^\| `([^`]+)` \|", TEXTS["keys.md"], re.MULTILINE))
    told |= set(re.findall(r"^### `([^`]+)`", TEXTS["keys.md"], re.MULTILINE))
    items = {f"{key}[]" for key in told}
    assert not keys - told - items


@pytest.mark.parametrize("page", PAGES)
def test_a_page_reads_well_as_it_is(page: str) -> None:
    """No HTML, no placeholders; rows as wide as the head of their table."""
    words = CODE.sub("code", TEXTS[page])
    assert not re.search(r"</?[a-z]|\{\{|\bNone\b\s*\|$|object at 0x|/home/|/tmp/", words)
    width = 0
    for line in TEXTS[page].splitlines():
        cells = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else 0
        assert not width or not cells or cells == width, line
        width = cells


def test_no_page_has_a_placeholder() -> None:
    """Also the pages that people write."""
    assert not [page.name for page in sorted(DOCS.glob("*.md")) if "{{" in CODE.sub("", page.read_text("utf-8"))]


def test_the_help_of_every_command_names_a_page() -> None:
    app = typer.main.get_command(tree())
    inner = [one for command in app.commands.values() for one in (command, *getattr(command, "commands", {}).values())]  # type: ignore[attr-defined]
    for command in [app, *inner]:
        pages = re.findall(r"docs/([\w-]+\.md)", command.epilog or "")
        assert pages, command.name
        assert all((DOCS / page).is_file() for page in pages), command.name
