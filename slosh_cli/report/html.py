"""One HTML page that needs nothing else: templates, style and script are files of the package."""

import base64
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

import jinja2
from markupsafe import Markup

from slosh_cli.results.files import FileError

_LARGEST: Final = 5_000_000
_KINDS: Final = {"png": "image/png", "svg": "image/svg+xml"}


def page_text(facts: Mapping[str, Any], data: Mapping[str, Any], figures: Mapping[str, Path]) -> str:
    """The page of `facts` (names of the template), `data` for its script, and figures from files, by name.

    Whatever the facts contain stays text. Raises FileError where the page would be larger than 5 MB.
    """
    folder = files("slosh_cli.report").joinpath("page")
    names = ("base.html", "page.css", "page.js", "train.js")
    parts = {name: folder.joinpath(name).read_text(encoding="utf-8") for name in names}
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.ChainableUndefined)
    environment.filters["short"] = short_number
    page = environment.from_string(parts["base.html"])
    text = page.render(
        facts,
        data=data,
        json=Markup(_json(data)),
        style=Markup(parts["page.css"]),
        script=Markup(parts["page.js"] + parts["train.js"]),
        figures=[{"name": name, "uri": _uri(path)} for name, path in figures.items()],
    )
    if len(text.encode("utf-8")) > _LARGEST:
        raise FileError("the report would be larger than 5 MB; give a smaller study")
    return text


def page_table(
    title: str, head: Sequence[str], rows: Sequence[Sequence[Any]], note: str = "", sortable: bool = False
) -> dict[str, Any]:
    """A table of a page: its rows are of cells that become text."""
    return {"title": title, "head": head, "rows": rows, "note": note, "sortable": sortable}


def short_number(text: Any) -> str:
    """A cell of a table to six digits where it is a number of more; any other as it is."""
    told = str(text)
    try:
        short = f"{float(told):.6g}"
    except ValueError:
        return told
    return short if len(short) < len(told) and math.isfinite(float(told)) else told


def plain_numbers(values: Iterable[Any]) -> list[float | None]:
    """Numbers as JSON has them, to seven digits; None for those that are not finite."""
    return [float(f"{value:.7g}") if math.isfinite(value) else None for value in map(float, values)]


def _json(data: Mapping[str, Any]) -> str:
    """JSON that ends no script element."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _uri(path: Path) -> str:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise FileError(f"cannot read {path}: {error.strerror or error}", where=str(path)) from error
    return f"data:{_KINDS[path.suffix[1:]]};base64,{base64.b64encode(content).decode('ascii')}"
