"""Tables, figures and JSON from a run of the benchmarks: `python -m tests.benchmarks [--docs]`.

Reads what `make bench` left in `outputs/bench/`, a file for each part that was run; writes `ratios.json` and the
figures beside them. With `--docs` the figures go to `docs/images/`, too, and the tables into `docs/speed.md`, between
their markers.
"""

import argparse
import json
import re
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from .figures import draw
from .records import of_kind, ratios, read
from .tables import TABLES, markdown

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "outputs" / "bench"
PAGE, IMAGES = ROOT / "docs" / "speed.md", ROOT / "docs" / "images"


def show(records: list[dict[str, Any]]) -> None:
    """All tables on the terminal."""
    console = Console(width=None if sys.stdout.isatty() else 160)
    for name, table in TABLES.items():
        head, rows = table(records)
        shown = Table(*head, title=name, title_justify="left")
        for row in rows:
            shown.add_row(*row)
        console.print(shown)
    if not any(one["contestant"] == "c" for one in of_kind(records, "contestant")):
        from .multibody import LEFT_OUT

        console.print(LEFT_OUT, markup=False)


def fill_page(text: str, records: list[dict[str, Any]]) -> str:
    """The page with its tables put between `<!-- bench NAME -->` and `<!-- end -->`."""

    def filled(match: re.Match[str]) -> str:
        return f"<!-- bench {match[1]} -->\n\n{markdown(TABLES[match[1]](records))}\n\n<!-- end -->"

    return re.sub(r"<!-- bench (\w+) -->.*?<!-- end -->", filled, text, flags=re.DOTALL)


def main() -> None:
    """Read, show, write."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--docs", action="store_true", help="renew docs/speed.md and its figures")
    given, records = parser.parse_args(), read(FOLDER)
    show(records)
    lines = [asdict(one) | {"verdict": one.verdict} for one in ratios(records)]
    (FOLDER / "ratios.json").write_text(json.dumps({"ratios": lines, "records": records}, indent=1), encoding="utf-8")
    files = [FOLDER / "ratios.json", *draw(records, FOLDER)]
    if given.docs:
        PAGE.write_text(fill_page(PAGE.read_text(encoding="utf-8"), records), encoding="utf-8")
        files += [PAGE, *draw(records, IMAGES, ("png",))]
    sys.stdout.write("".join(f"  {file.relative_to(ROOT)}\n" for file in files))


if __name__ == "__main__":
    main()
