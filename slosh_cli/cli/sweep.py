"""`slosh sweep`: a grid of stops, liquid and equivalent solid each."""

import os
import time
from pathlib import Path
from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, Overrides, option
from slosh_cli.errors import UsageError

_ONE_THREAD: Final = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""Variables that keep linear algebra to the thread that calls it: the stops share the cores among them already."""

_FILE: Final = "Scenario, train or study file (YAML; a study has base: and vary:). Default: the wagon of the paper."
_ScenarioOrStudy = Annotated[Path | None, typer.Argument(metavar="SCENARIO", help=_FILE, show_default=False)]
_SPEEDS: Final = """Initial speeds, in km/h where no unit is given: a list or a range. Default: three around
the scenario's own, 80,160 without SCENARIO; with --vary alone, the scenario's own."""
_Speeds = Annotated[str | None, option("--v0", "LIST", _SPEEDS)]
_TORQUES: Final = """Brake torques per wheel, in kN m where no unit is given. Default: six around the
scenario's own, 2.5:30:2.5 (start:stop:step, both ends in) without SCENARIO; with --vary alone, the scenario's own."""
_Torques = Annotated[str | None, option("--torque", "LIST", _TORQUES)]
_VARY: Final = """Vary any key of the scenario: --vary tank.fill=0.2:0.9:0.1, --vary 'wagon.pivot_spacing=10:14:1 m',
--vary contact.adhesion=dry,wet. Of a train: all.KEY, vehicles.N.KEY or a key of its own, --vary
all.braking.application=P,G, --vary coupling=screw,automatic. May be repeated."""
_Vary = Annotated[list[str] | None, option("--vary", "KEY=LIST", _VARY)]
_LIQUIDS: Final = "Models of the load. Default: the scenario's own (the paper's: modal) and rigid."
_Liquids = Annotated[str | None, option("--liquid", "LIST", _LIQUIDS)]
_FOLDER: Final = "Folder of the study. Default: outputs/, the study's name and what was --set."
_StudyFolder = Annotated[Path | None, option("--output -o", "DIR", _FOLDER)]
_Jobs = Annotated[int | None, option("--jobs", "N", "Threads. Default: one per core.", min=1)]
_CLUSTER: Final = "Compute on the workers of a Dask scheduler, tcp://host:8786 (needs Dask)."
_ClusterAddress = Annotated[str | None, option("--cluster", "ADDRESS", _CLUSTER)]
_Histories = Annotated[bool, typer.Option("--histories", help="Keep the history of every stop (HDF5).")]
_Fresh = Annotated[bool, typer.Option("--fresh", help="Forget what was computed before and start over.")]
_SHOW: Final = """Answers to draw and to print instead of the distance: --show unloading,first_lock,distance, or any
name of an answer in the table."""
_Show = Annotated[str | None, option("--show", "LIST", _SHOW)]
_Along = Annotated[str, option("--x", "KEY", "Key along the horizontal axis. Default: torque, else speed.")]
_Curves = Annotated[str, option("--curves", "KEY", "Key that makes curves, beside the models of the load.")]
_Panels = Annotated[
    str, option("--panels", "KEY", "Key that makes panels. Default: speed, else the first that is left.")
]
_DryRun = Annotated[bool, typer.Option("--dry-run", help="Say how many stops and about how long, no more.")]


def sweep_command(
    scenario_file: _ScenarioOrStudy = None,
    speeds: _Speeds = None,
    torques: _Torques = None,
    vary: _Vary = None,
    liquids: _Liquids = None,
    overrides: Overrides = None,
    output: _StudyFolder = None,
    jobs: _Jobs = None,
    cluster: _ClusterAddress = None,
    histories: _Histories = False,
    fresh: _Fresh = False,
    dry_run: _DryRun = False,
    show: _Show = None,
    x: _Along = "",
    curves: _Curves = "",
    panels: _Panels = "",
    as_json: AsJson = False,
) -> ExitCode:
    """Run a grid of stops and compare liquid with solid (Figure 3).

    Every finished stop is kept at once: the same command continues a study that was interrupted, and one that was
    extended computes only what is new. Without -o another study of the same name gets a folder with a number.
    """
    began = time.perf_counter()
    for variable in _ONE_THREAD:
        os.environ[variable] = "1"
    from slosh_cli.application.studies import study_folder
    from slosh_cli.cli.output import note
    from slosh_cli.cli.sweep_task import Task, carry_out, estimate
    from slosh_cli.report.study_pages import View
    from slosh_cli.study.build import Wishes, build

    if jobs is not None and cluster is not None:
        raise UsageError("--jobs is for this machine; a cluster has its own threads: leave one of them out", "--jobs")
    study = build(Wishes(scenario_file, overrides or (), speeds, torques, vary or (), liquids, histories))
    view = View(tuple(name.strip() for name in (show or "").split(",") if name.strip()), x, curves, panels)
    folder = study_folder(study, output, overrides, note)
    task = Task(study, folder, jobs, cluster, fresh=fresh, as_json=as_json, began=began, view=view)
    return estimate(task) if dry_run else carry_out(task)
