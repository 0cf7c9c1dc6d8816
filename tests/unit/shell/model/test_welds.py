"""Spot welds of closed hats: pairs of nodes that keep together, torsion of the closed cell, a pitch."""

import numpy as np
import pytest
from tests.support.shell.structures import STEEL

from crumple._core.shell.simulation import ShellState
from crumple.errors import Status
from crumple.shell import ShellRun, lower, solve_shell
from crumple.structure import Outputs, ShellSettings, Structure

HAT = {"type": "closed_hat", "width": 0.06, "depth": 0.04, "thickness": 1.5e-3, "flange": 0.02}
LENGTH = 0.4
SIZE = ShellSettings(element_size=10e-3, damping=2000.0)


def hat(flange=0.02, **more) -> Structure:
    return Structure(
        materials={"steel": STEEL},
        sections={"hat": {**HAT, "flange": flange}},
        nodes={"root": (0, 0, 0), "tip": (LENGTH, 0, 0)},
        members={"rail": {"nodes": ("root", "tip"), "section": "hat", "material": "steel"}},
        supports={"clamp": {"node": "root", "fix": "all"}},
        **more,
    )


def twisted(settings: ShellSettings) -> float:
    """Twist [rad] of the tip under 20 N m, at rest."""
    ramp = {"step5": {"x0": 0.0, "h0": 0.0, "x1": 3e-3, "h1": 20.0}}
    given = hat(loads=[{"node": "tip", "moment": {"x": ramp}}])
    result = solve_shell(given, ShellRun(8e-3, 2e-4, settings, Outputs(nodes=("tip",))))
    assert result.energy_residual < 1e-2
    assert any("spot welds connect pairs of nodes" in text for text in result.assumptions)
    turn = result["node.tip.rotation.x"]
    # at rest
    assert np.ptp(turn[-5:]) < 0.01 * turn[-1]
    return float(turn[-1])


def test_pairs_are_tied_at_every_ring_but_those_that_are_held():
    case = lower(hat(), SIZE)
    tube = case.mesh.tubes["rail"]
    spots = [body for body in case.bodies if not body.lumps]
    # the ring at the clamp is held; the tip is free
    assert len(spots) == 2 * (len(tube.stations) - 1)
    distance = [np.linalg.norm(np.diff(case.mesh.position[body.nodes], axis=0)) for body in spots]
    assert np.array(distance) == pytest.approx(1.5e-3)
    for body in spots:
        a, b = case.mesh.position[body.nodes]
        assert a[0] == pytest.approx(b[0])


def test_spots_lie_a_pitch_apart():
    case = lower(hat(), SIZE.model_copy(update={"weld_pitch": 0.05}))
    places = sorted({round(body.place[0], 6) for body in case.bodies if not body.lumps})
    assert places == pytest.approx(np.arange(8) * 0.05 + 0.025, abs=5e-3 + 1e-9)
    assert sum(not body.lumps for body in case.bodies) == 16


def test_welded_hat_twists_as_a_closed_cell_and_more_between_spots_far_apart():
    """T L / G J with the cell closed along the weld lines; an open section would twist some hundred times."""
    section = hat().section_of("rail")
    shear_modulus = STEEL["youngs_modulus"] / (2 * (1 + STEEL["poissons_ratio"]))
    wanted = 20.0 * LENGTH / (shear_modulus * section.torsion_constant)
    lines, spots = twisted(SIZE), twisted(SIZE.model_copy(update={"weld_pitch": 0.1}))
    assert lines == pytest.approx(wanted, rel=0.03)
    assert 1.02 * lines < spots < 3.0 * lines


def test_welded_pairs_stay_together_while_the_hat_is_crushed():
    given = hat(masses={"m": {"node": "tip", "mass": 50.0}}, initial_velocity=[{"translation": (-8.0, 0, 0)}])
    settings = ShellSettings(element_size=10e-3, imperfection=5e-5)
    case = lower(given, settings)
    result = solve_shell(given, ShellRun(4e-3, 1e-3, settings, Outputs(nodes=("tip",), pictures=(0.0, 4e-3))))
    assert result["energy.dissipated"][-1] > 100.0
    assert result.energy_residual < 1e-2
    moved = result.states.points + result.states.displacement[-1]
    tube = case.mesh.tubes["rail"]
    around = tube.nodes.shape[1]
    # as the distances were: those of the tip's rigid section and of the clamp too
    for a, b in tube.contour.welds:
        apart = moved.reshape(-1, around, 3)[:, a] - moved.reshape(-1, around, 3)[:, b]
        first = (
            result.states.points.reshape(-1, around, 3)[:, a]
            - result.states.points.reshape(-1, around, 3)[:, b]
        )
        assert np.linalg.norm(apart, axis=1) == pytest.approx(np.linalg.norm(first, axis=1), rel=1e-6)


def test_points_of_welds_stay_where_sections_get_coarser():
    settings = ShellSettings(
        element_size=30e-3, fine_size=6e-3, fine_length=30e-3, growth=1.4, coarse_sections="on"
    )
    # one element to both sides of the line
    case = lower(hat(flange=0.012), settings)
    assert case.report.triangles > 0
    tube = case.mesh.tubes["rail"]
    at = case.mesh.position[tube.nodes[:, tube.contour.welds]]
    # along y where the line is, on every ring
    assert np.ptp(at[..., 1], axis=0) == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(at[:, :, 1] - at[:, :, 0], axis=2) == pytest.approx(1.5e-3)


def test_members_that_share_a_mitre_share_its_spots():
    given = hat()
    ends = {"root": (0, 0, 0), "mid": (LENGTH / 2, 0, 0), "tip": (0.9 * LENGTH, 0.1 * LENGTH, 0)}
    rail = given.members["rail"]
    members = {
        "one": rail.model_copy(update={"nodes": ("root", "mid")}),
        "two": rail.model_copy(update={"nodes": ("mid", "tip")}),
    }
    case = lower(given.model_copy(update={"nodes": ends, "members": members}), SIZE)
    assert not case.mesh.joints["mid"].is_body
    nodes = np.concatenate([body.nodes for body in case.bodies])
    assert len(np.unique(nodes)) == len(nodes)
    assert ShellState(case.model).advance(1e-5) is Status.COMPLETE
