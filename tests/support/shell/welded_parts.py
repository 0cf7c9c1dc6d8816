"""Parts joined by spot welds, for tests: strips that overlap or cross, hat and plate."""

from __future__ import annotations

from typing import Any

from crumple import section
from crumple.structure import ShellSettings, Structure

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
THICKNESS = 1.5e-3
STRIP = {"type": "walls", "walls": [{"points": [(-0.02, 0.0), (0.02, 0.0)], "thickness": THICKNESS}]}
HAT = {"type": "hat", "width": 0.06, "depth": 0.04, "thickness": THICKNESS, "flange": 0.02}
FREEDOMS = ("x", "y", "z", "rx", "ry", "rz")
SETTINGS = ShellSettings(element_size=5e-3, element="stabilised", damping=1500.0)


def driven(node: str, axis: str, way: float, time: float) -> dict[str, Any]:
    """Support that moves a node smoothly along one axis and holds the rest."""
    ramp = {"step5": {"x0": 0.0, "h0": 0.0, "x1": time, "h1": way}}
    return {"node": node, "fix": [freedom for freedom in FREEDOMS if freedom != axis], "motion": {axis: ramp}}


def strips(nodes: dict[str, tuple[float, float, float]], supports: dict[str, Any], **welds: Any) -> Structure:
    """A strip from a to b, another on top from c to d, and welds between them."""
    return Structure(
        materials={"steel": STEEL},
        sections={"strip": STRIP},
        nodes=nodes,
        members={
            "low": {"nodes": ("a", "b"), "section": "strip", "material": "steel"},
            "up": {"nodes": ("c", "d"), "section": "strip", "material": "steel"},
        },
        supports=supports,
        spot_welds={"spot": {"members": ("low", "up"), **welds}},
    )


def lap(way: float, time: float, **welds: Any) -> Structure:
    """Strips of 80 mm that overlap by 40 mm, pulled apart along themselves; one spot between four nodes."""
    nodes = {"a": (0, 0, 0), "b": (0.08, 0, 0), "c": (0.04, 0, THICKNESS), "d": (0.12, 0, THICKNESS)}
    supports = {"held": {"node": "a", "fix": "all"}, "pulled": driven("d", "x", way, time)}
    given = {"points": [(0.0575, 0.0025, THICKNESS / 2)], **welds}
    return strips(nodes, supports, **given)


def cross(way: float, time: float, **welds: Any) -> Structure:
    """Strips of 120 mm at right angles, the upper one lifted by both ends."""
    nodes = {"a": (-0.06, 0, 0), "b": (0.06, 0, 0), "c": (0, -0.06, THICKNESS), "d": (0, 0.06, THICKNESS)}
    supports = {f"held-{n}": {"node": n, "fix": "all"} for n in "ab"}
    supports |= {f"lifted-{n}": driven(n, "z", way, time) for n in "cd"}
    return strips(nodes, supports, **{"points": [(0.0, 0.0, THICKNESS / 2)], **welds})


def closed_hat(length: float, **more: Any) -> Structure:
    """Hat and plate as one section, along x."""
    return Structure(
        materials={"steel": STEEL},
        sections={"hat": {**HAT, "type": "closed_hat"}},
        nodes={"root": (0, 0, 0), "tip": (length, 0, 0)},
        members={"hat": {"nodes": ("root", "tip"), "section": "hat", "material": "steel"}},
        **more,
    )


def hat_and_plate(length: float, *, spots: dict[str, Any], **more: Any) -> Structure:
    """The same as two members, welded along the middle of both flanges."""
    one = section.ClosedHat(0.06, 0.04, THICKNESS, 0.02)
    line, (plate,) = section.Hat(0.06, 0.04, THICKNESS, 0.02).properties.centroid[1], one.walls[1:]
    below = plate.points[0][1]
    walls = {"type": "walls", "walls": [{"points": plate.points, "thickness": THICKNESS}]}
    welds = {
        name: {"members": ("hat", "plate"), "at": (weld.first[0], below / 2 - line), **spots}
        for name, weld in zip(("left", "right"), one.welds, strict=True)
    }
    return Structure(
        materials={"steel": STEEL},
        sections={"hat": HAT, "plate": walls},
        nodes={
            "root": (0, 0, line),
            "tip": (length, 0, line),
            "plate-root": (0, 0, below),
            "plate-tip": (length, 0, below),
        },
        members={
            "hat": {"nodes": ("root", "tip"), "section": "hat", "material": "steel"},
            "plate": {"nodes": ("plate-root", "plate-tip"), "section": "plate", "material": "steel"},
        },
        spot_welds=welds,
        **more,
    )
