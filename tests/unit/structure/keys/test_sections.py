"""Sections of walls and metals of other names, from keys and from objects of the section room."""

from __future__ import annotations

import pickle
import subprocess
import sys

import pytest
from pydantic import TypeAdapter

from crumple import section
from crumple.errors import InputError
from crumple.material import Material, Swift, grade, grade_curve
from crumple.structure import MaterialSpec, Structure, placed_hinges
from crumple.structure.keys.section import SectionSpec

MILD = Material("mild", 210e9, 0.3, 7850.0, 300e6)
STRONG = Material("in place", 210e9, 0.3, 7850.0, 600e6)
SHAPES = {
    "square_tube": (
        {"side": "40 mm", "thickness": "2 mm", "corner_radius": "5 mm"},
        section.square_tube(0.04, 0.002, 0.005),
    ),
    "channel": (
        {"width": "40 mm", "depth": "80 mm", "thickness": "2 mm", "corner_radius": "4 mm", "lip": "15 mm"},
        section.Channel(0.04, 0.08, 0.002, 0.004, 0.015),
    ),
    "angle": (
        {"width": "40 mm", "depth": "60 mm", "thickness": "3 mm", "corner_radius": "5 mm"},
        section.Angle(0.04, 0.06, 0.003, 0.005),
    ),
    "hat": (
        {
            "width": "60 mm",
            "depth": "50 mm",
            "thickness": "1.5 mm",
            "flange": "20 mm",
            "corner_radius": "4 mm",
        },
        section.Hat(0.06, 0.05, 0.0015, 0.02, 0.004),
    ),
    "closed_hat": (
        {
            "width": "60 mm",
            "depth": "50 mm",
            "thickness": "1.5 mm",
            "flange": "20 mm",
            "corner_radius": "4 mm",
            "plate_thickness": "1 mm",
        },
        section.ClosedHat(0.06, 0.05, 0.0015, 0.02, 0.004, 0.001),
    ),
    "multi_cell_tube": (
        {
            "width": "90 mm",
            "depth": "60 mm",
            "thickness": "3 mm",
            "columns": 3,
            "rows": 2,
            "inner_thickness": "2 mm",
            "corner_radius": "6 mm",
        },
        section.MultiCellTube(0.09, 0.06, 0.003, 3, 2, 0.002, 0.006),
    ),
    "walls": (
        {
            "name": "two sheets",
            "walls": [
                {"points": [[0, 0], ["50 mm", 0], ["50 mm", "30 mm"]], "thickness": "2 mm", "name": "sheet"},
                {"points": [["5 mm", "-1.5 mm"], ["30 mm", "-1.5 mm"]], "thickness": "1 mm"},
            ],
            "welds": [{"first": ["20 mm", 0], "second": ["20 mm", "-1.5 mm"]}],
        },
        section.WallSection(
            (
                section.Wall(((0.0, 0.0), (0.05, 0.0), (0.05, 0.03)), 0.002, name="sheet"),
                section.Wall(((0.005, -0.0015), (0.03, -0.0015)), 0.001),
            ),
            (section.Weld((0.02, 0.0), (0.02, -0.0015)),),
            "two sheets",
        ),
    ),
}


def spec_of(given: object):
    return TypeAdapter(SectionSpec).validate_python(given)


@pytest.mark.parametrize("kind", SHAPES)
def test_keys_make_the_section_that_they_describe(kind):
    given, meant = SHAPES[kind]
    made = spec_of({"type": kind, **given}).section()
    assert made.title == meant.title
    for part in ("area", "second_moment_y", "second_moment_z", "torsion_constant"):
        assert getattr(made, part) == pytest.approx(getattr(meant, part), rel=1e-12)


@pytest.mark.parametrize("kind", SHAPES)
def test_a_section_of_its_room_comes_back(kind):
    meant = SHAPES[kind][1]
    assert spec_of(meant).section({}) == meant


def test_metals_of_walls_are_those_of_the_structure(keys):
    keys["materials"]["strong"] = STRONG
    keys["sections"]["tube"] = {"type": "closed_hat", **SHAPES["closed_hat"][0], "plate_material": "strong"}
    keys["members"]["arm"]["hinges"][0]["law"] = "constant"
    structure = Structure(**keys)
    hat, plate = structure.section_of("arm").walls
    assert hat.material is None
    assert (plate.material.name, plate.material.yield_stress) == ("strong", 600e6)
    assert structure.section_of("arm") is structure.section_of("arm")
    assert pickle.loads(pickle.dumps(structure)) == structure
    stronger = structure.model_copy(
        update={
            "materials": {
                **structure.materials,
                "strong": structure.materials["strong"].model_copy(update={"yield_stress": 700e6}),
            }
        }
    )
    assert stronger.section_of("arm").walls[1].material.yield_stress == 700e6


def test_a_hinge_knows_the_metals_of_the_walls(keys):
    # a box bent about y with none, either or all of its walls of a soft metal; first and third are its webs
    soft = Material("soft", 70e9, 0.3, 2700.0, 200e6)
    sheets = [
        {"points": [[0, 0], [0, 0.05]], "thickness": 0.002, "material": soft},
        {"points": [[0, 0.05], [0.03, 0.05]], "thickness": 0.002},
        {"points": [[0.03, 0.05], [0.03, 0]], "thickness": 0.002},
        {"points": [[0.03, 0], [0, 0]], "thickness": 0.002},
    ]
    structures = []
    for metals in ((soft, None, None, None), (None, None, soft, None), (soft,) * 4, (None,) * 4):
        walls = [{**sheet, "material": metal} for sheet, metal in zip(sheets, metals, strict=True)]
        keys["sections"]["tube"] = {"type": "walls", "walls": walls}
        keys["members"]["arm"]["hinges"][0] |= {"law": "constant", "axis": "y"}
        structures.append(Structure(**keys))
    moments = [placed_hinges(one)[0].record.positive.moment[0] for one in structures]
    rigidities = [one.flexural_rigidity("arm", "y") for one in structures]
    assert moments[0] == pytest.approx(moments[1])
    assert moments[2] / moments[3] == pytest.approx(200.0 / 488.0)
    assert rigidities[2] / rigidities[3] == pytest.approx(70.0 / 210.0)
    # one web of the box of 30 x 50 mm mid-lines, within what its mitred corners add
    web = 0.002 * 0.05**2 / 4.0
    assert moments[3] - moments[0] == pytest.approx(web * (488e6 - 200e6), rel=0.05)
    web = 0.002 * 0.05**3 / 12.0
    assert rigidities[3] - rigidities[0] == pytest.approx(web * (210e9 - 70e9), rel=0.05)


def test_metals_in_place_come_back_from_python():
    for meant in (
        section.ClosedHat(0.06, 0.05, 0.0015, 0.02, plate_material=STRONG),
        section.WallSection((section.Wall(((0, 0), (0.05, 0)), 0.002, material=STRONG),)),
    ):
        assert spec_of(meant).section({}) == meant
        assert hash(spec_of(meant)) == hash(spec_of(meant))


def test_unknown_metals_are_named_with_what_is_near(keys):
    keys["materials"]["strong"] = STRONG
    keys["sections"]["tube"] = {"type": "closed_hat", **SHAPES["closed_hat"][0], "hat_material": "strnog"}
    keys["sections"]["sheet"] = {
        "type": "walls",
        "walls": [{"points": [[0, 0], [0.05, 0]], "thickness": 0.002, "material": "copper"}],
    }
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    found = {problem.where: problem for problem in refusal.value.problems}
    assert set(found) == {"sections.tube.hat_material", "sections.sheet.walls[0].material"}
    assert found["sections.tube.hat_material"].todo == "did you mean 'strong'?"
    with pytest.raises(InputError, match="no material 'strnog'"):
        spec_of(keys["sections"]["tube"]).section({})


@pytest.mark.parametrize(
    ("kind", "change", "where", "message"),
    [
        ("hat", {"thickness": "30 mm"}, "thickness", "half"),
        ("channel", {"corner_radius": "50 mm"}, "corner_radius", "corner radius"),
        ("multi_cell_tube", {"columns": 21}, "columns", "too large"),
        ("multi_cell_tube", {"rows": 1.5}, "rows", "whole number"),
        ("closed_hat", {"flange": 0}, "flange", "more than 0"),
        ("square_tube", {"width": "50 mm"}, "width", "unknown key"),
        ("angle", {"type": "angel"}, "", "did you mean 'angle'?"),
    ],
)
def test_what_cannot_be_is_refused_with_its_path(keys, kind, change, where, message):
    keys["sections"]["odd"] = {"type": kind, **SHAPES[kind][0], **change}
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    (problem,) = refusal.value.problems
    assert problem.where == f"sections.odd.{where}".rstrip(".")
    assert message in str(problem)


def test_problems_of_walls_name_their_place_and_their_names(keys):
    wall = {"points": [[0, 0], ["50 mm", 0], ["50 mm", 0]], "thickness": "2 mm", "name": "left"}
    across = {"points": [["20 mm", "-20 mm"], ["20 mm", "20 mm"]], "thickness": "2 mm", "name": "across"}
    keys["sections"]["repeated"] = {"type": "walls", "walls": [across, wall]}
    wall = {**wall, "points": wall["points"][:2]}
    keys["sections"]["crossed"] = {"type": "walls", "walls": [wall, across]}
    many = {"points": [[0.001 * i, 0] for i in range(300)], "thickness": 0.002}
    keys["sections"]["many"] = {"type": "walls", "walls": [many, many]}
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    found = {problem.where: problem.what for problem in refusal.value.problems}
    assert found["sections.repeated.walls[1].points[1]"] == "the wall has a side without length"
    assert "left" in found["sections.crossed.walls[0]"]
    assert "across" in found["sections.crossed.walls[0]"]
    assert found["sections.many.walls"] == "the walls have too many points"


@pytest.mark.parametrize(
    ("kind", "law", "axis"),
    [
        ("hat", "folded_profile", "y"),
        ("closed_hat", "folded_profile", "y"),
        ("channel", "constant", "y"),
        ("angle", "constant", "z"),
        ("walls", {"type": "table", "rotation": ["0 deg", "30 deg"], "moment": ["1 kN*m", "0.5 kN*m"]}, "y"),
        ("multi_cell_tube", "constant", "y"),
        ("square_tube", None, "y"),
    ],
)
def test_hinges_in_sections_of_walls_lie_where_the_fold_turns(keys, kind, law, axis):
    keys["sections"]["tube"] = {"type": kind, **SHAPES[kind][0]}
    keys["members"]["arm"]["hinges"] = [{"name": "fold", "at": "root", "axis": axis}]
    if law is not None:
        keys["members"]["arm"]["hinges"][0]["law"] = law
    structure = Structure(**keys)
    (hinge,) = placed_hinges(structure)
    inside = section.fold_distance(structure.section_of("arm"), axis)
    assert 0.0 < hinge.station == pytest.approx(inside)
    assert hinge.record.positive.moment[0] > 0.0


@pytest.mark.parametrize(
    ("law", "message"),
    [("kecman", "rectangular tube"), ("folded_profile", "about")],
)
def test_a_law_that_does_not_fit_is_refused(keys, law, message):
    keys["sections"]["tube"] = {"type": "channel", **SHAPES["channel"][0]}
    keys["members"]["arm"]["hinges"] = [{"name": "fold", "at": "root", "axis": "y", "law": law}]
    with pytest.raises(InputError, match=message):
        Structure(**keys)


def test_a_grade_fills_in_what_is_not_given():
    spec = MaterialSpec(grade="s355", yield_stress="400 MPa")
    assert spec.grade == "S355"
    assert spec.statement == grade("S355").statement
    made, typical = spec.material("steel"), grade("S355").material
    assert made.yield_stress == 400e6
    assert made.ultimate_stress == typical.ultimate_stress
    assert made.hardening == grade_curve("S355", 400e6)
    plain = MaterialSpec(grade="S355").material("S355")
    assert plain == typical
    constant = MaterialSpec(grade="S355", flow_stress=4.5e8).material("")
    assert (constant.flow_stress, constant.hardening) == (4.5e8, None)
    own = MaterialSpec(grade="S355", hardening={"type": "swift", "prestrain": 0.01, "exponent": 0.1})
    assert own.material("").hardening == Swift(355e6, 0.01, 0.1)
    assert MaterialSpec(**spec.model_dump()) == spec


def test_a_grade_in_a_file_needs_no_units():
    context = {"file": True}
    assert MaterialSpec.model_validate({"grade": "DP600"}, context=context) == MaterialSpec(grade="DP600")


def test_an_unknown_grade_is_one_mistake():
    with pytest.raises(InputError) as refusal:
        MaterialSpec(grade="S356")
    (problem,) = refusal.value.problems
    assert (problem.where, problem.todo) == ("grade", "did you mean 'S355'?")
    assert "DP600" in problem.allowed


def test_an_ultimate_stress_below_the_yield_stress_of_a_grade_is_refused():
    with pytest.raises(InputError, match="below the yield stress"):
        MaterialSpec(grade="S355", yield_stress="900 MPa")


def test_tubes_alone_import_no_walls():
    code = (
        "import sys\n"
        "from crumple.structure.keys.section import SectionSpec\n"
        "from pydantic import TypeAdapter\n"
        "TypeAdapter(SectionSpec).validate_python("
        "{'type': 'rectangular_tube', 'width': 0.05, 'depth': 0.03, 'thickness': 0.002})\n"
        "print([n for n in sys.modules if n.startswith('crumple.section.wall')"
        " or n in ('scipy', 'pint', 'matplotlib')])"
    )
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"
