"""Tubes with thicker walls than those of the library: what is solved, and how the tables compare with it.

    python -m tools.law_thick solve tools/tube_library     solve what is missing; may be stopped at any time
    python -m tools.law_thick check tools/tube_library     errors of the tables below their thickest tube

Free folds, cantilevers and short cantilevers as those of the library, on its nominal mesh.  How the tables
are continued is chosen by the tubes `CHOOSE`; the tubes `JUDGE` were fixed before any was solved, and nothing
is chosen by them.  `BORDER` is the thickest square of the tables.
"""

from __future__ import annotations

import json
import os
import time
from dataclasses import asdict
from pathlib import Path

from tools.law_clamped import cantilever, histories
from tools.law_design import NOMINAL, Point
from tools.law_library import answer, run_verb

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
)
BORDER = ((15.0, 1.0, 0.0018, 1.0),)
SHORT = ("choose-01", "judge-00", "judge-03")
"""Tubes whose cantilevers of 2.5 larger sides are solved too."""
SHORTEST = 2.5


def design() -> dict[str, Point]:
    """Tubes by name, in the order of solution."""
    groups = {"choose": CHOOSE, "border": BORDER, "judge": JUDGE}
    return {
        (name := f"{group}-{number:02d}"): Point(f"thick-{name}", "rectangular_tube", "check", *place, NOMINAL)
        for group, places in groups.items()
        for number, place in enumerate(places)
    }


def solve_missing(folder: Path) -> None:
    """Solve what the folder lacks; a file is written whole or not at all."""
    tubes = design()
    todo = [("clamped", name) for name in tubes]
    todo += [("short", name) for name in SHORT] + [("free", name) for name in tubes]
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


if __name__ == "__main__":
    run_verb(__doc__, {"solve": solve_missing})
