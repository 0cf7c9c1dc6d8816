"""The verdict follows what engineers decide on: displacements, rotations of joints, forces, energies."""

from types import SimpleNamespace

import pytest

from crumple.comparison.cautions.verdict import verdict
from crumple.comparison.measure.decisive import Figure


def comparison(hinges=(), **figures):
    return SimpleNamespace(
        candidate=SimpleNamespace(name="multibody"),
        reference=SimpleNamespace(name="shell"),
        hinges=hinges,
        opened={"multibody": (SimpleNamespace(name="root"),)},
        figures={kind.replace("_", " "): found for kind, found in figures.items()},
    )


def figure(name, shell, model, allowed=0.1):
    return Figure(name, shell, model, abs(model - shell) / shell, allowed)


def judged(displacement=0.52, turned=0.5, zones=(40.0, 62.0), missed="", doubtful=False, hinges=()):
    shown = comparison(
        hinges,
        displacement=[figure("tip", 0.5, displacement)],
        rotations=[figure("knee", 0.5, turned, 0.15)],
        energy_by_zone=[figure("foot", 40.0, zones[0], 0.15), figure("knee", 60.0, zones[1], 0.15)],
    )
    return verdict(shown, missed, doubtful)


def test_figures_within_their_targets_agree_and_the_worst_of_each_kind_is_told():
    level, headline = judged()
    assert level == "good"
    assert headline == (
        "Both results agree: largest displacements within 4.0 %, rotations of joints within 0.0 %, "
        "energies of zones (of the whole) within 2.0 %."
    )
    assert judged(doubtful=True)[0] == "caution"


@pytest.mark.parametrize(
    ("displacement", "level", "start"),
    [
        (0.59, "caution", "The multibody result agrees only roughly with the shell run: "),
        (0.75, "bad", "The multibody result disagrees with the shell run: "),
    ],
)
def test_a_wrong_displacement_is_named_with_both_values(displacement, level, start):
    found = judged(displacement)
    assert found[0] == level
    assert found[1].startswith(start)
    assert f"largest displacement of tip {1e3 * displacement:.0f} mm multibody, 500 mm shell" in found[1]


def test_the_worst_figures_come_first_and_the_others_are_counted():
    _, headline = judged(0.75, 1.0, (100.0, 10.0))
    assert headline.index("rotation of knee 57.3° multibody, 28.6° shell") < headline.index("largest displ")
    assert headline.endswith("; 1 further figures.")


def test_energies_of_zones_count_as_parts_of_the_whole():
    # 30 % off in a zone that absorbs 40 %: 12 % of the whole
    assert judged(zones=(52.0, 60.0))[0] == "good"
    assert judged(zones=(56.0, 60.0))[0] == "caution"


def test_folds_of_one_side_alone_are_wrong_only_if_a_figure_is():
    level, headline = judged(missed="tube at 615 mm")
    assert level == "caution"
    assert "with reservations (the shell run folds where there is no hinge (tube at 615 mm)): " in headline
    level, headline = judged(0.75, missed="tube at 615 mm")
    assert level == "bad"
    assert headline.startswith(
        "The multibody result is wrong: the shell run folds where there is no hinge (tube at 615 mm); largest"
    )


def test_two_sides_of_a_corner_that_share_a_rotation_otherwise_do_not_disagree():
    hinge = SimpleNamespace(
        name="root",
        first=SimpleNamespace(plastic_energy=50.0),
        second=SimpleNamespace(plastic_energy=1.0),
        fold_station=None,
    )
    level, headline = judged(hinges=(hinge,))
    assert level == "caution"
    assert "with reservations (it folds where the shell run does not (root)): " in headline
