"""What the page says first: three sentences from the result's numbers, and cautions without repetition."""

from dataclasses import replace

import pytest
from tests.support.result.synthetic_tube import tube_result

from crumple.analysis import loads, solve
from crumple.report.wording.along import crushing_law_table, crushing_laws
from crumple.report.wording.answer import grouped, three_sentences
from crumple.report.wording.key_figures import between_hinges, key_figures
from crumple.report.wording.wording import verdict
from crumple.result.crush import CrushSummary


def sentences(result):
    return three_sentences(result, verdict(result, 1e-3, 1e-3))


def test_three_sentences_of_a_hinge_that_bends():
    said = sentences(tube_result())
    assert len(said) == 3
    assert said[0] == "The structure absorbed 783.7 J."
    assert said[1].startswith("root turned farthest, by 29.94°, at up to 1.5 kN m, at rest after 69.67 ms")
    assert "within its bound" in said[2]


def test_total_and_share_of_the_energy_are_of_one_kind():
    """The tube absorbs 783.7 J; what its hinges did not take is told apart."""
    hinge = tube_result().hinges["root"]
    for energies, said in (
        ((583.7, 200.0), "The structure absorbed 783.7 J in 2 hinges, 74 % of it in a."),
        (
            (300.0, 200.0),
            "The structure absorbed 783.7 J: 500 J in 2 hinges (60 % of it in a) "
            "and 283.7 J along members that yield between hinges.",
        ),
        ((600.0, 200.0), "The structure absorbed 800 J in 2 hinges (75 % of it in a)."),
    ):
        hinges = {name: replace(hinge, energy=energy) for name, energy in zip("ab", energies, strict=True)}
        assert sentences(tube_result(hinges=hinges))[0] == said


def test_energy_beside_the_only_hinge_is_told():
    """A tube of 783.7 J of which its hinge has 67.9 J: the key figure is of the hinge."""
    hinge = replace(tube_result().hinges["root"], energy=67.9)
    result = tube_result(hinges={"root": hinge})
    assert sentences(result)[0] == (
        "The structure absorbed 783.7 J: 67.9 J in hinge root and 715.8 J along members that yield between "
        "hinges."
    )
    figures = {name: (value, note) for name, value, note in key_figures(result)}
    assert figures["Energy absorbed in the hinge"] == ("67.9 J", "715.8 J more along members")
    whole = {name: (value, note) for name, value, note in key_figures(tube_result())}
    assert whole["Energy absorbed in the hinge"] == ("783.7 J", "")


def test_what_members_that_vibrate_lose_is_not_told():
    """Elastic runs: a ten-thousandth of a joule beside a hundred that members stored is no answer."""
    result = tube_result()
    energies = {"energy.dissipated": 1.1e-3, "energy.elastic": 2.0}
    channels = {
        name: replace(channel, values=0.0 * channel.values + energies.get(name, 0.0))
        for name, channel in result.channels.items()
    }
    hinge = replace(result.hinges["root"], energy=1e-3)
    still = replace(result, hinges={"root": hinge}, channels=channels)
    assert between_hinges(still) == 0.0
    some = replace(still, hinges={"root": replace(hinge, energy=0.0011 - 0.003)})
    assert between_hinges(some) == pytest.approx(0.003)


def test_rounding_is_no_energy():
    """A structure that flies past a wall dissipated 3e-33 J, beside 6 kJ of kinetic energy or none."""
    result = tube_result()
    hinge = replace(result.hinges["root"], energy=0.0)
    for kinetic, dissipated in ((6.4e3, 3.1e-33), (0.0, 3.1e-33), (6.4e3, 1e-7)):
        energies = {"energy.dissipated": dissipated, "energy.kinetic": kinetic}
        channels = {
            name: replace(channel, values=0.0 * channel.values + energies.get(name, 0.0))
            for name, channel in result.channels.items()
        }
        still = replace(result, hinges={"root": hinge}, channels=channels)
        assert between_hinges(still) == 0.0
        assert "absorbed" not in sentences(still)[0]


def test_the_error_is_that_of_the_largest_rotation():
    far = replace(tube_result().hinges["root"], rotation_max=0.5, rotation_error=0.001)
    near = replace(far, rotation_max=0.1, rotation_error=0.01)
    said = " ".join(sentences(tube_result(hinges={"near": near, "far": far})))
    assert "Estimated error of the largest rotation: 0.057° (0.2 %)." in said


def test_a_crush_zone_is_told_by_its_forces():
    zone = CrushSummary(0.15, 0.15, 60e3, 20e3, 3e3, 0.1, 0.4, bottomed_out=True)
    hinge = replace(tube_result().hinges["root"], crush=zone)
    said = sentences(tube_result(hinges={"front": hinge}))
    assert said[1] == (
        "front was crushed by 150 mm, until its folds were closed, "
        "at a mean force of 20 kN and a peak of 60 kN."
    )


def test_a_crush_zone_that_took_little_comes_after_the_folds():
    zone = CrushSummary(8e-4, 8e-4, 80e3, 25e3, 20.0, 0.1, 0.001, bottomed_out=False)
    folded = replace(tube_result().hinges["root"], energy=700.0)
    result = tube_result(hinges={"root": folded, "front": replace(folded, energy=30.0, crush=zone)})
    assert sentences(result)[1].startswith("root turned farthest")
    names = [name for name, *_ in key_figures(result)]
    assert names.index("Largest rotation") == 0
    assert "Crush length" in names


def test_without_hinges_and_energies_only_the_trust_is_stated():
    said = sentences(tube_result(hinges={}, channels={}, output_names=(), states=None))
    assert len(said) == 1


def test_alike_cautions_are_one_line():
    warnings = [
        "Hinge a turned 40° (0.7 rad), beyond the range of validity of its law, 30°.",
        "Hinge ab turned 45° (0.8 rad), beyond the range of validity of its law, 30°.",
        "The bars are rigid.",
        "Hinge c-d turned 5° (0.1 rad), beyond the range of validity of its law, 3°.",
    ]
    assert grouped(warnings, ["a", "ab", "c-d"]) == [f"{warnings[0]} The same of ab, c-d.", warnings[2]]


def test_cautions_that_differ_stay():
    warnings = ["Hinge a turned 4°.", "Hinge a turned 5°.", "Step 1 failed.", "Step 2 failed."]
    assert grouped(warnings, ["a"]) == warnings
    assert grouped(warnings, []) == warnings


RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections: {rail: {type: SECTION}}
nodes: {front: [0 m, 0 m, 0 m], rear: [0.4 m, 0 m, 0 m]}
members: {rail: {nodes: [front, rear], section: rail, material: steel}}
hinges: HINGES
supports: {foot: {node: front, fix: all}, guide: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {car: {node: rear, mass: 100 kg}}
initial_velocity: [{nodes: [rear], translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 5 ms, multibody: {mechanism_check: off}}
"""
SQUARE, ROUND = "square_tube, side: 40 mm, thickness: 2 mm", "circular_tube, diameter: 40 mm, thickness: 2 mm"


@pytest.mark.parametrize(
    ("section", "hinges", "words"),
    [
        (SQUARE, "auto", ("superfolding", "band not known", "Wierzbicki", "compared with shells")),
        (ROUND, "auto", ("concertina", "Alexander", "compared with shells")),
        (SQUARE, "{axial: {peak: 60 kN, mean: 30 kN, stroke: 0.2 m}}", ("forces given in the input",)),
        (SQUARE, "{axial: {peak: 60 kN, mean: 60 kN, stroke: 0.2 m}}", ("forces given in the input",)),
        (SQUARE, "{axial: true}", ("yield of the walls",)),
    ],
)
def test_a_crush_zone_says_what_its_force_is(section, hinges, words):
    result = solve(loads(RAIL.replace("SECTION", section).replace("HINGES", hinges)))
    ((said, names),) = crushing_laws(result)
    assert names == [name for name, hinge in result.hinges.items() if hinge.crush is not None]
    for word in words:
        assert word in said
    assert crushing_law_table(result).rows == [(", ".join(names), said)]
