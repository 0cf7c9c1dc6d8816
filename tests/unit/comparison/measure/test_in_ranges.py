"""Values of shells beside the range from the bands of the hinge laws."""

from dataclasses import replace

from tests.support.result.folded_tube import analysis, folded_result

from crumple.analysis import solve
from crumple.comparison import compare, with_frames
from crumple.comparison.measure.in_ranges import values_in_ranges
from crumple.report.wording.law_range import shell_range_sentence, shell_range_table
from crumple.result.nearby import LawRange


def test_values_of_shells_stand_beside_the_range_from_the_laws():
    """A rotation below and an energy inside; a figure of another definition has no value."""
    case = analysis()
    multibody, reference = solve(with_frames(case, 21)), folded_result(largest=0.545)
    energy = multibody.hinges["root"].energy
    ranges = {
        "hinge.root.rotation_max": (0.6, 0.9),
        "hinge.root.energy": (0.5 * energy, 1.5 * energy),
        "node.tip.displacement.z": (-0.1, 0.1),
    }
    ranged = replace(multibody, law_range=LawRange(ranges, {"root": 0.2}, ("other",)))
    found = compare(ranged, reference, case.structure)
    (hinge,) = found.hinges
    assert found.in_ranges["hinge.root.rotation_max"] == hinge.second.rotation_max
    assert found.in_ranges["hinge.root.energy"] == hinge.second.plastic_energy
    rows = {row[0]: row for row in shell_range_table(found).rows}
    assert rows["hinge.root.rotation_max"][-1].startswith("below by ")
    assert rows["hinge.root.energy"][-1] == "yes"
    sentence = shell_range_sentence(found)
    assert "inside for 1 of 2 quantities" in sentence
    assert "For 1 more" in sentence
    assert "1 of 1 hinges have no known band" in sentence
    assert "not a bound" in sentence
    summed = replace(hinge, first=replace(hinge.first, rotation_max=2.0 * hinge.first.rotation_max))
    kept = values_in_ranges(ranged, reference, [summed])
    assert set(kept) == set(found.in_ranges) - {"hinge.root.rotation_max"}
    shorter = replace(reference, time=reference.time * 0.5)
    assert compare(ranged, shorter, case.structure).in_ranges == {}
    assert shell_range_sentence(compare(multibody, reference, case.structure)) == ""
