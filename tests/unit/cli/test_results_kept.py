"""Results are kept: folders locked, files complete or absent, the input read once, defects reported."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from tests.support.long_chains import member_of_bars

from crumple.cli.console import defect, storing
from crumple.cli.console.folder import LOCK, results_folder
from crumple.cli.main import main
from crumple.errors import CancelledError, InputError
from crumple.portable import PART
from crumple.result.publishing import published

EXAMPLE = Path(__file__).parents[3] / "examples" / "01_tube_bending.yaml"


@pytest.fixture
def command(monkeypatch, capsys):
    """Run the command line in this process; gives exit code, output and errors."""

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["crumple", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            main()
        return (end.value.code or 0, *capsys.readouterr())

    return run


def test_a_second_run_into_a_folder_is_refused(command, tmp_path: Path) -> None:
    with results_folder(tmp_path, EXAMPLE):
        code, _, err = command("run", EXAMPLE, "--out", tmp_path)
        assert code == 2
        assert f"another run is writing into {tmp_path}" in err
        assert not (tmp_path / "summary.json").exists()
    assert command("run", EXAMPLE, "--out", tmp_path)[0] == 0


def test_folders_within_are_locked_too(command, tmp_path: Path) -> None:
    with results_folder(tmp_path, EXAMPLE, ("shell",)), pytest.raises(InputError, match="another run"):
        results_folder(tmp_path / "shell", EXAMPLE).__enter__()


def test_a_lock_goes_with_its_process(command, tmp_path: Path) -> None:
    code = (
        "import os, signal\nfrom crumple.cli.console.folder import results_folder\n"
        f"with results_folder({str(tmp_path)!r}, None): os.kill(os.getpid(), signal.SIGKILL)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -9
    assert (tmp_path / LOCK).exists()
    assert command("run", EXAMPLE, "--out", tmp_path)[0] == 0


def test_what_an_interrupted_run_left_unfinished_is_removed(command, tmp_path: Path) -> None:
    (tmp_path / f"{PART}abc").mkdir()
    (tmp_path / f"{PART}abc" / "summary.json").write_text("{}")
    (tmp_path / f"{PART}restart.npz.xyz").write_text("half")
    (tmp_path / "mine.txt").write_text("stays")
    assert command("run", EXAMPLE, "--out", tmp_path)[0] == 0
    assert [path.name for path in tmp_path.glob(f"{PART}*")] == []
    assert (tmp_path / "mine.txt").read_text() == "stays"


def test_files_are_published_together_with_the_summary_last(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "summary.json").write_text("old")
    (tmp_path / "histories.csv").write_text("old")

    def interrupted() -> None:
        with published(tmp_path) as staging:
            (staging / "histories.csv").write_text("new")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        interrupted()
    assert (tmp_path / "histories.csv").read_text() == "old"
    order, replace = [], Path.replace

    def noted(self: Path, target: Path) -> Path:
        assert (tmp_path / "summary.json").exists() is False
        order.append(target.name)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", noted)
    with published(tmp_path) as staging:
        for name in ("summary.json", "histories.csv", "a"):
            (staging / name).write_text("new")
        (staging / "figures").mkdir()
        (staging / "figures" / "z.svg").write_text("new")
    assert order[-1] == "summary.json"
    assert (tmp_path / "figures" / "z.svg").read_text() == "new"
    assert {path.name for path in tmp_path.iterdir()} == {"summary.json", "histories.csv", "a", "figures"}


def test_the_report_shows_the_input_that_was_solved(command, tmp_path: Path, monkeypatch) -> None:
    file, text = tmp_path / "tube.yaml", EXAMPLE.read_text(encoding="utf-8")
    file.write_text(text, encoding="utf-8")
    import crumple.analysis as analysis_room

    solve = analysis_room.solve

    def and_delete(*arguments, **options):
        file.unlink()
        return solve(*arguments, **options)

    monkeypatch.setattr(analysis_room, "solve", and_delete)
    assert command("run", file, "--out", tmp_path / "out")[0] == 0
    assert "Steel tube thrown" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_results_that_their_folder_does_not_take_are_kept_elsewhere(
    command, tmp_path: Path, monkeypatch
) -> None:
    import crumple.result

    write, spare = crumple.result.write, tmp_path / "spare"
    spare.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(spare))

    def full(result, folder):
        if (tmp_path / "out") in Path(folder).parents:
            raise OSError(errno.ENOSPC, "no room")
        write(result, folder)

    monkeypatch.setattr(crumple.result, "write", full)
    code, _, err = command("run", EXAMPLE, "--out", tmp_path / "out")
    assert code == 2
    [kept] = spare.glob("crumple-results-*")
    assert f"the results are in {kept}" in err
    assert json.loads((kept / "summary.json").read_text())["ok"]
    assert [path.name for path in (tmp_path / "out").iterdir()] == [LOCK]


def test_a_figure_that_cannot_be_drawn_loses_no_numbers(command, tmp_path: Path, monkeypatch) -> None:
    import crumple.report

    monkeypatch.setattr(crumple.report, "write_report", lambda *_: 1 / 0)
    code, _, err = command("run", EXAMPLE, "--out", tmp_path)
    assert code == defect.EXIT_CODE
    assert "Traceback" not in err
    assert json.loads((tmp_path / "summary.json").read_text())["ok"]


def test_a_defect_is_told_with_what_to_send(command, tmp_path: Path, monkeypatch) -> None:
    import crumple.analysis

    monkeypatch.setattr(crumple.analysis, "solve_with_frames", lambda *_, **__: {}["nothing"])
    code, out, err = command("run", EXAMPLE, "--out", tmp_path)
    assert (code, out) == (defect.EXIT_CODE, "")
    assert "this is a defect of Crumple" in err
    assert "Traceback" not in err
    kept = tmp_path / defect.NAME
    assert f"the file {kept}" in err
    assert "KeyError: 'nothing'" in kept.read_text(encoding="utf-8")


def test_a_defect_outside_of_a_run_goes_to_a_folder_for_temporary_files(
    command, tmp_path, monkeypatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("crumple.analysis.load_input", lambda *_: 1 / 0)
    code, _, err = command("check", EXAMPLE)
    assert code == defect.EXIT_CODE
    assert f"the file {tmp_path / defect.NAME}" in err


def test_too_little_memory_is_told(command, monkeypatch) -> None:
    def hungry(*_):
        raise MemoryError

    monkeypatch.setattr("crumple.analysis.load_input", hungry)
    code, _, err = command("check", EXAMPLE)
    assert (code, "too little memory" in err) == (2, True)


@pytest.mark.parametrize(
    "terminal",
    [{"PYTHONIOENCODING": "ascii"}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}],
)
def test_a_terminal_without_the_letters_of_a_title_shows_others(
    tmp_path: Path, terminal: dict[str, str]
) -> None:
    file = tmp_path / "a.yaml"
    text = EXAMPLE.read_text(encoding="utf-8")
    title = "title: Steel tube thrown at 15 rad/s, bending about its weak axis"
    assert title in text
    file.write_text(text.replace(title, 'title: "Größe 😀 <ß>"'), encoding="utf-8")
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("LC_", "LANG"))}
    words = [sys.executable, "-m", "crumple", "run", str(file), "--out", str(tmp_path / "out")]
    done = subprocess.run(words, env=environment | terminal, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"Gr??e ? <?>" in done.stdout


def test_a_second_interrupt_reports_what_is_lost(command, tmp_path, monkeypatch):
    """The first ends the run; the second comes while its results are written."""
    path = tmp_path / "case.yaml"
    path.write_text(member_of_bars(4), encoding="utf-8")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(storing, "store", interrupted)
    code, _, errors = command("run", path, "--out", tmp_path / "out")
    assert code == 130
    assert "second Ctrl-C: no results of this run were kept" in errors
    assert not list((tmp_path / "out").glob("*.json"))


@pytest.mark.parametrize(("number", "exit_code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("verb", ["run", "compare"])
def test_a_run_that_is_stopped_before_its_first_output_has_the_exit_code_of_the_signal(
    verb, number, exit_code, command, tmp_path, monkeypatch
):
    def interrupted(*_, **__):
        signal.raise_signal(number)
        raise CancelledError("cancelled before the first step: nothing was computed")

    monkeypatch.setattr("crumple.multibody.solve.refuse_pictures", interrupted)
    code, _, errors = command(verb, EXAMPLE, "--out", tmp_path / "out")
    assert code == exit_code
    assert "cancelled before the first step" in errors


def test_a_run_is_kept_if_the_runs_beside_it_are_stopped(command, tmp_path, monkeypatch):
    """Ctrl-C comes while variants are prepared."""
    path = tmp_path / "case.yaml"
    varied = (
        "uncertainty:\n  rows: 50\n  variables:\n    wall:\n      path: sections.tube.thickness\n"
        "      distribution: {type: uniform, low: 1.8 mm, high: 2.2 mm}\n      source: assumed\n"
    )
    path.write_text(EXAMPLE.read_text(encoding="utf-8") + varied, encoding="utf-8")

    def stopped(*_, **__):
        raise CancelledError("cancelled while the variants were prepared: none was solved")

    monkeypatch.setattr("crumple.analysis.with_law_range", stopped)
    monkeypatch.setattr("crumple.analysis.with_modes", stopped)
    monkeypatch.setattr("crumple.multibody.variants.variants._cases", stopped)
    code, _, errors = command("run", path, "--out", tmp_path / "out", "--law-range", "--modes")
    assert code == 0
    assert errors.count("Stopped: ") == 3
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["ok"]


@pytest.mark.parametrize(("check", "why"), [("off", "mechanism_check is off"), ("auto", "of impacts on")])
def test_modes_that_were_asked_for_and_are_none_are_explained(command, tmp_path, check, why):
    text = EXAMPLE.read_text(encoding="utf-8")
    text = text.replace("accuracy: 1e-3", f"accuracy: 1e-3, mechanism_check: {check}")
    path = tmp_path / "case.yaml"
    path.write_text(text, encoding="utf-8")
    code, _, errors = command("run", path, "--out", tmp_path / "out", "--no-law-range", "--modes")
    assert code == 0
    assert (
        f"No modes of collapse (--modes): {'analysis.multibody.' if check == 'off' else 'they are '}{why}"
        in errors
    )
