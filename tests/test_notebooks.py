"""The notebooks of the documentation are what their script says, small, and their cells run."""

import re
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import nbformat
import pytest
from matplotlib import pyplot

DOCS = Path(__file__).parents[1] / "docs"
FILES = sorted((DOCS / "notebooks").glob("*.ipynb"))
MACHINE = re.compile(r"/(?:home|root|tmp|usr|work|Users)/|[A-Z]:\\")


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(DOCS))
    return import_module("notebooks")


def read(file: Path) -> Any:
    return nbformat.read(file, as_version=4)


def test_cells_are_those_of_the_script(made: ModuleType) -> None:
    found = {file.name: [(cell.cell_type, cell.source) for cell in read(file).cells] for file in FILES}
    assert found == {name: list(made.cells(text)) for name, text in made.NOTEBOOKS.items()}, "make pages"


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_notebook_is_valid_small_and_of_no_machine(file: Path) -> None:
    notebook = read(file)
    nbformat.validate(notebook)
    assert file.stat().st_size < 300_000
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    assert {output.output_type for output in outputs} == {"stream", "execute_result"}
    texts = [output.get("text", "") + output.get("data", {}).get("text/plain", "") for output in outputs]
    assert not MACHINE.search("\n".join([*texts, *(cell.source for cell in notebook.cells)]))
    assert any("image/png" in output.get("data", {}) for output in outputs)
    links = re.findall(r"\]\(([^)#]+)\)", "\n".join(cell.source for cell in notebook.cells))
    assert all((file.parent / link).is_file() for link in links)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_cells_run(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    pyplot.switch_backend("agg")
    names: dict[str, Any] = {}
    for cell in read(file).cells:
        if cell.cell_type == "code":
            exec(compile(cell.source, file.name, "exec"), names)
    pyplot.close("all")
    assert not list(tmp_path.iterdir())
