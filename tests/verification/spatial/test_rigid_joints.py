"""Elastic members do not bend inside the rigid joints at their ends.

Two arms of length L in line, clamped at their far ends (one slides along), meet a post that stands across
them; the post is turned over by a couple M at its tip, so that the joint turns without moving aside. The arms
bend from its faces on, a beside the node: with l = L - a each resists the rotation of the joint by

    M = 4 E I/l (1 + 3 a/l + 3 a^2/l^2) per radian,

from the stiffness 12 E I/l^3, 6 E I/l^2, 4 E I/l of a clamped beam whose end moves by a and turns by 1. The
post of 120 mm on arms of 1 m makes this 28 % more than 4 E I/L.

A tripod in space, whose legs are clamped at their feet and meet a post, is pushed sideways at the post's tip:
the force is that of straight beams (Euler and Bernoulli) with rigid ends, by the direct stiffness method,
within 2 %. With legs and post that bend from node to node it would be 15 % less.

Kind: closed form; independent calculation.  Source: textbook; derived here.
"""

import math

import numpy as np
import pytest

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Structure, joint_reach

METAL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 5e9}
HELD = {"fix": "all"}


def elastic(first, second, section, **keys):
    return {"nodes": (first, second), "section": section, "material": "metal", "elastic": 6} | keys


def solved(structure, kernel):
    settings = MultibodySettings(kernel=kernel, accuracy=1e-4, mechanism_check="off", maximum_time_step=0.01)
    result = solve_multibody(structure, Run(1.0, 0.01, settings, Outputs(nodes=("joint", "tip"))))
    assert result.status.ok, result.reason
    return result


def slowly(value):
    return {"step5": {"x0": 0.0, "h0": 0.0, "x1": 1.0, "h1": value}}


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_a_joint_between_two_arms(kernel, record_figure):
    arm, couple = 1.0, 10.0
    structure = Structure(
        materials={"metal": METAL},
        sections={
            "arm": {"type": "square_tube", "side": 0.04, "thickness": 0.002},
            "post": {"type": "rectangular_tube", "width": 0.04, "depth": 0.12, "thickness": 0.002},
        },
        nodes={"left": (-arm, 0, 0), "joint": (0, 0, 0), "right": (arm, 0, 0), "tip": (0, 0, 0.5)},
        members={
            "one": elastic("left", "joint", "arm", hinges=()),
            "other": elastic("joint", "right", "arm", hinges=()),
            "post": elastic("joint", "tip", "post", hinges=(), up=(1, 0, 0)),
        },
        supports={
            "one": {"node": "left", **HELD},
            # a straight run between clamps would be locked
            "other": {"node": "right", "fix": ["y", "z", "rx", "ry", "rz"]},
        },
        loads=[{"node": "tip", "moment": {"y": slowly(couple)}}],
    )
    beside = joint_reach(structure, "one", "joint")
    assert beside == pytest.approx(0.06)
    bends = arm - beside
    share = beside / bends
    rigidity = structure.flexural_rigidity("one", "y")
    expected = 2.0 * 4.0 * rigidity / bends * (1.0 + 3.0 * share + 3.0 * share**2)
    found = couple / abs(float(solved(structure, kernel)["node.joint.rotation.y"][-1]))
    record_figure("joint between two arms", found, expected, 0.005, "N*m/rad", relative=True)


def test_a_tripod(record_figure):
    foot, height, path = 0.3, 0.4, 1e-4
    angles = [math.radians(angle) for angle in (0.0, 120.0, 240.0)]
    feet = {f"f{i}": (foot * math.cos(a), foot * math.sin(a), -height) for i, a in enumerate(angles)}
    structure = Structure(
        materials={"metal": METAL},
        sections={
            "leg": {"type": "circular_tube", "diameter": 0.03, "thickness": 0.0015},
            "post": {"type": "circular_tube", "diameter": 0.06, "thickness": 0.002},
        },
        nodes=feet | {"joint": (0, 0, 0), "tip": (0, 0, 0.6)},
        members={name: elastic(name, "joint", "leg") for name in feet}
        | {"post": elastic("joint", "tip", "post")},
        # members twist at hinges only; folds of this metal do not open
        hinges={},
        supports={name: {"node": name, **HELD} for name in feet}
        | {"push": {"node": "tip", "motion": {"x": slowly(path)}}},
    )
    result = solved(structure, "spatial")
    found = float(np.abs(result["support.push.force.x"][-1]))
    rigid, straight = (force_at_tip(structure, path, reach) for reach in (True, False))
    assert straight < 0.86 * rigid
    record_figure("tripod pushed at its tip", found, rigid, 0.02, "N", relative=True)


def force_at_tip(structure, path, reach):
    """Force that moves the tip along x by a path, of straight beams with rigid ends or without, clamped."""
    first = {name: 6 * i for i, name in enumerate(structure.nodes)}
    whole = np.zeros((6 * len(first), 6 * len(first)))
    for name, member in structure.members.items():
        ends = [joint_reach(structure, name, node) * reach for node in member.nodes]
        own = beam(structure, name, ends)
        places = np.concatenate([first[node] + np.arange(6) for node in member.nodes])
        whole[np.ix_(places, places)] += own
    held = [first[s.node] + i for s in structure.supports.values() if s.held for i in range(6)]
    driven = first["tip"]
    free = [i for i in range(len(whole)) if i not in held and i != driven]
    inner = np.linalg.solve(whole[np.ix_(free, free)], -whole[free, driven] * path)
    return float(whole[driven, driven] * path + whole[driven, free] @ inner)


def beam(structure, name, ends):
    """Stiffness of a beam between rigid ends in global axes, (12, 12): displacements and rotations."""
    frame, section = structure.frame_of(name), structure.section_of(name)
    length = frame.length - sum(ends)
    bending = structure.flexural_rigidity(name, "y")
    area = math.pi / 4.0 * (section.diameter**2 - (section.diameter - 2.0 * section.thickness) ** 2)
    own = np.zeros((12, 12))
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    own[np.ix_([0, 6], [0, 6])] = METAL["youngs_modulus"] * area / length * pair
    # a round tube has G J = E I/(1 + nu)
    own[np.ix_([3, 9], [3, 9])] = bending / 1.3 / length * pair
    one, two = 6.0 * length, length**2
    plane = np.array(
        [
            [12, one, -12, one],
            [one, 4 * two, -one, 2 * two],
            [-12, -one, 12, -one],
            [one, 2 * two, -one, 4 * two],
        ]
    )
    own[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])] = bending / length**3 * plane
    turned = np.outer([1, -1, 1, -1], [1, -1, 1, -1])
    own[np.ix_([2, 4, 8, 10], [2, 4, 8, 10])] = bending / length**3 * plane * turned
    to_face = np.eye(12)
    to_face[1, 5], to_face[2, 4] = ends[0], -ends[0]
    to_face[7, 11], to_face[8, 10] = -ends[1], ends[1]
    axes = np.kron(np.eye(4), frame.axes)
    return axes.T @ to_face.T @ own @ to_face @ axes
