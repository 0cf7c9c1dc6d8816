"""Error of the coupling of a corner's hinge: zero of a made-up fold on the ellipsoid, and its sub-model."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple.characterisation import Bending, LawCurve, OutOfPlane, characterise
from crumple.characterisation.coupling.oblique_corner import (
    COUPLED,
    ObliqueCorner,
    coupling_errors,
    on_ellipsoid,
    on_shifted_ellipsoid,
)
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.sub_model import StrongCornerError
from crumple.cli.main import app
from crumple.errors import Problem
from crumple.hinge.corner.shift import corner_shift
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
ROTATION = np.linspace(0.0, math.radians(30.0), 61)


def made_up(moment):
    moment = np.broadcast_to(moment, ROTATION.shape)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(ROTATION))])
    return LawCurve(ROTATION, moment, energy)


def test_constant_moments_combine_as_on_an_ellipse():
    found = on_ellipsoid(math.pi / 4.0, made_up(1000.0), made_up(500.0), ROTATION)
    np.testing.assert_allclose(found, math.sqrt(2.0 / (1e-6 + 4e-6)))


def test_of_equal_folds_every_direction_is_the_same():
    falling = 1000.0 / (1.0 + ROTATION)
    for tilt in (0.0, 0.3, math.pi / 4.0, math.pi / 2.0):
        np.testing.assert_allclose(on_ellipsoid(tilt, *2 * (made_up(falling),), ROTATION), falling, rtol=1e-4)


def test_a_fold_on_the_ellipsoid_has_no_error_and_strong_senses_are_left_out():
    model = OutOfPlane(TUBE, STEEL)

    def solved(one):
        if isinstance(one, Bending) and one.sense < 0:
            raise StrongCornerError(Problem("strong", "", ""))
        if not isinstance(one, ObliqueCorner):
            return made_up(500.0)
        laws = made_up(800.0), (made_up(500.0), made_up(500.0))
        return made_up(on_shifted_ellipsoid(one.tilt, *laws, corner_shift(TUBE, one.angle), ROTATION)[0])

    assert coupling_errors(model, made_up(800.0), solved) == {
        COUPLED[0]: "coupling shifted ellipsoid work +0% to 10 deg, +0% to 30 deg"
    }


def test_a_shift_keeps_the_moments_about_the_axes_and_helps_to_open():
    laws = made_up(800.0), (made_up(500.0), made_up(900.0))

    def moment(tilt, share):
        return on_shifted_ellipsoid(tilt, *laws, lambda _: np.float64(share), ROTATION)[0]

    for share in (0.0, 0.3, 0.6):
        for tilt, alone in ((0.0, 800.0), (math.pi / 2.0, 500.0), (-math.pi / 2.0, 900.0)):
            np.testing.assert_allclose(moment(tilt, share), alone)
    for tilt in (0.3, math.pi / 4.0):
        np.testing.assert_allclose(moment(tilt, 0.0), on_ellipsoid(tilt, laws[0], laws[1][0], ROTATION))
        assert np.all(moment(tilt, 0.5) < moment(tilt, 0.0))
        assert np.all(moment(-tilt, 0.5) > moment(-tilt, 0.0))


@pytest.mark.parametrize("axis", ["y", "z"])
@pytest.mark.parametrize("tilt", [math.pi / 4.0, -math.pi / 4.0])
def test_the_moment_lies_between_bisector_and_normal_and_closes_or_opens(axis, tilt):
    structure = ObliqueCorner(TUBE, STEEL, axis, math.radians(60.0), tilt=tilt).analysis().structure
    motion = structure.supports["turned"].motion
    driven = next(one for one in "xyz" if getattr(motion, f"r{one}") is not None)
    moment = np.eye(3)["xyz".index(driven)]
    pieces = (("held", "middle"), ("middle", "turned"))
    before, after = (np.subtract(structure.nodes[b], structure.nodes[a]) for a, b in pieces)
    before, after = before / np.linalg.norm(before), after / np.linalg.norm(after)
    normal = np.cross(before, after) / math.sin(math.radians(60.0))
    # a rotation about the normal increases the angle between the pieces
    assert moment @ normal == pytest.approx(math.sin(tilt))
    assert moment @ (before + after) == pytest.approx(0.0, abs=1e-12)
    for piece, along in (("first", before), ("second", after)):
        assert np.asarray(structure.members[piece].up) @ along == pytest.approx(0.0, abs=1e-12)


def test_the_flexibility_is_that_of_both_planes():
    out, both, within = (
        ObliqueCorner(TUBE, STEEL, tilt=tilt) for tilt in (0.0, math.pi / 4.0, math.pi / 2.0)
    )
    assert both._flexibility == pytest.approx(0.5 * (out._flexibility + within._flexibility))
    assert within._flexibility == pytest.approx(
        within.length / (STEEL.youngs_modulus * TUBE.second_moment("y"))
    )


@pytest.mark.slow
def test_a_corner_states_the_errors_of_its_coupling():
    model = OutOfPlane(TUBE, STEEL, largest=math.radians(11.0), resolution=Resolution(3.0, 4.0))
    origin = dict(characterise(model, interaction=True).law.origin)
    for key in COUPLED:
        work = float(origin[key].split("work ")[1].split("%")[0])
        assert abs(work) < 20.0


def test_the_direction_is_checked_and_interaction_is_for_the_bisector(tmp_path):
    words = ["characterise", "square_tube 50x50x2", "--material", "S235", "--store", str(tmp_path)]
    words += ["--load", "out-of-plane", "--angle", "90 deg"]
    run = CliRunner().invoke(app, [*words, "--about", "edge"])
    assert run.exit_code != 0
    assert "direction is unknown" in str(run.exception) + run.output
    run = CliRunner().invoke(app, [*words, "--about", "tangent", "--interaction"])
    assert run.exit_code != 0
    assert "corners about their bisector" in str(run.exception) + run.output
