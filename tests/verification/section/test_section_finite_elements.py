"""Properties of thin-walled sections compared with finite elements of the cross-section.

The finite elements are those of sectionproperties (MIT).  The solids are built here with shapely from the
mid-lines, arcs with 64 chords per quarter circle, independently of the product.  Area, centroid, second
moments and plastic moduli: 0.1 % (the chords of the arcs; sharp corners agree to 1e-9).  Torsion constant,
shear centre and warping are mid-line values in the product and plane elasticity here.  They differ by the
stiffness of corners and by end effects of order t/b, so their tolerances state how accurate the thin-wall
theory is: 2 % in J, 0.5 % of the depth in the shear centre of these sections.

Kind: other code.  Source: run here.
"""

import numpy as np
import pytest
from sectionproperties.analysis import Section as ElementSection
from sectionproperties.pre import Geometry
from shapely import LineString, Polygon, box, union_all

from crumple.section import Angle, Channel, ClosedHat, Hat, MultiCellTube, RectangularTube, walls_of

MM = 1e-3

OPEN = [
    Channel(50 * MM, 100 * MM, 2 * MM),
    Channel(50 * MM, 100 * MM, 2 * MM, 4 * MM, 15 * MM),
    Angle(50 * MM, 40 * MM, 1.5 * MM, 3 * MM),
    Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM),
    Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, 4 * MM),
]
CLOSED = [
    MultiCellTube(100 * MM, 60 * MM, 2 * MM, 2, 2),
    MultiCellTube(100 * MM, 60 * MM, 2 * MM, 3, 1, 1 * MM, 5 * MM),
    walls_of(RectangularTube(50 * MM, 25 * MM, 2.65 * MM, 5.3 * MM)),
]

# a few seconds for all of them together: the quick run looks at one open and one closed section
QUICK = (OPEN[0], CLOSED[0])
CASES = [
    pytest.param(section, marks=[] if section in QUICK else pytest.mark.slow) for section in (*OPEN, *CLOSED)
]


def solid(wall):
    """Metal of one wall: its mid-line with round bends, buffered to both sides."""
    radius, t = wall.corner_radius - wall.thickness / 2, wall.thickness
    points = np.array(wall.points)
    if wall.closed:
        # start in the middle of a side, so that every corner is inside the line
        points = np.concatenate([[(points[0] + points[-1]) / 2], points, [(points[0] + points[-1]) / 2]])
    line = [points[0]]
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        inwards, outwards = (side / np.linalg.norm(side) for side in (corner - before, after - corner))
        turn = np.arctan2(np.cross(inwards, outwards), inwards @ outwards)
        if radius <= 0.0 or turn == 0.0:
            line.append(corner)
            continue
        cut = radius * np.tan(abs(turn) / 2)
        start, sign = corner - cut * inwards, np.sign(turn)
        centre = start + sign * radius * np.array([-inwards[1], inwards[0]])
        for angle in np.linspace(0, turn, 65):
            c, s = np.cos(angle), np.sin(angle)
            line.append(centre + np.array([[c, -s], [s, c]]) @ (start - centre))
    line.append(points[-1])
    if not wall.closed:
        return LineString(line).buffer(t / 2, cap_style="flat", join_style="mitre", mitre_limit=10)
    ring = Polygon(line)
    outer = ring.buffer(t / 2, join_style="mitre", mitre_limit=10)
    return outer.difference(ring.buffer(-t / 2, join_style="mitre", mitre_limit=10))


def elements(geometry, size):
    section = ElementSection(Geometry(geometry).create_mesh([size**2]))
    section.calculate_geometric_properties()
    section.calculate_warping_properties()
    section.calculate_plastic_properties()
    return section


def metal(section):
    """Union of the walls; a wall that ends on another's mid-line runs into it."""
    return union_all([solid(wall) for wall in section.walls])


@pytest.mark.filterwarnings("ignore:Arrays of 2-dimensional vectors:DeprecationWarning")
@pytest.mark.parametrize("section", CASES, ids=lambda section: section.title)
def test_against_elements(section, record_figure):
    other = elements(metal(section), 0.8 * section.thickness)
    ours = section.properties
    about_y, about_z, product = other.get_ic()
    centre, pole = np.array(other.get_c()), np.array(other.get_sc())
    plastic = other.get_s()
    pairs = {
        "A": (ours.area, other.get_area()),
        "I_y": (ours.second_moment_y, about_y),
        "I_z": (ours.second_moment_z, about_z),
        "Z_y": (section.plastic_section_modulus_y, plastic[0]),
        "Z_z": (section.plastic_section_modulus_z, plastic[1]),
    }
    for name, (value, expected) in pairs.items():
        record_figure(f"{section.title}: {name}", value, expected, 1e-3, "SI", relative=True)
    assert ours.product_moment == pytest.approx(product, abs=1e-3 * about_y)
    np.testing.assert_allclose(ours.centroid, centre, atol=1e-6)
    record_figure(
        f"{section.title}: J",
        ours.torsion_constant * 1e12,
        other.get_j() * 1e12,
        0.02,
        "mm^4",
        relative=True,
    )
    off = float(np.linalg.norm(np.array(ours.shear_centre) - (pole - centre)))
    depth = section.bending_depth("y")
    tolerance = 0.005 * depth * 1e3
    record_figure(f"{section.title}: distance of the shear centres", off * 1e3, 0.0, tolerance, "mm")
    if section in OPEN[:2]:
        record_figure(
            f"{section.title}: I_w",
            ours.warping_constant * 1e18,
            other.get_gamma() * 1e18,
            3e-3,
            "mm^6",
            relative=True,
        )


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Arrays of 2-dimensional vectors:DeprecationWarning")
def test_closed_hat_welded_along_lines_and_bonded_all_over(record_figure):
    section = ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM)
    hat, plate = (solid(wall) for wall in section.walls)
    bonded = elements(union_all([hat, plate], grid_size=1e-9), 0.75 * MM)
    about_y = bonded.get_ic()[0]
    record_figure("closed hat: I_y", section.second_moment_y, about_y, 1e-3, "m^4", relative=True)
    record_figure(
        "closed hat: Z_y", section.plastic_section_modulus_y, bonded.get_s()[0], 1e-3, "m^3", relative=True
    )
    # sheets a hair apart, joined by a narrow bridge at each weld line
    gap, width = 0.05 * MM, 0.6 * MM
    apart = union_all([hat, _moved(plate, -gap), *(_bridge(weld, width, gap) for weld in section.welds)])
    welded = elements(apart, 0.5 * MM)
    record_figure(
        "closed hat, welded along lines: J",
        section.torsion_constant * 1e12,
        welded.get_j() * 1e12,
        0.025,
        "mm^4",
        relative=True,
    )
    # sheets bonded over the whole flange are stiffer: the flow need not go out to the weld line
    record_figure(
        "closed hat, J over that of sheets bonded all over",
        section.torsion_constant / bonded.get_j(),
        0.85,
        0.01,
    )


def _moved(polygon, z):
    return Polygon([(x, y + z) for x, y in polygon.exterior.coords])


def _bridge(weld, width, gap):
    y, middle = weld.first[0], (weld.first[1] + weld.second[1]) / 2
    return box(y - width / 2, middle - 4 * gap, y + width / 2, middle + 4 * gap)
