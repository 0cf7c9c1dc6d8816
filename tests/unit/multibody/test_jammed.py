"""Driven obstacles that strike what cannot give way."""

from tests.verification.structures import STEEL, TUBE

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import Structure

RAM = {"type": "plane", "point": (1.05, 0, 0), "normal": (-1, 0, 0), "velocity": (-0.1, 0, 0)}


def pushed(ram):
    """A bar with a hinge half-way, clamped at x = 0."""
    hinge = {"name": "fold", "at": 0.5, "law": {"type": "constant", "moment": 500.0}}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={
            "bar": {"nodes": ("root", "tip"), "section": "tube", "material": "steel", "hinges": [hinge]}
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        obstacles={"ram": ram},
    )
    return solve_multibody(structure, Run(1.0, 0.05))


def test_a_ram_along_a_bar_ends_the_run_when_it_touches():
    result = pushed(RAM)
    assert result.status is Status.STEP_COLLAPSED
    assert "presses on what cannot give way" in result.reason
    # it has 50 mm to go at 0.1 m/s
    assert 0.45 <= result.time[-1] <= 0.5


def test_a_ram_that_bends_the_bar_goes_on():
    across = {"type": "sphere", "point": (0.9, 0, 0.15), "radius": 0.1, "velocity": (0, 0, -0.1)}
    result = pushed(across)
    assert result.status is Status.COMPLETE
    assert result["hinge.fold.rotation"][-1] > 0.05
