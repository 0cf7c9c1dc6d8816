"""An initial motion that a support forbids: the nearest admissible motion remains.

Source: an inelastic arrest is orthogonal in kinetic energy.  A bar thrown about its end while its other end
rests on a roller keeps no motion; a bar with a hinge in the middle keeps the part of its momentum along the
one remaining coordinate, T = J^2/(2 I), derived in the test.  The support does no work.  Tolerance:
rounding, 1e-9.

Kind: closed form.  Source: derived here.
"""

from __future__ import annotations

import numpy as np
import pytest

from crumple.multibody import Run, solve_multibody
from crumple.result import Result
from crumple.structure import Outputs, Structure

LENGTH, RATE = 1.0, 15.0


def propped(hinges: list[dict[str, object]], tip: float = 0.0) -> Structure:
    law = {"type": "constant", "moment": 500.0}
    masses = {"payload": {"node": "tip", "mass": tip}} if tip else {}
    return Structure(
        materials={
            "steel": {
                "youngs_modulus": 210e9,
                "poissons_ratio": 0.3,
                "density": 7850.0,
                "yield_stress": 488e6,
            }
        },
        sections={"tube": {"type": "circular_tube", "diameter": 0.04, "thickness": 0.002}},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (LENGTH, 0.0, 0.0)},
        members={
            "bar": {
                "nodes": ("root", "tip"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"law": law} | hinge for hinge in hinges],
            }
        },
        supports={"clamp": {"node": "root", "fix": "all"}, "roller": {"node": "tip", "fix": ["z"]}},
        masses=masses,
        initial_velocity=[{"rotation": RATE, "axis": (0.0, 1.0, 0.0)}],
    )


def solved(structure: Structure) -> Result:
    return solve_multibody(structure, Run(duration=0.02, every=1e-3))


def test_motion_blocked_by_a_roller_is_lost_and_reported() -> None:
    result = solved(propped([{"name": "root", "at": "root", "offset": 0.0}]))
    np.testing.assert_allclose(result["energy.kinetic"], 0.0, atol=1e-9)
    np.testing.assert_allclose(result["energy.external_work"], 0.0, atol=1e-12)
    assert any("lost at the start" in text and "'axial: true'" in text for text in result.warnings)


def test_the_nearest_motion_is_kept(record_figure) -> None:
    """Halves turn by -w and +w about root and tip; the tip slides along x to second order only."""
    hinges = [{"name": "root", "at": "root", "offset": 0.0}, {"name": "middle", "at": 0.5}]
    structure = propped(hinges)
    result = solved(structure)
    steel, section = structure.material_of("bar"), structure.section_of("bar")
    half = LENGTH / 2
    mass = section.mass_per_length(steel.density) * half
    own = mass * half**2 / 12 + steel.density * section.second_moment("y") * half
    # unit motion: root half turns by 1, the middle moves by half, the tip half turns by -1
    inertia = 2 * (mass * (half / 2) ** 2 + own)
    momentum = RATE * (mass * (half / 2) ** 2 + own + mass * 1.5 * half * (half / 2) - own)
    record_figure(
        "energy kept", result["energy.kinetic"][0], momentum**2 / (2 * inertia), 1e-9, "J", relative=True
    )
    np.testing.assert_allclose(result["energy.external_work"], 0.0, atol=1e-12)
    assert result.energy_residual < 1e-3


def test_a_held_point_stays(record_figure) -> None:
    hinges = [{"name": "root", "at": "root", "offset": 0.0}, {"name": "middle", "at": 0.5}]
    result = solve_multibody(
        propped(hinges, tip=3.0), Run(duration=0.02, every=1e-3, outputs=Outputs(nodes=("tip",)))
    )
    moved = float(np.abs(result["node.tip.displacement.z"]).max())
    record_figure("displacement of a held point", moved, 0.0, 1e-5, "m")
    assert result["node.tip.velocity.z"][0] == pytest.approx(0.0, abs=1e-9)
