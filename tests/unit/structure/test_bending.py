"""Hinges rotate about the section axis normal to the plane of bending, unless another axis is given."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crumple.structure import Structure, placed_hinges

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.05, "depth": 0.025, "thickness": 0.00265}


def cantilever(roll: float = 0.0, axis: str | None = None, **motion: Any) -> Structure:
    hinge = {"name": "root", "at": "root"} | ({"axis": axis} if axis else {})
    member = {
        "nodes": ("root", "tip"),
        "section": "tube",
        "material": "steel",
        "roll": roll,
        "hinges": [hinge],
    }
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
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


def test_looking_spoils_neither_comparison_nor_copies() -> None:
    one, two = cantilever(gravity=(0, 0, -9.81)), cantilever(gravity=(0, 0, -9.81))
    assert axis_of(one) == "y"
    assert one == two
    assert axis_of(one.model_copy(update={"gravity": (0, 9.81, 0)})) == "z"
