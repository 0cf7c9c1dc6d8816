"""Welded T-joints: shared nodes along the outline of the branch, and what stays rigid."""

import math

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.material import Material
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.mesh import mesh_of
from crumple.structure import ShellSettings, Structure

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
WELDED = ShellSettings(element_size=8e-3, t_joints="welded")


def tee(brace, degrees=90.0, *, up=(0.0, 0.0, 1.0), reverse=False, thickness=0.003, **more):
    """A chord along x, and a brace in the x-z plane whose section has its width along x."""
    angle = math.radians(degrees)
    ends = ("far", "node") if reverse else ("node", "far")
    chord = {"section": "chord", "material": "steel", "up": up}
    return Structure(
        materials={"steel": STEEL},
        sections={"chord": RectangularTube(0.060, 0.060, thickness), "brace": brace},
        nodes={
            "left": (-0.3, 0.0, 0.0),
            "node": (0.0, 0.0, 0.0),
            "right": (0.3, 0.0, 0.0),
            "far": (0.3 * math.cos(angle), 0.0, 0.3 * math.sin(angle)),
        },
        # the brace comes first: its nodes at the joint are those of members that are meshed later
        members={
            "brace": {"nodes": ends, "section": "brace", "material": "steel", "up": (0.0, 1.0, 0.0)},
            "first": {"nodes": ("left", "node"), **chord},
            "second": {"nodes": ("node", "right"), **chord},
        },
        supports={"left": {"node": "left", "fix": "all"}, "right": {"node": "right", "fix": "all"}},
        **more,
    )


def edge_counts(mesh):
    """How many elements each edge has: edges of one, two and three elements."""
    corners = mesh.quads
    pairs = np.concatenate([corners[:, [i, (i + 1) % 4]] for i in range(4)])
    return np.bincount(np.unique(np.sort(pairs, axis=1), axis=0, return_counts=True)[1], minlength=4)


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(
    ("width", "depth", "degrees"),
    [
        (0.040, 0.040, 90.0),
        (0.060, 0.040, 90.0),
        (0.040, 0.060, 90.0),
        (0.040, 0.040, 60.0),
        (0.05, 0.03, 130.0),
    ],
)
def test_branch_shares_the_nodes_of_its_outline(width, depth, degrees, reverse):
    brace = RectangularTube(width=width, depth=depth, thickness=0.002)
    structure = tee(brace, degrees, reverse=reverse)
    mesh = mesh_of(structure, WELDED)
    joint, ring = mesh.joints["node"], mesh.end_ring("brace", reverse)
    assert joint.kind is Kind.WELDED
    assert not joint.is_body
    # every edge of the seam has the branch's wall and the face on both of its sides; a branch as wide as the
    # face follows its edges
    counts = edge_counts(mesh)
    assert counts[3:].sum() == len(ring) == counts[3]
    place = mesh.position[ring]
    np.testing.assert_allclose(place[:, 2], 0.0285, atol=1e-12)
    sine = math.sin(math.radians(degrees))
    across = 0.0285 if depth == 0.060 else (depth - 0.002) / 2
    assert np.ptp(place[:, 1]) == pytest.approx(2 * across)
    assert np.ptp(place[:, 0]) == pytest.approx((width - 0.002) / sine)
    middle = 0.0285 / math.tan(math.radians(degrees))
    assert place[:, 0].max() + place[:, 0].min() == pytest.approx(2 * middle, abs=1e-9)
    assert len(np.unique(mesh.position.round(9), axis=0)) == len(mesh.position)


def test_branch_narrower_than_a_thick_chord_keeps_its_width():
    structure = tee(RectangularTube(0.036, 0.036, 0.003), thickness=0.014)
    place = mesh_of(structure, WELDED).position[mesh_of(structure, WELDED).end_ring("brace", False)]
    np.testing.assert_allclose(np.ptp(place[:, :2], axis=0), 0.033)


def test_branch_on_a_side_face_and_counter_clockwise_walls():
    mesh = mesh_of(tee(RectangularTube(0.040, 0.040, 0.002), up=(0.0, 1.0, 0.0)), WELDED)
    tube = mesh.tubes["brace"]
    corner = mesh.position[mesh.quads[tube.elements_between(0, tube.last_ring)]]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    outward = corner.mean(axis=1) * [1.0, 1.0, 0.0]
    assert (np.einsum("ij,ij->i", normal, outward) > 0.0).all()
    assert mesh.joints["node"].kind is Kind.WELDED


def test_wall_of_the_chord_goes_on_inside_the_branch():
    mesh = mesh_of(tee(RectangularTube(0.040, 0.040, 0.002)), WELDED)
    middle = mesh.position[mesh.quads].mean(axis=1)
    inside = (np.abs(middle[:, :2]) < 0.019).all(axis=1) & (np.abs(middle[:, 2] - 0.0285) < 1e-9)
    corner = mesh.position[mesh.quads[inside]]
    areas = np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1) / 2
    assert areas.sum() == pytest.approx(0.038**2)


@pytest.mark.parametrize(
    ("brace", "more"),
    [
        (RectangularTube(0.040, 0.070, 0.002), {}),
        (RectangularTube(0.040, 0.040, 0.002), {"masses": {"lump": {"node": "node", "mass": 2.0}}}),
    ],
    ids=["wider than the face", "with a mass"],
)
def test_other_joints_stay_rigid(brace, more):
    assert mesh_of(tee(brace, **more), WELDED).joints["node"].kind is Kind.RIGID


def test_steep_branch_is_joined_rigidly_and_that_cuts_off_too_much():
    with pytest.raises(InputError, match="cuts too much off member"):
        mesh_of(tee(RectangularTube(0.040, 0.040, 0.002), 25.0), WELDED)


def test_without_the_setting_all_ends_are_rigid():
    structure = tee(RectangularTube(0.040, 0.040, 0.002))
    assert mesh_of(structure, ShellSettings(element_size=8e-3)).joints["node"].kind is Kind.RIGID


def test_graded_meshes_have_whole_sections_at_welded_members():
    settings = WELDED.model_copy(update={"element_size": 3e-2, "fine_size": 8e-3, "coarse_sections": "on"})
    mesh = mesh_of(tee(RectangularTube(0.040, 0.040, 0.002)), settings)
    assert not mesh.triangles.any()
    assert edge_counts(mesh)[3] == len(mesh.end_ring("brace", False))
