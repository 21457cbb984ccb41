"""Arguments and options that several commands share, so that they read the same everywhere."""

from pathlib import Path
from typing import Annotated, Any

import typer


def option(names: str, metavar: str, text: str, **more: Any) -> Any:
    """An option with a value that has no default, or says it in its `text`; `names` are apart by blanks."""
    return typer.Option(*names.split(), metavar=metavar, help=text, show_default=False, **more)


ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="Scenario file (YAML).", show_default=False)]
Overrides = Annotated[
    list[str] | None,
    option(
        "--set",
        "KEY=VALUE",
        "Change one value of the scenario: --set braking.torque='12 kN m'. May be repeated.",
    ),
]
AsJson = Annotated[
    bool, typer.Option("--json", help="Print exactly one JSON object on stdout, everything else on stderr.")
]
OutputFolder = Annotated[
    Path | None,
    option("--output -o", "DIR", "Folder for the files. Default: outputs/, the scenario's name and what was --set."),
]
Threaded = Annotated[int | None, option("--jobs", "N", "Threads. Default: one per core.", min=1)]
