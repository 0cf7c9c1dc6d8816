"""Studies on a Dask cluster of this machine, of which parts are lost: the table is the same each time.

The rows are single runs, because a rate of rotation is not among what batches give.
"""

import importlib.util
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future

import pytest
from tests.unit.study.test_study import WALL, count, rows_of, written

from crumple.errors import InputError
from crumple.study import LoadedStudy, run_study
from crumple.study.cluster import ClusterExecutor

pytestmark = [
    pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="Dask is not installed"),
    pytest.mark.skipif(os.name == "nt", reason="processes are stopped by signals"),
]
RATE = "{channel: node.tip.rotation_rate.y, take: max}"
ROWS = 60
BEGIN = 60.0  # [s] for a process of Dask; a busy machine takes seconds


class Cluster:
    """A scheduler and workers with one thread each, bound to this machine alone."""

    def __init__(self, folder):
        self._file, self._workers = folder / "scheduler.json", []
        self._scheduler = self._started("scheduler", "--port", "0", "--no-show", "--no-dashboard",
                                        "--scheduler-file", self._file)  # fmt: skip
        until(self._file.exists)

    @property
    def address(self):
        import json

        return json.loads(self._file.read_text())["address"]

    def add(self):
        self._workers.append(
            self._started("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        )

    def kill(self, which):
        self._workers[which].kill()
        self._workers[which].wait()

    def stop(self, which):
        self._workers[which].send_signal(signal.SIGSTOP)

    def kill_scheduler(self):
        self._scheduler.kill()
        self._scheduler.wait()

    def end(self):
        for process in (*self._workers, self._scheduler):
            process.kill()
            process.wait()

    def _started(self, kind, *arguments):
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--host", "127.0.0.1", *arguments]
        if kind == "worker":
            command = [
                sys.executable,
                "-m",
                f"distributed.cli.dask_{kind}",
                *arguments,
                "--host",
                "127.0.0.1",
            ]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        return subprocess.Popen(list(map(str, command)), cwd=self._file.parent, **quiet)


def until(condition):
    end = time.monotonic() + BEGIN
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture
def cluster(tmp_path):
    found = Cluster(tmp_path)
    try:
        found.add()
        found.add()
        yield found
    finally:
        found.end()


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study, and its rows solved without a cluster."""
    folder = tmp_path_factory.mktemp("whole")
    file = written(folder, f"{{type: latin_hypercube, rows: {ROWS}, seed: 3}}", WALL, RATE)
    run_study(LoadedStudy(file), folder, 2)
    return file, rows_of(folder)


def solved(file, folder, executor):
    folder.mkdir(exist_ok=True)
    return run_study(LoadedStudy(file), folder, executor.workers, executor=executor)


def while_solving(folder, action, rows=4):
    """Do something as soon as some rows are known."""

    def act():
        until(lambda: count(folder) >= rows)
        action()
        assert count(folder) < ROWS

    thread = threading.Thread(target=act)
    thread.start()
    return thread


def two_workers(executor):
    until(lambda: executor.workers == 2)
    return executor


@pytest.mark.slow
def test_a_worker_is_killed_while_it_works(cluster, study, tmp_path):
    file, whole = study
    with ClusterExecutor(cluster.address) as executor:
        thread = while_solving(tmp_path / "a", lambda: cluster.kill(0))
        _, answer = solved(file, tmp_path / "a", two_workers(executor))
        thread.join()
    assert answer.solved == ROWS
    assert rows_of(tmp_path / "a") == whole


@pytest.mark.slow
def test_a_worker_that_never_answers(cluster, study, tmp_path):
    """Its work goes to the other one after the limit."""
    file, whole = study
    with ClusterExecutor(cluster.address) as executor:
        # a worker's first work contains its imports
        solved(file, tmp_path / "first", two_workers(executor))
    with ClusterExecutor(cluster.address, limit=5.0) as executor:
        thread = while_solving(tmp_path / "a", lambda: cluster.stop(0))
        _, answer = solved(file, tmp_path / "a", two_workers(executor))
        thread.join()
    assert answer.solved == ROWS
    assert rows_of(tmp_path / "a") == whole


@pytest.mark.slow
def test_no_worker_answers(cluster, study, tmp_path):
    file, _ = study
    with ClusterExecutor(cluster.address, limit=1.0) as executor:
        two_workers(executor)
        cluster.stop(0)
        cluster.stop(1)
        with pytest.raises(InputError, match="work had no answer within 1 s"):
            solved(file, tmp_path / "a", executor)


@pytest.mark.slow
def test_a_scheduler_that_goes_away(cluster, study, tmp_path, run_command):
    """The rows so far are kept, and --resume goes on with another one."""
    file, whole = study
    folder = tmp_path / "a"
    with ClusterExecutor(cluster.address) as executor:
        thread = while_solving(folder, cluster.kill_scheduler)
        with pytest.raises(InputError, match="the scheduler went away") as refused:
            solved(file, folder, two_workers(executor))
        thread.join()
    assert "go on with --resume" in str(refused.value)
    known = count(folder)
    assert 4 <= known < ROWS
    (tmp_path / "again").mkdir()
    again = Cluster(tmp_path / "again")
    try:
        again.add()
        code, out, err = run_command("study", file, "--out", folder, "--scheduler", again.address, "--resume")
    finally:
        again.end()
    assert (code, err) == (0, "")
    assert f"{ROWS - known} solved now" in out
    assert rows_of(folder) == whole


@pytest.mark.slow
def test_batches_on_a_cluster_have_the_bits_of_those_here(cluster, tmp_path):
    file = written(tmp_path, "{type: sobol, rows: 64}", WALL)
    (tmp_path / "here").mkdir()
    run_study(LoadedStudy(file), tmp_path / "here")
    with ClusterExecutor(cluster.address) as executor:
        solved(file, tmp_path / "there", executor)
        # a mistake of a worker's call ends the study in plain words
        with pytest.raises(InputError, match="a worker failed: ZeroDivisionError"):
            executor.submit(divmod, 1, 0).result()
    assert rows_of(tmp_path / "here") == rows_of(tmp_path / "there")


def test_no_scheduler_and_no_extra(study, tmp_path, monkeypatch, run_command):
    from crumple.study import cluster as module

    monkeypatch.setattr(module, "CONNECTING", 0.2)
    command = ["study", study[0], "--out", tmp_path, "--scheduler"]
    for address in ("tcp://127.0.0.1:1", "nowhere://x"):
        code, _, err = run_command(*command, address)
        assert code == 2
        assert "no scheduler answers" in err
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, _, err = run_command(*command, "tcp://127.0.0.1:1")
    assert code == 2
    assert "install crumple[cluster]" in err


def test_a_scheduler_without_workers(tmp_path, monkeypatch):
    from crumple.study import cluster as module

    monkeypatch.setattr(module, "FIRST_WORKER", 0.2)
    lonely = Cluster(tmp_path)
    try:
        with pytest.raises(InputError, match="the scheduler has no worker"):
            ClusterExecutor(lonely.address)
    finally:
        lonely.end()


def test_a_worker_of_another_version(monkeypatch):
    from crumple.study import cluster as module

    assert module._called(module.__version__, Future) is not None
    with pytest.raises(InputError, match="another version of Crumple"):
        module._called("0.0.1", Future)
