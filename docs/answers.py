"""The page of answers and channels, from the tables that every output derives from.

`python docs/answers.py` writes ``answers.md`` beside itself; a test says when that is due.
"""

from __future__ import annotations

import re
from pathlib import Path

from slosh_cli.results.answers import Answer, PerWheel, Shown
from slosh_cli.results.channels import CHANNELS, LINE_CHANNELS, TIME, channel, slosh_amplitude
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario

PAGE = Path(__file__).with_name("answers.md")
INTRODUCTION = """# What a run answers

Made by `python docs/answers.py` from the tables that the program itself uses.

## Answers

Each is an attribute of a `Result` in Python. `run.h5` and `--json` have it by the same name where the table says so,
`summary.csv` and the table of `slosh sweep` as the column named here. What is given per wheel is a list there and a
column per wheel, number `i`, in tables; wheel 1 leads.

| name | unit | meaning | comes from | `--json` | `run.h5` | `summary.csv` | `slosh sweep` |
|---|---|---|---|---|---|---|---|
"""
CHANNEL_HEAD = """
## Channels

The histories of `run.h5`, `to_frame()` and `to_xarray()`.

| name | unit | meaning |
|---|---|---|
"""


def page() -> str:
    """The whole page."""
    channels = [TIME, *CHANNELS.values(), channel(slosh_amplitude(1)), *LINE_CHANNELS.values()]
    rows = dict.fromkeys(
        f"| `{numbered(one.name)}` | {unit(one.unit)} | {numbered(one.long_name)} |\n" for one in channels
    )
    return INTRODUCTION + "".join(map(answer_row, Result.table())) + CHANNEL_HEAD + "".join(rows)


def answer_row(one: Answer) -> str:
    """One line of the table of answers."""
    meaning = f"{one.meaning} (per wheel)" if one.kind == PerWheel else one.meaning
    key = one.given.split(".")[0] in Scenario.model_fields
    source = f"`{one.given}`" if key else "the scenario" if one.given else "other answers" if one.of else "the run"
    columns = numbered(one.columns[0]) if one.kind == PerWheel else one.columns[0]
    shown = {Shown.JSON: "yes", Shown.HISTORY: "yes", Shown.SUMMARY: f"`{columns}`", Shown.STUDY: f"`{columns}`"}
    cells = [text if output in one.shown else "" for output, text in shown.items()]
    return f"| `{one.name}` | {unit(one.unit)} | {meaning} | {source} | {' | '.join(cells)} |\n"


def unit(text: str) -> str:
    """A unit; `-` for a number without one."""
    return "-" if text == "1" else text


def numbered(text: str) -> str:
    """The text of one wheel, bogie or mode as that of number i."""
    return re.sub(r"(?<=_)\d(?=_)|(?<=wheel )\d|(?<=bogie )\d|(?<=mode )\d", "i", text)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
