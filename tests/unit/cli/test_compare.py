"""`crumple compare` and `crumple run --fidelity both` from input file to page, on a coarse mesh."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import typer
from tests.support.result.folded_tube import analysis, angle_over_time, folded_result
from tests.unit.cli.test_shell_run import coarse

from crumple.cli.compare import _show
from crumple.cli.console.fidelity import Fidelity
from crumple.cli.run import run
from crumple.comparison import compare
from crumple.errors import Status
from crumple.shell import Moment


def test_compare_writes_both_results_and_one_page(run_command, tmp_path: Path) -> None:
    measured = tmp_path / "test.csv"
    measured.write_text(
        "time [ms],tip [deg],M2,node.tip.displacement.z [mm],hinge.root.moment [mm]\n"
        "0,0,1,0,1\n6,5,2,90,1\n12,9,3,160,1\n"
    )
    code, out, err = run_command(
        "compare", coarse(tmp_path, 12), "--out", tmp_path / "out", "--threads", 1,
        "--curve", f"bench={measured}", "--pair", "tip=-member.tube.chord_rotation", "--second-mesh", 1.5,
    )  # fmt: skip
    assert code == 0
    # on a busy machine it takes so long that there are news
    assert all(" ms, step " in line for line in err.splitlines())
    assert "times faster" in out
    assert "Solved again, multibody took" in out
    assert "Caution" in out
    assert "Range from the hinge laws: the shell value is inside for " in out
    message = " ".join(out.split())
    assert "Curve bench (test.csv): member.tube.chord_rotation rated 0." in message
    assert "hinge.root.moment is in m, but in N*m in the results" in message
    for name in ("multibody", "shell"):
        summary = json.loads((tmp_path / "out" / name / "summary.json").read_text())
        assert summary["fidelity"] == name
        assert (tmp_path / "out" / name / "report.html").is_file()
    hashes = {
        json.loads((tmp_path / "out" / name / "summary.json").read_text())["provenance"]["input_hash"]
        for name in ("multibody", "shell")
    }
    assert len(hashes) == 1
    page = (tmp_path / "out" / "report.html").read_text()
    for expected in (
        "bench",
        "laws of the shells",
        "elastic members",
        "no unit: M2",
        "node.tip.displacement.z over time, with the curves from files.",
        'id="player"',
        "shell, 30 mm",
        "Repeated solve",
        "Range from the hinge laws",
    ):
        assert expected in page
    assert (tmp_path / "out" / "figures" / "shapes.svg").is_file()
    drawn = (tmp_path / "out" / "figures" / "curve_1.svg").read_text()
    assert "node.tip.displacement.z, mm" in drawn
    assert ">bench<" in drawn


def test_run_with_both_fidelities(run_command, tmp_path: Path) -> None:
    file = coarse(tmp_path, 12)
    code, out, err = run_command(
        "run", file, "--fidelity", "both", "--out", tmp_path, "--json", "--threads", 1
    )
    assert (code, err) == (0, "")
    assert {name: entry["fidelity"] for name, entry in json.loads(out).items()} == {
        "multibody": "multibody",
        "shell": "shell",
    }
    assert not (tmp_path / "report.html").exists()


@pytest.mark.parametrize(("status", "begun"), [(Status.CANCELLED, 1), (Status.NOT_FINITE, 2)])
def test_a_stopped_first_run_keeps_the_second_away(tmp_path: Path, monkeypatch, status, begun) -> None:
    runs = []

    def solved(*given) -> object:
        runs.append(given)
        return SimpleNamespace(status=status)

    for name, stand_in in (("_solve", solved), ("_show", lambda *_: None)):
        monkeypatch.setattr(f"crumple.cli.run.{name}", stand_in)
    with pytest.raises(typer.Exit):
        run(coarse(tmp_path, 12), out=str(tmp_path / "out"), fidelity=Fidelity.BOTH)
    assert len(runs) == begun


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (("--curve", "nothing"), "is not name=file.csv"),
        (("--curve", "a=missing.csv"), "there is no such file"),
        (("--curve", "a=missing.csv", "--pair", "x"), "is not column=history"),
        (("--pair", "tip=node.tip.displacement.z"), "no curve file has a column"),
        (("--pair", "x=y", "--pair", "x=z"), "is paired twice"),
        (("--curve", "shell=missing.csv"), "is that of a result"),
        (("--second-mesh", "1"), "this factor gives no second mesh"),
        (("--second-mesh", "nan"), "this factor gives no second mesh"),
        (("--second-mesh", "9"), "of member tube, with --second-mesh 9"),
    ],
)
def test_bad_requests_are_refused_before_anything_is_solved(
    run_command, tmp_path: Path, arguments, wanted
) -> None:
    code, _, err = run_command("compare", coarse(tmp_path, 12), "--out", tmp_path / "out", *arguments)
    assert code == 2
    assert wanted in err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["multibody", "shell"])
def test_an_unusable_output_path_is_reported_before_solving(run_command, tmp_path: Path, name: str) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / name).write_text("in the way")
    code, _, err = run_command("compare", coarse(tmp_path, 12), "--out", out, "--threads", 1)
    assert code == 2
    assert "a file has this name, or the name of a folder above it" in err
    assert not (out / "shell" / "summary.json").exists()
    assert f"{out / name}: a file" in " ".join(err.split())


def test_an_interrupted_comparison_goes_on(run_command, tmp_path: Path, monkeypatch) -> None:
    words = ("compare", coarse(tmp_path, 50), "--threads", 1, "--no-variants", "--out")
    parts, whole = tmp_path / "parts", tmp_path / "whole"

    def end(moment: Moment) -> str:
        if moment.time > 0.015:
            os.kill(os.getpid(), signal.SIGTERM)
        return ""

    with monkeypatch.context() as patch:
        patch.setattr("crumple.cli.console.shell_run.status_line", end)
        patch.setattr("crumple.shell.stepping.WATCH_EVERY", 0.0)
        code, out, _ = run_command(*words, parts)
    assert code == 1
    message = " ".join(out.split())
    saved = parts / "shell" / "restart.npz"
    assert f"Continue with the same command and --restart {saved}" in message
    assert "ms, which both contain, are compared" in message
    assert (parts / "report.html").is_file()
    assert run_command(*words, whole, "--restart", tmp_path / "none.npz")[0] == 2
    assert run_command(*words, parts, "--restart", saved)[0] == 0
    assert not saved.exists()
    assert run_command(*words, whole)[0] == 0
    histories = Path("shell") / "histories.csv"
    assert (parts / histories).read_bytes() == (whole / histories).read_bytes()


def test_the_table_shows_the_hinges_that_absorbed_most(monkeypatch, capsys) -> None:
    case, times = analysis(), np.linspace(0.0, 0.1, 101)
    small, large = (largest * angle_over_time(times) for largest in (0.5, 1.5))
    shell = folded_result([(0.01, 0.04, small), (0.60, 0.63, large)])
    found = compare(shell, shell, case.structure)
    monkeypatch.setattr("crumple.cli.compare.MOST_HINGES", 1)
    _show(found, Path("out"))
    message = capsys.readouterr().out
    table = message[: message.index("1 of 2 hinges, those with the largest absorbed energy")]
    assert "tube at" in table
    assert "root" not in table.partition("Hinge")[2]
