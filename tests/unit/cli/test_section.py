"""`crumple section` and the sections and materials that can be written on the command line."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

import pytest

from crumple import section as room
from crumple.cli import main as command
from crumple.cli.console.named import material_of, section_of
from crumple.errors import InputError
from crumple.material import grade
from crumple.section import moment_capacity

HAT = "hat 60x50x1.5 mm, flange 20 mm, corner radius 4 mm"
FILE = """
crumple: 1
materials:
  mild: {grade: S355}
  strong: {grade: DP600}
sections:
  hat:
    {type: closed_hat, width: 60 mm, depth: 50 mm, thickness: 1.5 mm, flange: 20 mm, plate_material: strong}
nodes: {root: [0 m, 0 m, 0 m], tip: [1 m, 0 m, 0 m]}
members:
  beam: {nodes: [root, tip], section: hat, material: mild, hinges: [{name: fold, at: root, law: constant}]}
supports:
  clamp: {node: root, fix: all}
initial_velocity: [{rotation: 1 rad/s, axis: [0, -1, 0]}]
analysis: {duration: 10 ms}
"""


@pytest.fixture
def run_command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Call `crumple section` with arguments; gives exit code, standard output, standard error."""

    def call(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["crumple", "section", *map(str, arguments)])
        monkeypatch.setenv("COLUMNS", "200")
        code = 0
        try:
            command.main()
        except SystemExit as stop:
            code = int(stop.code or 0)
        return code, *capsys.readouterr()

    return call


def row(out: str, label: str) -> list[str]:
    """Cells after the first of the table row with a label."""
    (found,) = [line for line in out.splitlines() if re.match(rf"│ {re.escape(label)} +│", line)]
    return [cell.strip() for cell in found.split("│")[2:-1]]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("rectangular_tube 50x25x2 mm, corner radius 5 mm", room.RectangularTube(0.05, 0.025, 0.002, 0.005)),
        ("square tube 4x0.2 cm", room.square_tube(0.04, 0.002)),
        ("square_tube 70x70x2", room.square_tube(0.07, 0.002)),
        ("circular_tube 60x2", room.CircularTube(0.06, 0.002)),
        ("circular_tube 60x2 mm", room.CircularTube(0.06, 0.002)),
        (
            "channel 40x80x2 mm, lip 15 mm, corner radius 4 mm",
            room.Channel(0.04, 0.08, 0.002, 0.004, 0.015),
        ),
        ("angle 40×60×3 mm", room.Angle(0.04, 0.06, 0.003)),
        (HAT, room.Hat(0.06, 0.05, 0.0015, 0.02, 0.004)),
        (
            "closed hat 60x50x1.5 mm, flanges 20 mm, plate 1 mm",
            room.ClosedHat(0.06, 0.05, 0.0015, 0.02, plate_thickness=0.001),
        ),
        (
            "multi-cell tube 90x60x3 mm, cells 3x2, inner walls 2 mm",
            room.MultiCellTube(0.09, 0.06, 0.003, 3, 2, 0.002),
        ),
    ],
)
def test_sections_in_one_line(text: str, meant: object) -> None:
    made = section_of(text)
    assert type(made) is type(meant)
    assert made.title == meant.title


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("hat 60x50x1.5 mm", "a hat needs its flange"),
        ("hat 60x50x1.5 mm, flange 20 mm, flanges 20 mm", "given twice"),
        ("hat 60x50x1.5 mm, flange 20 kg", "a length is needed"),
        ("hat 60x50x1.5 mm, cells 2x2", "does not belong to a hat"),
        ("angle 40x60x3 mm, lip 5 mm", "does not belong to an angle"),
        ("multi_cell_tube 90x60x3 mm, cells 30x2", "1 to 20"),
        ("square_tube 40x30x2 mm", "2 dimensions, not 3"),
        ("square_tube 40x40x40x2", "2 dimensions, not 4"),
        ("hat 60x50x40 mm, flange 20 mm", "half"),
        ("walls 50x25x2 mm", "this is not a section"),
    ],
)
def test_wrong_sections_are_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        section_of(text)


def test_grades_on_the_command_line() -> None:
    made, notes = material_of("S355")
    assert made == grade("S355").material
    assert notes == [grade("S355").statement]
    changed, _ = material_of("grade dp600, yield 400 MPa")
    assert (changed.name, changed.yield_stress) == ("DP600", 400e6)
    assert material_of("dp600, flow 500 MPa")[0].flow_stress == 500e6
    with pytest.raises(InputError, match="not a property"):
        material_of("S999")


def test_geometry_of_an_open_section(run_command) -> None:
    code, out, _ = run_command(HAT, "--angle", "30 deg")
    assert code == 0
    hat = room.Hat(0.06, 0.05, 0.0015, 0.02, 0.004)
    assert row(out, "Area") == [f"{hat.area * 1e6:.5g} mm^2"]
    assert row(out, "Shear centre y, z from the centroid") == [f"0 m, {hat.shear_centre[1] * 1e3:.5g} mm"]
    assert row(out, "Warping constant") == [f"{hat.warping_constant * 1e12:.5g} cm^6"]
    turned = hat.second_moment(math.radians(30.0)) * 1e8
    assert row(out, "Second moment of area about 30 deg") == [f"{turned:.5g} cm^4"]
    assert row(out, "Principal axis, from y towards z") == ["90 deg"]
    assert "Squash force" not in out


def test_what_a_section_carries(run_command, tmp_path: Path) -> None:
    figure = tmp_path / "hat.svg"
    arguments = ("--material", "S355", "--axial", "-20 kN", "--angle", "30 deg", "--figure", figure)
    code, out, _ = run_command(HAT, *arguments)
    assert code == 0
    hat, steel = section_of(HAT), grade("S355").material
    for label, axis, sense in (("+y", "y", 1), ("-y", "y", -1), ("+(30 deg)", math.pi / 6, 1)):
        meant = moment_capacity(hat, steel, axis, sense=sense, axial_force=-20e3)
        values = (meant.moment, meant.elastic_moment, meant.plastic_moment, meant.effective_moment)
        cells = row(out, label)
        assert [float(cell) for cell in cells[:4]] == pytest.approx([v / 1e3 for v in values], abs=1e-4)
    assert row(out, "Squash force") == [f"{steel.yield_stress * hat.area / 1e3:.5g} kN"]
    assert "axial force of -20 kN" in out
    assert "Warning: open section" in out
    assert "Assumed: S355: typical, not design values" in out
    assert figure.read_text().startswith("<svg")


def test_a_section_of_two_metals_from_a_file(run_command, tmp_path: Path) -> None:
    file = tmp_path / "model.yaml"
    file.write_text(FILE)
    code, out, _ = run_command(f"{file}:hat", "--material", f"{file}:mild")
    assert code == 0
    mild, strong = grade("S355").material, grade("DP600").material
    hat = room.ClosedHat(0.06, 0.05, 0.0015, 0.02, plate_material=strong)
    plate = 0.1 * 0.0015
    squash = mild.yield_stress * (hat.area - plate) + strong.yield_stress * plate
    assert row(out, "Squash force") == [f"{squash / 1e3:.5g} kN"]
    assert "independent of the materials" in out
    assert "Assumed: S355" in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--axial", "20 kN"), "needs a material"),
        (("--material", "S355", "--axial", "900 kN"), "more than the section carries"),
        (("--material", "S355", "--axial", "20 mm"), "a force is needed"),
        (("--angle", "30"), "unit"),
    ],
)
def test_wrong_options(run_command, arguments: tuple[str, ...], message: str) -> None:
    code, out, err = run_command(HAT, *arguments)
    assert (code, out) == (2, "")
    assert message in " ".join(err.split())
