"""Tubes with thicker walls than those of the library: what is solved, and how the tables compare with it.

    python -m tools.tube_library.thick solve tools/tube_library    solve what is missing; may be stopped
    python -m tools.tube_library.thick check tools/tube_library    errors of the laws and formulas

Free folds, cantilevers and short cantilevers as those of the library, on its nominal mesh.  How the tables
are continued is chosen by the tubes `CHOOSE`; the tubes `JUDGE` were fixed before they were solved, and
nothing is chosen by them (the last two, and the short cantilevers of all but three, after the others beside a
clamp were known).  `BORDER` is the thickest square of the tables.
"""

from __future__ import annotations

import json
import os
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np
from tools.law_clamped import LENGTH, cantilever, fold_rotation, histories
from tools.law_design import DEEPEST, NOMINAL, WALL, Point
from tools.law_fit import AT
from tools.law_library import LARGEST, PLACE, answer, percents, run_verb

from crumple.characterisation.curve import law_curve
from crumple.hinge import build_law
from crumple.hinge.law import HingeLaw
from crumple.numeric.arrays import Floats

CHOOSE = (
    (10.0, 1.0, 0.0012, 1.0),
    (12.0, 1.0, 0.0026, 1.0),
    (10.0, 1.5, 0.0018, 1.45),
    (12.0, 0.67, 0.0018, 1.0),
)
"""Slenderness, ratio, yield strain, hardening."""
JUDGE = (
    (12.0, 1.0, 0.001714, 1.0),
    (12.5, 1.0, 0.0012, 1.0),
    (10.0, 1.0, 0.0035, 1.0),
    (13.333333, 1.0, 0.0017, 1.5),
    (10.0, 2.0, 0.0017, 1.0),
    (10.0, 0.7, 0.0022, 1.3),
    (16.666667, 1.0, 0.0017, 1.0),
    (11.0, 1.2, 0.0025, 1.2),
)
BORDER = ((15.0, 1.0, 0.0018, 1.0),)
FREE = ("choose-00", "choose-01", "choose-02", "border-00", "judge-00", "judge-03", "judge-06")
"""Tubes whose free folds are solved: all were meant to be; the others were left out because of their cost."""
SHORTEST = 2.5
"""Length of the short cantilevers in larger sides."""


def design() -> dict[str, Point]:
    """Tubes by name, in the order of solution."""
    groups = {"choose": CHOOSE, "border": BORDER, "judge": JUDGE}
    return {
        (name := f"{group}-{number:02d}"): Point(
            f"thick-{name}", "rectangular_tube", "check", *place, NOMINAL
        )
        for group, places in groups.items()
        for number, place in enumerate(places)
    }


def solve_missing(folder: Path) -> None:
    """Solve what the folder lacks; a file is written whole or not at all."""
    tubes = design()
    todo = [(kind, name) for kind in ("clamped", "short") for name in tubes]
    todo += [("free", name) for name in FREE]
    for kind, name in todo:
        point, path = tubes[name], folder / f"thick-{kind}-{name}.json"
        if path.exists():
            continue
        begun = time.process_time()
        if kind == "free":
            found = answer(point)
        else:
            analysis = cantilever(point, SHORTEST if kind == "short" else None)
            found = {"point": asdict(point), "histories": histories(point, analysis)}
        part = path.with_suffix(".part")
        part.write_text(json.dumps(found) + "\n")
        os.replace(part, path)
        print(f"{path.stem} {time.process_time() - begun:.0f} s {found.get('refused', '')}", flush=True)


def read(path: Path) -> tuple[Floats, Floats] | None:
    """Rotation [rad] and M/M_p of a solved tube; None if it folded elsewhere."""
    found = json.loads(path.read_text())
    if "histories" in found and "down" in found["histories"]:
        own = found["histories"]
        curve = law_curve(fold_rotation(own), np.array(own["moment"]), LARGEST)
        return curve.rotation, curve.moment
    if "curve" not in found:
        return None
    return tuple(np.array(found["curve"][name]) for name in ("rotation", "moment"))


def works(rotation: Floats, moment: Floats) -> Floats:
    """Work over M_p up to `AT`; none beyond the end of a law."""
    fine = [np.linspace(0.0, end, 601) for end in np.radians(AT)]
    done = [float(np.trapezoid(np.interp(one, rotation, moment), one)) for one in fine]
    return np.where(np.radians(AT) <= rotation[-1] + 1e-6, done, np.nan)


def law_of(kind: str, point: Point) -> HingeLaw:
    """Law of a tube as the shells have it."""
    if kind == "free":
        return build_law("library", point.section, point.material)
    span = SHORTEST if kind == "short" else LENGTH["rectangular_tube"]
    return build_law("clamped_tube", point.section, point.material, span=span * point.slenderness * WALL)


def check(folder: Path) -> None:
    """Work of shells over M_p, and errors of the law and of the formula."""
    fine = np.radians(np.linspace(0.0, 40.0, 1601))
    for kind in ("clamped", "short", "free"):
        for name, point in design().items():
            path = folder / f"thick-{kind}-{name}.json"
            if not path.exists():
                continue
            place = " ".join(f"{getattr(point, key):8.4g}" for key in PLACE)
            curve = read(path)
            if curve is None or (kind == "free" and point.ratio < DEEPEST):
                print(f"{kind:7} {name:9} {place}   {'folded elsewhere' if curve is None else 'no law'}")
                continue
            shells = works(*curve)
            plastic = point.material.yield_stress * point.section.plastic_section_modulus("y")
            formula = "hardening_tube" if point.hardening > 1.0 else "kecman"
            laws = law_of(kind, point), build_law(formula, point.section, point.material)
            rows = [works(fine, one.moment_capacity(fine) / plastic) / shells - 1.0 for one in laws]
            print(f"{kind:7} {name:9} {place}   {shells.round(4).tolist()}  {'  '.join(map(percents, rows))}")


if __name__ == "__main__":
    run_verb(__doc__, {"solve": solve_missing, "check": check})
