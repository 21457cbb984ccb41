"""A Dask cluster of real processes on this machine: the same rows, and nothing lost when a worker dies."""

import contextlib
import json
import logging
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from study_tools import CHEAP, QuickSolver, journal_rows, run_slosh, start_slosh

from slosh_cli.errors import UsageError
from slosh_cli.study import cluster
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.cluster import Cluster, ClusterError, _solve_batch, _this_version
from slosh_cli.study.key import RESULT_VERSION

TABLE = "outputs/cheap/braking_distance.csv"
JOURNAL = "outputs/cheap/journal.sqlite"

needs_dask = pytest.mark.skipif(shutil.which("dask", path=str(Path(sys.executable).parent)) is None, reason="no Dask")


def address_in(file: Path) -> str:
    """The address that a scheduler writes into its file once it is there."""
    deadline = time.monotonic() + 60.0
    while not file.exists() or not file.read_text().strip().endswith("}"):
        assert time.monotonic() < deadline, "no scheduler"
        time.sleep(0.02)
    return str(json.loads(file.read_text())["address"])


class Processes:
    """A scheduler and two workers, each a process that can be killed."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.scheduler = self._start("scheduler", "--scheduler-file", "scheduler.json", "--port", "0")
        self.address = address_in(folder / "scheduler.json")
        self.workers: list[subprocess.Popen[bytes]] = []
        self.complete()

    def _start(self, what: str, *arguments: str) -> "subprocess.Popen[bytes]":
        command = [sys.executable, "-m", "dask", what, "--host", "127.0.0.1", "--no-dashboard", *arguments]
        quiet = subprocess.DEVNULL
        return subprocess.Popen(command, cwd=self._folder, stdout=quiet, stderr=quiet)

    def complete(self) -> None:
        """Start workers until there are two."""
        self.workers = [worker for worker in self.workers if worker.poll() is None]
        while len(self.workers) < 2:
            self.workers.append(
                self._start("worker", "--nthreads", "1", "--no-nanny", "--scheduler-file", "scheduler.json")
            )

    def stop(self) -> None:
        for process in (*self.workers, self.scheduler):
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            process.wait()


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Processes]:
    running = Processes(tmp_path_factory.mktemp("cluster"))
    yield running
    running.stop()


@pytest.fixture
def processes(shared: Processes) -> Processes:
    """A scheduler and two live workers; a test may kill workers."""
    shared.complete()
    return shared


def sweep(stops: int, *more: object) -> list[object]:
    return ["sweep", *CHEAP, "--torque", f"2.1:{2 + 0.1 * (stops // 2):g}:0.1", "--json", *more]


def folder(parent: Path, name: str) -> Path:
    made = parent / name
    made.mkdir()
    return made


@needs_dask
def test_the_rows_are_the_same_to_the_last_bit_on_one_thread_two_threads_and_a_cluster(
    tmp_path: Path, processes: Processes
) -> None:
    tables = {}
    grid = ["sweep", "--v0", "40", "--torque", "5:25:4", "--set", "name=cheap", "--set", "solver.tolerance=1e-3"]
    grid += ["--set", "tank.coefficients=computed", "--json"]
    for name, how in {"one": ["--jobs", 1], "two": ["--jobs", 2], "dask": ["--cluster", processes.address]}.items():
        where = folder(tmp_path, name)
        code, out, err = run_slosh(where, *grid, *how)
        assert code in (0, 3), err
        assert json.loads(out)["runs"] == 12
        tables[name] = (where / TABLE).read_bytes()
    assert tables["one"] == tables["two"] == tables["dask"]
    assert len(tables["one"].splitlines()) == 13


TRAIN = """\
format: 1
name: cheap
vehicles:
  - {scenario: tank-wagon, count: 3, set: {tank.liquid.model: rigid, tank.coefficients: computed}}
braking: {initial_speed: 6 km/h, onset: 0.1 s, stop_speed: 0.2 m/s}
solver: {tolerance: 1.0e-2}
"""


@needs_dask
def test_the_rows_of_trains_are_the_same_on_one_thread_two_threads_and_a_cluster(
    tmp_path: Path, processes: Processes
) -> None:
    train = tmp_path / "train.yaml"
    train.write_text(TRAIN, encoding="utf-8")
    grid = ["sweep", train, "--v0", "5,6", "--vary", "vehicles.2.tank.fill=0.4,0.6", "--json"]
    grid += ["--vary", "coupling=screw,automatic"]
    tables = []
    for name, how in {"one": ["--jobs", 1], "two": ["--jobs", 2], "dask": ["--cluster", processes.address]}.items():
        where = folder(tmp_path, name)
        code, out, err = run_slosh(where, *grid, *how)
        assert code == 0, err
        assert json.loads(out)["done"] == 8
        tables.append((where / TABLE).read_bytes())
    assert tables[0] == tables[1] == tables[2]
    assert len(tables[0].splitlines()) == 9


@needs_dask
@pytest.mark.parametrize("stops", [120, pytest.param(600, marks=pytest.mark.slow)])
def test_a_worker_that_is_killed_midway_loses_nothing(tmp_path: Path, processes: Processes, stops: int) -> None:
    local, remote = folder(tmp_path, "local"), folder(tmp_path, "remote")
    code, _, err = run_slosh(local, *sweep(stops))
    assert code in (0, 3), err
    command = start_slosh(remote, *sweep(stops, "--cluster", processes.address))
    while len(journal_rows(remote / JOURNAL)) < stops // 6 and command.poll() is None:
        time.sleep(0.01)
    processes.workers[0].send_signal(signal.SIGKILL)
    out, err = command.communicate(timeout=300)
    assert command.returncode in (0, 3), err
    answer = json.loads(out)
    assert (answer["runs"], answer["done"] + answer["failed"], answer["reused"]) == (stops, stops, 0)
    assert (remote / TABLE).read_bytes() == (local / TABLE).read_bytes()
    assert "died" not in err


@needs_dask
def test_a_scheduler_that_is_lost_is_a_clear_error_and_the_study_goes_on(tmp_path: Path, shared: Processes) -> None:
    shared.complete()
    command = start_slosh(tmp_path, *sweep(600, "--cluster", shared.address))
    while len(journal_rows(tmp_path / JOURNAL)) < 10 and command.poll() is None:
        time.sleep(0.01)
    shared.scheduler.send_signal(signal.SIGKILL)  # no later test needs it
    out, err = command.communicate(timeout=120)
    assert command.returncode == 2, err
    error = json.loads(out)["error"]
    assert error["code"] == "cluster"
    assert f"lost the Dask scheduler at {shared.address}" in error["message"]
    assert "every stop received before is kept" in err
    assert "Traceback" not in err
    kept = len(journal_rows(tmp_path / JOURNAL))
    assert kept >= 10
    _, out, _ = run_slosh(tmp_path, *sweep(600))
    assert json.loads(out)["reused"] >= kept


@needs_dask
def test_an_address_where_nobody_answers_is_a_clear_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_CONNECT_SECONDS", 0.3)
    with pytest.raises(ClusterError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:1"):
        Cluster("tcp://127.0.0.1:1")
    with pytest.raises(ClusterError, match="no Dask scheduler answers at nonsense:"):
        Cluster("nonsense:")


NO_CERTIFICATES = {f"DASK_DISTRIBUTED__COMM__TLS__{end}" for end in ("CA_FILE", "CLIENT__CERT", "CLIENT__KEY")}


@needs_dask
def test_an_encrypted_address_without_certificates_is_a_clear_error(tmp_path: Path) -> None:
    assert not NO_CERTIFICATES & set(os.environ)
    code, _, err = run_slosh(tmp_path, *sweep(2, "--cluster", "tls://127.0.0.1:1"))
    assert code == 2, err
    assert "tls://127.0.0.1:1 needs certificates: name them under distributed.comm.tls" in err
    assert "Traceback" not in err


@needs_dask
@pytest.mark.skipif(shutil.which("openssl") is None, reason="no openssl to make certificates with")
def test_a_cluster_with_certificates_is_reached_by_the_configuration_of_dask(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make = "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=slosh -addext subjectAltName=IP:127.0.0.1"
    files = ["-keyout", "key.pem", "-out", "cert.pem"]
    subprocess.run(["openssl", *make.split(), *files], cwd=tmp_path, check=True, capture_output=True)
    cert, key = str(tmp_path / "cert.pem"), str(tmp_path / "key.pem")
    ends = {end: {"cert": cert, "key": key} for end in ("client", "scheduler")}
    settings = {"distributed": {"comm": {"tls": {"ca-file": cert, **ends}, "require-encryption": True}}}
    (tmp_path / "dask.yaml").write_text(json.dumps(settings))
    monkeypatch.setenv("DASK_CONFIG", str(tmp_path / "dask.yaml"))
    words = [sys.executable, "-m", "dask", "scheduler", "--protocol", "tls", "--host", "127.0.0.1", "--no-dashboard"]
    words += ["--port", "0", "--scheduler-file", "scheduler.json"]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as scheduler:
        try:
            address = address_in(tmp_path / "scheduler.json")
            assert address.startswith("tls://")
            code = f"from slosh_cli.study.cluster import Cluster; print(Cluster({address!r}).words)"
            asked = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
            assert asked.stdout == f"the cluster at {address}, which has no workers yet\n", asked.stderr
        finally:
            scheduler.kill()


def test_without_dask_the_user_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError, match=r"pip install .distributed"):
        Cluster("tcp://127.0.0.1:8786")


def test_a_worker_with_another_version_refuses_the_batch() -> None:
    with pytest.raises(ClusterError, match=r"a worker has slosh .*, but the study needs slosh 99"):
        _solve_batch((), "slosh 99")


class StandIn:
    """A Dask client whose futures end as they are told, at once."""

    status = "running"

    def __init__(self, endings: Any) -> None:
        self._endings = endings
        self.batches: list[int] = []

    def nthreads(self) -> dict[str, int]:
        return {"one": 1, "two": 1}

    def submit(self, function: Any, batch: Any, needed: str, *, pure: bool) -> Any:
        self.batches.append(len(batch))
        return self._endings(function, batch, needed)


class Future:
    """A future that has ended with a value or an error, or whose value is `lost` on its way."""

    def __init__(
        self, value: Any = None, error: Exception | None = None, status: str = "", lost: Exception | None = None
    ) -> None:
        self._value, self._error, self._lost = value, error, lost
        self.status = status or ("error" if error else "finished")

    def add_done_callback(self, call: Any) -> None:
        call(self)

    def exception(self) -> Exception | None:
        return self._error

    def result(self) -> Any:
        if self._lost is not None:
            raise self._lost
        return self._value

    def cancel(self) -> None:
        """Nothing is on its way."""


@pytest.fixture
def connected(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A Cluster whose client is a stand-in with the given endings."""
    distributed = pytest.importorskip("distributed")

    def make(endings: Any) -> tuple[Cluster, StandIn]:
        client = StandIn(endings)
        monkeypatch.setattr(distributed, "Client", lambda *_, **__: client)
        return Cluster("tcp://somewhere:8786"), client

    return make


def outcomes(study: Any, workers: Cluster) -> list[Any]:
    import threading

    stops = (study.stop(index) for index in range(study.size))
    return [one for batch in workers.outcomes(stops, study.size, threading.Event()) for one in batch]


STUDY = Wishes(speeds="20:59:1", torques="5", liquids="rigid")


def test_a_stop_that_kills_every_worker_fails_alone(connected: Any, solver: QuickSolver) -> None:
    from distributed import KilledWorker

    def ending(function: Any, batch: Any, needed: str) -> Future:
        if any(stop.index == 17 for stop in batch):
            return Future(error=KilledWorker("solve_batch", None, 3))
        return Future(function(batch, needed))

    workers, _ = connected(ending)
    found = sorted(outcomes(build(STUDY), workers), key=lambda one: one.index)
    assert [one.index for one in found] == list(range(40))
    assert [one.index for one in found if one.status != "stopped"] == [17]
    assert not found[17].final
    assert "every worker that computed this stop died" in found[17].answer["reason"]


def test_batches_grow_to_a_few_seconds_of_work_and_shrink_towards_the_end(
    connected: Any, solver: QuickSolver, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "_BATCH_SECONDS", 0.05)
    workers, client = connected(lambda function, batch, needed: Future(function(batch, needed)))
    found = outcomes(build(Wishes(speeds="20:59:0.1", torques="5", liquids="rigid")), workers)
    assert sorted(one.index for one in found) == list(range(391))
    assert client.batches[0] == 4
    assert 8 <= max(client.batches) <= 391 // 4 + 1
    assert client.batches[-1] == 1


def test_no_part_of_dask_adds_a_traceback_of_its_own(connected: Any) -> None:
    own = logging.getLogger("distributed.client")  # has a level of its own; a user's settings may give others one
    own.setLevel(logging.WARNING)
    connected(lambda *_: Future())
    for name in (
        "distributed.batched",
        "distributed.comm.tcp",
        "distributed.never_seen",
        "tornado.application",
        "asyncio",
    ):
        assert not logging.getLogger(name).isEnabledFor(logging.ERROR), name
    assert not own.isEnabledFor(logging.ERROR)


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (ModuleNotFoundError("No module named 'slosh_cli'"), "the workers need slosh 0.1.0 and Dask"),
        (ClusterError("a worker has slosh 0"), "a worker has slosh 0"),
        (MemoryError("too much"), "a worker failed: MemoryError: too much"),
    ],
)
def test_what_is_wrong_with_the_workers_reaches_the_user(connected: Any, error: Exception, message: str) -> None:
    workers, _ = connected(lambda *_: Future(error=error))
    with pytest.raises(ClusterError, match=message):
        outcomes(build(STUDY), workers)


def test_futures_that_the_scheduler_lost_end_the_study(connected: Any) -> None:
    workers, _ = connected(lambda *_: Future(status="cancelled"))
    with pytest.raises(ClusterError, match="lost the Dask scheduler"):
        outcomes(build(STUDY), workers)


def test_outcomes_that_die_with_their_worker_are_computed_again(connected: Any, solver: QuickSolver) -> None:
    class Recomputed(Future):
        """Finished, lost with its worker, finished again."""

        def add_done_callback(self, call: Any) -> None:
            self.status = "finished" if self.status == "lost" else "lost"
            call(self)

        def result(self) -> Any:
            assert self.status == "finished"
            return super().result()

    workers, _ = connected(lambda function, batch, needed: Recomputed(function(batch, needed)))
    assert len({one.index for one in outcomes(build(STUDY), workers)}) == 40


def test_outcomes_that_are_lost_on_their_way_here_end_the_study(connected: Any) -> None:
    from distributed import CancelledError
    from distributed.comm import CommClosedError

    for error in (CommClosedError("stream is closed"), CancelledError(), TimeoutError()):
        workers, _ = connected(lambda *_, error=error: Future(lost=error))
        with pytest.raises(ClusterError, match="lost the Dask scheduler"):
            outcomes(build(STUDY), workers)
    workers, _ = connected(lambda *_: Future(lost=ValueError("not about the connection")))
    with pytest.raises(ValueError, match="not about the connection"):
        outcomes(build(STUDY), workers)


@pytest.mark.parametrize("request_", ["submit", "nthreads", "scheduler_info"])
def test_a_scheduler_lost_in_the_middle_of_a_request_is_told(connected: Any, request_: str) -> None:
    workers, client = connected(lambda *_: Future())

    def gone(*_: Any, **__: Any) -> Any:
        client.status = "closed"
        raise RuntimeError("Client is closed")

    setattr(client, request_, gone)
    with pytest.raises(ClusterError, match="lost the Dask scheduler"):
        _ = workers.words if request_ == "scheduler_info" else outcomes(build(STUDY), workers)


def test_a_lost_connection_ends_the_study_though_no_future_says_so(
    connected: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Pending(Future):
        def add_done_callback(self, call: Any) -> None:
            """It never ends."""

    monkeypatch.setattr(cluster, "_POLL_SECONDS", 0.01)
    workers, client = connected(lambda *_: Pending())
    monkeypatch.setattr(client, "status", "closed", raising=False)
    with pytest.raises(ClusterError, match="lost the Dask scheduler"):
        outcomes(build(STUDY), workers)


def test_both_ends_share_program_and_result_version() -> None:
    assert _this_version().startswith("slosh ")
    assert f"results {RESULT_VERSION}" in _this_version()
