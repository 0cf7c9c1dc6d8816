"""`crumple characterise` prints and keeps the law of a sub-model; what is kept is not solved again."""

import json
import signal
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple.characterisation import Bending, LawCurve, LawStore, solving
from crumple.characterisation.law import law_of
from crumple.cli.characterise import _picture, _show
from crumple.cli.main import app
from crumple.errors import InputError
from crumple.hinge import read_law
from crumple.material import Material
from crumple.section import RectangularTube

TUBE = ["characterise", "rectangular_tube 50x25x2.65 mm", "--material", "yield 488 MPa, E 210 GPa"]

METAL = Material("metal", 210e9, 0.3, 7850.0, 488e6)
MODEL = Bending(RectangularTube(0.05, 0.025, 0.00265), METAL, largest=0.1745)


def invoke(*arguments):
    return CliRunner().invoke(app, [*TUBE, *arguments], catch_exceptions=False)


def test_law_is_solved_once_and_kept(tmp_path, monkeypatch):
    # a coarse and fast sub-model: what is tested is the way of the law, not its figures
    monkeypatch.setattr("crumple.characterisation.resolution.Resolution.element_size", lambda *_: 0.012)
    folder = tmp_path / "kept"
    first = invoke("--store", str(folder), "--to", "10 deg", "--json", "--threads", "1")
    assert first.exit_code == 0, first.output
    content = json.loads(first.stdout)
    curve = content["curve"]
    assert curve["rotation"][0] == 0.0
    assert curve["rotation"][-1] == pytest.approx(0.1745, rel=0.05)
    assert len(curve["rotation"]) == len(curve["moment"]) == len(curve["energy"])
    (file,) = folder.glob("*.law.yaml")
    law = read_law(file.read_text(encoding="utf-8"), file.name)
    assert law.points(1) == (tuple(curve["rotation"]), tuple(curve["moment"]))
    assert dict(law.origin)["method"] == "shell"
    (picture,) = folder.glob("*.svg")
    assert "<svg" in picture.read_text(encoding="utf-8")

    monkeypatch.setattr(solving, "solve", lambda *_, **__: pytest.fail("solved again"))
    again = invoke("--store", str(folder), "--to", "10 deg")
    assert again.exit_code == 0
    assert "Plastic rotation" in again.output
    assert "The law ends" not in again.output
    assert file.name in again.output.replace("\n", "")


SIGNALS = pytest.mark.parametrize(("number", "exit_code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])


@SIGNALS
def test_a_section_that_is_stopped_has_no_law_and_the_exit_code_of_the_signal(
    number, exit_code, tmp_path, monkeypatch
):
    solve = solving.solve

    def interrupted(*given, **options):
        signal.raise_signal(number)
        return solve(*given, **options)

    monkeypatch.setattr(solving, "solve", interrupted)
    done = invoke("--store", str(tmp_path), "--threads", "1")
    assert (done.exit_code, "Stopped; no law was stored." in done.stderr) == (exit_code, True)
    assert not list(tmp_path.glob("*.law.yaml"))


@SIGNALS
def test_a_file_that_is_stopped_has_the_exit_code_of_the_signal(number, exit_code, tmp_path, monkeypatch):
    def interrupted(*_):
        signal.raise_signal(number)
        yield from ()

    monkeypatch.setattr("crumple.characterisation.parallel.in_processes", interrupted)
    words = ["characterise", "examples/01_tube_bending.yaml", "--store", str(tmp_path / "laws")]
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert (done.exit_code, "Stopped with 0 of " in done.stderr) == (exit_code, True)


@pytest.mark.parametrize(("turned", "said"), [(0.1745, False), (0.1, True)])
def test_a_law_that_ends_before_what_was_asked_for_says_so(turned, said, tmp_path, capsys):
    rotation = np.linspace(0.0, turned, 5)
    curve = LawCurve(rotation, np.full(5, 1000.0), 1000.0 * rotation)
    _show(MODEL, law_of(MODEL, curve, None, {}, None), tmp_path / "law.yaml")
    text = " ".join(capsys.readouterr().out.split())
    assert ("The law ends at 5.73 deg, not at 10 deg" in text) is said


@pytest.mark.parametrize(
    ("options", "what"),
    [
        (["--angle", "101 deg"], "angle of the corner is out of range"),
        (["--angle", "0 deg"], "angle of the corner is out of range"),
        (["--to", "2 deg"], "rotation is out of range"),
        (["--sense", "up"], "sense is unknown"),
        (["--axis", "x"], "axis"),
        (["--list"], "a section has nothing to list"),
    ],
)
def test_what_cannot_be_is_refused(options, what, tmp_path):
    with pytest.raises(InputError, match=what):
        invoke("--store", str(tmp_path / "kept"), *options)
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("given", [TUBE[1:], ["examples/12_l_frame.yaml"]])
def test_a_store_that_cannot_be_written_is_refused_before_anything_is_solved(given, tmp_path, monkeypatch):
    solved = []
    monkeypatch.setattr(solving, "solve", lambda *_, **__: solved.append(1))
    monkeypatch.setattr("crumple.characterisation.parallel.characterise_all", lambda *_, **__: solved)
    (tmp_path / "file").write_text("", encoding="utf-8")
    for store in (tmp_path / "file", tmp_path / "file" / "laws"):
        with pytest.raises(InputError, match="a file has this name") as caught:
            CliRunner().invoke(app, ["characterise", *given, "--store", str(store)], catch_exceptions=False)
        assert "--store" in caught.value.problems[0].todo
    assert solved == []


def law():
    rotation = np.linspace(0.0, 0.2, 5)
    return law_of(MODEL, LawCurve(rotation, np.full(5, 1000.0), 1000.0 * rotation), None, {}, None)


def test_a_folder_with_the_name_of_a_law_is_refused_before_anything_is_solved(tmp_path):
    store = LawStore(tmp_path)
    store.prepare([MODEL])
    store.path(MODEL).mkdir()
    with pytest.raises(InputError, match="a folder has this name"):
        store.prepare([MODEL])


@pytest.mark.parametrize("room", [True, False])
def test_a_law_that_its_store_does_not_take_is_kept_elsewhere(room, tmp_path, monkeypatch):
    spare = tmp_path / "spare"
    if room:
        spare.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(spare))
    store = LawStore(tmp_path / "laws")
    store.path(MODEL).mkdir(parents=True)
    with pytest.raises(InputError, match="laws cannot be written to") as caught:
        store.keep(MODEL, law())
    (problem,) = caught.value.problems
    if room:
        (kept,) = spare.glob("*/*.law.yaml")
        assert str(kept) in problem.todo
        assert read_law(kept.read_text(encoding="utf-8")) == law()
    else:
        assert "--store" in problem.todo


def test_a_picture_that_cannot_be_written_costs_no_law(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("crumple.report.figures.shape.deformation", lambda _: "<svg/>")
    (tmp_path / "a.law.svg").mkdir()
    _picture(SimpleNamespace(result=None), tmp_path / "a.law.yaml")
    assert "No picture: " in capsys.readouterr().err


def test_a_file_of_the_store_that_is_no_text_is_refused(tmp_path):
    store = LawStore(tmp_path)
    store.path(MODEL).write_bytes(b"\x9e\x8b")
    with pytest.raises(InputError, match="not a text in UTF-8"):
        store.law(MODEL)
