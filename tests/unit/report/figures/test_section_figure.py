from xml.etree import ElementTree

import pytest

from crumple.material import Material
from crumple.report.figures.section_figure import section_figure
from crumple.section import (
    Angle,
    Channel,
    CircularTube,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    Wall,
    WallSection,
)

STEEL = Material("steel", 210e9, 0.3, 7850.0, 355e6)
SECTIONS = [
    RectangularTube(0.05, 0.025, 0.002, 0.004),
    CircularTube(0.05, 0.002),
    Channel(0.05, 0.1, 0.002, 0.004, 0.015),
    Angle(0.05, 0.04, 0.003),
    Hat(0.06, 0.05, 0.0015, 0.02),
    ClosedHat(0.06, 0.05, 0.0015, 0.02, 0.004),
    MultiCellTube(0.1, 0.06, 0.002, 3, 2),
    WallSection((Wall(((-0.03, 0.0), (0.03, 0.0)), 0.002), Wall(((0.0, 0.0), (0.0, -0.05)), 0.003))),
]


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.title)
def test_every_section_can_be_drawn(section, caplog):
    svg = section_figure(section, STEEL)
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    assert f"Cross-section: {section.title}." in svg
    assert "nan" not in svg
    # matplotlib complains about limits and aspects in its log alone
    assert caplog.text == ""


@pytest.mark.parametrize("material", [None, STEEL])
def test_figure_repeats_and_shows_the_interaction_with_a_material_alone(material):
    svg = section_figure(SECTIONS[0], material)
    assert svg == section_figure(SECTIONS[0], material)
    assert ("half the plastic torque" in svg) == (material is not None)
