"""Kill -9, a full disk, a folder that cannot be written, two runs at once: files are whole or absent.

The summary stands only beside complete results of its own run, and the next run clears up and succeeds.
Commands run in processes forked from one that has imported everything, so that kills fall into the work.
"""

from __future__ import annotations

import ctypes
import json
import os
import random
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
import pytest

from crumple.cli.console.folder import FILES, LOCK, results_folder
from crumple.cli.console.shell_run import RESTART
from crumple.portable import PART

pytestmark = pytest.mark.skipif(
    not hasattr(os, "fork"), reason="commands run in processes that are forked off"
)

INPUT = """
crumple: 1
title: {end} ms
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {{tube: {{type: square_tube, side: 40 mm, thickness: 2 mm}}}}
nodes: {{root: [0 m, 0 m, 0 m], tip: [0.3 m, 0 m, 0 m]}}
members:
  m: {{nodes: [root, tip], section: tube, material: steel, hinges: [{{name: root, at: root, law: kecman}}]}}
supports: {{clamp: {{node: root, fix: all}}}}
masses: {{payload: {{node: tip, mass: 6 kg}}}}
initial_velocity: [{{rotation: 15 rad/s, about: [0 m, 0 m, 0 m], axis: [0, -1, 0]}}]
analysis: {{duration: {end} ms, multibody: {{accuracy: 1e-6}}, shell: {{element_size: 13 mm}}}}
outputs: {{every: 0.1 ms}}
"""
ENDS = 5, 6
"""Durations [ms] of two inputs that take turns in one folder: so a mixture of their files is noticed."""
SERVER = """
import json, os, resource, sys
import crumple.cli.main as command
def begin(words, errors, limit):
    child = os.fork()
    if child:
        return child
    if limit:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(os.open(errors, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
    sys.argv = ["crumple", *words]
    try:
        command.main()
        code = 0
    except SystemExit as end:
        code = end.code or 0
    except BaseException:
        import traceback
        traceback.print_exc()
        code = 99
    sys.stderr.flush()
    os._exit(code)
for line in sys.stdin:
    asked = json.loads(line)
    if isinstance(asked, int):
        answer = os.waitstatus_to_exitcode(os.waitpid(asked, 0)[1])
    elif isinstance(asked, str):
        answer = exec(asked)
    else:
        answer = begin(*asked)
    print(answer, flush=True)
"""
WARM = (
    "import h5py, filelock, rich.console, rich.table, jinja2, matplotlib.figure, crumple.analysis, "
    "crumple.report, crumple.comparison, crumple.multibody, crumple.shell, crumple.result"
)


class Commands:
    """Starts commands in forked processes."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._begun = folder, 0
        self._errors: dict[int, Path] = {}
        words = [sys.executable, "-c", SERVER]
        alone = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        self.server = subprocess.Popen(
            words, env=alone, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        self._ask(WARM)

    def _ask(self, request: object) -> str:
        assert self.server.stdin is not None
        assert self.server.stdout is not None
        self.server.stdin.write(json.dumps(request) + "\n")
        return self.server.stdout.readline().strip()

    def begin(self, words: list[str], limit: int = 0) -> int:
        """Process of a command; `limit` of the size of its files [B], 0: none."""
        errors = self._folder / f"{self._begun}.txt"
        self._begun += 1
        process = int(self._ask((words, str(errors), limit)))
        self._errors[process] = errors
        return process

    def end(self, process: int) -> tuple[int, str]:
        """Exit code, negative if killed, and what it wrote on standard error."""
        code, errors = int(self._ask(process)), self._errors.pop(process)
        return code, errors.read_text() if errors.exists() else ""

    def run(self, words: list[str], limit: int = 0) -> tuple[int, str]:
        return self.end(self.begin(words, limit))


@pytest.fixture(scope="module")
def commands(tmp_path_factory) -> Iterator[Commands]:
    started = Commands(tmp_path_factory.mktemp("commands"))
    with started.server:
        yield started
        started.server.stdin.close()


class Verb(NamedTuple):
    """A command, its longest time [s], its number of files, and folders of single results within its own."""

    words: list[str]
    seconds: float
    files: int = 1
    within: tuple[str, ...] = ()


VERBS = {
    "run": Verb(["run"], 2.0),
    "compare": Verb(["compare", "--no-variants", "--threads", "1"], 5.0, 1, ("multibody", "shell")),
    "layouts": Verb(["layouts"], 4.0, 2, ("a", "b")),
}


def _asked(verb: Verb, place: Path, turn: int = 0) -> list[str]:
    """Words of a command into place / out; inputs take turns."""
    files = []
    for i in range(verb.files):
        path = place / f"{turn % 2}" / ("ab"[i] + ".yaml")
        path.parent.mkdir(exist_ok=True)
        path.write_text(INPUT.format(end=ENDS[(turn + i) % 2]), encoding="utf-8")
        files.append(str(path))
    return [*verb.words, *files, "--out", str(place / "out")]


def _assert_whole(folder: Path) -> None:
    """Every file can be read to its end; a summary has the other files of its run beside it."""
    for path in folder.rglob("*"):
        if (
            path.name == LOCK
            or path.is_dir()
            or any(p.startswith(PART) for p in path.relative_to(folder).parts)
        ):
            continue
        _assert_file(path)
    for summary in folder.rglob("summary.json"):
        if not summary.parent.name.startswith(PART):
            _assert_of_one_run(summary.parent)
    if (folder / "report.html").exists() and (folder / "shell").is_dir():
        assert (folder / "multibody" / "summary.json").exists()
        assert (folder / "shell" / "summary.json").exists()


def _assert_file(path: Path) -> None:
    match path.suffix:
        case ".json":
            json.loads(path.read_text(encoding="utf-8"))
        case ".csv":
            assert path.read_text(encoding="utf-8").endswith("\n")
            np.genfromtxt(path, delimiter=",", skip_header=1)  # refuses rows of unequal length
        case ".html":
            assert path.read_text(encoding="utf-8").rstrip().endswith("</html>")
        case ".svg":
            ElementTree.parse(path)
        case ".vtkhdf":
            with h5py.File(path) as file:
                file.visit(lambda _: None)
        case ".npz":
            with np.load(path) as saved:
                assert all(saved[name] is not None for name in saved)
        case kind:
            raise AssertionError(f"{path}: no command writes {kind} files")


def _assert_of_one_run(folder: Path) -> None:
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "complete"
    assert [name for name in FILES if not (folder / name).is_file()] == []
    times = np.genfromtxt(folder / "histories.csv", delimiter=",", skip_header=1)[:, 0]
    assert f"{1e3 * times[-1]:.6g} ms" == summary["title"]
    assert f"{summary['title']}</" in (folder / "report.html").read_text(encoding="utf-8")


def _assert_next_run_succeeds(commands: Commands, verb: Verb, place: Path) -> None:
    code, errors = commands.run(_asked(verb, place))
    assert code == 0, errors
    out = place / "out"
    _assert_whole(out)
    folders = [out / name for name in verb.within] or [out]
    assert [f for f in folders if not (f / "summary.json").exists()] == []
    assert (out / "report.html").exists()
    assert list(out.rglob(f"{PART}*")) == []
    assert list(out.rglob(RESTART)) == []


@pytest.mark.parametrize(
    ("name", "kills"),
    [
        ("run", 3),
        ("compare", 1),
        ("layouts", 1),
        *(pytest.param(name, 50, marks=pytest.mark.slow) for name in VERBS),
    ],
)
def test_a_kill_leaves_whole_files_and_the_next_run_succeeds(
    commands: Commands, tmp_path: Path, name: str, kills: int
) -> None:
    verb, moments = VERBS[name], random.Random(kills)
    out, whole, killed = tmp_path / "out", verb.seconds, 0
    for turn in range(10 * kills):
        begun = time.monotonic()
        process = commands.begin(_asked(verb, tmp_path, turn))
        time.sleep(moments.uniform(0.0, 1.0) * whole)
        os.kill(process, signal.SIGKILL)
        code, errors = commands.end(process)
        _assert_whole(out) if out.exists() else None
        if code == -signal.SIGKILL:
            killed += 1
        else:
            # it came to its end before: look for moments within what it took
            assert code == 0, errors
            whole = min(whole, time.monotonic() - begun)
        if killed == kills or killed % 10 == 9:
            with results_folder(out, tmp_path, verb.within):
                assert list(out.rglob(f"{PART}*")) == []
            _assert_next_run_succeeds(commands, verb, tmp_path)
        if killed == kills:
            break
    assert killed == kills


@pytest.fixture(scope="module")
def largest_file(commands: Commands, tmp_path_factory: pytest.TempPathFactory) -> int:
    """Size of the largest file of a run [B]; it depends on the version of the HDF5 library."""
    folder = tmp_path_factory.mktemp("largest")
    assert commands.run(_asked(VERBS["run"], folder))[0] == 0
    return max(path.stat().st_size for path in (folder / "out").rglob("*"))


@pytest.mark.parametrize("share", [0.001, 0.03, 0.3, 0.9])
def test_a_full_disk_is_an_error_and_leaves_whole_files(
    commands: Commands, tmp_path: Path, largest_file: int, share: float
) -> None:
    """A limit on the size of files ends a write just as a full disk does, with a part of it on the disk."""
    code, errors = commands.run(_asked(VERBS["run"], tmp_path), int(share * largest_file))
    assert code == 2
    assert "Traceback" not in errors
    assert "the results cannot be written" in errors
    _assert_whole(tmp_path / "out")
    assert not (tmp_path / "out" / "summary.json").exists()
    _assert_next_run_succeeds(commands, VERBS["run"], tmp_path)


def test_a_folder_that_cannot_be_written_is_refused_before_the_run(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out").chmod(0o555)
    drop, override = 24, 1  # PR_CAPBSET_DROP, CAP_DAC_OVERRIDE: without it permissions bind root too
    prctl = ctypes.CDLL(None).prctl
    words = [sys.executable, "-m", "crumple", *_asked(VERBS["run"], tmp_path)]
    done = subprocess.run(
        words, capture_output=True, text=True, check=False, preexec_fn=lambda: prctl(drop, override, 0, 0, 0)
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert f"the results cannot be written to {tmp_path / 'out'}: Permission denied" in done.stderr
    assert list((tmp_path / "out").iterdir()) == []


def test_of_two_runs_into_one_folder_at_once_one_is_refused(commands: Commands, tmp_path: Path) -> None:
    first, second = (commands.begin(_asked(VERBS["run"], tmp_path, turn)) for turn in (0, 1))
    outcomes = [commands.end(process) for process in (first, second)]
    assert sorted(code for code, _ in outcomes) in ([0, 2], [0, 0])
    assert outcomes[0][0] == 0 or "another run is writing into" in outcomes[0][1]
    _assert_whole(tmp_path / "out")
    assert (tmp_path / "out" / "summary.json").exists()
    assert list((tmp_path / "out").glob(f"{PART}*")) == []
