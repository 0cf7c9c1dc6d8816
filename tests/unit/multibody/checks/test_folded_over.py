"""Hinges that bend past a right angle have a caution with its time; twist and free joints have none."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.structures import STEEL, cantilever, constant_law

from crumple.hinge import Freedom
from crumple.multibody import Run, solve_multibody
from crumple.multibody.checks.folded_over import folded_over
from crumple.structure import MultibodySettings, Outputs, Structure

MOMENT, LENGTH, LUMP, RATE = 1000.0, 1.0, 6.0, 25.0
RIGHT = math.pi / 2.0


def solve(structure, duration, **settings):
    settings = MultibodySettings(**{"members": "rigid"} | settings)
    return solve_multibody(structure, Run(duration, duration / 400, settings))


def about(result):
    return [caution for caution in result.cautions if caution.code == "folded_over"]


def thrown(rate, **parts):
    """A bar with a lump at its tip that turns about a hinge at its root against a constant moment."""
    field = {"rotation": rate, "axis": (0.0, -1.0, 0.0)}
    law = constant_law(MOMENT, form="set-valued")
    return cantilever(law, LUMP, hinge_place=0.0, initial_velocity=[field], **parts)


def times(rate):
    """Time of a right angle [s] and largest angle [rad] by w t - M t2/(2 J)."""
    tube = thrown(rate)
    bar = tube.section_of("tube").mass_per_length(STEEL["density"]) * LENGTH
    inertia = LUMP * LENGTH**2 + bar * LENGTH**2 / 3.0
    largest = rate**2 * inertia / (2.0 * MOMENT)
    left = rate**2 - 2.0 * MOMENT / inertia * RIGHT
    return (rate - math.sqrt(left)) * inertia / MOMENT if left > 0.0 else None, largest


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_a_hinge_past_a_right_angle_is_a_caution_with_its_time(kernel):
    when, largest = times(RATE)
    assert RIGHT < largest < math.pi
    result = solve(thrown(RATE), 0.25, kernel=kernel)
    (found,) = about(result)
    assert (found.place, found.unit, found.limit) == ("hinge root", "rad", RIGHT)
    assert found.value == pytest.approx(largest, rel=2e-3)
    assert found.text == (
        f"Hinge root (at {when * 1e3:.3g} ms) bent past 90 deg: the pieces on both sides of it would meet "
        f"and here pass through each other. Do not trust the result after {when * 1e3:.3g} ms: solve with "
        "shells, let members bend with analysis.multibody.members: elastic, or place hinges elsewhere."
    )
    assert not found.violation
    assert result.status.ok
    assert result.warnings[0] == found.text


def test_up_to_a_right_angle_there_is_none():
    rate = 20.0
    when, largest = times(rate)
    assert when is None
    assert largest == pytest.approx(RIGHT, rel=0.25)
    assert not about(solve(thrown(rate), 0.25))


def test_elastic_members_are_not_advised_where_they_are():
    (found,) = about(solve(thrown(1.3 * RATE), 0.1, members="elastic"))
    assert found.text.endswith(": solve with shells or place hinges elsewhere.")


def test_a_joint_that_turns_freely_is_no_hinge():
    """The arm turns by 2.5 rad about its pin, and the hinge in its middle hardly."""
    bar = {"section": "tube", "material": "steel"}
    law = constant_law(1e5, form="set-valued")
    arm = Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.04, "thickness": 0.002}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0)},
        members={"ab": {"nodes": ("a", "b"), **bar, "hinges": [{"name": "mid", "at": 0.25, "law": law}]}},
        joints={"pin": {"node": "a", "member": "ab", "type": "revolute", "axis": (0.0, 1.0, 0.0)}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        initial_velocity=[{"rotation": 25.0, "axis": (0.0, -1.0, 0.0)}],
    )
    run = Run(0.1, 1e-3, MultibodySettings(members="rigid"), outputs=Outputs(nodes=("b",)))
    result = solve_multibody(arm, run)
    assert result["node.b.displacement.x"][-1] == pytest.approx(0.5 * (math.cos(2.5) - 1.0), rel=1e-3)
    assert not about(result)


def hinge(name, freedoms, rotation_max=0.0, **columns):
    """A history of three outputs, in rad; of a plane without freedoms; the largest rotation of all steps."""
    spatial = None if freedoms is None else SimpleNamespace(freedoms=freedoms)
    own = {key.replace("_", "."): np.array(values) for key, values in columns.items()}
    place = SimpleNamespace(name=name, member="m", spatial=spatial)
    return SimpleNamespace(hinge=place, columns=own, values=own.__getitem__, rotation_max=rotation_max)


def found_in(*hinges):
    solved = SimpleNamespace(hinges=hinges, time=np.array([0.0, 0.01, 0.02]), bending_tried=False)
    structure = SimpleNamespace(members={"m": SimpleNamespace(elastic=True)})
    return list(folded_over(structure, solved))


def test_several_hinges_have_one_sentence_in_the_order_of_their_times():
    late = hinge("late", (Freedom.Y,), rotation=[0.0, 0.0, 2.0 * RIGHT])
    early = hinge("early", None, rotation=[0.0, -2.0 * RIGHT, -2.0 * RIGHT])
    first, second = found_in(late, hinge("none", None, rotation=[0.0, 1.5, -1.5]), early)
    assert (first.place, second.place) == ("hinge early", "hinge late")
    assert first.text == second.text
    assert first.text.startswith("Hinges early (at 5 ms), late (at 15 ms) bent past 90 deg: the pieces on ")
    assert "Do not trust the result after 5 ms: solve with shells or place" in first.text


@pytest.mark.parametrize("freedoms", [None, (Freedom.Y,), (Freedom.AXIAL, Freedom.Z), (Freedom.Y, Freedom.Z)])
def test_a_right_angle_that_is_passed_between_two_outputs_counts(freedoms):
    """Whatever the interval of the outputs: the stepper keeps the largest rotation of all steps."""
    turned = {"rotation": [0.0, 1.5, 1.4]}
    (bent,) = found_in(hinge("h", freedoms, 1.6, **turned))
    assert bent.value == 1.6
    assert "Hinge h (at 10 ms) bent past 90 deg" in bent.text
    assert not found_in(hinge("h", freedoms, 1.57, **turned))


def test_twist_does_not_count():
    turned, still = [0.0, 3.0, 3.0], [0.0, 0.0, 0.0]
    assert not found_in(hinge("only", (Freedom.X,), 3.0, rotation=turned))
    both = {"rotation": turned, "rotation_x": turned, "rotation_y": still, "rotation_z": still}
    assert not found_in(hinge("both", (Freedom.X, Freedom.Y, Freedom.Z), 3.0, **both))
    # of two axes the length of the vector counts: each below a right angle
    (bent,) = found_in(
        hinge("b", (Freedom.Y, Freedom.Z), rotation_y=[0.0, 1.2, 0.0], rotation_z=[0.0, 1.5, 0.0])
    )
    assert bent.value == pytest.approx(math.hypot(1.2, 1.5))
