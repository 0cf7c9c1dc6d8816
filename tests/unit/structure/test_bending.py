"""Hinges turn about the section axis across the plane in which the structure bends."""

import numpy as np
import pytest

from crumple.structure import Structure, placed_hinges

WAYS = {
    "rotation": {"initial_velocity": [{"rotation": 3, "axis": (0, -1, 0)}]},
    "translation": {"initial_velocity": [{"translation": (0, 0, 2)}]},
    "impulse": {"impulses": [{"node": "tip", "impulse": (0, 0, 5)}]},
    "angular impulse": {"impulses": [{"node": "tip", "angular_impulse": (0, 5, 0)}]},
    "force": {"loads": [{"node": "tip", "force": {"z": 5}}]},
    "moment": {"loads": [{"node": "tip", "moment": {"y": 5}}]},
    "gravity": {"gravity": (0, 0, -9.81)},
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    ("roll", "axis"), [("0 deg", "y"), ("90 deg", "z"), ("180 deg", "y"), ("-90 deg", "z")]
)
def test_turning_the_section_does_not_turn_the_bending(keys, way, roll, axis):
    keys["members"]["arm"]["roll"] = roll
    (hinge,) = placed_hinges(Structure(**keys, **WAYS[way]))
    assert hinge.axis == axis
    assert abs(hinge.direction[1]) == pytest.approx(1.0)


def test_a_plane_frame_bends_in_its_plane(keys):
    keys["nodes"]["top"] = (1, 1, 0)
    keys["members"]["post"] = {"nodes": ("tip", "top"), "section": "tube", "material": "steel", "bars": 3}
    for hinge in placed_hinges(Structure(**keys, gravity=(0, 0, -9.81))):
        np.testing.assert_allclose(np.abs(hinge.direction), [0, 0, 1], atol=1e-12)


def test_without_a_reason_hinges_turn_about_y(keys):
    assert placed_hinges(Structure(**keys))[0].axis == "y"


def test_a_changed_copy_looks_again(keys):
    structure = Structure(**keys)
    assert structure.bending_normal is None
    sideways = structure.model_copy(update={"gravity": (0, 9.81, 0)})
    np.testing.assert_allclose(np.abs(sideways.bending_normal), [0, 0, 1])
