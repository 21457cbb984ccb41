"""The clock is set back, a worker hangs, the study's folder is removed while it runs."""

import shutil
import time
from pathlib import Path
from threading import Event
from types import SimpleNamespace
from typing import Any

import pytest
from study_tools import QuickSolver

from slosh_cli.application.studies import sweep
from slosh_cli.results.files import try_targets
from slosh_cli.scenario import Scenario
from slosh_cli.study import cluster as clusters
from slosh_cli.study import journal as journals
from slosh_cli.study.cluster import Cluster
from slosh_cli.study.table import TABLE


class Never:
    """A future that never ends."""

    def add_done_callback(self, _: object) -> None:
        """Nothing to call it for."""

    def cancel(self) -> None:
        """Nobody listens."""


VARY = {"braking.torque": "5,10 kN m"}


def test_a_clock_that_is_set_back_costs_no_stop_and_no_file(
    tmp_path: Path, paper: Scenario, solver: QuickSolver, monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep(paper, VARY, folder=tmp_path)
    table, part = (tmp_path / TABLE).read_bytes(), tmp_path / ".run.h5.0123abcd.part"
    part.write_text("of a process that is at work")
    monkeypatch.setattr(time, "time", lambda: 1e6)
    monkeypatch.setattr(journals, "_now", lambda: "1970-01-12T13:46:40.000+00:00")
    found = sweep(paper, VARY, folder=tmp_path)
    assert (found.reused, len(found.rows)) == (4, 4)
    assert (tmp_path / TABLE).read_bytes() == table
    try_targets(tmp_path, ["run.h5"])
    assert part.exists()
    longer = sweep(paper, {"braking.torque": "5,10,15 kN m"}, folder=tmp_path)
    assert (longer.reused, len(longer.rows)) == (4, 6)


def test_a_study_whose_folder_is_removed_while_it_runs_loses_nothing(
    tmp_path: Path, paper: Scenario, solver: QuickSolver
) -> None:
    expected = sweep(paper, VARY, folder=tmp_path / "whole", threads=1)
    folder = tmp_path / "removed"

    def remove(done: int, total: int) -> None:
        if done == 0:
            shutil.rmtree(folder)

    found = sweep(paper, VARY, folder=folder, threads=1, progress=remove)
    assert list(found.rows) == list(expected.rows)
    assert (folder / TABLE).read_bytes() == (tmp_path / "whole" / TABLE).read_bytes()
    assert sweep(paper, VARY, folder=folder).reused == 4


def test_a_worker_that_hangs_is_heard_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cluster gives an empty batch now and then, so that the command can say since when nothing came."""
    monkeypatch.setattr(clusters, "_POLL_SECONDS", 0.01)
    hanging: Any = Cluster.__new__(Cluster)
    hanging.__dict__.update(_batches={}, _done=clusters.queue.SimpleQueue(), _seconds=[], _threads=1, _counted=0.0)
    hanging._client = SimpleNamespace(status="running", submit=lambda *_, **__: Never(), nthreads=lambda: {"a": 1})
    batches = hanging.outcomes([object()], 1, Event())
    assert [next(batches), next(batches)] == [[], []]
    batches.close()
    assert not hanging._batches
