"""Shell runs from the command line: results and report, status lines, interruption, restart."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

from crumple.cli.console.progress import Bar, duration
from crumple.cli.console.shell_run import long_run_of, status_line
from crumple.shell import Moment

EXAMPLE = Path(__file__).parents[3] / "examples" / "01_tube_bending.yaml"
MOMENT = Moment(
    0.02,
    0.1,
    7.5e-7,
    26000,
    dict.fromkeys(("kinetic", "elastic", "plastic", "hourglass", "contact"), 12.3),
    75.4,
)


def coarse(folder: Path, milliseconds: int) -> Path:
    """Example 01 with coarse elements and a shorter run."""
    text = EXAMPLE.read_text(encoding="utf-8")
    text = text.replace("multibody: {accuracy: 1e-3}", "shell: {element_size: 20 mm}")
    text = text.replace("duration: 100 ms", f"duration: {milliseconds} ms")
    text = text.replace(
        "pictures: [0 ms, 20 ms, 40 ms, 60 ms, 80 ms, 100 ms]", "pictures: [0 ms, 6 ms, 12 ms]"
    )
    file = folder / "coarse.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def crumple(*arguments: object) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-m", "crumple", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=600)


def test_run_writes_results_and_pictures(tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = crumple("run", coarse(tmp_path, 12), "--fidelity", "shell", "--out", out, "--threads", 1)
    assert (run.returncode, run.stderr) == (0, "")
    assert "Status: complete" in run.stdout
    summary = json.loads((out / "summary.json").read_text())
    assert summary["fidelity"] == "shell"
    assert summary["hinges"]["root"]["energy"] > 0
    assert summary["outputs"]["tip_rotation"]["max"] < 0
    assert summary["provenance"]["settings"]["element_size"] == 0.02
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "plastic strain" in page
    assert (out / "figures" / "fold_1.svg").exists()
    assert not (out / "restart.npz").exists()


def test_an_interrupted_run_can_be_read_and_continues_bitwise(
    run_command, tmp_path: Path, monkeypatch
) -> None:
    words = ("run", coarse(tmp_path, 30), "--fidelity", "shell", "--out")
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    assert run_command(*words, whole, "--threads", 1)[0] == 0

    def end(moment: Moment) -> str:
        if moment.time > 0.015:
            os.kill(os.getpid(), signal.SIGTERM)
        return ""

    with monkeypatch.context() as patch:
        patch.setattr("crumple.cli.console.shell_run.status_line", end)
        patch.setattr("crumple.shell.stepping.WATCH_EVERY", 0.0)
        code, printed, _ = run_command(*words, parts, "--threads", 1)
    assert code == 1
    assert "cancelled" in printed
    assert "--restart" in printed
    summary = json.loads((parts / "summary.json").read_text())
    assert 0.0 < summary["end_time"] < 0.03
    # another process: nothing but the file of the restart is left of the first
    assert crumple(*words, parts, "--restart", parts / "restart.npz").returncode == 0
    assert (parts / "histories.csv").read_bytes() == (whole / "histories.csv").read_bytes()


def test_restart_is_for_shells(run_command, tmp_path: Path) -> None:
    code, _, err = run_command("run", EXAMPLE, "--restart", tmp_path / "restart.npz", "--out", tmp_path)
    assert code == 2
    assert "only shell runs" in err


def test_status_line_contains_time_step_energies_and_end() -> None:
    text = status_line(MOMENT)
    for part in ("20 of 100 ms", "step 0.75 us", "kinetic 12.3 J", "about 75 s left"):
        assert part in text


def test_wall_times_for_people() -> None:
    assert [duration(seconds) for seconds in (12.4, 600.0, 9000.0)] == ["12 s", "10 min", "2.5 h"]


def test_news_go_to_standard_error_where_there_is_no_terminal(monkeypatch, capsys, tmp_path) -> None:
    monkeypatch.setattr("crumple.cli.console.progress.STATUS_INTERVAL", -1.0)
    bar = Bar("solving")
    bar(0.0)
    bar(0.25)
    assert re.fullmatch(r"solving: 0 %\nsolving: 25 %, about \d+ s left\n", capsys.readouterr().err)
    watch = long_run_of(tmp_path, None, bar).watch
    assert watch is not None
    watch(MOMENT)
    bar(0.5)
    assert "of 100 ms" in capsys.readouterr().err


def test_lowering_is_shown_until_the_first_fraction(monkeypatch, capsys) -> None:
    monkeypatch.setattr("crumple.cli.console.progress.STATUS_INTERVAL", -1.0)
    bar = Bar("solving")
    bar.preparing()
    bar(0.0)
    bar.preparing()
    assert capsys.readouterr().err == "lowering\nsolving: 0 %\n"
