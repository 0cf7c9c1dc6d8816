"""Meshes of members and joints: numbers, orientation, shared nodes, cuts, refusals by name."""

import dataclasses

import numpy as np
import pytest
from tests.support.shell.structures import STEEL, TUBE, cantilever, knee, structure, tee, thrown

from crumple.analysis.input_file import check
from crumple.errors import InputError
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.mesh import mesh_of
from crumple.shell.mesh.quality import areas, report_of
from crumple.structure import Outputs, ShellSettings
from crumple.structure.hinges.corners import corners
from crumple.structure.hinges.joint_reach import joint_reach

COARSE = ShellSettings(element_size=12e-3)


def normals(mesh):
    corner = mesh.position[mesh.quads]
    return np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])


def test_five_millimetres_on_the_tube_of_example_01():
    mesh = mesh_of(thrown(), ShellSettings())
    report = report_of(thrown(), mesh)
    assert report.elements == 5600
    assert report.nodes == 201 * 28
    assert report.smallest_side == pytest.approx(47.35e-3 / 10)
    assert report.mass == pytest.approx(2 * (47.35e-3 + 22.35e-3) * 2.65e-3 * 7850, rel=1e-12)


def test_normals_point_outwards():
    mesh = mesh_of(tee(), COARSE)
    for tube in mesh.tubes.values():
        quads = mesh.quads[tube.elements_between(0, tube.last_ring)]
        middle = mesh.position[quads].mean(axis=1)
        arm = middle - tube.frame.origin
        arm = arm - (arm @ tube.frame.x)[:, None] * tube.frame.x
        own = normals(mesh)[tube.elements_between(0, tube.last_ring)]
        assert (np.einsum("ij,ij->i", own, arm) > 0).all()


def test_graded_mesh_is_fine_at_clamp_and_hinge_and_coarse_at_the_tip():
    settings = ShellSettings(element_size=15e-3, fine_size=5e-3, fine_length=60e-3)
    sides = np.diff(mesh_of(thrown(), settings).tubes["tube"].stations)
    # the hinge lies 23.1 mm inside, so the fine stretch ends 83.1 mm from the root
    assert sides[:15] == pytest.approx(5e-3, rel=0.05)
    assert sides[-1] == pytest.approx(15e-3, rel=0.05)
    assert len(sides) < 90


def test_fine_place_asked_for():
    settings = ShellSettings(
        element_size=15e-3, fine_size=5e-3, fine_length=30e-3, fine_at=[{"member": "tube", "at": 0.6}]
    )
    rings = mesh_of(cantilever(), settings).tubes["tube"].stations
    near = np.abs(rings[:-1] - 0.6) < 25e-3
    assert np.diff(rings)[near] == pytest.approx(5e-3, rel=0.1)


def test_asked_stations_have_rings():
    outputs = Outputs(section_rotations={"bend": {"member": "tube", "from": 0.111, "to": 0.333}})
    rings = mesh_of(cantilever(), COARSE, outputs).tubes["tube"].stations
    assert {0.111, 0.333} <= set(rings)


def test_knee_shares_the_nodes_of_a_mitre():
    mesh = mesh_of(knee(), COARSE)
    assert mesh.joints["b"].kind is Kind.MITRED
    one, two = mesh.tubes["one"], mesh.tubes["two"]
    assert set(one.nodes[-1]) == set(two.nodes[0])
    assert mesh.walls == one.nodes.size + two.nodes.size - len(one.nodes[-1])
    shared = mesh.position[one.nodes[-1]]
    # they lie in the plane that halves the right angle
    assert (shared[:, 0] - 0.5) == pytest.approx(-shared[:, 2], abs=1e-12)
    assert report_of(knee(), mesh).worst_aspect < 4.0


@pytest.mark.parametrize(("angle", "mitred"), [(60.0, True), (100.0, True), (101.0, False), (130.0, False)])
def test_automatic_hinges_and_shells_agree_which_corners_are_mitred(angle, mitred):
    turn = np.radians(angle)
    end = (0.5 + 0.5 * float(np.cos(turn)), 0.0, 0.5 * float(np.sin(turn)))
    given = knee()
    given = given.model_copy(update={"nodes": {**given.nodes, "c": end}})
    assert (mesh_of(given, COARSE).joints["b"].kind is Kind.MITRED) is mitred
    assert ("b" in corners(given)) is mitred
    assert (joint_reach(given, "one", "b") == 0.0) is mitred


def test_knee_with_a_mass_has_a_rigid_shared_section():
    given = knee().model_copy(update={"masses": {"m": {"node": "b", "mass": 1.0}}})
    mesh = mesh_of(given, COARSE)
    assert mesh.joints["b"].kind is Kind.MITRED
    assert mesh.joints["b"].is_body


def test_members_of_different_sections_do_not_share_nodes():
    small = {**TUBE, "width": 0.04}
    given = knee()
    given = given.model_copy(
        update={
            "sections": {"tube": TUBE, "small": small},
            "members": {**given.members, "two": given.members["two"].model_copy(update={"section": "small"})},
        }
    )
    assert mesh_of(given, COARSE).joints["b"].kind is Kind.RIGID


def test_three_members_are_cut_back_clear_of_each_other():
    mesh = mesh_of(tee(), COARSE)
    joint = mesh.joints["b"]
    assert joint.kind is Kind.RIGID
    # half the mid-line depth of the neighbour and a wall
    assert joint.cut == pytest.approx([22.35e-3 / 2 + 2.65e-3] * 3)
    assert len(mesh.reference) == 1
    assert mesh.position[mesh.reference["b"]] == pytest.approx([0.5, 0.0, 0.0])
    ends = [mesh.position[mesh.end_ring(end.member, end.second)] for end in joint.ends]
    gaps = [np.linalg.norm(a[:, None] - b[None], axis=2).min() for a in ends for b in ends if a is not b]
    assert min(gaps) > 2.65e-3


def test_members_within_each_other_are_refused():
    given = structure(
        {"a": (0, 0, 0), "b": (1, 0, 0), "c": (1, 0, 0.05)}, {"one": ("a", "b"), "two": ("a", "c")}
    )
    with pytest.raises(InputError, match=r"one and two overlap along their length at node a"):
        mesh_of(given, COARSE)


def test_member_too_short_for_its_joints_is_refused():
    given = structure(
        {"a": (0, 0, 0), "b": (0.03, 0, 0), "c": (0.03, 0, 0.5), "d": (0.5, 0, 0)},
        {"short": ("a", "b"), "up": ("b", "c"), "on": ("b", "d")},
    )
    with pytest.raises(InputError, match=r"cuts too much off member short"):
        mesh_of(given, COARSE)


def test_too_many_elements_are_refused():
    with pytest.raises(InputError, match="too many elements"):
        mesh_of(cantilever(), ShellSettings(element_size=0.1e-3))


@pytest.mark.parametrize(
    ("spoil", "what"),
    [
        (lambda corner: corner[[0, 0, 2, 3]], "no area|coincide"),
        (lambda corner: corner[[1, 0, 2, 3]], "no area"),
        (lambda corner: np.vstack([0.4 * corner.mean(0) + 0.6 * corner[2], corner[1:]]), "not convex"),
    ],
)
def test_bad_elements_are_refused_by_name(spoil, what):
    mesh = mesh_of(cantilever(), COARSE)
    corners = mesh.quads[40].copy()
    position = mesh.position.copy()
    position[corners] = spoil(position[corners])
    with pytest.raises(InputError, match=what) as caught:
        report_of(cantilever(), dataclasses.replace(mesh, position=position))
    assert "member tube" in str(caught.value)


def test_bad_elements_of_one_kind_are_one_problem():
    mesh = mesh_of(cantilever(), COARSE)
    position = mesh.position.copy()
    # the nodes of a ring drawn together: elements on both sides have two corners at one place
    ring = mesh.tubes["tube"].nodes[5]
    position[ring] = position[ring].mean(axis=0)
    with pytest.raises(InputError) as caught:
        report_of(cantilever(), dataclasses.replace(mesh, position=position))
    found = [problem for problem in caught.value.problems if problem.what.startswith("two corners")]
    assert len(found) == 1
    assert found[0].came.count("member tube, ") == 3
    assert found[0].came.endswith(f"; and {2 * len(ring) - 3} more")


def test_place_of_an_element_in_words():
    mesh = mesh_of(cantilever(), COARSE)
    tube = mesh.tubes["tube"]
    middle = tube.stations[3:5].mean() * 1e3
    expected = f"member tube, {middle:.4g} mm from its first node, side 2 of the section"
    assert mesh.place_of(3 * len(tube.contour.sides) + 2) == expected


def test_areas_of_a_tube_sum_to_its_surface():
    assert areas(mesh_of(cantilever(), COARSE)).sum() == pytest.approx(2 * (47.35e-3 + 22.35e-3), rel=1e-12)


def test_thicker_steel_is_heavier():
    assert STEEL["density"] == 7850.0
    given = cantilever().model_copy(update={"sections": {"tube": {**TUBE, "thickness": 5.3e-3}}})
    thin, thick = (report_of(s, mesh_of(s, COARSE)).mass for s in (cantilever(), given))
    assert thick / thin == pytest.approx(2 * (44.7 + 19.7) / (47.35 + 22.35))


def test_a_mitre_of_a_huge_section_does_not_compare_all_points_with_all(tmp_path):
    file = tmp_path / "huge.yaml"
    file.write_text(
        "crumple: 1\nmaterials: {metal: {grade: S235}}\n"
        "sections: {s: {type: square_tube, side: 40 m, thickness: 2 mm}}\n"
        "nodes: {a: [0 m, 0 m, 0 m], b: [0.3 m, 0 m, 0.3 m], c: [0.6 m, 0 m, 0.6 m]}\n"
        "members:\n  m: {nodes: [a, b], section: s, material: metal}\n"
        "  n: {nodes: [b, c], section: s, material: metal}\n"
        "supports: {a: {node: a, fix: all}}\nmasses: {m: {node: c, mass: 2 kg}}\n"
        "hinges: {law: constant}\nanalysis: {duration: 2 ms}\n"
    )
    # the table of all distances took 23 GB
    assert "too many elements" in check(file, "shell")[0].what
