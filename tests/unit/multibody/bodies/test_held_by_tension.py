"""Folds of elastic members gain moment by tension, up to what they have lost."""

import pytest

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Structure, placed_hinges, with_elastic_members

TUBE = {"type": "rectangular_tube", "width": 0.06, "depth": 0.04, "thickness": 0.002}
ARMS = {"y": 0.019, "z": 0.029}
FIRST = 3e3


def column(tension, left=0.5, axis="y", members="elastic", **keys):
    """A column whose moment falls at once to a share of 3 kN m, thrown across under a force along it.

    Keys: the section, the coupling of the hinge, and its axes.
    """
    axes = keys.get("axes", ("y", "z"))
    law = {"type": "table", "rotation": (0.0, 0.001, 3.2), "moment": (FIRST, left * FIRST, left * FIRST)}
    hinge = {"name": "foot", "at": 0.06, "law": law}
    hinge |= {"axes": axes, "coupling": keys.get("coupling")} if axes else {"axis": axis}
    metal = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 500e6}
    across = (0.0, 0.0, 4.0) if axis == "y" else (0.0, 4.0, 0.0)
    structure = Structure(
        materials={"metal": metal},
        sections={"tube": keys.get("section", TUBE)},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0)},
        members={"ab": {"nodes": ("a", "b"), "section": "tube", "material": "metal", "hinges": [hinge]}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        masses={"m": {"node": "b", "mass": 30.0}},
        loads=[{"node": "b", "force": {"x": tension}}],
        initial_velocity=[{"nodes": ("b",), "translation": across}],
    )
    return structure, Run(0.006, 0.0005, MultibodySettings(kernel="spatial", members=members))


def moment_left(*args, **keys):
    """Capacity of the fold at the end, about the axis of bending [N m]."""
    axis = keys.get("axis", "y")
    result = solve_multibody(*column(*args, **keys))
    assert result.status.ok
    assert result.hinges["foot"].rotation_max > 0.02
    name = f"hinge.foot.capacity.{axis}" if keys.get("axes", ("y", "z")) else "hinge.foot.capacity"
    return float(result[name][-1])


@pytest.mark.parametrize("axis", ["y", "z"])
def test_tension_times_the_distance_of_the_flange_is_gained(axis):
    assert moment_left(40e3, axis=axis) == pytest.approx(0.5 * FIRST + 40e3 * ARMS[axis], rel=0.03)
    # the thrown mass pulls a little
    assert moment_left(0.0, axis=axis) == pytest.approx(0.5 * FIRST, rel=0.03)


def test_a_hinge_about_one_axis_gains_as_much():
    assert moment_left(40e3, axes=None) == pytest.approx(0.5 * FIRST + 40e3 * ARMS["y"], rel=0.03)


def test_no_more_is_gained_than_was_lost():
    assert moment_left(120e3) == pytest.approx(FIRST, rel=1e-9)


def test_a_fold_that_has_lost_little_gains_a_part():
    # of three tenths lost all of it is gained
    assert moment_left(10e3, left=0.85) == pytest.approx(0.85 * FIRST + 0.5 * 10e3 * ARMS["y"], rel=0.01)


def test_compression_rigid_bars_and_folds_without_coupling_gain_nothing():
    alone = pytest.approx(0.5 * FIRST, rel=1e-3)
    assert moment_left(-40e3) == alone
    assert moment_left(40e3, members="rigid") == alone
    assert moment_left(40e3, coupling="none") == alone


def test_round_tubes_gain_nothing():
    ring = {"type": "circular_tube", "diameter": 0.06, "thickness": 0.003}
    assert moment_left(40e3, section=ring) == pytest.approx(0.5 * FIRST, rel=1e-3)


def flanges(structure):
    """Axes about which tension holds the folds, by hinge."""
    bent = with_elastic_members(structure, MultibodySettings(members="elastic"), 0.1)
    return {hinge.name: set(hinge.flanges) for hinge in placed_hinges(bent) if hinge.plastic}


def test_corners_have_no_flange_and_the_members_beside_them_have():
    structure, _ = column(0.0)
    given = {"nodes": {**structure.nodes, "c": (0.5, 0.0, 0.5)}, "hinges": {}}
    ab = structure.members["ab"].model_copy(update={"hinges": None})
    given["members"] = {"ab": ab, "bc": ab.model_copy(update={"nodes": ("b", "c")})}
    found = flanges(structure.model_copy(update={**given, "masses": {}, "loads": ()}))
    assert found["corner-b"] == set()
    assert found["ab-a"] == {"y", "z"}
