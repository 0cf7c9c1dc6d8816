"""Small structures of one steel tube, meshed coarsely so that they run in a blink."""

from __future__ import annotations

from typing import Any

from crumple.structure import Structure

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.05, "depth": 0.025, "thickness": 2.65e-3}


def structure(
    nodes: dict[str, tuple[float, ...]], members: dict[str, tuple[str, str]], **more: Any
) -> Structure:
    """Members of the same tube between nodes."""
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes=nodes,
        members={
            name: {"nodes": ends, "section": "tube", "material": "steel"} for name, ends in members.items()
        },
        **more,
    )


def cantilever(**more: Any) -> Structure:
    """Tube of 1 m along x, clamped at its root."""
    given = {"supports": {"clamp": {"node": "root", "fix": "all"}}, **more}
    return structure({"root": (0, 0, 0), "tip": (1, 0, 0)}, {"tube": ("root", "tip")}, **given)


def thrown() -> Structure:
    """The cantilever of example 01: 6 kg at its tip, thrown at 15 rad/s, with a hinge at the root."""
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0, 0, 0), "tip": (1, 0, 0)},
        members={
            "tube": {
                "nodes": ("root", "tip"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"name": "root", "at": "root", "law": "kecman"}],
            }
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"payload": {"node": "tip", "mass": 6.0}},
        initial_velocity=[{"rotation": 15.0, "axis": (0, -1, 0)}],
    )


def knee() -> Structure:
    """Two tubes of 0.5 m at a right angle in the x-z plane."""
    return structure(
        {"a": (0, 0, 0), "b": (0.5, 0, 0), "c": (0.5, 0, 0.5)},
        {"one": ("a", "b"), "two": ("b", "c")},
        supports={"clamp": {"node": "a", "fix": "all"}},
    )


def tee() -> Structure:
    """Three tubes that meet at a node."""
    return structure(
        {"a": (0, 0, 0), "b": (0.5, 0, 0), "c": (1, 0, 0), "d": (0.5, 0, 0.5)},
        {"one": ("a", "b"), "two": ("b", "c"), "three": ("b", "d")},
        supports={"clamp": {"node": "a", "fix": "all"}},
    )
