"""Sections that get coarser along a member: what is left out, triangles between, nothing lost or torn."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.structures import STEEL, cantilever, thrown

from crumple._core.shell.simulation import ShellState
from crumple.errors import Status
from crumple.shell import ShellRun, lower, mesh_of, solve_shell
from crumple.shell.mesh.bays import bays_of, coarse_rings, halving_of, levels_of
from crumple.shell.mesh.contour import contour_of
from crumple.shell.mesh.profile import Contour
from crumple.shell.mesh.quality import areas, report_of
from crumple.shell.model.initial_motion import nodal_masses
from crumple.structure import Outputs, ShellSettings, Structure

GRADED = ShellSettings(element_size=30e-3, fine_size=8e-3, fine_length=40e-3, growth=1.3)
COARSER = GRADED.model_copy(update={"coarse_sections": "on"})
DEEPER = COARSER.model_copy(update={"fine_size": 3e-3})
"""Ten times as long far away as in the fine zone: the section is halved three times."""


def square(sides_each, thickness=1e-3):
    """Square of sides divided evenly."""
    corner = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    points = [
        corner[i] + (corner[(i + 1) % 4] - corner[i]) * k / n
        for i, n in enumerate(sides_each)
        for k in range(n)
    ]
    number = np.arange(len(points))
    sides = np.column_stack([number, np.roll(number, -1)])
    return Contour(np.array(points), sides, np.full(len(points), thickness))


def test_walls_with_an_even_number_of_sides_are_halved_and_corners_stay():
    halving = halving_of(square((4, 3, 2, 1)))
    assert halving.pairs.tolist() == [[0, 1], [2, 3], [7, 8]]
    assert halving.others.tolist() == [4, 5, 6, 9]


def test_walls_of_two_thicknesses_and_round_ones_stay():
    uneven = square((2, 2, 2, 2))
    assert len(halving_of(uneven).pairs) == 4
    thickness = uneven.thickness.copy()
    thickness[1] = 2e-3
    assert halving_of(replace(uneven, thickness=thickness)).pairs.tolist() == [[2, 3], [4, 5], [6, 7]]
    round_ = Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "circular_tube", "diameter": 0.05, "thickness": 2e-3}},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={"m": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
    ).section_of("m")
    assert not len(halving_of(contour_of(round_, 5e-3)).pairs)


def test_open_section_is_halved_wall_by_wall():
    hat = {"type": "hat", "width": 0.05, "depth": 0.04, "flange": 0.02, "thickness": 1.5e-3}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"hat": hat},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={"m": {"nodes": ("a", "b"), "section": "hat", "material": "steel"}},
    )
    contour = contour_of(structure.section_of("m"), 5e-3)
    halving = halving_of(contour)
    used = np.concatenate([halving.pairs.reshape(-1), halving.others])
    assert np.array_equal(np.sort(used), np.arange(len(contour.sides)))
    assert len(halving.pairs) > 10
    # both sides of a pair lie in one line
    ends = contour.points[contour.sides]
    along = ends[:, 1] - ends[:, 0]
    first, second = along[halving.pairs[:, 0]], along[halving.pairs[:, 1]]
    assert np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).max() < 1e-15


def test_coarse_rings_lie_between_long_elements_and_several_in_a_row():
    lengths = np.array([1, 1, 2, 2, 2, 2, 1, 2, 2, 2, 1, 2, 2, 2, 2.0])
    at = np.concatenate([[0], np.cumsum(lengths)])
    wanted = np.zeros(16, dtype=bool)
    wanted[12:] = True
    assert np.array_equal(coarse_rings(at, 1.0), wanted)
    assert coarse_rings(np.arange(6) * 2.0, 1.0).all()
    assert not coarse_rings(np.arange(6) * 1.9, 1.0).any()


def test_sections_are_halved_again_down_to_two_sides_a_wall():
    """Sixteen, eight, six and two sides; one alone is the first halving's, three are odd."""
    levels = levels_of(square((16, 8, 6, 2)))
    walls = [np.bincount(np.searchsorted([16, 24, 30], level.of, side="right")) for level in levels]
    assert [wall.tolist() for wall in walls] == [[16, 8, 6, 2], [8, 4, 3, 1], [4, 2, 3, 1], [2, 2, 3, 1]]
    for level in levels:
        ends = level.contour.points[level.contour.sides]
        # sides follow each other around, and are as long as the whole together
        assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(4.0)
        assert np.array_equal(np.sort(level.contour.sides[:, 0]), np.sort(level.contour.sides[:, 1]))
    assert not len(levels[-1].halving.pairs)


def test_rings_are_halved_as_often_as_their_elements_are_twice_as_long():
    at = np.concatenate([[0], np.cumsum([1.0] * 4 + [2.0] * 5 + [4.0] * 6 + [9.0] * 6)])
    assert coarse_rings(at, 1.0, 3).tolist() == [0] * 5 + [1] * 5 + [2] * 6 + [3] * 6
    assert coarse_rings(at, 1.0, 2).max() == 2
    # from one to eight at once: a level a ring, from both sides
    jump = np.concatenate([[0], np.cumsum([1.0] * 4 + [8.0] * 8 + [1.0] * 4)])
    assert coarse_rings(jump, 1.0, 3).tolist() == [0] * 5 + [1, 2, 3, 3, 3, 2, 1] + [0] * 5


def edges_of(quads):
    """Every edge of the elements with the number of elements on it."""
    pairs = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    pairs = np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)
    return np.unique(pairs, axis=0, return_counts=True)


@pytest.mark.parametrize("fine_at", [(), ({"member": "tube", "at": 0.7},)])
def test_mesh_is_closed_and_keeps_its_mass(fine_at):
    """No hanging node: every edge has two elements but those of both end rings; every node is used."""
    given = thrown()
    settings = COARSER.model_copy(update={"fine_at": fine_at})
    mesh, full = (
        mesh_of(given, settings),
        mesh_of(given, settings.model_copy(update={"coarse_sections": "off"})),
    )
    report, whole = report_of(given, mesh), report_of(given, full)
    assert report.elements < 0.85 * whole.elements
    # three for each pair of sides, once towards the tip, and twice more around the fine place
    pairs = len(halving_of(mesh.tubes["tube"].contour).pairs)
    assert report.triangles == 3 * pairs * (1 if not fine_at else 3)
    assert f"({report.triangles} of them triangles)" in str(report)
    assert whole.triangles == 0
    assert report.mass == pytest.approx(whole.mass, rel=1e-12)
    used = np.unique(mesh.quads)
    assert np.array_equal(used, np.arange(mesh.walls))
    _, counts = edges_of(mesh.quads)
    ends = [len(np.unique(mesh.end_ring("tube", second))) for second in (False, True)]
    assert set(counts) == {1, 2}
    assert (counts == 1).sum() == sum(ends)
    # normals outwards, all of them
    corner = mesh.position[mesh.quads]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    out = corner.mean(axis=1) * [0, 1, 1]
    assert (np.einsum("ij,ij->i", normal, out) > 0).all()


def test_mesh_halved_three_times_is_closed_and_better_shaped():
    given = thrown()
    mesh, full = (
        mesh_of(given, DEEPER.model_copy(update={"coarse_sections": word})) for word in ("on", "off")
    )
    report, whole = report_of(given, mesh), report_of(given, full)
    levels = levels_of(mesh.tubes["tube"].contour)
    assert [len(level.contour.sides) for level in levels] == [48, 24, 12, 8]
    assert report.triangles == 3 * sum(len(level.halving.pairs) for level in levels)
    assert report.elements < 0.6 * whole.elements
    assert report.worst_aspect < 0.4 * whole.worst_aspect
    assert report.smallest_side == pytest.approx(whole.smallest_side)
    assert report.mass == pytest.approx(whole.mass, rel=1e-12)
    assert np.array_equal(np.unique(mesh.quads), np.arange(mesh.walls))
    _, counts = edges_of(mesh.quads)
    # eight sides are left at the tip's section
    assert (counts == 1).sum() == 48 + 8
    assert set(counts) == {1, 2}


def test_nodes_of_triangles_have_the_mass_that_the_stepper_gives_them():
    """Kinetic energy of one moving node at a time."""
    case = lower(cantilever(), COARSER)
    mass, inertia = nodal_masses(cantilever(), case.mesh)
    three = case.mesh.quads[case.mesh.triangles]
    for node in (*three[0, :3], *three[-1, :3]):
        velocity = np.zeros_like(case.model.position)
        velocity[node, 1] = 2.0
        state = ShellState(replace(case.model, velocity=velocity))
        assert state.energies["kinetic"] == pytest.approx(2.0 * mass[node], rel=1e-12)
        state = ShellState(replace(case.model, spin=velocity))
        assert state.energies["kinetic"] == pytest.approx(2.0 * inertia[node], rel=1e-12)


def test_elements_are_found_by_bay_and_by_place():
    mesh = mesh_of(thrown(), COARSER)
    tube = mesh.tubes["tube"]
    assert tube.bays.start[-1] == len(mesh.quads)
    assert np.array_equal(
        np.concatenate([tube.bay(i) for i in range(tube.last_ring)]), np.arange(len(mesh.quads))
    )
    middle = mesh.position[mesh.quads].mean(axis=1)[:, 0]
    for i in range(tube.last_ring):
        own = middle[tube.bay(i)]
        assert (own > tube.stations[i]).all()
        assert (own < tube.stations[i + 1]).all()
    last = int(tube.bay(tube.last_ring - 1)[-1])
    assert f"{1e3 * (tube.stations[-1] + tube.stations[-2]) / 2:.4g} mm" in mesh.place_of(last)
    assert areas(mesh).min() > 0


@pytest.mark.parametrize("settings", [COARSER, DEEPER])
def test_stretch_along_the_tube_is_the_same_in_every_element(settings):
    """Constant strain along the member through triangles and quadrilaterals: stress E e within rounding."""
    case = lower(cantilever(), settings)
    state = ShellState(replace(case.model, fixed=None, rigid_sets=[]))
    x = case.model.position
    moved = x * [1e-4, -0.3e-4, -0.3e-4]
    state.deform(x + moved, moved, 0 * x, 1.0)
    sx, sy, sxy = (state.point_field(f"stress_{axes}") for axes in ("x", "y", "xy"))
    mises = np.sqrt(sx**2 - sx * sy + sy**2 + 3 * sxy**2)
    assert mises == pytest.approx(210e9 * 1e-4, rel=1e-3)


@pytest.mark.parametrize("settings", [COARSER, DEEPER])
def test_a_run_on_a_coarser_section_keeps_its_energy_and_its_channels(settings):
    outputs = Outputs(nodes=("tip",), section_rotations={"bend": {"member": "tube", "from": 0.0, "to": 1.0}})
    results = [
        solve_shell(thrown(), ShellRun(4e-3, 2e-4, chosen, outputs))
        for chosen in (settings.model_copy(update={"coarse_sections": "off"}), settings)
    ]
    fine, coarse = results
    assert coarse.status is Status.COMPLETE
    assert coarse.energy_residual < 1e-3
    for name in ("node.tip.displacement.z", "bend"):
        assert coarse[name][-1] == pytest.approx(fine[name][-1], rel=0.02)
    assert coarse.provenance.settings["triangles"] > 0
    states = coarse.states
    assert len(states.quads) == coarse.provenance.settings["elements"]
    assert states.cell_data["plastic_work"].shape[1] == len(states.quads)
    # what is stored is drawn where it is
    mesh = mesh_of(thrown(), settings, outputs)
    assert np.array_equal(states.points[states.quads], mesh.position[mesh.quads])


def test_members_that_meet_stay_fine_there():
    from tests.support.shell.structures import knee

    mesh = mesh_of(knee(), COARSER)
    for node in ("b",):
        for end in mesh.joints[node].ends:
            ring = mesh.end_ring(end.member, end.second)
            assert len(np.unique(ring)) == len(ring)
    _, counts = edges_of(mesh.quads)
    assert set(counts) <= {1, 2}


def test_bays_number_their_elements():
    contour = square((2, 2, 2, 2))
    bays = bays_of(contour, np.array([False, False, True, True, False]))
    assert np.diff(bays.start).tolist() == [8, 12, 4, 12]
    assert bays.side[8:20].tolist() == [0, 2, 4, 6] * 3
