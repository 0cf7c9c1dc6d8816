"""Members of one flat wall: the positions of nodes in a line do not determine the rotation of a section."""

import pytest
from tests.support.structures import STEEL

from crumple.shell import ShellRun, solve_shell
from crumple.structure import Outputs, ShellSettings, Structure


def wall(*points):
    return {"type": "walls", "walls": [{"points": points, "thickness": 2e-3}]}


FLAT = wall((-0.02, 0.0), (0.02, 0.0))
ANGLE = wall((-0.02, 0.0), (0.02, 0.0), (0.02, 0.02))


def reported(section, hinged):
    law = {"type": "constant", "moment": 10.0}
    hinge = {"name": "h", "at": 0.03, "axis": "y", "law": law}
    member = {"nodes": ("a", "b"), "section": "sheet", "material": "steel"} | (
        {"hinges": [hinge]} if hinged else {}
    )
    structure = Structure(
        materials={"steel": STEEL},
        sections={"sheet": section},
        nodes={"a": (0, 0, 0), "b": (0.1, 0, 0)},
        members={"strip": member},
        supports={"clamp": {"node": "a", "fix": "all"}},
        initial_velocity=[{"rotation": 5.0, "axis": (0, 1, 0)}],
    )
    result = solve_shell(structure, ShellRun(5e-5, 5e-5, ShellSettings(element_size=0.01), Outputs()))
    return [text for text in result.warnings if "one flat wall" in text]


@pytest.mark.parametrize(
    ("section", "hinged", "number"), [(FLAT, True, 1), (FLAT, False, 0), (ANGLE, True, 0)]
)
def test_hinges_in_a_flat_member_are_reported_as_not_measurable(section, hinged, number):
    found = reported(section, hinged)
    assert len(found) == number
    assert all("Member strip" in text for text in found)
