"""Parts of structures for the tests of the multibody room."""

from __future__ import annotations

from crumple.structure import Structure

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.050, "depth": 0.025, "thickness": 0.00265}
LAW = {"type": "constant", "moment": 500.0}
CLAMP = {"clamp": {"node": "a", "fix": "all"}}
THROWN = [{"rotation": 10.0, "axis": (0.0, 1.0, 0.0)}]
X_LINE = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)}


def member(first, second, *hinges, **keys):
    """Member of the tube; a hinge is (name, place) or (name, place, further keys)."""
    given = [
        {"name": hinge[0], "at": hinge[1], "law": LAW} | (hinge[2] if len(hinge) > 2 else {})
        for hinge in hinges
    ]
    keys = {"section": "tube", "material": "steel"} | keys
    return {"nodes": (first, second), "hinges": given, **keys}


def structure(nodes=None, members=None, **parts):
    """Structure of tubes; without members one bar along x, clamped at a with a hinge."""
    return Structure(
        materials={"steel": STEEL},
        nodes=nodes or X_LINE,
        members=members or {"bar": member("a", "b", ("h", "a"))},
        **({"sections": {"tube": TUBE}, "supports": CLAMP} | parts),
    )
