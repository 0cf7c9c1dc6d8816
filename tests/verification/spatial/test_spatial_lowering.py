"""Structures in the spatial kernel: planar kernel, limit theorems, beam theory, rotated frames.

- Both kernels solve the same planar frame; rotations agree within the requested accuracy.
- Rotated and translated as a whole, a frame in space folds alike.
- Fixed beam under a force in its middle, span L between its hinges: P = 8 M_p/L by virtual work, M_p (theta +
  2 theta + theta) = P L theta/2.  Rigid bars lock unless one end may slide along; the test counts the hinges
  where the model has them.
- Portal under a force at the level of its beam: H = 4 M_p/h, h between the two hinges of a column.
- Cantilever of n elastic bars under a force at its tip: F L^3/(3 E I) as n grows.

Kind: closed form; independent calculation; invariant.  Source: derived here; derived here; derived here.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.support.structures import STEEL, TUBE, constant_law, table_law

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Stage, Structure

MOMENT = 1000.0
AROUND = {"type": "square_tube", "side": 0.05, "thickness": 0.003}
SLOW = {"z": {"table": {"time": (0.0, 1.0), "value": (0.0, -0.02)}}}
SIDEWAYS = {"x": {"table": {"time": (0.0, 1.0), "value": (0.0, 0.02)}}}


def tube(first, second, *hinges, law=None, **keys):
    """Member of the square tube; hinges are (name, distance)."""
    law = law or constant_law(MOMENT)
    given = tuple({"name": name, "at": at, "law": law, "axis": "y"} for name, at in hinges)
    return {"nodes": (first, second), "section": "tube", "material": "steel", "hinges": given, **keys}


def frame(nodes, members, section=AROUND, **parts):
    return Structure(
        materials={"steel": STEEL}, sections={"tube": section}, nodes=nodes, members=members, **parts
    )


def struck_portal():
    law = table_law(900.0, 500.0)
    members = {
        "ab": tube("a", "b", ("foot", 0.05), ("knee", 0.75), law=law, up=(0, 1, 0), roll=np.pi / 2),
        "bc": tube("b", "c", ("left", 0.1), ("right", 1.1), law=law),
        "cd": tube("c", "d", ("far_knee", 0.05), ("far_foot", 0.75), law=law, up=(0, 1, 0), roll=np.pi / 2),
    }
    clamps = {f"s{node}": {"node": node, "fix": "all"} for node in "ad"}
    nodes = {"a": (0, 0, 0), "b": (0, 0, 0.8), "c": (1.2, 0, 0.8), "d": (1.2, 0, 0)}
    masses = {"m": {"node": "b", "mass": 20.0}, "n": {"node": "c", "mass": 10.0}}
    blow = [{"node": "b", "impulse": (150.0, 0.0, -20.0)}]
    return frame(nodes, members, supports=clamps, masses=masses, impulses=blow)


def test_both_kernels_fold_a_planar_frame_alike(record_figure):
    runs = {
        kernel: solve_multibody(struck_portal(), Run(0.15, 1e-3, MultibodySettings(kernel=kernel)))
        for kernel in ("tree", "spatial")
    }
    for result in runs.values():
        assert result.status.ok
    largest = max(hinge.rotation_max for hinge in runs["tree"].hinges.values())
    assert largest > 0.05
    apart = max(
        np.abs(runs["tree"][f"hinge.{name}.rotation"] - runs["spatial"][f"hinge.{name}.rotation"]).max()
        for name in runs["tree"].hinges
    )
    record_figure(
        "planar kernel against spatial kernel, rotations of a struck portal", apart / largest, 0.0, 1e-3
    )
    assert apart < 1e-3 * largest


def tilted(rotation, shift):
    """Frame in space with hinges about two axes, thrown about a slant axis, turned and moved as a whole."""

    def place(point):
        return tuple(rotation.apply(point) + shift)

    def turned(direction):
        return tuple(rotation.apply(direction))

    up = {"up": turned((0.3, -0.2, 1.0))}
    law = table_law(300.0, 200.0)
    both = {"axes": ("y", "z"), "law": constant_law(250.0), "coupling": "ellipsoid"}
    members = {
        "ab": tube("a", "b", ("h", 0.1), law=law, **up),
        "bc": tube("b", "c", law=law, **up),
        "cd": tube("c", "d", ("i", 0.2), law=law, **up),
        "be": tube("b", "e", law=law, **up) | {"hinges": [{"name": "k", "at": 0.1, **both}]},
    }
    points = {
        "a": (0, 0, 0),
        "b": (0.5, 0, 0.1),
        "c": (0.6, 0.5, 0),
        "d": (0.1, 0.6, 0.2),
        "e": (0.9, -0.4, 0.3),
    }
    return frame(
        {name: place(point) for name, point in points.items()},
        members,
        TUBE,
        supports={"s": {"node": "a", "fix": "all"}},
        masses={"m": {"node": "d", "mass": 3.0}, "n": {"node": "e", "mass": 2.0}},
        initial_velocity=[{"rotation": 12.0, "about": place((0, 0, 0)), "axis": turned((0.2, 1.0, 0.5))}],
        gravity=turned((1.0, 2.0, -9.81)),
    )


def test_a_turned_frame_folds_alike(record_figure):
    run = Run(0.08, 1e-3)
    base = solve_multibody(tilted(Rotation.identity(), np.zeros(3)), run)
    other = solve_multibody(tilted(Rotation.from_rotvec((0.7, -1.1, 2.0)), np.array([3.0, -2.0, 5.0])), run)
    assert base.status.ok
    assert other.status.ok
    largest = max(hinge.rotation_max for hinge in base.hinges.values())
    apart = max(
        np.abs(base[f"hinge.{name}.rotation"] - other[f"hinge.{name}.rotation"]).max() for name in base.hinges
    )
    record_figure(
        "turning a frame in space, largest change of a hinge's rotation", apart / largest, 0.0, 1e-6
    )
    assert largest > 0.02
    assert apart < 1e-6 * largest


def pushed(structure, support):
    """Force of a driven support at the first outputs of a quasi-static push."""
    stage = Stage(name="push", kind="quasi-static", duration=0.2)
    result = solve_multibody(structure, Run(0.2, 0.02, stages=(stage,)))
    assert result.status.ok, result.reason
    return result, float(np.abs(result[f"support.{support}.force.{'z' if support == 'ram' else 'x'}"][1]))


def test_fixed_beam_collapses_at_the_load_of_the_limit_theorems(record_figure):
    nodes = {"a": (0, 0, 0), "m": (1, 0, 0), "b": (2, 0, 0)}
    members = {
        "am": tube("a", "m", ("left", 0.02), ("middle", 0.99)),
        "mb": tube("m", "b", ("right", 0.98)),
    }
    supports = {
        "clamp": {"node": "a", "fix": "all"},
        "slide": {"node": "b", "fix": ("y", "z", "rx", "ry", "rz")},
        "ram": {"node": "m", "motion": SLOW},
    }
    result, force = pushed(frame(nodes, members, supports=supports), "ram")
    # the middle hinge lies 10 mm beside the force, which sinks with the right bar
    left, right = 0.99 - 0.02, 1.98 - 0.99
    sink = 1.98 - 1.0
    expected = MOMENT * (right / left + (1.0 + right / left) + 1.0) / sink
    record_figure("fixed beam, collapse force over the limit theorems'", force / expected, 1.0, 0.01)
    assert force == pytest.approx(expected, rel=1e-3)
    assert force == pytest.approx(8.0 * MOMENT / 1.96, rel=0.02)
    assert result["support.clamp.moment.y"][1] == pytest.approx(MOMENT * (1 + 0.02 / left * 2), rel=2e-3)


def test_portal_sways_at_the_load_of_the_limit_theorems(record_figure):
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1.5, 0, 1), "d": (1.5, 0, 0)}
    turned = {"up": (0, 1, 0), "roll": np.pi / 2}
    members = {
        "ab": tube("a", "b", ("foot", 0.02), ("knee", 0.98), **turned),
        "bc": tube("b", "c"),
        "cd": tube("c", "d", ("far_knee", 0.02), ("far_foot", 0.98), **turned),
    }
    supports = {f"s{node}": {"node": node, "fix": "all"} for node in "ad"}
    supports["push"] = {"node": "b", "motion": SIDEWAYS}
    _, force = pushed(frame(nodes, members, supports=supports), "push")
    expected = 4.0 * MOMENT / 0.96
    record_figure("portal, sway force over the limit theorems'", force / expected, 1.0, 0.01)
    assert force == pytest.approx(expected, rel=1e-3)


def sag(bars):
    """Tip deflection [m] of a cantilever of 1 m cut into elastic bars, over F L^3/(3 E I)."""
    law = constant_law(1e6, form="elastic-plastic")
    root = {"name": "root", "at": "root", "offset": 0.0, "law": law, "axis": "y"}
    member = tube("root", "tip", bars={"number": bars, "law": law, "axis": "y"}) | {"hinges": [root]}
    rise = {"z": {"table": {"time": (0.0, 0.1, 1.0), "value": (0.0, 10.0, 10.0)}}}
    supports = {"clamp": {"node": "root", "fix": "all"}}
    nodes = {"root": (0, 0, 0), "tip": (1, 0, 0)}
    whole = frame(nodes, {"bar": member}, supports=supports, loads=[{"node": "tip", "force": rise}])
    stage = Stage(name="load", kind="quasi-static", duration=0.2)
    result = solve_multibody(whole, Run(0.2, 0.05, outputs=Outputs(nodes=("tip",)), stages=(stage,)))
    assert result.status.ok, result.reason
    return float(result["node.tip.displacement.z"][-1]) * 3.0 * whole.flexural_rigidity("bar", "y") / 10.0


@pytest.mark.parametrize("bars", [1, 4, 16])
def test_elastic_bars_are_as_stiff_as_the_beam(bars, record_figure):
    record_figure(f"elastic cantilever of {bars} bars, tip deflection over the beam's", sag(bars), 1.0, 1e-4)
