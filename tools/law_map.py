"""Maps of trust: energy of the formulas over that of the library of tubes, less 1.

`python -m tools.law_map docs/images` writes tube_library_kecman.svg and tube_library_circular.svg, and prints
the spread of the errors over each map.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.colors import TwoSlopeNorm
from tools.law_design import DEEPEST, RATIO, SLENDERNESS, THICKEST, WALL, YIELD_STRAIN, YOUNGS_MODULUS

from crumple.errors import InputError
from crumple.hinge import absorbed_energy, build_law
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.report.drawing.style import INK, WIDTH, add_axes, drawing, new_figure, to_svg
from crumple.section import CircularTube, RectangularTube, Section

AT = (10.0, 30.0)
"""Plastic rotations up to which energies are compared [deg]."""
STRESS = 350e6
"""Yield stress of rectangular tubes [Pa], with 210 GPa."""
HARDENINGS = (1.0, 1.4)
"""Flow stress over yield stress."""
LEVELS = np.array([-0.6, -0.4, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.4, 0.6, 1.0, 2.0])
NORM = TwoSlopeNorm(0.0, -0.6, 1.0)
COUNT = 25
"""Points along each side of a map."""


def metal(stress: float, flow: float) -> Material:
    """Steel without a hardening curve."""
    return Material("steel", YOUNGS_MODULUS, 0.3, 7850.0, stress, given_flow_stress=flow * stress)


def error(formula: str, section: Section, material: Material, at: float) -> float:
    """Energy of a formula over that of the library, less 1; not a number where either has no law."""
    try:
        own, library = (build_law(name, section, material, "y") for name in (formula, "library"))
    except InputError:
        return float("nan")
    rotation = float(np.radians(at))
    return float(absorbed_energy(own, rotation) / absorbed_energy(library, rotation) - 1.0)


def tube(slenderness: float, ratio: float) -> RectangularTube:
    """Tube of unit wall."""
    return RectangularTube(slenderness * min(ratio, 1.0) * WALL, slenderness / max(ratio, 1.0) * WALL, WALL)


def kecman_map(material: Material, at: float) -> tuple[Floats, Floats, Floats]:
    """Slenderness, ratio, and error over both."""
    slenderness = np.geomspace(THICKEST, SLENDERNESS[1], COUNT)
    ratio = np.geomspace(DEEPEST, RATIO[1], COUNT)
    values = [[error("kecman", tube(s, r), material, at) for s in slenderness] for r in ratio]
    return slenderness, ratio, np.array(values)


def circular_map(flow: float, at: float) -> tuple[Floats, Floats, Floats]:
    """Slenderness, yield strain, and error over both."""
    slenderness, strain = np.geomspace(*SLENDERNESS, COUNT), np.geomspace(*YIELD_STRAIN, COUNT)
    values = [
        [
            error("circular", CircularTube(s * WALL, WALL), metal(e * YOUNGS_MODULUS, flow), at)
            for s in slenderness
        ]
        for e in strain
    ]
    return slenderness, 1e3 * strain, np.array(values)


def picture(maps: list[list[tuple[str, tuple[Floats, Floats, Floats]]]], name: str, y: str) -> str:
    """Contours in rows of maps with a title each."""
    rows, columns = len(maps), len(maps[0])
    wide, high = (WIDTH - 0.35) / columns, 1.75
    with drawing():
        figure = new_figure(WIDTH, rows * high + 0.15)
        for row, line in enumerate(maps):
            for column, (title, (across, up, values)) in enumerate(line):
                axes = add_axes(
                    figure, 0.4 + column * wide, (rows - 1 - row) * high + 0.4, wide - 0.25, high - 0.65
                )
                axes.contourf(across, up, values, LEVELS, cmap="RdBu_r", norm=NORM, extend="both")
                lines = axes.contour(across, up, values, LEVELS, colors=INK, linewidths=0.5)
                axes.clabel(lines, fmt=lambda value: f"{100.0 * value:+.0f} %", fontsize=5.5)
                axes.set_xscale("log")
                axes.set_yscale("log")
                axes.set_xticks([15, 20, 30, 40, 60], ["15", "20", "30", "40", "60"])
                ticks = [value for value in (0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0) if up[0] <= value <= up[-1]]
                axes.set_yticks(ticks, [f"{value:g}" for value in ticks])
                axes.minorticks_off()
                axes.set_title(title, fontsize=7, loc="left")
                axes.set_xlabel("larger side or diameter / wall", fontsize=6.5)
                if column == 0:
                    axes.set_ylabel(y, fontsize=6.5)
        what = "Contours of the energy of a formula over that of the library of shell solutions, less one."
        return to_svg(figure, name, what)


def summary(title: str, values: Floats) -> None:
    """Print the spread of a map."""
    known = values[np.isfinite(values)]
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    print(
        f"{title}: 5 % {low:+.0%}, median {middle:+.0%}, 95 % {high:+.0%}, largest {np.abs(known).max():.0%}"
    )


def main(folder: Path) -> None:
    """Both pictures, and their spread."""
    kecman = [
        [(f"flow/yield {flow:g}, {at:.0f}°", kecman_map(metal(STRESS, flow), at)) for flow in HARDENINGS]
        for at in AT
    ]
    circular = [
        [(f"flow/yield {flow:g}, {at:.0f}°", circular_map(flow, at)) for flow in HARDENINGS] for at in AT
    ]
    for name, maps, y in (
        ("kecman", kecman, "flange width / depth"),
        ("circular", circular, "yield stress / E, per mille"),
    ):
        (folder / f"tube_library_{name}.svg").write_text(picture(maps, f"tube-library-{name}", y))
        for title, (_, _, values) in (one for line in maps for one in line):
            summary(f"{name}, {title}", values)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
