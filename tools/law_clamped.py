"""Bending laws of circular tubes beside a clamp: which cantilevers are solved, and with what result.

A cantilever of a circular tube is clamped at one end; its tip is driven across, and free to turn and to move
along.  With the moment M and the force F at the clamp, the length L, and the deflection w and rotation u of
the tip, a hinge at x from the clamp (`fold_distance`: where candidates are) has

    moment    M - F x                      rotation    u - F L^2/(2 E I)

so the law contains all plastic bending of the member, and the clamp's effect on the fold.  Fitted are the
tubes of the library on the nominal mesh (`law_design`), whose free fold is known on the same mesh, and four
without hardening; held out are the library's held-out tubes, and two without hardening.  Nobody chooses
anything by the latter.
"""

from __future__ import annotations

import json
import math
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from crumple.analysis import Analysis, solve
from crumple.characterisation.resolution import Resolution
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube, fold_distance, half_fold_length
from crumple.structure import Structure
from tools.law_design import COARSE, NOMINAL, YOUNGS_MODULUS, Point, points

DIAMETERS = 8.0
"""Length of the cantilevers over the diameter."""
END = math.radians(42.0)
"""Rotation of the chord of the tip at the end."""
SLOWNESS = 5.0
"""As in `Resolution`, of the whole cantilever."""
PLASTIC = ((17.0, 0.0032), (24.0, 0.0013), (40.0, 0.0017), (57.0, 0.0028))
"""Fitted tubes without hardening: diameter over wall, yield strain."""
SEED = 20263
"""Of the two tubes without hardening that are held out: uniform in the logarithms of the range."""


def design() -> tuple[Point, ...]:
    """Cantilevers in the order of solution, held-out ones last; their names are those of the free tubes."""
    free = [one for one in points() if one.kind == "circular_tube" and one.elements == NOMINAL]
    fitted = [one for one in free if one.role in {"mesh", "hardened"}]
    held = [one for one in free if one.role == "held-out"]
    random = np.random.default_rng(SEED).uniform(size=(2, 2))
    later = [(15.0 * 4.0**a, 0.0012 * (0.004 / 0.0012) ** b) for a, b in random]
    own = [_plastic("training", number, *place) for number, place in enumerate(PLASTIC)]
    return (*own, *fitted, *held, *(_plastic("held-out", number, *place) for number, place in enumerate(later)))


def _plastic(role: Any, number: int, slenderness: float, strain: float) -> Point:
    name = f"circular_tube-plastic-{role}-{number:02d}"
    return Point(name, "circular_tube", role, round(slenderness, 6), 1.0, round(strain, 6), 1.0, NOMINAL)


def cantilever(point: Point, diameters: float = DIAMETERS) -> Analysis:
    """Cantilever of a tube, its tip driven across."""
    section, material = point.section, point.material
    assert isinstance(section, CircularTube)
    half, length = half_fold_length(section), diameters * section.diameter
    duration = Resolution(slowness=SLOWNESS).duration(section, material, "y", length, END)
    drive = {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": -length * math.sin(END)}
    return Analysis(
        structure=Structure(
            materials={"metal": material},
            sections={"tube": section},
            nodes={"foot": (0.0, 0.0, 0.0), "tip": (length, 0.0, 0.0)},
            members={"arm": {"nodes": ("foot", "tip"), "section": "tube", "material": "metal"}},
            supports={
                "foot": {"node": "foot", "fix": "all"},
                "tip": {"node": "tip", "fix": ["y", "rx", "rz"], "motion": {"z": {"havsin": drive}}},
            },
        ),
        duration=duration,
        shell={
            "element_size": section.diameter / 5.0,
            "fine_size": half / point.elements,
            "fine_length": 3.0 * half,
        },
        outputs={"every": duration / 400.0, "nodes": ["tip"]},
    )


def histories(point: Point, analysis: Analysis) -> dict[str, list[float]]:
    """Plastic rotation of the tip [rad], M/M_p at the hinge, its place from the clamp over half a fold, energies [J]."""
    section, material = point.section, point.material
    result = solve(analysis, "shell", threads=1)
    length = float(analysis.structure.frame_of("arm").length)
    rigidity = material.youngs_modulus * section.second_moment("y")
    moment, force = (np.abs(result[f"support.foot.{name}"]) for name in ("moment.y", "force.z"))
    down, turned = (np.abs(result[f"node.tip.{name}"]) for name in ("displacement.z", "rotation.y"))
    plastic = turned - force * length**2 / (2.0 * rigidity)
    fallen = down - force * length**3 / (3.0 * rigidity)
    share = (moment - force * fold_distance(section)) / (
        material.yield_stress * section.plastic_section_modulus("y")
    )
    found = {"rotation": plastic, "moment": share, "down": down / length, "fallen": fallen / length}
    found |= {"work": result["energy.external_work"], "kinetic": result["energy.kinetic"]}
    return {name: [float(f"{one:.5g}") for one in values] for name, values in found.items()}


def main(folder: Path, wanted: list[str]) -> None:
    """Solve the cantilevers that the folder lacks."""
    for point in design():
        path = folder / f"clamped-{point.name}.json"
        if path.exists() or (wanted and not any(part in point.name for part in wanted)):
            continue
        begun = time.process_time()
        found = histories(point, cantilever(point))
        path.write_text(json.dumps({"point": vars(point), "histories": found}) + "\n")
        print(f"{point.name} {time.process_time() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
