"""Sub-models of members and corners: geometry, mirror images, kept laws."""

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.analysis import solve
from crumple.characterisation import Bending, LawCurve, LawStore, OutOfPlane, characterise
from crumple.characterisation.law import law_of
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import energy_error
from crumple.characterisation.sub_model import StrongCornerError, is_mirrored
from crumple.errors import InputError
from crumple.function.transition import havsin
from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.library import by_place
from crumple.material import Material
from crumple.section import half_fold_length
from crumple.section.shapes.hat import Hat
from crumple.section.shapes.rectangular_tube import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)


def test_member_is_almost_straight_and_its_gauge_two_half_folds():
    model = Bending(TUBE, STEEL)
    nodes = {name: np.array(at) for name, at in model.analysis().structure.nodes.items()}
    first, second = nodes["middle"] - nodes["held"], nodes["turned"] - nodes["middle"]
    angle = math.acos(first @ second / np.linalg.norm(first) / np.linalg.norm(second))
    assert math.degrees(angle) == pytest.approx(0.2, rel=1e-6)
    assert model.gauge == pytest.approx(2.0 * half_fold_length(TUBE))
    assert np.linalg.norm(first) == pytest.approx(model.gauge / 2.0 + 1.75 * 0.050)


@pytest.mark.parametrize("axis", ["y", "z"])
@pytest.mark.parametrize("sense", [1, -1])
def test_positive_rotation_about_the_axis_closes_a_corner(axis, sense):
    model = Bending(TUBE, STEEL, axis, sense, math.radians(60.0))
    structure = model.analysis().structure
    arm = np.subtract(structure.nodes["turned"], structure.nodes["middle"])
    turned = getattr(structure.supports["turned"].motion, f"r{axis}")
    assert turned is not None
    spin = {"y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}[axis]
    # a turn in the sense moves the far end so that the angle to the first piece grows, or shrinks
    moved = arm + 1e-3 * sense * np.cross(spin, arm)
    before, after = (math.acos(v[0] / np.linalg.norm(v)) for v in (arm, moved))
    assert math.degrees(before) == pytest.approx(60.0)
    assert (after > before) == (sense > 0)


def test_turn_is_half_a_sine_wave_up_to_its_middle_and_then_keeps_its_speed():
    model = Bending(TUBE, STEEL, sense=-1)
    half_wave = model.resolution.duration(TUBE, STEEL, "y", model.length, model.turn)
    motion = model.analysis().structure.supports["turned"].motion.ry
    assert motion is not None
    early, late = np.linspace(0.0, 0.5, 37) * half_wave, np.linspace(0.5, 0.8, 20) * half_wave
    sine = havsin(early, 0.0, 0.0, half_wave, -model.turn)
    assert motion(early) == pytest.approx(sine, abs=1e-5 * model.turn)
    assert motion.derivative(late) == pytest.approx(np.full(20, -0.5 * math.pi * model.turn / half_wave))
    assert motion(model.duration) == pytest.approx(-model.turn)


def test_run_ends_where_its_law_does_which_is_that_of_the_whole_turn():
    model = Bending(TUBE, STEEL, resolution=Resolution(2.0, 7.0))
    done, whole = characterise(model), solve(model.analysis(), "shell")
    turned = model.histories(done.result)[0]
    assert turned[-1] >= model.largest > turned[-5]
    assert done.result.time[-1] < 0.99 * whole.time[-1]
    assert np.array_equal(done.curve.rotation, model.curve(whole).rotation)
    assert np.array_equal(done.curve.moment, model.curve(whole).moment)


def test_a_tube_is_its_mirror_image_and_a_hat_only_about_z():
    hat = Hat(width=0.060, depth=0.050, thickness=0.0015, flange=0.020)
    assert is_mirrored(TUBE, "y")
    assert is_mirrored(TUBE, "z")
    assert is_mirrored(hat, "z")
    assert not is_mirrored(hat, "y")


def test_error_is_that_of_the_extrapolated_energy():
    rotation = np.linspace(0.0, 0.5, 60)

    def curve(size: float) -> LawCurve:
        energy = 100.0 * rotation * (1.0 + 0.04 * size**1.5)
        return LawCurve(rotation, np.full(60, 100.0), energy)

    assert energy_error(curve(1.0), curve(1.0 / 1.25), curve(1.0 / 1.5625)) == pytest.approx(0.04, rel=1e-3)


def test_a_kept_law_is_found_again_and_another_model_is_not(tmp_path):
    store, model = LawStore(tmp_path / "laws"), Bending(TUBE, STEEL, sense=-1)
    assert store.law(model) is None
    ours = LawCurve(np.array([0.0, 0.2]), np.array([900.0, 500.0]), np.array([0.0, 140.0]))
    other = LawCurve(np.array([0.0, 0.3]), np.array([800.0, 400.0]), np.array([0.0, 180.0]))
    law = law_of(model, ours, other, {"mesh": "none"}, 0.02)
    path = store.keep(model, law)
    assert store.law(model) == law
    assert read_law(write_law(law), path.name) == law
    assert law.points(-1) == ((0.0, 0.2), (900.0, 500.0))
    assert law.points(1) == ((0.0, 0.3), (800.0, 400.0))
    assert law.validity.rotation_max == pytest.approx(0.2)
    assert store.law(Bending(TUBE, STEEL, sense=-1, angle=1.0)) is None
    assert [file.name for file in (tmp_path / "laws").iterdir()] == [path.name]


def test_a_cancelled_sub_model_gives_no_law():
    with pytest.raises(KeyboardInterrupt):
        characterise(Bending(TUBE, STEEL, resolution=Resolution(2.0, 7.0)), cancel=lambda: True)


@pytest.mark.parametrize(
    ("angle", "message"), [(None, "folded elsewhere"), (1.5, "as strong as its members")]
)
def test_a_sub_model_that_folds_outside_its_gauge_is_refused_with_the_reason(angle, message):
    model = Bending(TUBE, STEEL, angle=angle)
    turned = np.linspace(0.0, model.turn, 50)
    moment = np.linspace(0.0, 500.0, 50)
    # nearly all of the rotation is in the pieces beside the gauge
    history = {
        "first": 0.5 * turned,
        "second": 0.499 * turned,
        "node.turned.rotation.y": turned,
        "support.held.moment.y": moment,
        "support.turned.moment.y": -moment,
    }
    with pytest.raises(InputError, match=message):
        model.curve(history)


@pytest.mark.parametrize(("late", "found"), [(0.9, True), (0.0, False)])
def test_walls_that_yield_everywhere_before_they_fold_have_a_law_that_ends_earlier(late, found):
    """A sixth of the rotation is between the planes up to half of it, then nearly all, or nothing."""
    model = Bending(TUBE, STEEL)
    turned = np.linspace(0.0, model.turn, 200)
    moment = 900.0 * np.minimum(1.0, turned / 0.02)
    half = 0.5 * model.turn
    between = np.minimum(turned, half) / 6.0 + late * 0.5 * np.maximum(turned - half, 0.0)
    history = {
        "first": 0.5 * (turned - between),
        "second": 0.5 * (turned - between),
        "node.turned.rotation.y": turned,
        "support.held.moment.y": moment,
        "support.turned.moment.y": -moment,
    }
    if not found:
        with pytest.raises(InputError, match="folded elsewhere"):
            model.curve(history)
        return
    curve = model.curve(history)
    assert 0.25 * model.largest < curve.rotation[-1] < 0.5 * model.largest
    assert curve.moment[-1] == pytest.approx(900.0, rel=1e-3)


@pytest.mark.parametrize("axis", ["y", "z"])
@pytest.mark.parametrize("degrees", [30.0, 90.0, 100.0])
@pytest.mark.parametrize("kind", [Bending, OutOfPlane])
def test_shells_join_the_pieces_of_a_corner_by_a_mitre(kind, degrees, axis):
    deep = RectangularTube(width=0.050, depth=0.060, thickness=0.002)
    coarse = Resolution(elements=2.0)
    analysis = kind(deep, STEEL, axis=axis, angle=math.radians(degrees), resolution=coarse).analysis()
    said = " ".join(solve(analysis, "shell", 1, cancel=lambda: True).assumptions)
    assert "Walls are shells" in said
    assert "move as one rigid body" not in said


@pytest.mark.parametrize("sense", [1, -1])
def test_corner_that_is_too_strong_in_one_sense_has_the_law_of_its_member_there(monkeypatch, sense):
    coarse = {"largest": math.radians(8.0), "resolution": Resolution(2.0, 7.0)}
    model = Bending(TUBE, STEEL, sense=sense, angle=math.radians(20.0), **coarse)
    measured = Bending.curve

    def curve(self, result):
        if self.angle is not None and self.sense < 0:
            raise StrongCornerError("as strong as its members")
        return measured(self, result)

    monkeypatch.setattr(Bending, "curve", curve)
    done = characterise(model)
    member = characterise(Bending(TUBE, STEEL, sense=-1, **coarse)).curve
    assert done.law.curve.negative == (tuple(member.rotation.tolist()), tuple(member.moment.tolist()))
    assert done.law.curve.positive[1][0] < 0.99 * member.moment[0]
    assert "straight member" in dict(done.law.origin)["opened"]
    assert "closed" not in dict(done.law.origin)
    assert "mass_scaling" in dict(done.law.origin)
    assert done.curve.moment[0] == done.law.points(sense)[1][0]
    assert done.law.title == model.title


def test_laws_of_corners_of_an_earlier_method_are_computed_again_and_not_preferred(tmp_path):
    model = Bending(TUBE, STEEL, angle=1.0)
    curve = LawCurve(np.array([0.0, 0.2]), np.array([900.0, 500.0]), np.array([0.0, 140.0]))
    law = law_of(model, curve, curve, {}, None)
    path = LawStore(tmp_path).path(model)
    assert "-5-" in path.name
    assert "-3-" in LawStore(tmp_path).path(Bending(TUBE, STEEL)).name
    # the earlier law has a known error, which decides among laws of one method
    origin = tuple(one for one in law.origin if one[0] != "revision")
    earlier = replace(law, origin=origin, validity=replace(law.validity, uncertainty=0.01))
    texts = [write_law(earlier), write_law(law)]
    assert by_place(texts) == {model.place: texts[1]}
