"""Frame indifference: a structure that is rotated, translated or in steady motion folds alike.

The behaviour of a hinge may not depend on the position and direction of the structure, or on the velocity
of the observer.  Rotation and translation change nothing but rounding.  A steady velocity changes the step
lengths, so hinge quantities agree to the requested accuracy, and to rounding with equal steps.

Kind: invariant.  Source: derived here.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.support.multibody.chains import bar, hinge, softening_law, started
from tests.support.structures import STEEL, TUBE, table_law

from crumple._core.planar.simulation import JointKind, TreeModel
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Structure

LAW = table_law(900.0, 500.0)
NODES = {"root": (0.0, 0.0, 0.0), "knee": (0.5, 0.0, 0.1), "tip": (1.0, 0.0, -0.1), "arm": (0.5, 0.0, 0.6)}


def frame(rotation, shift, clamped=True):
    """Branched structure in the x-z plane, thrown about a point, turned and moved as a whole."""

    def place(point):
        return tuple(rotation.apply(point) + shift)

    def turned(direction):
        return tuple(rotation.apply(direction))

    def member(first, second, at):
        hinges = ({"name": f"{first}-{second}", "at": at, "law": LAW},)
        common = {"section": "tube", "material": "steel", "up": turned((0.0, 0.0, 1.0))}
        if (first, second) == ("knee", "arm"):
            common["up"] = turned((1.0, 0.0, 0.0))
        return {"nodes": (first, second), "hinges": hinges, **common}

    supports = {"clamp": {"node": "root", "fix": "all"}} if clamped else {}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={name: place(point) for name, point in NODES.items()},
        members={
            "a": member("root", "knee", 0.1),
            "b": member("knee", "tip", 0.2),
            "c": member("knee", "arm", 0.05),
        },
        supports=supports,
        masses={
            "m": {"node": "tip", "mass": 4.0, "offset": turned((0.05, 0.0, 0.02))},
            "n": {"node": "arm", "mass": 1.0},
        },
        initial_velocity=[
            {"rotation": 12.0, "about": place((0.1, 0.0, 0.0)), "axis": turned((0.0, 1.0, 0.0))},
            {"translation": turned((5.0, 0.0, 40.0)), "members": ("b",), "nodes": ("tip",)},
        ],
        gravity=turned((3.0, 0.0, -9.81)),
    )


def hinge_channels(structure):
    # steps bound by the outputs alone: rounding decides nowhere whether one is accepted
    settings = MultibodySettings(accuracy=1e-4, maximum_time_step=1e-3)
    result = solve_multibody(structure, Run(0.06, 0.002, settings, Outputs(nodes=("tip",))))
    assert result.status.ok
    tip = np.stack([result[f"node.tip.displacement.{axis}"] for axis in "xyz"], axis=1)
    return {name: result[name] for name in result.channels if name.startswith("hinge.")}, tip


@pytest.mark.parametrize("clamped", [True, False])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_turned_and_moved(seed, clamped, record_figure):
    generator = np.random.default_rng(seed)
    rotation = Rotation.random(random_state=generator)
    plain, tip = hinge_channels(frame(Rotation.identity(), np.zeros(3), clamped))
    moved, moved_tip = hinge_channels(frame(rotation, generator.normal(size=3), clamped))
    sizes = {name: max(float(np.abs(values).max()), 1e-3) for name, values in plain.items()}
    worst = max(float(np.abs(moved[name] - plain[name]).max()) / sizes[name] for name in plain)
    kind = "clamped" if clamped else "floating"
    record_figure(f"relative change of the worst hinge channel, {kind}, turn {seed}", worst, 0.0, 1e-6)
    change = np.abs(rotation.apply(tip) - moved_tip).max()
    record_figure(f"change of the tip's path, {kind}, turn {seed}", change, 0.0, 1e-8, "m")
    assert max(np.abs(values).max() for name, values in plain.items() if name.endswith(".rotation")) > 0.1


def floating_chain():
    root = bar(0.3, joint=JointKind.FREE)
    second, third = bar(0.3, 0.0, (0.3, 0.0), 0), bar(0.3, 1.0, (0.3, 0.0), 1)
    hinges = tuple(hinge(dof, softening_law(0.05, 1e-6), softening=0) for dof in (3, 4))
    return TreeModel((root, second, third), hinges)


def boosted(velocity, accuracy=1e-4, steps=0):
    simulation = started(floating_chain(), [2.0, *velocity, 20.0, -30.0], accuracy)
    for _ in range(steps):
        assert simulation.step(0.05 / steps)
    return simulation.q[[0, 3, 4]] if steps else simulation.run(np.array([0.05])).q[-1, [0, 3, 4]]


def test_steady_velocity_with_equal_steps(record_figure):
    change = np.abs(boosted((30.0, -50.0), steps=200) - boosted((0.0, 0.0), steps=200)).max()
    # rounding of velocities 1e16 below 50 m/s, magnified by the stiffness of locked hinges
    record_figure("change of rotations under a boost of 58 m/s", change, 0.0, 1e-7, "rad")


def test_steady_velocity_with_adaptive_steps(record_figure):
    still = boosted((0.0, 0.0))
    change = np.abs(boosted((5.0, -8.0)) - still).max() / np.abs(still).max()
    record_figure("relative change under a boost of 9 m/s, accuracy 1e-4", change, 0.0, 1e-3)
