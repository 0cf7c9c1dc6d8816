"""A cross-section in one figure: its metal and centres; with a material also its plastic interaction.

The section is drawn to scale with centroid, shear centre and principal axes.  Beside it are the moments about
y and z that it carries with an axial force, without torque and with half the plastic torque, and the moments
about both axes at three axial forces.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.report.drawing.scales import display_unit
from crumple.report.drawing.style import (
    GRID,
    INK,
    MUTED,
    SERIES,
    WIDTH,
    Line,
    add_axes,
    draw_lines,
    drawing,
    name_axes,
    new_figure,
    to_svg,
)
from crumple.section import PlasticInteraction, Section, plastic_interaction, walls_of
from crumple.section.walled import WalledSection

HEIGHT = 2.9
"""Of the figure [in]."""
_SIDE = 2.1  # of each drawing [in]
_BOTTOM = 0.45


def section_figure(section: Section, material: Material | None = None) -> str:
    """Section as SVG.

    Parameters
    ----------
    section
        Tube or section of walls.
    material
        Metal of the walls without a material of their own; without one only the section itself is drawn.
    """
    with drawing():
        figure = section_drawing(section, material)
        return to_svg(figure, "section", f"Cross-section: {section.title}.") + "\n"


def section_drawing(section: Section, material: Material | None = None) -> Figure:
    """Figure of a section, for `section_figure`; call it inside `style.drawing()`."""
    walled = walls_of(section)
    figure = new_figure(WIDTH if material else _SIDE + 0.6, HEIGHT)
    draw_walls(add_axes(figure, 0.3, _BOTTOM, _SIDE, _SIDE), walled)
    if material is not None:
        interaction = plastic_interaction(walled, material)
        _draw_force_and_moment(add_axes(figure, 2.85, _BOTTOM, 1.65, _SIDE), interaction)
        _draw_moments(add_axes(figure, 5.15, _BOTTOM, 1.65, _SIDE), interaction)
    return figure


def draw_walls(axes: Axes, section: WalledSection) -> None:
    """Metal to scale [mm], centroid (dot), shear centre (cross), principal axes (thin); y to the right."""
    # sheets that are welded flat on each other are drawn sheet by sheet, so that both can be seen
    for wall in range(len(section.walls)) if section.welds else [-1]:
        colour = SERIES[0] if wall <= 0 else SERIES[5]
        axes.add_patch(PathPatch(_metal(section, wall), facecolor=colour, edgecolor=colour, linewidth=0.2))
    width, depth = section.flange_width("y"), section.bending_depth("y")
    properties = section.properties
    reach = 0.6e3 * max(width, depth)
    for turn in (0.0, np.pi / 2.0):
        c, s = (reach * f(properties.principal_angle + turn) for f in (np.cos, np.sin))
        axes.plot([-c, c], [-s, s], color=MUTED, linewidth=0.5, dashes=(6, 2, 1, 2))
    axes.plot([0.0], [0.0], "o", color=INK, markersize=3.0)
    y, z = (1e3 * place for place in properties.shear_centre)
    axes.plot([y], [z], "x", color=SERIES[1], markersize=5.0)
    right, left = (1e3 * reach for reach in section.extent(-np.pi / 2.0))
    top, bottom = (1e3 * reach for reach in section.extent("y"))
    spans = [(min(-left, y), max(right, y)), (min(-bottom, z), max(top, z))]
    # the axes are square: the same scale along both
    half = 0.56 * max(high - low for low, high in spans)
    (y0, y1), (z0, z1) = ((middle - half, middle + half) for middle in map(_middle, spans))
    axes.set_xlim(y0, y1)
    axes.set_ylim(z0, z1)
    axes.grid(visible=False)
    name_axes(axes, "y, mm", "z, mm")


def _middle(span: tuple[float, float]) -> float:
    return (span[0] + span[1]) / 2.0


def _metal(section: WalledSection, wall: int) -> Path:
    """Metal of one wall, or of all (-1), as one path with holes [mm]."""
    if wall < 0:
        outlines = [section.outer_outline(), *(hole[::-1] for hole in section.inner_outlines())]
    else:
        chosen = section.centred_polygons[section.skeleton.wall == wall]
        outlines = [np.column_stack([polygon.real, polygon.imag]) for polygon in chosen]
    vertices, codes = [], []
    for outline in outlines:
        vertices += [1e3 * outline, 1e3 * outline[:1]]
        codes += [Path.MOVETO, *[Path.LINETO] * (len(outline) - 1), Path.CLOSEPOLY]
    return Path(np.concatenate(vertices), codes)


def _draw_force_and_moment(axes: Axes, interaction: PlasticInteraction) -> None:
    curves = {
        "M about y": interaction.force_moment_curve("y"),
        "M about z": interaction.force_moment_curve("z"),
    }
    weaker = "half the torque"
    half = interaction.plastic_torque / 2.0
    force_unit, per_force = display_unit("N", interaction.squash_force)
    largest = max(float(np.abs(curve[:, 1]).max()) for curve in curves.values())
    unit, per_moment = display_unit("N*m", largest)
    _cross(axes, interaction.squash_force / per_force, largest / per_moment)
    for axis in ("y", "z"):
        curve = _closed(interaction.force_moment_curve(axis, torque=half))
        draw_lines(
            axes, [Line(weaker, curve[:, 0] / per_force, curve[:, 1] / per_moment, faint=True)], labels=False
        )
    for index, (name, open_curve) in enumerate(curves.items()):
        curve = _closed(open_curve)
        line = Line(name, curve[:, 0] / per_force, curve[:, 1] / per_moment, index)
        draw_lines(axes, [line], labels=False)
        _legend(axes, index, name)
    _legend(axes, 2, "with half the plastic torque", MUTED)
    name_axes(axes, f"N, {force_unit}", f"M, {unit}")


def _draw_moments(axes: Axes, interaction: PlasticInteraction) -> None:
    unit, factor = display_unit("N*m", float(interaction.scales[1:3].max()))
    _cross(axes, float(interaction.scales[1]) / factor, float(interaction.scales[2]) / factor)
    for index, share in enumerate((0.0, 0.3, 0.6)):
        curve = _closed(interaction.moment_curve(share * interaction.squash_force)) / factor
        name = f"N = {share:g} of the largest" if share else "N = 0"
        draw_lines(axes, [Line(name, curve[:, 0], curve[:, 1], index)], labels=False)
        _legend(axes, index, name)
    name_axes(axes, f"M about y, {unit}", f"M about z, {unit}")


def _cross(axes: Axes, x: float, y: float) -> None:
    axes.set_xlim(-1.12 * x, 1.12 * x)
    # room for the names of the curves above them
    axes.set_ylim(-1.12 * y, 1.75 * y)
    axes.axhline(0.0, color=GRID, linewidth=0.8, zorder=0)
    axes.axvline(0.0, color=GRID, linewidth=0.8, zorder=0)


def _legend(axes: Axes, index: int, text: str, colour: str = "") -> None:
    axes.text(
        0.02,
        0.98 - 0.075 * index,
        text,
        transform=axes.transAxes,
        va="top",
        fontsize=7.0,
        color=colour or SERIES[index],
    )


def _closed(curve: Floats) -> Floats:
    return np.concatenate([curve, curve[:1]])
