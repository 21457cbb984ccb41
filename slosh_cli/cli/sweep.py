"""`slosh sweep`: a grid of stops, liquid and equivalent solid each."""

import os
import time
from pathlib import Path
from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, Overrides
from slosh_cli.errors import UsageError

ONE_THREAD: Final = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""Variables that keep linear algebra to the thread that calls it: the stops share the cores among them already."""


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("sweep")(sweep)


def sweep(
    scenario_file: Annotated[
        Path | None,
        typer.Argument(
            metavar="[SCENARIO]",
            help="Scenario or study file (YAML; a study has base: and vary:). Default: the wagon of the paper.",
            show_default=False,
        ),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            "--v0", metavar="LIST", show_default=False,
            help="Initial speeds, in km/h where no unit is given: a list or a range. Default: 80,160; "
            "with --vary alone, the scenario's own.",
        ),
    ] = None,
    torques: Annotated[
        str | None,
        typer.Option(
            "--torque", metavar="LIST", show_default=False,
            help="Brake torques per wheel, in kN m where no unit is given. Default: 2.5:30:2.5 (start:stop:step, both "
            "ends in); with --vary alone, the scenario's own.",
        ),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary", metavar="KEY=LIST", show_default=False,
            help="Vary any key of the scenario: --vary tank.fill=0.2:0.9:0.1, --vary 'wagon.pivot_spacing=10:14:1 m', "
            "--vary contact.adhesion=dry,wet. May be repeated.",
        ),
    ] = None,
    liquids: Annotated[
        str | None,
        typer.Option(
            "--liquid", metavar="LIST", show_default=False,
            help="Models of the load. Default: the scenario's own (the paper's: modal) and rigid.",
        ),
    ] = None,
    overrides: Overrides = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="DIR", show_default=False,
            help="Folder of the study. Default: outputs/ and the study's name.",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option("--jobs", metavar="N", min=1, show_default=False, help="Threads. Default: one per core."),
    ] = None,
    cluster: Annotated[
        str | None,
        typer.Option(
            "--cluster", metavar="ADDRESS", show_default=False,
            help="Compute on the workers of a Dask scheduler, tcp://host:8786 (needs slosh-cli[cluster]).",
        ),
    ] = None,
    histories: Annotated[bool, typer.Option("--histories", help="Keep the history of every stop (HDF5).")] = False,
    fresh: Annotated[bool, typer.Option("--fresh", help="Forget what was computed before and start over.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say how many stops and about how long, no more.")] = False,
    as_json: AsJson = False,
) -> ExitCode:  # fmt: skip
    """Run a grid of stops and compare liquid with solid (Figure 3).

    Every finished stop is kept at once: the same command continues a study that was interrupted, and a study that
    has changed computes only what is new.
    """
    began = time.perf_counter()
    for variable in ONE_THREAD:
        os.environ[variable] = "1"
    from slosh_cli.cli.sweep_task import Task, estimate, run
    from slosh_cli.study.build import Wishes, build

    if jobs is not None and cluster is not None:
        raise UsageError("--jobs is for this machine; a cluster has its own threads: leave one of them out", "--jobs")
    study = build(Wishes(scenario_file, overrides or (), speeds, torques, vary or (), liquids, histories))
    folder = output or Path("outputs") / study.name
    task = Task(study, folder, jobs, cluster, fresh=fresh, as_json=as_json, began=began)
    return estimate(task) if dry_run else run(task)
