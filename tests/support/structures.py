"""Structures shared by the verification tests: a tube as cantilever or free chain, and plain hinge laws."""

from __future__ import annotations

from crumple.structure import Structure

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.050, "depth": 0.025, "thickness": 0.00265}


def constant_law(moment, **keys):
    """Law of a constant moment [N m]."""
    return {"type": "constant", "moment": moment, "rate": "off", **keys}


def table_law(positive, negative, **keys):
    """Law of one constant moment per sense [N m]."""
    return {
        "type": "table",
        "rotation": (0.0, 3.0),
        "moment": (positive, positive),
        "negative_rotation": (0.0, 3.0),
        "negative_moment": (negative, negative),
        "rate": "off",
        **keys,
    }


def cantilever(law, payload=6.0, length=1.0, bars=1, reversed_member=False, hinge_place=None, **parts):
    """Tube along x, clamped at its root, with a hinge there and a mass at its tip.

    Parameters
    ----------
    law
        Of every hinge.
    hinge_place
        Distance of the hinge from the root [m]; None leaves it to the rule for clamps.
    """
    root = {"name": "root", "at": "root", "law": law}
    if hinge_place is not None:
        root["offset"] = hinge_place
    member = {
        "nodes": ("tip", "root") if reversed_member else ("root", "tip"),
        "section": "tube",
        "material": "steel",
        "bars": {"number": bars, "law": law},
        "hinges": [root],
    }
    parts = {"supports": {"clamp": {"node": "root", "fix": "all"}}} | parts
    if payload:
        parts = {"masses": {"payload": {"node": "tip", "mass": payload}}} | parts
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (length, 0.0, 0.0)},
        members={"tube": member},
        **parts,
    )
