"""Parts of a study joined give the study solved whole, also after one was killed; gaps are refused."""

import shutil
import sqlite3
import subprocess
import sys
import time

import pytest
from tests.unit.study.test_study import WALL, rows_of, written

from crumple.errors import InputError
from crumple.study import LoadedStudy, run_part, run_study
from crumple.study.parts import read_part

METHOD = "{type: monte_carlo, rows: 301, seed: 4}"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study, and the folder in which it was solved whole."""
    folder = tmp_path_factory.mktemp("whole")
    file = written(folder, METHOD, WALL, more="constraints: [{response: r, at_most: 30 deg}]")
    run_study(LoadedStudy(file), folder)
    return file, folder


def count(file):
    try:
        with sqlite3.connect(file) as opened:
            number = opened.execute("SELECT count(*) FROM rows").fetchone()[0]
        opened.close()
    except sqlite3.OperationalError:
        return 0
    return number


def test_one_of_three_parts_is_killed_and_repeated(study, tmp_path, run_command):
    file, whole = study
    for part in ("1/3", "3/3"):
        assert "solved now" in run_command("study", file, "--out", tmp_path, "--part", part)[1]
    command = [sys.executable, "-m", "crumple", "study", file, "--out", tmp_path, "--part", "2/3"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    place = tmp_path / "part-2-of-3" / "part.sqlite"
    while process.poll() is None and count(place) == 0:
        time.sleep(0.01)
    process.kill()
    process.wait()
    known = count(place)
    assert known > 0
    if known < 100:
        code, _, err = run_command("study", file, "--out", tmp_path, "--merge")
        assert code == 2
        assert f"the parts lack {100 - known} of 301 rows" in err
    code, out, _ = run_command("study", file, "--out", tmp_path, "--part", "2/3", "--resume")
    assert f"Part 2/3: 100 rows, {100 - known} solved now" in out
    assert run_command("study", file, "--out", tmp_path, "--merge")[0] == 0
    assert rows_of(tmp_path) == rows_of(whole)
    assert (tmp_path / "study.json").read_bytes() == (whole / "study.json").read_bytes()


def test_parts_may_come_from_other_folders_and_number(study, tmp_path):
    """Two parts that were solved elsewhere, with other numbers of workers."""
    file, whole = study
    for part in ((1, 2), (2, 2)):
        rows, solved = run_part(LoadedStudy(file), tmp_path / f"at_{part[0]}", part, part[0])
        assert rows == solved == {1: 151, 2: 150}[part[0]]
        name = f"part-{part[0]}-of-2"
        shutil.copytree(tmp_path / f"at_{part[0]}" / name, tmp_path / "all" / name)
    table, answer = run_study(LoadedStudy(file), tmp_path / "all", merge=True)
    assert len(table.rows) == answer.complete == 301
    assert rows_of(tmp_path / "all") == rows_of(whole)


def test_missing_and_foreign_parts_are_refused(study, tmp_path):
    file, _ = study
    with pytest.raises(InputError, match="there are no parts"):
        run_study(LoadedStudy(file), tmp_path, merge=True)
    run_part(LoadedStudy(file), tmp_path, (2, 100))
    with pytest.raises(InputError, match="lack 298 of 301 rows"):
        run_study(LoadedStudy(file), tmp_path, merge=True)
    other = written(tmp_path, METHOD.replace("seed: 4", "seed: 5"), WALL)
    with pytest.raises(InputError, match="another study"):
        run_study(LoadedStudy(other), tmp_path, merge=True)


@pytest.mark.parametrize("method", ["optimise", "sobol_indices"])
def test_methods_that_follow_their_rows_have_no_parts(tmp_path, method):
    file = written(tmp_path, f"{{type: {method}, rows: 16}}", WALL, more="objective: {minimise: r}")
    with pytest.raises(InputError, match="has no parts"):
        run_part(LoadedStudy(file), tmp_path, (1, 2))


def test_parts_are_joined_by_a_command_of_its_own(study, tmp_path, run_command):
    code, _, err = run_command("study", study[0], "--out", tmp_path, "--part", "1/2", "--merge")
    assert code == 2
    assert "a part is of a study alone" in err


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "a/b", "1/20000", "-1/3", ""])
def test_what_is_no_part(text):
    with pytest.raises(InputError, match="not a part"):
        read_part(text)
