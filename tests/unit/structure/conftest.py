"""A sound cantilever as plain keys, to be changed by the tests."""

import copy

import pytest

TUBE = {
    "materials": {
        "steel": {
            "youngs_modulus": "210 GPa",
            "poissons_ratio": 0.3,
            "density": "7850 kg/m^3",
            "yield_stress": "488 MPa",
        }
    },
    "sections": {
        "tube": {"type": "rectangular_tube", "width": "50 mm", "depth": "25 mm", "thickness": "2.65 mm"},
        "pipe": {"type": "circular_tube", "diameter": "40 mm", "thickness": "2 mm"},
    },
    "nodes": {"root": (0, 0, 0), "tip": (1, 0, 0)},
    "members": {
        "arm": {
            "nodes": ("root", "tip"),
            "section": "tube",
            "material": "steel",
            "hinges": [{"name": "fold", "at": "root"}],
        }
    },
    "supports": {"clamp": {"node": "root", "fix": "all"}},
}


@pytest.fixture
def keys():
    return copy.deepcopy(TUBE)
