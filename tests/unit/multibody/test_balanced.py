"""A planar run whose energy residual exceeds its bound is repeated with a finer accuracy."""

import pytest

import crumple
from crumple.multibody import solve
from crumple.multibody.answer.stated_errors import MARGIN

ELASTIC = {"type": "constant", "moment": 3000.0, "form": "elastic-plastic"}


def portal(**settings):
    """Portal of stiff elastic members on pinned feet, thrown sideways and down with one corner."""
    up = {"material": "steel", "up": (0.0, 1.0, 0.0)}
    return crumple.Analysis(
        title="portal",
        duration=0.013,
        multibody={"mechanism_check": "off", "members": "rigid", **settings},
        structure=crumple.Structure(
            materials={
                "steel": {
                    "youngs_modulus": 210e9,
                    "poissons_ratio": 0.3,
                    "density": 7850.0,
                    "yield_stress": 4e8,
                }
            },
            sections={
                "wide": {"type": "circular_tube", "diameter": 0.057, "thickness": 0.0015},
                "narrow": {"type": "circular_tube", "diameter": 0.039, "thickness": 0.0028},
            },
            nodes={"a": (0, 0, 0), "b": (1.14, 0, 0), "c": (0, 0, 0.515), "d": (1.14, 0, 0.515)},
            members={
                "left": {"nodes": ("a", "c"), "section": "wide", **up},
                "right": {"nodes": ("b", "d"), "section": "narrow", **up},
                "beam": {"nodes": ("c", "d"), "section": "wide", **up},
            },
            hinge_laws={"elastic": ELASTIC},
            hinges={"law": "elastic", "axial": False},
            supports={foot: {"node": foot, "fix": ["x", "y", "z"]} for foot in "ab"},
            masses={"corner": {"node": "d", "mass": 43.0}},
            initial_velocity=[{"translation": (3.65, 0.0, -3.0), "nodes": ["c", "d"]}],
        ),
    )


def test_a_run_that_loses_energy_is_repeated_with_a_finer_accuracy(monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(solve, "FINER", ())
        coarse = crumple.solve(portal(energy_residual_bound=5e-7))
    assert coarse.status is crumple.Status.RESIDUAL_EXCEEDED
    result = crumple.solve(portal(energy_residual_bound=5e-7))
    assert result.status is crumple.Status.COMPLETE
    assert result.provenance.settings["accuracy_used"] == pytest.approx(1e-4)
    assert result.provenance.settings["accuracy"] == 1e-3
    for name, hinge in result.hinges.items():
        stated = coarse.hinges[name].rotation_error + hinge.rotation_error
        assert 0.0 < stated < 1e-3 * MARGIN
        assert hinge.rotation_max == pytest.approx(coarse.hinges[name].rotation_max, abs=stated)


def test_a_bound_that_a_hundredth_of_the_accuracy_does_not_keep_is_still_told():
    result = crumple.solve(portal(energy_residual_bound=1e-9))
    assert result.status is crumple.Status.RESIDUAL_EXCEEDED
    assert result.provenance.settings["accuracy_used"] == pytest.approx(1e-5)


def test_a_sound_run_keeps_its_accuracy():
    result = crumple.solve(portal(accuracy=1e-5))
    assert result.status is crumple.Status.COMPLETE
    assert "accuracy_used" not in result.provenance.settings
