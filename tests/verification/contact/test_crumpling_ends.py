"""Ends of members that meet a plane obliquely crumple at the force of the outline that it has met.

A member that slides along its axis with a mass m strikes a plane whose normal makes an angle with it.  When
it has gone on by x, the point i of its face, a_i behind the first, is crushed by d_i = max(0, (x - a_i) cos):
the energy m v^2/2 is the sum of f_i d_i, whose only unknown is x.

Kind: closed form.  Source: derived here.
"""

from math import cos, radians, sin, tan

import numpy as np
import pytest

import crumple
from crumple.hinge.registry import build_axial_law
from crumple.multibody.bodies.crumpling_ends import OBLIQUE, crumpling_ends, points_around
from crumple.report.wording.along import crumpled_table
from crumple.report.wording.answer import three_sentences
from crumple.report.wording.wording import verdict
from crumple.result import read, write

MODEL = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: SECTION
nodes:
  back: [0 m, 0 m, 0 m]
  tip: [400 mm, 0 m, 0 m]
members:
  rail: {nodes: [back, tip], section: tube, material: steel}
masses:
  sled: {node: back, mass: 30 kg}
supports:
  slide: {node: back, fix: [y, z, rx, ry, rz]}
initial_velocity:
  - {translation: [5 m/s, 0 m/s, 0 m/s]}
obstacles:
  wall: {type: plane, point: POINT, normal: NORMAL}
analysis:
  duration: 20 ms
  multibody: {members: rigid}
outputs:
  every: 0.1 ms
"""
SECTIONS = {
    "rectangle": "{type: rectangular_tube, width: 40 mm, depth: 50 mm, thickness: 3 mm}",
    "round": "{type: circular_tube, diameter: 50 mm, thickness: 2 mm}",
}


def thrown(section, normal, change=("", "")):
    """A rail in front of a plane that its face is just to touch."""
    text = MODEL.replace("SECTION", SECTIONS.get(section, section)).replace("NORMAL", f"{list(normal)}")
    text = text.replace(*change)
    plain = crumple.loads(text.replace("POINT", "[1 m, 0 m, 0 m]"))
    structure = plain.structure
    outline = structure.section_of("rail").outer_outline() @ structure.frame_of("rail").axes[1:]
    face = np.array(structure.nodes["tip"]) + outline
    nearest = face[(face @ np.array(normal)).argmin()]
    point = "[" + ", ".join(f"{value!r} m" for value in (nearest + np.array([1e-9, 0.0, 0.0])).tolist()) + "]"
    return crumple.loads(text.replace("POINT", point))


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize(("tilt", "turn"), [(10, 0), (20, 0), (15, 10)])
def test_the_blow_ends_where_its_energy_is_taken_up(section, tilt, turn, record_figure):
    tilted, turned = radians(tilt), radians(turn)
    normal = np.array([-cos(tilted) * cos(turned), -sin(turned), -sin(tilted) * cos(turned)])
    analysis = thrown(section, normal.tolist())
    (end,) = crumpling_ends(analysis.structure)
    structure = analysis.structure
    kind = structure.section_of("rail").kind
    law = build_axial_law(
        {"rectangular_tube": "superfolding", "circular_tube": "circular"}[kind],
        structure.section_of("rail"),
        structure.material_of("rail"),
    )
    assert end.force == pytest.approx(OBLIQUE[kind] * law.mean_crushing_force)
    outline = structure.section_of("rail").outer_outline()
    points = points_around(outline)
    across = np.array([place for place, _ in points]) @ structure.frame_of("rail").axes[1:]
    ahead = -across @ normal / normal[0]
    ahead = ahead.max() - ahead
    shares = np.array([share for _, share in points])
    mass = 30.0 + structure.section_of("rail").area * 0.4 * 7850.0
    way = np.linspace(0.0, 0.04, 40001)
    taken = (end.force * shares * np.maximum(way[:, None] - ahead, 0.0)).sum(axis=1) * -normal[0]
    stop = float(np.interp(mass * 5.0**2 / 2.0, taken, way))
    result = crumple.solve(analysis)
    assert result.status.ok, result.reason
    (found,) = result.crumpled_ends
    assert (found.member, found.node, found.obstacle) == ("rail", "tip", "wall")
    record_figure(f"depth, {section} {tilt} {turn}", found.depth, stop * -normal[0], 1e-2, "m", relative=True)
    record_figure(
        f"energy, {section} {tilt} {turn}", found.energy, mass * 5.0**2 / 2.0, 2e-3, "J", relative=True
    )


@pytest.mark.parametrize("section", SECTIONS)
def test_points_share_the_perimeter(section):
    outline = thrown(section, [-1.0, 0.0, 0.0]).structure.section_of("rail").outer_outline()
    points = points_around(outline)
    assert len(points) == 8
    shares = np.array([share for _, share in points])
    assert shares.sum() == pytest.approx(1.0)
    assert np.allclose(np.array([place for place, _ in points]).T @ shares, outline.mean(axis=0), atol=1e-4)
    if section == "rectangle":
        # corners stand for a quarter of each side, middles of sides for half of theirs
        assert sorted(set(np.round(shares, 6))) == pytest.approx([40 / 360, 45 / 360, 50 / 360], abs=1e-5)


def test_square_ends_and_closed_ends_do_not():
    oblique = [-cos(0.2), 0.0, -sin(0.2)]
    hat = "{type: hat, width: 40 mm, depth: 50 mm, thickness: 2 mm, flange: 15 mm}"
    assert not list(crumpling_ends(thrown("rectangle", [-1.0, 0.0, 0.0]).structure))
    # ahead by less than a wall
    slightly = 0.9 * 3.0 / 50.0
    assert not list(crumpling_ends(thrown("rectangle", [-1.0, 0.0, -tan(slightly)]).structure))
    assert not list(crumpling_ends(thrown(hat, oblique).structure))
    closed = thrown("rectangle", oblique).structure
    assert list(crumpling_ends(closed))
    plate = closed.model_copy(
        update={
            "masses": {**closed.masses, "plate": closed.masses["sled"].model_copy(update={"node": "tip"})}
        }
    )
    assert not list(crumpling_ends(plate))
    for change in (
        ("material: steel}\nmasses", "material: steel, rigid: true}\nmasses"),
        ("material: steel}\nmasses", "material: steel, rigid: [{start: 350 mm, end: 400 mm}]}\nmasses"),
        ("supports:", "loads: [{node: tip, force: {x: -1 N}}]\nsupports:"),
    ):
        assert not list(crumpling_ends(thrown("rectangle", oblique, change).structure)), change


def test_an_end_that_is_used_up_says_so():
    """A heavier blow closes the end; its files keep what crumpled."""
    analysis = thrown("round", [-cos(0.3), 0.0, -sin(0.3)])
    assert "crumpled_end" not in {caution.code for caution in crumple.solve(analysis).cautions}
    sled = analysis.structure.masses["sled"].model_copy(update={"mass": 3000.0})
    heavy = analysis.structure.model_copy(update={"masses": {"sled": sled}})
    result = crumple.solve(analysis.model_copy(update={"structure": heavy}))
    (caution,) = [caution for caution in result.cautions if caution.code == "crumpled_end"]
    assert caution.value > 0.95 * 0.05
    assert "End tip of member rail" in caution.text


def test_results_list_what_crumpled(tmp_path):
    """In files, on the page and in the summary."""
    result = crumple.solve(thrown("rectangle", [-cos(0.3), 0.0, -sin(0.3)]))
    write(result, tmp_path)
    assert read(tmp_path).crumpled_ends == result.crumpled_ends
    (end,) = result.crumpled_ends
    ((name, member, obstacle, depth, _),) = crumpled_table(result).rows
    assert (name, member, obstacle) == ("tip", "rail", "wall")
    assert "crumpled end tip" in three_sentences(result, verdict(result, 1e-3, 1e-3))[0]
    assert float(depth) == pytest.approx(end.depth * 1e3, rel=0.01)
