"""Which tubes an obstacle dents, and what that makes of the laws of their folds."""

from dataclasses import replace

import numpy as np
import pytest

from crumple import loads
from crumple.hinge.bending.dented import DentedLaw, WrappedLaw
from crumple.hinge.bending.pressed import PressedLaw
from crumple.hinge.dent import Striker, dent_of, left_in_bending
from crumple.hinge.registry import build_law
from crumple.section import RectangularTube, half_fold_length
from crumple.structure import dented_tubes, hinge_places, law_uses, plastic_hinges
from crumple.structure.hinges.automatic import strikes_on
from crumple.structure.hinges.places import law_of

TEXT = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  round: {type: circular_tube, diameter: 60 mm, thickness: 2 mm}
  square: {type: square_tube, side: 60 mm, thickness: 2 mm}
  hat: {type: closed_hat, width: 60 mm, depth: 60 mm, thickness: 2 mm, flange: 20 mm}
  open: {type: channel, width: 60 mm, depth: 60 mm, thickness: 2 mm}
nodes:
  left: [0 m, 0 m, 0 m]
  right: [800 mm, 0 m, 0 m]
  low: [0 m, 0 m, -400 mm]
  beyond: [0 m, 300 mm, LOWER mm]
  far: [800 mm, 300 mm, LOWER mm]
members:
  beam: {nodes: [left, right], section: SECTION, material: steel}
  post: {nodes: [low, left], section: round, material: steel}
  other: {nodes: [beyond, far], section: round, material: steel}
hinges: auto
supports:
  foot: {node: low, fix: all}
  end: {node: right, fix: all}
  one: {node: beyond, fix: all}
  two: {node: far, fix: all}
obstacles: {pole: {OBSTACLE, mass: 20 kg, velocity: [0 m/s, 0 m/s, -5 m/s], guide: [0, 0, -1]}}
analysis: {duration: 10 ms}
"""
POLE = (
    "type: cylinder, point: [400 mm, 0 m, HEIGHT mm], axis: [0, 1, 0], radius: 50 mm, members: [beam, post]"
)
BALL = "type: sphere, point: [400 mm, 0 m, HEIGHT mm], radius: 50 mm"
HIGH = POLE.replace("HEIGHT", "90")
STRIKER = Striker(50e-3)


def structure_of(section="round", obstacle=HIGH, change=("", "")):
    text = TEXT.replace("SECTION", section).replace("OBSTACLE", obstacle)
    return loads(text.replace(*change).replace("LOWER", "0")).structure


def share_left(section, steel, moment, spans, held):
    dent = dent_of(section, steel, 60e-3, STRIKER)
    return left_in_bending(section, dent, 60e-3, moment, spans, held)


def dented(structure):
    return [tube.member for tube in dented_tubes(structure, "pole")]


@pytest.mark.parametrize(
    ("section", "obstacle", "expected"),
    [
        ("round", HIGH, ["beam"]),
        ("square", HIGH, ["beam"]),
        ("square, roll: 15 deg", HIGH, ["beam"]),
        # on an edge between two walls, and on what is no tube
        ("square, roll: 45 deg", HIGH, []),
        ("open", HIGH, []),
        # on its crown, and on its plate
        ("hat", HIGH, ["beam"]),
        ("hat, roll: 180 deg", HIGH, []),
        ("round", BALL.replace("HEIGHT", "90"), ["beam"]),
        # a ball on a flat wall meets its webs, but for a small one; and not on a hat
        ("square", BALL.replace("HEIGHT", "90"), ["beam"]),
        ("square", BALL.replace("HEIGHT", "70").replace("radius: 50", "radius: 30"), []),
        ("hat", BALL.replace("HEIGHT", "90"), []),
        ("round", HIGH + ", dents: false", []),
        # nearly along the tube
        ("round", HIGH.replace("[0, 1, 0]", "[2, 1, 0]"), []),
        # on the corner, where nothing folds
        ("round", HIGH.replace("point: [400 mm", "point: [0 mm"), []),
        # at the end, which has no fold under the pole
        ("round", HIGH.replace("point: [400 mm", "point: [780 mm"), []),
        # on both beams at once
        ("round", HIGH.replace("members: [beam, post]", "members: [beam, other]"), ["beam", "other"]),
        # at once with a beam that it does not dent
        ("open", HIGH.replace("members: [beam, post]", "members: [beam, other]"), []),
    ],
)
def test_what_is_dented(section, obstacle, expected):
    assert dented(structure_of(section, obstacle)) == expected


def test_what_is_struck_later_does_not_count():
    """The other beam lies 20 mm lower."""
    both = HIGH.replace("members: [beam, post]", "members: [beam, other]")
    assert dented(structure_of("round", both, ("LOWER", "-20"))) == ["beam"]


@pytest.mark.parametrize(("x", "expected"), [(-100, []), (200, ["beam"])])
def test_what_lies_behind_a_struck_corner_is_not_dented(x, expected):
    """A ball at 45 degrees meets the corner of beam and post, or the beam; the other lies below."""
    ball = f"type: sphere, point: [{x} mm, 0 m, 100 mm], radius: 40 mm"
    text = TEXT.replace("SECTION", "round").replace("OBSTACLE", ball)
    text = text.replace("300 mm, LOWER mm", "0 mm, -300 mm")
    text = text.replace(
        "velocity: [0 m/s, 0 m/s, -5 m/s], guide: [0, 0, -1]", "velocity: [5 m/s, 0 m/s, -5 m/s]"
    )
    assert dented(loads(text).structure) == expected


def test_the_edge_of_a_plane_dents_nothing():
    edge = (
        "type: plane, point: [400 mm, 0 m, 40 mm], normal: [0.5, 0, -1], edge: [-1, 0, -0.5], members: [beam]"
    )
    assert dented(structure_of("round", edge)) == []


def test_hinges_given_by_hand_are_left_alone():
    plain = "section: round, material: steel}\n  post"
    by_hand = plain.replace("}", ", hinges: [{name: mine, at: 400 mm, axis: y}]}")
    structure = structure_of("round", HIGH, (plain, by_hand))
    assert dented(structure) == []
    assert not any(isinstance(hinge.law, DentedLaw) for hinge in plastic_hinges(structure))


@pytest.mark.parametrize(("section", "axes"), [("round", {"y", "z"}), ("square", {"y"})])
def test_laws_of_folds_in_dents(section, axes):
    """Those that bend under the force; a round tube is alike about all axes."""
    structure = structure_of(section)
    about = [replace(place, axis=axis) for place in hinge_places(structure) for axis in ("y", "z")]
    laws = {(place.name, place.axis): law_of(structure, place) for place in about}
    dents = {place: law for place, law in laws.items() if isinstance(law, DentedLaw | PressedLaw)}
    assert dents.keys() == {("beam-pole", axis) for axis in axes}
    for law in dents.values():
        # a pole sinks into the fold of a rectangular tube, which it dents less
        assert isinstance(law, PressedLaw) == (section == "square")
        assert 0.2 < (law.law if isinstance(law, PressedLaw) else law).left < 1.0


@pytest.mark.parametrize(("radius", "sinks"), [(50, True), (80, True), (85, False), (120, False)])
def test_a_wide_pole_does_not_sink_into_a_fold(radius, sinks):
    """From 3.375 half lengths of the fold on, 81 mm here, less than a quarter of its force is on the fold."""
    pole = POLE.replace("HEIGHT", str(40 + radius)).replace("radius: 50", f"radius: {radius}")
    laws = {hinge.name: hinge.law for hinge in plastic_hinges(structure_of("square", pole))}
    assert isinstance(laws["beam-pole"], PressedLaw if sinks else DentedLaw)


@pytest.mark.parametrize(("radius", "kind"), [(50, DentedLaw), (200, WrappedLaw)])
def test_a_thick_round_tube_bends_around_a_wide_pole(radius, kind):
    pole = HIGH.replace("radius: 50", f"radius: {radius}").replace("90 mm", f"{radius + 40} mm")
    structure = structure_of("round", pole, ("thickness: 2 mm", "thickness: 5 mm"))
    place = next(place for place in hinge_places(structure) if place.name == "beam-pole")
    law = law_of(structure, place)
    assert type(law) is kind
    fold = 2.0 * half_fold_length(structure.section_of("beam"), "y")
    assert kind is DentedLaw or law.most == pytest.approx(fold / (radius + 30.0) * 1e3)
    # as thin as before it is dented, however wide the pole
    thin = structure_of("round", pole)
    assert type(law_of(thin, place)) is DentedLaw
    assert law_of(thin, place).is_round


def test_a_tube_that_is_free_to_turn_at_its_ends_bends_before_it_is_dented_deeply():
    """The force that bends it is smaller, so that the dent leaves more."""
    clamped = "supports:\n  foot: {node: low, fix: all}\n  end: {node: right, fix: all}"
    turning = (
        "supports:\n  foot: {node: left, fix: [x, y, z, rx, rz]}\n  end: {node: right, fix: [y, z, rx, rz]}"
    )
    alone = ("  post: {nodes: [low, left], section: round, material: steel}\n", "")
    text = TEXT.replace("SECTION", "round").replace("OBSTACLE", HIGH.replace("[beam, post]", "[beam]"))
    text = text.replace("LOWER", "0").replace("  low: [0 m, 0 m, -400 mm]\n", "").replace(*alone)
    left = []
    for supports in (clamped.replace("node: low", "node: left"), turning):
        structure = loads(text.replace(clamped, supports)).structure
        (law,) = [hinge.law for hinge in plastic_hinges(structure) if isinstance(hinge.law, DentedLaw)]
        left.append(law.left)
    assert left[0] < left[1] < 1.0


@pytest.mark.parametrize(
    ("wall", "free", "clamped", "origin"),
    [(2, "library", "clamped_tube", "library"), (7, "circular", "circular", "formula")],
)
def test_folds_of_round_tubes_have_the_laws_of_the_library(wall, free, clamped, origin):
    """Within its range: those beside joints and clamps, which keep the section round, have their own."""
    whole = structure_of("round", HIGH + ", dents: false", ("thickness: 2 mm", f"thickness: {wall} mm"))
    laws = {hinge.name: hinge.law.name for hinge in plastic_hinges(whole) if hinge.member == "beam"}
    assert laws.pop("beam-pole") == free
    assert set(laws.values()) == {clamped, "mitred_corner"}
    uses = law_uses(whole)
    assert {uses[name].origin for name, law in laws.items() if law == clamped} == {origin}
    assert uses["beam-pole"].origin == origin


@pytest.mark.parametrize(("wall", "free", "origin"), [(2, "library", "library"), (7, "kecman", "formula")])
def test_free_folds_of_rectangular_tubes_have_the_library(wall, free, origin):
    """Within its range; those beside joints and clamps keep the formula."""
    thick = ("square_tube, side: 60 mm, thickness: 2 mm", f"square_tube, side: 60 mm, thickness: {wall} mm")
    whole = structure_of("square", HIGH + ", dents: false", thick)
    laws = {hinge.name: hinge.law.name for hinge in plastic_hinges(whole) if hinge.member == "beam"}
    assert laws.pop("beam-pole") == free
    assert set(laws.values()) == {"kecman"}
    assert law_uses(whole)["beam-pole"].origin == origin


def test_a_law_that_the_input_names_stays():
    named = ("hinges: auto", "hinges: {law: {type: constant, moment: 2 kN*m}}")
    structure = structure_of("round", HIGH, named)
    assert dented(structure) == ["beam"]
    assert not any(isinstance(hinge.law, DentedLaw) for hinge in plastic_hinges(structure))


def test_a_hat_is_dented_like_the_tube_of_its_crown_and_webs():
    hat, tube = (dented_tubes(structure_of(section), "pole")[0] for section in ("hat", "square"))
    assert hat.depth == tube.depth == pytest.approx(0.06)
    assert hat.dent.at(0.01) == pytest.approx(tube.dent.at(0.01))
    text = TEXT.replace("SECTION", "hat").replace("OBSTACLE", HIGH).replace("LOWER", "0")
    text = text.replace("flange: 20 mm}", "flange: 20 mm, hat_material: soft}")
    text = text.replace("materials:", "materials:\n  soft: SOFT")
    soft = "youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 175 MPa"
    text = text.replace("SOFT", f"{{{soft}}}")
    (softer,) = dented_tubes(loads(text).structure, "pole")
    assert softer.dent.at(0.01) == pytest.approx(hat.dent.at(0.01) / 2.0)


@pytest.mark.parametrize("roll", ["0 deg", "180 deg"])
def test_a_struck_hat_bends_with_its_crown_compressed(roll):
    """The dent grows until its force bends the hat, whose moment then is that of the compressed crown."""
    below = HIGH.replace("HEIGHT", "90")
    strike = "velocity: [0 m/s, 0 m/s, -5 m/s], guide: [0, 0, -1]"
    # thin walls: the plate buckles later than the crown
    text = TEXT.replace("2 mm, flange", "1.2 mm, flange")
    text = text.replace("SECTION", f"hat, roll: {roll}").replace("LOWER", "0")
    if roll != "0 deg":
        below = below.replace("90 mm", "-90 mm")
        text = text.replace(strike, "velocity: [0 m/s, 0 m/s, 5 m/s], guide: [0, 0, 1]")
    structure = loads(text.replace("OBSTACLE", below)).structure
    (law,) = [hinge.law for hinge in plastic_hinges(structure) if isinstance(hinge.law, DentedLaw)]
    section, strike = structure.section_of("beam"), strikes_on(structure, "beam")["beam-pole"]
    moments = {sense: float(law.law.moment_capacity(0.0, sense)) for sense in (1, -1)}
    tube = RectangularTube(section.width, section.depth, section.thickness)
    dent = dent_of(tube, structure.material_of("beam"), tube.depth, STRIKER)
    left = [left_in_bending(tube, dent, tube.depth, moments[k], strike.spans, strike.held) for k in (1, -1)]
    assert law.left == left[1] != left[0]


def _left(structure):
    """Share of the moment that the beam's dent leaves, its strike, and its moment [N m]."""
    (law,) = [hinge.law for hinge in plastic_hinges(structure) if isinstance(hinge.law, DentedLaw)]
    return law.left, strikes_on(structure, "beam")["beam-pole"], float(law.law.moment_capacity(0.0))


def _largest(law, sense=1):
    return float(law.moment_capacity(np.linspace(0.0, 0.1, 21), sense).max())


@pytest.mark.parametrize("thickness", [2.0, 1.0])
def test_an_end_carries_no_more_than_what_holds_it(thickness):
    """A beam on a weak post bends before it is dented as deep as between clamps, and keeps more moment."""
    thin = f"  thin: {{type: circular_tube, diameter: 40 mm, thickness: {thickness} mm}}\n  round:"
    post = "post: {nodes: [low, left], section: "
    text = TEXT.replace("  round:", thin, 1).replace(post + "round", post + "thin")
    structure = loads(
        text.replace("SECTION", "round").replace("OBSTACLE", HIGH).replace("LOWER", "0")
    ).structure
    left, strike, moment = _left(structure)
    law = build_law("clamped_tube", structure.section_of("post"), structure.material_of("post"))
    section, steel = structure.section_of("beam"), structure.material_of("beam")
    # the beam's first node is on the post, the last one clamped
    share = _largest(law) / moment
    assert share < 0.5
    assert left == pytest.approx(share_left(section, steel, moment, strike.spans, (share, 1.0)))
    assert left > 1.05 * share_left(section, steel, moment, strike.spans, (1.0, 1.0))


LIMB = "  limb: {nodes: [left, out], section: round, material: steel}\n"


@pytest.mark.parametrize(
    ("more", "held"),
    [
        (LIMB, False),
        (LIMB + "  tip: {nodes: [out, up], section: round, material: steel}\n", False),
        (LIMB + "masses: {m: {node: out, mass: 5 kg}}\n", True),
        (LIMB + "  brace: {nodes: [out, low], section: round, material: steel}\n", True),
    ],
)
def test_a_limb_with_a_free_end_holds_no_beam(more, held):
    """It turns with the joint: the beam is dented as on the weak post alone, or as between clamps."""
    thin = "  thin: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}\n  round:"
    post = "post: {nodes: [low, left], section: "
    text = TEXT.replace("  round:", thin, 1).replace(post + "round", post + "thin")
    nodes = "  out: [-300 mm, 0 m, 0 m]\n" + ("  up: [-300 mm, 0 m, 0.2 m]\n" if "up]" in more else "")
    text = text.replace("  low: [", nodes + "  low: [")
    text = text.replace("hinges: auto\n", more + "hinges: auto\n")
    structure = loads(
        text.replace("SECTION", "round").replace("OBSTACLE", HIGH).replace("LOWER", "0")
    ).structure
    left, strike, moment = _left(structure)
    law = build_law("clamped_tube", structure.section_of("post"), structure.material_of("post"))
    section, steel = structure.section_of("beam"), structure.material_of("beam")
    shares = (1.0 if held else _largest(law) / moment, 1.0)
    assert left == pytest.approx(share_left(section, steel, moment, strike.spans, shares))


@pytest.mark.parametrize(("above", "closes"), [(True, True), (False, False)])
def test_a_corner_carries_the_moment_of_its_law_in_its_sense(above, closes):
    """Pressed from outside, the beam closes its corner with the post below; from inside it opens it."""
    below = HIGH.replace("90", "-90")
    text = (
        TEXT.replace("SECTION", "round").replace("LOWER", "0").replace("OBSTACLE", HIGH if above else below)
    )
    if not above:
        text = text.replace("-5 m/s], guide: [0, 0, -1]", "5 m/s], guide: [0, 0, 1]")
    structure = loads(text).structure
    left, strike, moment = _left(structure)
    (corner,) = [hinge.law for hinge in plastic_hinges(structure) if hinge.name == "corner-left"]
    # round tubes resist opening by more than twice as much
    moments = sorted(_largest(corner, sense) for sense in (1, -1))
    assert moments[1] > 2.0 * moments[0]
    share = moments[0 if closes else 1] / moment
    section, steel = structure.section_of("beam"), structure.material_of("beam")
    assert left == pytest.approx(share_left(section, steel, moment, strike.spans, (share, 1.0)))


KINKED = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  hat: {type: closed_hat, width: 60 mm, depth: 60 mm, thickness: 2 mm, flange: 20 mm}
nodes: {left: [0 m, 0 m, 0 m], kink: [400 mm, 0 m, 0 m], right: [RIGHT m, 0 m, DROP m]}
members:
  beam: {nodes: [left, kink], section: hat, material: steel}
  on: {nodes: [kink, right], section: hat, material: steel}
hinges: auto
supports: {foot: {node: left, fix: all}, end: {node: right, fix: [FIX, ry, rz, rx]}}
MORE
obstacles:
  pole: {type: cylinder, point: [240 mm, 0 m, 90 mm], axis: [0, 1, 0], radius: 50 mm, mass: 20 kg,
         velocity: [0 m/s, 0 m/s, -5 m/s], guide: [0, 0, -1], members: [beam]}
analysis: {duration: 10 ms}
"""
WEIGHT = "masses: {m: {node: kink, mass: 5 kg}}"


@pytest.mark.parametrize(
    ("right", "drop", "fix", "more", "goes_on"),
    [
        (0.9, -0.2, "y, z", "", True),
        # what cannot slide holds the kink as a strut, and so do a mass and a post
        (0.9, -0.2, "x, y, z", "", False),
        (0.9, -0.2, "y, z", WEIGHT, False),
        (0.4, -0.5, "x, y", "", False),
        # beyond it the tube is held by nothing
        (0.9, -0.2, "y", "", False),
    ],
)
def test_a_tube_spans_beyond_a_kink_that_nothing_holds(right, drop, fix, more, goes_on):
    """Held at the kink, it would be dented far deeper before it bends."""
    text = KINKED
    for key, value in {"RIGHT": right, "DROP": drop, "FIX": fix, "MORE": more}.items():
        text = text.replace(key, str(value))
    structure = loads(text).structure
    left, strike, moment = _left(structure)
    section, steel = structure.section_of("beam"), structure.material_of("beam")
    tube = RectangularTube(section.width, section.depth, section.thickness)
    near, beside = strike.spans
    further = (near, beside + 0.5) if goes_on else strike.spans
    # the mitre, where nothing keeps it in shape, carries less than the hat
    mitre = [hinge.law for hinge in plastic_hinges(structure) if hinge.name == "corner-kink"]
    held = (1.0, min([_largest(law) / moment for law in mitre], default=1.0))
    deep = share_left(tube, steel, moment, strike.spans, held)
    assert (left > 1.2 * deep) == goes_on
    if goes_on:
        assert left == pytest.approx(share_left(tube, steel, moment, further, (1.0, 1.0)))
    else:
        assert left == pytest.approx(deep)
        assert bool(mitre) == (not more)


@pytest.mark.parametrize(("folds", "found"), [(0.8, False), (1.3, True), (3.0, True)])
def test_a_tube_is_dented_down_to_half_a_fold_from_the_fold_at_its_end(folds, found):
    # the fold at the end moves towards it where a pole presses beside it
    beside = structure_of("square", HIGH.replace("point: [400 mm", "point: [760 mm"))
    end = next(place for place in hinge_places(beside) if place.name == "beam-right")
    half = half_fold_length(RectangularTube(0.06, 0.06, 0.002), "y")
    at = 1e3 * (end.station - folds * half)
    near = HIGH.replace("point: [400 mm", f"point: [{at:.6f} mm")
    assert ("beam" in dented(structure_of("square", near))) is found
