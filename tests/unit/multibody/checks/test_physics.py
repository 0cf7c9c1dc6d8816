"""Checks of results against laws of mechanics and against what members carry."""

from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.structures import STEEL, cantilever, constant_law

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.multibody.checks import physics
from crumple.result import Caution, Channel, CrumpledEnd, sentences
from crumple.structure import MultibodySettings, Structure
from crumple.structure.hinges.lengthening.nodes_met import supports_met


def solve(structure, duration=0.05, **settings):
    return solve_multibody(structure, Run(duration, duration / 50, MultibodySettings(**settings)))


def codes(result):
    return [caution.code for caution in result.cautions]


def run_of(energies, hinge=(), obstacle_velocity=()):
    """What a solved run offers to the checks of energies."""
    history = SimpleNamespace(
        hinge=SimpleNamespace(name="knee"), values=lambda name: np.array(hinge or [0.0, 1.0])
    )
    velocity = np.array(obstacle_velocity or [0.0, 0.0])
    channels = [
        SimpleNamespace(name=f"obstacle.ram.velocity.{axis}", values=velocity * (axis == "x"))
        for axis in "xyz"
    ]
    zero = np.zeros(2)
    energy = {"kinetic": np.array([100.0, 0.0]), "external_work": zero, "elastic": zero}
    energy |= {name: np.array(values) for name, values in energies.items()}
    return SimpleNamespace(hinges=(history,), energy=energy, further=channels)


@pytest.mark.parametrize(
    ("histories", "fall"),
    [([0.0, 5.0, 4.0], 1.0), ([0.0, -2.0, 3.0], 2.0), ([0.0, 1.0, 1.0], 0.0), ([3.0, 2.5, 4.0, 3.2], 0.8)],
)
def test_the_largest_fall_is_below_what_was_reached(histories, fall):
    assert physics.largest_fall(np.array(histories)) == pytest.approx(fall)


def test_dissipated_energy_that_falls_is_a_violation():
    (friction,) = physics.falling_energies(run_of({"friction": [1.0, 0.8]}), 100.0)
    assert (friction.code, friction.place, friction.violation) == ("dissipation_falls", "friction", True)
    assert friction.value == pytest.approx(0.2)
    assert friction.limit == pytest.approx(0.1)
    (hinge,) = physics.falling_energies(run_of({}, hinge=[5.0, 4.5]), 100.0)
    assert hinge.place == "hinge knee"
    # what the energy balance may leave open is no violation
    assert not list(physics.falling_energies(run_of({"friction": [1.0, 0.95]}), 100.0))
    # nor is rounding in a structure that nothing moves
    assert not list(physics.falling_energies(run_of({}, hinge=[0.0, -2e-112]), 1e-120))


def ram(**keys):
    obstacle = SimpleNamespace(mass=2.0, restitution=0.0, velocity=(10.0, 0.0, 0.0), **keys)
    return SimpleNamespace(obstacles={"ram": obstacle})


def test_a_rebound_that_nothing_pays_for_is_a_violation():
    # 2 kg at 10 m/s: 100 J; a tenth may come back, that is 3.16 m/s
    (found,) = physics.rebounds(ram(), run_of({}, obstacle_velocity=[10.0, -3.3]))
    assert (found.code, found.violation, found.limit) == ("rebound", True, pytest.approx(10.0))
    assert found.value == pytest.approx(3.3**2)
    assert not list(physics.rebounds(ram(), run_of({}, obstacle_velocity=[10.0, -3.0])))
    # work from outside, springs and other bodies' motion can pay for it
    for paid in (
        {"external_work": [0.0, -2.0]},
        {"elastic": [0.0, 2.0]},
        {"kinetic": [102.0, 0.0]},
    ):
        assert not list(physics.rebounds(ram(), run_of(paid, obstacle_velocity=[10.0, -3.3])))


def test_an_obstacle_with_restitution_may_rebound():
    structure = ram()
    structure.obstacles["ram"].restitution = 0.5
    assert not list(physics.rebounds(structure, run_of({}, obstacle_velocity=[10.0, -5.0])))


def spinning(rate):
    """A tube that turns about its pinned root: its own centrifugal force pulls it."""
    law = constant_law(2000.0, form="set-valued")
    return cantilever(
        law, payload=0.0, hinge_place=0.0, initial_velocity=[{"rotation": rate, "axis": (0.0, -1.0, 0.0)}]
    )


def test_tension_beyond_yield_is_a_caution_and_not_a_violation():
    # stress at the root of a bar of 1 m: rho w^2 L^2/2
    yields = np.sqrt(2.0 * STEEL["yield_stress"] / STEEL["density"])
    fast = solve(spinning(1.15 * yields), 0.002, kernel="spatial")
    (found,) = [caution for caution in fast.cautions if caution.code == "axial_tension"]
    assert found.place == "member tube"
    assert found.value == pytest.approx(1.15**2 * found.limit, rel=0.02)
    assert fast.status is Status.COMPLETE
    assert fast.warnings[0] in sentences(fast.cautions)
    slow = solve(spinning(0.9 * yields), 0.002, kernel="spatial")
    assert "axial_tension" not in codes(slow)


def test_a_fold_beyond_jamming_is_a_caution():
    thrown = [{"rotation": 40.0, "axis": (0.0, -1.0, 0.0)}]
    result = solve(cantilever({"type": "kecman"}, initial_velocity=thrown), 0.2)
    (found,) = [caution for caution in result.cautions if caution.code == "beyond_jamming"]
    assert found.value == result.hinges["root"].rotation_max > found.limit
    # reported once, and not again as the range of the law
    assert sum("turned by" in text for text in result.warnings) == 1


def crash_box(speed):
    """A box of 0.25 m before a sled of 500 kg."""
    hinge = {"name": "crush", "at": 0.125, "axial": {"law": "superfolding"}}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.07, "thickness": 0.002}},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (0.25, 0.0, 0.0)},
        members={
            "box": {"nodes": ("root", "tip"), "section": "tube", "material": "steel", "hinges": (hinge,)}
        },
        supports={"base": {"node": "root", "fix": "all"}},
        obstacles={
            "sled": {
                "type": "plane",
                "point": (0.2501, 0.0, 0.0),
                "normal": (-1.0, 0.0, 0.0),
                "mass": 500.0,
                "velocity": (-speed, 0.0, 0.0),
            }
        },
    )


def test_a_crash_box_that_bottoms_out_is_a_caution():
    fast = solve(crash_box(12.0))
    (found,) = [caution for caution in fast.cautions if caution.code == "bottomed_out"]
    assert (found.place, found.unit) == ("hinge crush", "m")
    assert 0.5 * 0.25 < found.limit < found.value < 0.25
    crush = fast.hinges["crush"].crush
    assert (crush.length, crush.stroke, crush.bottomed_out) == (found.value, found.limit, True)
    assert crush.efficiency == pytest.approx(crush.length / 0.25)
    # nothing bent: rotations and moments are not reported
    assert not fast.hinges["crush"].bends
    assert not any("rotations of" in text for text in fast.warnings)
    # the mean of the law until the folds are closed
    assert crush.energy == pytest.approx(fast.hinges["crush"].energy, rel=1e-9)
    assert crush.mean_force == pytest.approx(crush.energy / crush.length)
    assert "bottomed_out" not in codes(solve(crash_box(4.0)))


def test_energy_lost_in_rigid_impacts_is_a_caution_from_a_tenth():
    structure = cantilever(constant_law(100.0))
    energy = {"contact": np.array([0.0, 11.0])}
    (found,) = physics.impact_losses(
        structure, SimpleNamespace(energy=energy, crushed=(), crumpled=()), 100.0
    )
    assert (found.code, found.value, found.limit) == ("impact_loss", 11.0, 10.0)
    assert "(11%)" in found.text
    no_impact = SimpleNamespace(energy={"contact": np.array([0.0, 9.0])}, crushed=(), crumpled=())
    assert not list(physics.impact_losses(structure, no_impact, 100.0))
    # what crumples is not lost in an impact
    end = CrumpledEnd("rail", "tip", "wall", 0.01, 2.0)
    crumples = SimpleNamespace(energy=energy, crushed=(), crumpled=(end,))
    assert not list(physics.impact_losses(structure, crumples, 100.0))


@pytest.mark.parametrize(
    ("x", "supported", "expected"),
    [
        # the plane meets the whole post, its clamp too
        (0.0, "foot", ["foot"]),
        # the post leans away from the plane: the corner is met first
        (-0.1, "foot", []),
        # the node that is met is held across the blow alone
        (0.0, "guided", []),
    ],
)
def test_what_an_obstacle_meets_at_a_support_is_named(x, supported, expected):
    held = {"foot": "all", "guided": ["y", "z", "rx", "ry", "rz"]}[supported]
    structure = Structure(
        nodes={"foot": (0.0, 0.0, 0.0), "corner": (x, 0.0, 0.7), "end": (0.8, 0.0, 0.7)},
        members={
            name: {"nodes": nodes, "section": "tube", "material": "steel"}
            for name, nodes in {"post": ("foot", "corner"), "beam": ("corner", "end")}.items()
        },
        sections={"tube": {"type": "square_tube", "side": 0.05, "thickness": 0.002}},
        materials={"steel": STEEL},
        supports={"foot": {"node": "foot", "fix": held}},
        obstacles={"ram": {"type": "plane", "point": (-0.2, 0.0, 0.0), "normal": (1.0, 0.0, 0.0)}},
    )
    assert list(supports_met(structure)) == [("ram", node) for node in expected]
    # the plane starts 0.2 m from the post: it is said only where it comes there
    for path, reached in ((0.18, True), (0.1, False)):
        moved = Channel("obstacle.ram.displacement.x", "m", np.array([0.0, path, 0.05]))
        still = [Channel(f"obstacle.ram.displacement.{axis}", "m", np.zeros(3)) for axis in "yz"]
        energy = {"contact": np.array([0.0, 50.0])}
        solved = SimpleNamespace(energy=energy, crushed=(), crumpled=(), further=(moved, *still))
        (found,) = physics.impact_losses(structure, solved, 100.0)
        assert ("Obstacle ram meets node foot" in found.text) == (bool(expected) and reached)


def test_a_violation_changes_the_status(monkeypatch):
    broken = Caution("dissipation_falls", 1.0, 0.1, "J", "friction", "It falls.", violation=True)
    monkeypatch.setattr("crumple.multibody.solve.physics_cautions", lambda *_, **__: (broken,))
    thrown = [{"rotation": 5.0, "axis": (0.0, -1.0, 0.0)}]
    result = solve(cantilever(constant_law(1000.0), initial_velocity=thrown))
    assert (result.status, result.reason) == (Status.IMPOSSIBLE, "It falls.")
    assert not result.status.ok
    assert "It falls." not in result.warnings


def test_alike_cautions_are_one_sentence():
    two = [Caution("a", 1, 0, "", place, "same") for place in ("x", "y")]
    assert sentences([*two, Caution("b", 1, 0, "", "", "other")]) == ("same", "other")
