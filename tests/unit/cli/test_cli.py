"""The command line: verbs, exit codes, refusals on standard error without a traceback."""

from __future__ import annotations

import csv
import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import crumple
from crumple.errors import Status

EXAMPLE = Path(__file__).parents[3] / "examples" / "01_tube_bending.yaml"
STEEL = "yield 488 MPa, E 210 GPa"
TUBE = "rectangular_tube 50x25x2.65 mm"


def test_help_names_every_verb(run_command) -> None:
    code, out, _ = run_command("--help")
    assert code == 0
    for verb in ("run", "compare", "layouts", "check", "schema", "hinge", "section"):
        assert f" {verb} " in out


@pytest.mark.parametrize("verb", ["run", "compare", "layouts", "check", "schema", "hinge", "section"])
def test_every_verb_has_help(run_command, verb: str) -> None:
    assert run_command(verb, "--help")[0] == 0


def test_version(run_command) -> None:
    assert run_command("--version") == (0, f"crumple {crumple.__version__}\n", "")


def test_installed_command_and_module() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "crumple", "--version"], check=True, capture_output=True, text=True
    )
    assert done.stdout == f"crumple {crumple.__version__}\n"


def test_run_writes_the_contract_and_prints_the_table(run_command, tmp_path: Path) -> None:
    code, out, err = run_command("run", EXAMPLE, "--out", tmp_path / "results")
    assert (code, err) == (0, "")
    for word in ("Status: complete", "root", "Energy residual", "solved in", "report.html"):
        assert word in out
    for name in ("summary.json", "histories.csv", "result.vtkhdf", "report.html", "figures"):
        assert (tmp_path / "results" / name).exists()
    summary = json.loads((tmp_path / "results" / "summary.json").read_text())
    assert f"{summary['hinges']['root']['energy']:.1f}" in out


def test_run_json_is_the_summary_alone(run_command, tmp_path: Path) -> None:
    code, out, err = run_command("run", EXAMPLE, "--out", tmp_path, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out) == json.loads((tmp_path / "summary.json").read_text())


def test_run_that_ends_badly_keeps_its_results(run_command, tmp_path: Path, monkeypatch) -> None:
    import crumple.analysis

    def cancelled(*what, **options):
        return solve(*what, **options | {"progress": shares.append, "cancel": lambda: shares[-1] > 0.0})

    shares, solve = [0.0], crumple.analysis.solve_with_frames
    monkeypatch.setattr(crumple.analysis, "solve_with_frames", cancelled)
    text = EXAMPLE.read_text().replace("accuracy: 1e-3", "accuracy: 1e-10")
    file = tmp_path / "long.yaml"
    file.write_text(text)
    code, out, _ = run_command("run", file, "--out", tmp_path / "results")
    assert code == 1
    assert Status.CANCELLED.value in out
    assert (tmp_path / "results" / "report.html").exists()


def test_check(run_command, tmp_path: Path) -> None:
    code, out, _ = run_command("check", EXAMPLE)
    assert code == 0
    assert "no mistakes found" in out
    loose = tmp_path / "loose.yaml"
    stages = "analysis: {stages: [{name: hang, kind: quasi-static, duration: 0.1 s}]}"
    loose.write_text(
        "crumple: 1\nnodes: {a: [0, 0, 0], b: [1 m, 0, 0]}\ngravity: [0, 0, -9.81 m/s^2]\n"
        "materials: {steel: {grade: S355}}\n"
        "sections: {tube: {type: square_tube, side: 50 mm, thickness: 3 mm}}\n"
        f"members: {{ab: {{nodes: [a, b], section: tube, material: steel}}}}\n"
        f"supports: {{pin: {{node: a, fix: pin}}}}\n{stages}\n"
    )
    code, out, err = run_command("check", loose)
    assert code == 0, err
    assert "Stage hang is quasi-static, and nothing resists gravity" in out
    bad = tmp_path / "bad.yaml"
    bad.write_text(
        EXAMPLE.read_text()
        .replace("yield_stress: 488 MPa", "yield_stress: 488 mm")
        .replace("depth:", "dept:")
    )
    code, out, err = run_command("check", bad)
    assert (code, out) == (2, "")
    assert "mm is the unit of a length, but a stress is needed" in err
    assert "dept" in err
    assert "problems" in err


def test_check_asks_the_solver_that_is_named(run_command, tmp_path: Path) -> None:
    code, out, err = run_command("check", EXAMPLE, "--fidelity", "both")
    assert (code, err) == (0, "")
    assert "Shells: " in out
    assert "time step" in out
    # one flat wall: only the shell solver warns, because section rotations of it are not defined
    flat = tmp_path / "flat.yaml"
    flat.write_text(
        "crumple: 1\nmaterials: {steel: {grade: S355}}\nnodes: {a: [0, 0, 0], b: [0.1 m, 0, 0]}\n"
        "sections: {sheet: {type: walls,\n"
        "  walls: [{points: [[-20 mm, 0 mm], [20 mm, 0 mm]], thickness: 2 mm}]}}\n"
        "members: {strip: {nodes: [a, b], section: sheet, material: steel,\n"
        "  hinges: [{name: h, at: 30 mm, axis: y, law: {type: constant, moment: 10 N*m}}]}}\n"
        "supports: {clamp: {node: a, fix: all}}\ninitial_velocity: [{rotation: 5 rad/s, axis: [0, 1, 0]}]\n"
        "analysis: {duration: 1 ms, shell: {element_size: 10 mm}}\n"
    )
    assert "one flat wall" not in run_command("check", flat)[1]
    code, out, err = run_command("check", flat, "--fidelity", "shell")
    assert code == 0, err
    assert "Warning: Member strip is one flat wall" in out
    bad = tmp_path / "bad.yaml"
    bad.write_text(
        EXAMPLE.read_text().replace("duration: 100 ms", "duration: 100 ms\n  shell: {element_size: 90 mm}")
    )
    assert run_command("check", bad)[0] == 0
    for fidelity in ("shell", "both"):
        code, out, err = run_command("check", bad, "--fidelity", fidelity)
        assert (code, out) == (2, "")
        assert err.count("the elements are larger than the section of member tube") == 1
        assert "bad.yaml:38" in err


@pytest.mark.parametrize("verb", ["run", "compare", "check"])
@pytest.mark.parametrize(
    "content",
    [None, b"", b"\x00\xff\xfe\x80", b"crumple: 1\n", b"a: &x 1\nb: *x\n", b"!!python/object:os.system\n"],
)
def test_bad_files_are_refused(run_command, tmp_path: Path, verb: str, content: bytes | None) -> None:
    file = tmp_path / "file.yaml"
    if content is not None:
        file.write_bytes(content)
    code, out, err = run_command(verb, file)
    assert (code, out) == (2, "")
    assert "file.yaml" in err


def test_run_into_a_file_is_refused(run_command, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    code, _, err = run_command("run", EXAMPLE, "--out", tmp_path / "taken")
    assert code == 2
    assert "taken" in err


def test_schema_is_json(run_command) -> None:
    code, out, _ = run_command("schema")
    assert code == 0
    assert "members" in json.loads(out)["properties"]


def test_section(run_command) -> None:
    code, out, _ = run_command("section", TUBE, "--material", f"{STEEL}, density 7850 kg/m^3")
    assert code == 0
    # area of the tube from its outer and inner rectangle, and its mass
    assert "369.41 mm^2" in out
    assert "2.8999 kg/m" in out
    assert "Assumed: nu 0.3" in out
    assert "density" not in out


def test_section_of_a_file(run_command) -> None:
    assert "369.41 mm^2" in run_command("section", f"{EXAMPLE}:tube")[1]
    code, _, err = run_command("section", f"{EXAMPLE}:tubes")
    assert code == 2
    assert "no section 'tubes'" in err


def test_corner_radius_and_circular_tube(run_command) -> None:
    assert "corner radius 5 mm" in run_command("section", f"{TUBE}, corner radius 5 mm")[1]
    assert "circular tube 60 x 2 mm" in run_command("section", "circular tube 60x2 mm")[1]


def test_hinge_prints_laws_side_by_side(run_command, tmp_path: Path) -> None:
    curve = tmp_path / "test.csv"
    with curve.open("w", newline="") as file:
        csv.writer(file).writerows([("rotation [deg]", "moment [kN*m]"), (0, 1.5), (30, 0.5)])
    figure = tmp_path / "laws.svg"
    code, out, _ = run_command(
        "hinge", TUBE, "--material", STEEL, "--curve", curve, "--to", "30 deg", "--figure", figure
    )
    assert code == 0
    for word in ("constant", "kecman", "test.csv", "Source:", "Range:", "Not shown: wierzbicki"):
        assert word in out
    # the last row holds the measured point in the table's unit
    assert any(
        line.split()[1] == "30" and line.split()[-2] == "0.500" for line in out.splitlines() if " 30 " in line
    )
    assert figure.read_text().startswith("<svg")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("section", "box 50x25 mm"), "not a section"),
        (("section", "rectangular_tube 50x25 mm"), "3 dimensions, not 2"),
        (("section", "rectangular_tube 50x25x20 mm"), "half the smaller side"),
        (("section", "rectangular_tube 50x25x2 kg"), "but a length is needed"),
        (("section", "rectangular_tube 9**9**9 mm"), "not a section"),
        (("section", "circular_tube 60x2 mm, corner radius 5 mm"), "does not belong"),
        (("section", TUBE, "--material", "E 210 GPa"), "missing: yield"),
        (("section", TUBE, "--material", "yield 488 MPa, yield 1 MPa, E 1 GPa"), "given twice"),
        (("section", TUBE, "--material", "strength 488 MPa"), "not a property"),
        (("hinge", TUBE, "--material", "yield 488 mm, E 210 GPa"), "but a stress is needed"),
        (("hinge", TUBE, "--material", STEEL, "--axis", "x"), "bending axis"),
        (("hinge", TUBE, "--material", STEEL, "--law", "nothing"), "unknown hinge law"),
        (("hinge", "circular_tube 60x2 mm", "--material", STEEL, "--law", "kecman"), "rectangular tubes"),
        (("hinge", TUBE, "--material", STEEL, "--to", "0 deg"), "out of range"),
        (("hinge", TUBE, "--material", STEEL, "--to", "30 m"), "but an angle is needed"),
        (("hinge", TUBE, "--material", STEEL, "--curve", "nowhere.csv"), "nowhere.csv"),
        (("hinge", TUBE, "--material", STEEL, "--to", "60"), "--to: the unit is missing"),
        (("hinge", TUBE, "--material", STEEL, "--law", "nix"), "--law: unknown hinge law"),
        (("hinge", TUBE, "--material", "yield 350"), "--material: the unit is missing"),
        (("section", TUBE, "--material", STEEL, "--axial", "20"), "--axial: the unit is missing"),
        (("section", TUBE, "--angle", "30"), "--angle: the unit is missing"),
        (("characterise", TUBE, "--material", STEEL, "--to", "60"), "--to: the unit is missing"),
        (("characterise", TUBE, "--material", STEEL, "--angle", "30"), "--angle: the unit is missing"),
        (("run", EXAMPLE, "--fidelity", "magic"), "multibody"),
        (("walk",), "walk"),
    ],
)
def test_wrong_arguments(run_command, arguments: tuple[str, ...], message: str) -> None:
    code, out, err = run_command(*arguments)
    assert (code, out) == (2, "")
    assert message in " ".join(err.split())


@pytest.mark.parametrize(
    ("rows", "line", "message"),
    [
        ("0, 1\n# note\n5, 2\n3, 3\n", 5, "the rotations do not increase"),
        ("0, 1\n5, -2\n", 3, "the moment is not positive"),
        ("0, 1\n5, 2\n\n300, 2\n", 5, "the rotation is more than half a turn"),
        ("0, 0\n1, 2\n", 2, "give the file to a law 'type: measured' of an input file"),
    ],
)
def test_rows_of_a_measured_curve_are_refused_by_their_lines(run_command, tmp_path, rows, line, message):
    file = tmp_path / "curve.csv"
    file.write_text(f"rotation [deg], moment [kN*m]\n{rows}", encoding="utf-8")
    code, out, err = run_command("hinge", TUBE, "--material", STEEL, "--curve", file)
    assert (code, out) == (2, "")
    assert f"{file}:{line}: --curve: " in err
    assert message in " ".join(err.split())


def test_run_imports_nothing_slow(tmp_path: Path) -> None:
    code = (
        "import sys\nfrom crumple.cli.main import app\n"
        f"app(['run', {str(EXAMPLE)!r}, '--out', {str(tmp_path)!r}], standalone_mode=False)\n"
        "slow = ('pandas', 'matplotlib.pyplot', 'scipy.optimize', 'pint')\n"
        "print([name for name in slow if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_results_folder_that_cannot_be_used_is_refused_by_its_own_name(run_command, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    for place in (file, file / "deeper"):
        code, out, err = run_command("run", EXAMPLE, "--out", place)
        assert (code, out) == (2, "")
        assert f"cannot be written to {place}: a file has this name, or the name of a folder above it" in err
    assert file.read_text() == "mine"
    for nothing in ("", "  "):
        code, _, err = run_command("run", EXAMPLE, "--out", nothing)
        assert code == 2
        assert "the name of the results' folder is empty" in err


@pytest.mark.parametrize("name", ["summary.json", "histories.csv", "result.vtkhdf", "report.html", "figures"])
def test_what_is_in_the_way_of_a_result_is_found_before_the_run(
    run_command, tmp_path: Path, monkeypatch, name: str
) -> None:
    import crumple.analysis

    monkeypatch.setattr(crumple.analysis, "solve_with_frames", None)
    if name == "figures":
        (tmp_path / name).write_text("mine")
    else:
        (tmp_path / name).mkdir()
    code, _, err = run_command("run", EXAMPLE, "--out", tmp_path)
    assert code == 2
    assert f"{tmp_path / name} is a folder, but a result file has this name" in err
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_full_disk_is_reported_without_temporary_names(run_command, tmp_path: Path, monkeypatch) -> None:
    import crumple.result

    def full(result, folder):
        raise OSError(errno.ENOSPC, "Can't write data", str(folder / ".histories.csv.private"))

    monkeypatch.setattr(crumple.result, "write", full)
    code, _, err = run_command("run", EXAMPLE, "--out", tmp_path)
    assert code == 2
    assert f"cannot be written to {tmp_path}: {os.strerror(errno.ENOSPC)}" in err
    assert "private" not in err


def test_a_path_where_no_folder_can_be_created_is_reported(run_command) -> None:
    code, _, err = run_command("run", EXAMPLE, "--out", "/proc/results")
    assert code == 2
    assert "cannot be written to /proc/results: No such file or directory" in err


def test_help_lists_every_exit_code(run_command) -> None:
    _, out, _ = run_command("--help")
    reported = " ".join(out.split())
    assert all(
        text in reported for text in ("0 done", "1 a run", "2 the input, or the folder", "130 ended by")
    )
