"""Hinges rotate about the section axis normal to the plane of bending, unless another axis is given."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crumple.multibody import Run, solve_multibody
from crumple.structure import Outputs, Structure, placed_hinges
from crumple.structure.bending import planar
from crumple.structure.hinges.elastic_members import joint_stations
from crumple.structure.hinges.runs.bars import bar_of

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.05, "depth": 0.025, "thickness": 0.00265}

ROUND = {"type": "circular_tube", "diameter": 0.05, "thickness": 0.002}


def cantilever(
    roll: float = 0.0,
    axis: str | None = None,
    section: dict[str, Any] | None = None,
    automatic: bool = False,
    **motion: Any,
) -> Structure:
    hinge = {"name": "root", "at": "root"} | ({"axis": axis} if axis else {})
    hinges = {"hinges": "auto", "elastic": 4} if automatic else {"hinges": [hinge]}
    member = {
        "nodes": ("root", "tip"),
        "section": "tube",
        "material": "steel",
        "roll": roll,
        **hinges,
    }
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": section or TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={"tube": member},
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"payload": {"node": "tip", "mass": 6.0}},
        **motion,
    )


def axis_of(structure: Structure) -> str:
    (hinge,) = placed_hinges(structure)
    return hinge.axis


@pytest.mark.parametrize(
    ("motion", "flat", "upright"),
    [
        ({"initial_velocity": [{"rotation": 15.0, "axis": (0, 1, 0)}]}, "y", "z"),
        ({"initial_velocity": [{"rotation": 15.0, "axis": (0, 0, 1)}]}, "z", "y"),
        ({"initial_velocity": [{"translation": (0, 0, 3.0)}]}, "y", "z"),
        ({"initial_velocity": [{"translation": (0, 3.0, 0)}]}, "z", "y"),
        ({"impulses": [{"node": "tip", "impulse": (0, 0, 5.0)}]}, "y", "z"),
        ({"loads": [{"node": "tip", "force": {"y": 10.0}}]}, "z", "y"),
        ({"loads": [{"node": "tip", "moment": {"y": 10.0}}]}, "y", "z"),
        ({"gravity": (0, 0, -9.81)}, "y", "z"),
        ({}, "y", "y"),
        ({"initial_velocity": [{"translation": (3.0, 0, 0)}]}, "y", "y"),
    ],
)
def test_turning_the_section_keeps_the_plane_of_bending(
    motion: dict[str, Any], flat: str, upright: str
) -> None:
    assert axis_of(cantilever(**motion)) == flat
    assert axis_of(cantilever(roll=np.pi / 2, **motion)) == upright


def test_a_given_axis_is_kept() -> None:
    motion = {"initial_velocity": [{"rotation": 15.0, "axis": (0, 1, 0)}]}
    assert axis_of(cantilever(axis="z", **motion)) == "z"


def test_a_frame_bends_in_its_plane_whatever_moves_it() -> None:
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 1.0), "c": (1.0, 0.0, 1.0)}
    hinge = [{"name": "foot", "at": "a"}]
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes=nodes,
        members={
            "column": {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": hinge},
            "beam": {"nodes": ("b", "c"), "section": "tube", "material": "steel"},
        },
        supports={"clamp": {"node": "a", "fix": "all"}},
        gravity=(0.0, -9.81, 0.0),
    )
    (placed,) = placed_hinges(structure)
    np.testing.assert_allclose(np.abs(placed.direction), (0.0, 1.0, 0.0), atol=1e-12)


@pytest.mark.parametrize(
    ("section", "turn", "flat"),
    [(TUBE, 27.0, False), (TUBE, 0.1, False), (TUBE, 0.05, True), (TUBE, 90.0, True), (ROUND, 27.0, True)],
)
def test_a_section_at_an_angle_to_the_plane_also_bends_across_it(
    section: dict[str, Any], turn: float, flat: bool
) -> None:
    """Automatic hinges then turn about both axes, and elastic members bend about both."""
    pushed = (0.0, np.sin(np.radians(turn)), np.cos(np.radians(turn)))
    arm = cantilever(initial_velocity=[{"translation": pushed}], section=section, automatic=True)
    assert planar(arm) == flat
    (hinge,) = [one for one in placed_hinges(arm) if one.name == "tube-root"]
    assert (hinge.spatial is None) == flat
    bends = [axis for axis in ("y", "z") if joint_stations(arm, bar_of(arm, "tube"), axis, (0.0,))]
    assert len(bends) == (1 if flat else 2)


OTHER = {
    "beside": ((0.0, 1.0, 0.0), (1.0, 1.0, 0.0)),
    "leaning": ((0.0, 1.0, 0.0), (0.3, 1.6, 0.2)),
    "above": ((0.0, 0.0, 1.0), (1.0, 0.0, 1.0)),
}


def with_another_part(structure: Structure, ends: tuple[Any, Any], **parts: Any) -> Structure:
    """The structure and a free tube that nothing connects to it, thrown upwards."""
    plain = {name: dict(getattr(structure, name)) for name in ("nodes", "members")}
    thrown = {"translation": (0.0, 0.0, 1.0), "members": ("other",)}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes=plain["nodes"] | dict(zip("de", ends, strict=True)),
        members=plain["members"] | {"other": {"nodes": ("d", "e"), "section": "tube", "material": "steel"}},
        supports=structure.supports,
        masses=structure.masses,
        initial_velocity=[*structure.initial_velocity, thrown],
        **parts,
    )


@pytest.mark.parametrize("ends", OTHER.values(), ids=OTHER)
@pytest.mark.parametrize("way", ["y", "z"])
def test_another_part_does_not_decide_on_the_plane(way: str, ends: tuple[Any, Any]) -> None:
    """Two tubes span a plane that neither bends in; a hinge across it locked the one that is thrown."""
    along = {"y": (0.0, 40.0, 0.0), "z": (0.0, 0.0, 40.0)}[way]
    alone = cantilever(initial_velocity=[{"translation": along, "members": ("tube",)}])
    whole = with_another_part(alone, ends)
    assert axis_of(whole) == axis_of(alone)
    run = Run(0.02, 1e-3, outputs=Outputs(nodes=("tip",)))
    one, two = solve_multibody(alone, run), solve_multibody(whole, run)
    assert one.hinges["root"].rotation_max > 0.05
    for axis in "xyz":
        name = f"node.tip.displacement.{axis}"
        assert two[name][-1] == pytest.approx(one[name][-1], abs=1e-4), name


def test_spot_welds_connect() -> None:
    """Two tubes side by side are one part, which bends in their plane where nothing else says so."""
    alone = cantilever()
    welds = {"line": {"members": ("tube", "other"), "points": [(0.5, 0.025, 0.0)]}}
    beside = ((0.0, 0.05, 0.0), (1.0, 0.05, 0.0))
    assert axis_of(with_another_part(alone, beside, spot_welds=welds)) == "z"


def test_looking_spoils_neither_comparison_nor_copies() -> None:
    one, two = cantilever(gravity=(0, 0, -9.81)), cantilever(gravity=(0, 0, -9.81))
    assert axis_of(one) == "y"
    assert one == two
    assert axis_of(one.model_copy(update={"gravity": (0, 9.81, 0)})) == "z"


def knee(section: dict[str, Any], turn: float, digits: int, **motion: Any) -> Structure:
    """Three members in an upright plane that is turned about z; coordinates rounded to so many digits."""
    along = np.array([np.cos(turn), np.sin(turn), 0.0])
    places = {"a": (0.0, 0.0), "b": (0.1, 0.7), "c": (0.8, 0.9), "d": (1.1, 0.1)}
    nodes = {name: tuple(np.round(x * along + [0.0, 0.0, z], digits)) for name, (x, z) in places.items()}
    hinges = {"nodes": ("a", "b"), "section": "tube", "material": "steel"}
    members = {
        first + second: hinges | {"nodes": (first, second), "hinges": [{"name": first, "at": first}]}
        for first, second in ("ab", "bc", "dc")
    }
    supports = {"one": {"node": "a", "fix": "all"}, "other": {"node": "d", "fix": "all"}}
    velocity = [{"nodes": ["b"], "translation": tuple(3.0 * along)}]
    rest = {"supports": supports, "initial_velocity": velocity} | motion
    return Structure(
        materials={"steel": STEEL}, sections={"tube": section}, nodes=nodes, members=members, **rest
    )


@pytest.mark.parametrize("section", [TUBE, ROUND], ids=["rectangular", "round"])
@pytest.mark.parametrize("digits", [7, 6, 5])
@pytest.mark.parametrize("turn", [0.2, 0.6])
def test_hinges_of_a_frame_of_rounded_coordinates_are_parallel(
    section: dict[str, Any], digits: int, turn: float
) -> None:
    """Axes that differ lock a closed loop, however little."""
    structure = knee(section, turn, digits)
    assert planar(structure)
    axes = np.array([hinge.direction for hinge in placed_hinges(structure)])
    assert np.abs(np.cross(axes[:1], axes)).max() < 1e-15
    normal = (-np.sin(turn), np.cos(turn), 0.0)
    np.testing.assert_allclose(np.abs(axes[0]), np.abs(normal), atol=1e-4)
    lines = np.array([structure.frame_of(name).axes for name in structure.members])
    assert np.abs(lines[:, 0] @ axes[0]).max() < 1e-15
    np.testing.assert_allclose(lines @ lines.transpose(0, 2, 1), [np.eye(3)] * 3, atol=1e-15)


def test_a_section_that_lies_obliquely_to_a_plane_keeps_its_axes() -> None:
    exact, rounded = (
        knee(TUBE, 0.2, digits).model_copy(
            update={"members": {k: m.model_copy(update={"roll": 0.1}) for k, m in part.members.items()}}
        )
        for digits, part in ((16, knee(TUBE, 0.2, 16)), (6, knee(TUBE, 0.2, 6)))
    )
    for name in exact.members:
        np.testing.assert_allclose(rounded.frame_of(name).axes, exact.frame_of(name).axes, atol=1e-5)


def test_what_bends_a_tube_that_is_straight_but_for_rounding_decides_on_the_plane() -> None:
    """And not the direction in which its middle is off the line."""

    def normal(aside: float, **motion: Any) -> tuple[float, float, float] | None:
        nodes = {"a": (0.0, 0.0, 0.0), "b": (0.5, aside, 0.0), "c": (1.0, 0.0, 0.0)}
        plain = {"section": "tube", "material": "steel"}
        members = {"ab": {"nodes": ("a", "b"), **plain}, "bc": {"nodes": ("b", "c"), **plain}}
        return Structure(
            materials={"steel": STEEL}, sections={"tube": TUBE}, nodes=nodes, members=members, **motion
        ).bending_normal

    pushed = {"initial_velocity": [{"translation": (0.0, 0.0, -3.0)}]}
    for aside in (0.0, 1e-6, 1e-5, -5e-5):
        found = normal(aside, **pushed)
        assert found is not None
        np.testing.assert_allclose(np.abs(found), (0.0, 1.0, 0.0), atol=1e-12)
    along = {"initial_velocity": [{"translation": (-3.0, 0.0, 0.0)}]}
    assert normal(0.0, **along) is None
    for aside in (1e-5, 1e-3):
        found = normal(aside, **along)
        assert found is not None
        np.testing.assert_allclose(np.abs(found), (0.0, 0.0, 1.0), atol=1e-12)
