"""Sub-model of a welded T-joint: its law, its place, and what is refused."""

import math

import pytest

from crumple.characterisation import LawStore, TJoint, characterise
from crumple.characterisation.resolution import Resolution
from crumple.errors import InputError
from crumple.material import Material
from crumple.section.shapes.rectangular_tube import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
BRANCH = RectangularTube(width=0.036, depth=0.036, thickness=0.003)
CHORD = RectangularTube(width=0.060, depth=0.060, thickness=0.003)
COARSE = {"largest": math.radians(6.0), "resolution": Resolution(2.0, 7.0)}


def test_law_of_a_joint_is_far_below_its_branch_and_is_kept(tmp_path):
    model, store = TJoint(BRANCH, CHORD, STEEL, **COARSE), LawStore(tmp_path)
    done = characterise(model)
    store.keep(model, done.law)
    assert store.law(model) == done.law
    # the yield-line bound of the face is 591 N m; coarse elements are stiff
    assert 0.8 * 591.0 < done.curve.moment_at(math.radians(2.0)) < 1.1 * 591.0
    assert done.curve.moment.max() < 0.5 * model.strength
    assert done.law.elastic_stiffness is not None
    assert done.law.curve.positive == done.law.curve.negative


def test_both_planes_and_other_walls_are_other_places():
    thin = RectangularTube(width=0.060, depth=0.060, thickness=0.002)
    models = [
        TJoint(BRANCH, CHORD, STEEL),
        TJoint(BRANCH, CHORD, STEEL, "across"),
        TJoint(BRANCH, thin, STEEL),
    ]
    assert len({model.place for model in models}) == 3
    assert models[0].place == TJoint(BRANCH, CHORD, STEEL, **COARSE).place


def test_joint_as_strong_as_its_branch_is_refused():
    stiff = RectangularTube(width=0.060, depth=0.060, thickness=0.010)
    with pytest.raises(InputError, match="as strong as its branch"):
        characterise(TJoint(BRANCH, stiff, STEEL, **COARSE))


def test_branch_wider_than_the_face_is_refused():
    with pytest.raises(InputError, match="wider than the face"):
        TJoint(CHORD, BRANCH, STEEL)
