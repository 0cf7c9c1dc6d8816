"""Make the library of bending laws of tubes from shell sub-models.

    python -m tools.law_library solve tools/tube_library     solve what is missing; may be stopped at any time
    python -m tools.law_library list tools/tube_library      points, estimated cost, what is solved
    python -m tools.law_library table tools/tube_library     fit, and write the tables that are shipped
    python -m tools.law_library check tools/tube_library     errors at the points held out, and of the mesh

Points and range: tools/law_design.py.  Definitions: docs/theory/tube_library.md.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from tools.law_design import (
    COARSE,
    DEEPEST,
    HARDENING,
    NOMINAL,
    RATIO,
    SLENDERNESS,
    STRONGEST,
    THICKEST,
    THICKEST_ROUND,
    TRAINING,
    YIELD_STRAIN,
    Point,
    Role,
    points,
)
from tools.law_fit import AT, KNOTS, Fit, Points, Solved, best_fit, energy_of, rounded

from crumple.analysis import solve
from crumple.characterisation import Bending
from crumple.characterisation.needed import Needed
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import ATTEMPTS, MOST_KINETIC, kinetic_share
from crumple.errors import CrumpleError
from crumple.hinge.tube_library.table import Coordinate, TubeTable, table_of, tube_table
from crumple.hinge.tube_library.tube import coordinate, within
from crumple.numeric.arrays import Floats
from crumple.shell import LongRun
from crumple.version import __version__

LARGEST = math.radians(40.0)
"""Plastic rotation at which the laws end."""
FURTHEST = math.radians(60.0)
"""Plastic rotation for which the sub-models turn; they end with their law.  The pieces beside the fold of
thick tubes that harden turn plastically too, which left laws of 23 to 39 deg of a turn for 40 deg."""

PLACE = ("slenderness", "ratio", "yield_strain", "hardening")
NOMINAL_ROLES: tuple[Role, ...] = ("mesh", "hardened")
"""Points on the nominal mesh that are fitted."""
ROLES: tuple[Role, ...] = ("training", "earlier", "former", "strong", *NOMINAL_ROLES)
"""Points that are fitted."""
HELD_OUT: tuple[Role, ...] = ("held-out", "check")
"""Points that are not."""
PROVENANCE = {
    "method": "straight sub-models bent by end moments, docs/theory/characterisation.md",
    "imperfection": "kink of 0.2 deg in the middle",
    "corners": "sharp",
    "poissons_ratio": 0.3,
    "hardening": "power law (Swift) with prestrain 0.01",
}
SOLID = {"rectangular_tube": 0.12, "circular_tube": 0.0}
"""Largest difference of energies from solids (50x25x2.65 mm, 488 MPa, to 42 deg); bands contain it."""
METAL = (
    Coordinate("yield_strain", *YIELD_STRAIN, True),
    Coordinate("hardening", HARDENING[0], STRONGEST, True),
)
ROUND = (THICKEST_ROUND, SLENDERNESS[1])
"""Diameter over wall."""
SIDE = (SLENDERNESS[0] * RATIO[0], SLENDERNESS[1])
BUCKLING = tuple(side * math.sqrt(strain) for side, strain in zip(SIDE, YIELD_STRAIN, strict=True))
CHOICES = {
    "rectangular_tube": (
        (Coordinate("flange", *SIDE, True), Coordinate("web", *SIDE, True), *METAL),
        (Coordinate("slenderness", *SLENDERNESS, True), Coordinate("ratio", *RATIO, True), *METAL),
        (Coordinate("flange_buckling", *BUCKLING, True), Coordinate("web_buckling", *BUCKLING, True), *METAL),
        (Coordinate("flange_buckling", *BUCKLING, True), Coordinate("ratio", *RATIO, True), *METAL),
    ),
    "circular_tube": (
        (Coordinate("slenderness", *ROUND, True), *METAL),
        (Coordinate("flange_buckling", *BUCKLING, True), *METAL),
    ),
}
"""Coordinates that are tried; leaving one out chooses."""


def model(point: Point, slowness: float = Resolution().slowness) -> Bending:
    """Sub-model of a point."""
    resolution = Resolution(point.elements, slowness)
    return Bending(point.section, point.material, largest=FURTHEST, resolution=resolution)


def answer(point: Point) -> dict[str, Any]:
    """Law of a point over its plastic moment, or why it has none.

    The histories are kept, so that a law can be read from them in another way.
    """
    one = model(point)
    plastic_moment = point.material.yield_stress * point.section.plastic_section_modulus("y")
    found: dict[str, Any] = {"point": asdict(point), "crumple": __version__}
    begun = time.process_time()
    for attempt in range(ATTEMPTS):
        result = solve(one.analysis(), "shell", 1, long_run=LongRun(enough=partial(_enough, one)))
        found |= {"status": result.status.name, "slowness": one.resolution.slowness, "attempts": attempt + 1}
        if not result.status.ok:
            break
        rotation, moment = one.histories(result)
        found["histories"] = {
            "rotation": rotation.round(6).tolist(),
            "moment": (moment / plastic_moment).round(5).tolist(),
            "whole": np.abs(result["node.turned.rotation.y"]).round(6).tolist(),
        }
        found["energy_residual"] = float(result.energy_residual)
        try:
            curve = replace(one, largest=LARGEST).curve(result)
        except CrumpleError as error:
            found["refused"] = str(error).strip()
            break
        kinetic = kinetic_share(result, curve.energy_at(one.watched_from))
        found["kinetic"] = kinetic
        found["curve"] = {
            "rotation": curve.rotation.round(6).tolist(),
            "moment": (curve.moment / plastic_moment).round(6).tolist(),
        }
        if kinetic <= MOST_KINETIC:
            break
        slower = one.resolution.slowness * 1.2 * math.sqrt(kinetic / MOST_KINETIC)
        one = replace(one, resolution=replace(one.resolution, slowness=slower))
    return found | {"seconds": round(time.process_time() - begun, 1)}


def _enough(one: Bending, channels: Mapping[str, Floats]) -> bool:
    """Whether the fold has turned up to the end of the law."""
    return bool(one.histories(channels)[0].max() >= LARGEST)


def solve_missing(folder: Path) -> None:
    """Solve every point without a file; a file is written whole or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    for point in points():
        path = folder / f"{point.name}.json"
        if path.exists():
            continue
        try:
            found = answer(point)
        except CrumpleError as error:
            found = {"point": asdict(point), "crumple": __version__, "refused": str(error).strip()}
        part = path.with_suffix(".part")
        part.write_text(json.dumps(found))
        os.replace(part, path)
        print(path.name, found.get("seconds"), found.get("kinetic"), found.get("refused", ""), flush=True)


def show(folder: Path) -> None:
    """Every point with its estimated processor time."""
    total = 0.0
    for point in points():
        seconds = Needed(model(point), "", ()).seconds()
        total += seconds
        done = "solved" if (folder / f"{point.name}.json").exists() else ""
        print(
            f"{point.name:32} {point.slenderness:6.1f} {point.ratio:5.2f} {point.yield_strain:.4f} "
            f"{point.hardening:4.2f} {seconds:6.0f} s {done}"
        )
    print(f"{total:.0f} s in all")


def read(folder: Path, kind: str, role: str) -> list[Solved]:
    """Solved points with a law, in the order of their names."""
    found = [json.loads(path.read_text()) for path in sorted(folder.glob(f"{kind}-{role}-*.json"))]
    return [
        Solved(one["point"], np.array(one["curve"]["rotation"]), np.array(one["curve"]["moment"]))
        for one in found
        if "curve" in one and one["kinetic"] <= MOST_KINETIC
    ]


def table(folder: Path) -> None:
    """Fit and write the table of each shape."""
    for kind in TRAINING:
        fitted = [one for role in ROLES for one in read(folder, kind, role)]
        held_out = [one for role in HELD_OUT for one in read(folder, kind, role)]
        fits = fits_of(kind, kind, fitted)
        for one in fits:
            keys = [coordinate.key for coordinate in one.coordinates]
            print(kind, keys, f"degree {one.degree}, step {[keys[number] for number in one.step]}")
            print(
                f"  noise {one.noise:.2g}, variance of the step {one.step_variance:.2g}, "
                f"lengths {one.lengths.round(2)}; left out, root mean square {math.sqrt(one.score):.2%}"
            )
        write_table(kind, kind, {}, fits, (fitted, held_out), least_band=SOLID[kind])


def fits_of(name: str, kind: str, fitted: list[Solved]) -> list[Fit]:
    """Best fit of a table by each choice of coordinates."""
    return [best_fit(choice, points_of(choice, name, fitted)) for choice in CHOICES[kind]]


def write_table(
    name: str,
    kind: str,
    provenance: dict[str, str],
    fits: list[Fit],
    solved: tuple[list[Solved], list[Solved]],
    *,
    least_band: float = 0.0,
    columns: int = KNOTS.size,
) -> TubeTable:
    """Write the table that is shipped, by the best of its fits.

    Parameters
    ----------
    name
        Of the table.
    kind
        Of its sections.
    provenance
        What differs from `PROVENANCE`.
    fits
        By each choice of coordinates.
    solved
        Points that are fitted, and points that are held out.
    least_band
        Half-width that its band has at least [-].
    columns
        How many of the knots it has.
    """
    fitted, held_out = solved
    fit = min(fits, key=lambda one: one.score)
    written = {
        "provenance": PROVENANCE
        | provenance
        | {"crumple": __version__, "elements along half a fold": [COARSE, NOMINAL]},
        "coordinates": [asdict(one) for one in fit.coordinates],
        "ranges": ranges(name),
        "rotation_deg": KNOTS[:columns].tolist(),
        "band": 0.0,
        "fit": settings(fit) | fit.entries(columns),
        "points": [
            *(entry(one, errors) for one, errors in zip(fitted, fit.left_out, strict=True)),
            *(entry(one) for one in held_out),
        ],
    }
    found = table_of(written)
    written["band"] = max(least_band, band_of(found, held_out))
    path = Path(__file__).parent.parent / "src/crumple/hinge/tube_library" / f"{name}.json"
    path.write_text(lines_of(written) + "\n")
    return found


def band_of(found: TubeTable, held_out: list[Solved]) -> float:
    """Largest error of energies at held-out tubes, and at nominal ones left out, up to a whole percent."""
    errors = [np.abs(error_of(found, one)).max() for one in held_out]
    errors += [
        np.abs(one["left_out"]).max()
        for one in found.facts["points"]
        if "left_out" in one and all(within(one[key], *range_) for key, range_ in found.ranges.items())
    ]
    return math.ceil(100.0 * max(errors)) / 100.0


def error_of(found: TubeTable, one: Solved) -> Floats:
    """Errors of the energies of a table at a solved point."""
    moment = found.moment(tuple(columns(found.coordinates, one).tolist()))
    return energy_of(found.rotation, moment) / one.energy - 1.0


def settings(fit: Fit) -> dict[str, Any]:
    """What leaving one out chose, besides the lengths."""
    step = [fit.coordinates[number].key for number in fit.step]
    noise, variance = (float(f"{one:.3g}") for one in (fit.noise, fit.step_variance))
    return {"degree": fit.degree, "step": step, "noise": noise, "step_variance": variance}


def points_of(coordinates: tuple[Coordinate, ...], name: str, solved: list[Solved]) -> Points:
    """Solved points as the fit of a table takes them."""
    places = [
        [one.scaled(value) for one, value in zip(coordinates, columns(coordinates, each), strict=True)]
        for each in solved
    ]
    element = 1.0 / np.array([one.point["elements"] for one in solved])
    # a tube on another mesh has another whole number of elements, so its sides differ a little
    tubes = [tuple(one.point[key] for key in PLACE if key != "ratio") for one in solved]
    counted = [all(within(one.point[key], *range_) for key, range_ in ranges(name).items()) for one in solved]
    return Points(
        np.array(places),
        (element - 1.0 / NOMINAL) / (1.0 / COARSE - 1.0 / NOMINAL),
        np.array([sorted(set(tubes)).index(tube) for tube in tubes], np.float64),
        np.array(counted, np.float64),
        np.log(np.stack([one.on_knots for one in solved])),
    )


def columns(coordinates: tuple[Coordinate, ...], one: Solved) -> Floats:
    """Values of the coordinates of a solved point."""
    return np.array([coordinate(which, one.point) for which in coordinates])


def ranges(name: str) -> dict[str, tuple[float, float]]:
    """Range of a table by name of the coordinate: beside a clamp thick and deep tubes fold there, too."""
    metal = {"yield_strain": YIELD_STRAIN, "hardening": (HARDENING[0], STRONGEST)}
    if name.endswith("circular_tube"):
        return {"slenderness": ROUND, **metal}
    if "clamped" in name or name.startswith("short"):
        return {"slenderness": SLENDERNESS, "ratio": RATIO, **metal}
    return {"slenderness": (THICKEST, SLENDERNESS[1]), "ratio": (DEEPEST, RATIO[1]), **metal}


def entry(one: Solved, left_out: Floats | None = None) -> dict[str, Any]:
    """A solved point in the file of the table, with the errors of its energy without its tube."""
    keys = ("name", "role", "slenderness", "ratio", "yield_strain", "hardening", "elements")
    found = {key: one.point[key] for key in keys} | {"energy": rounded(one.energy)}
    if left_out is None or one.point["elements"] < NOMINAL:
        return found
    without = energy_of(np.radians(KNOTS), one.on_knots * np.exp(-left_out))
    return found | {"left_out": [float(f"{error:.4f}") for error in without / one.energy - 1.0]}


def lines_of(found: dict[str, Any]) -> str:
    """JSON with a line for each point, and for each row of numbers."""

    def written(key: str, value: Any) -> str:
        if key == "points":
            return "[\n" + ",\n".join(f"    {json.dumps(one)}" for one in value) + "\n  ]"
        if key == "fit":
            rows = (f"    {json.dumps(name)}: {json.dumps(one)}" for name, one in value.items())
            return "{\n" + ",\n".join(rows) + "\n  }"
        return json.dumps(value)

    return (
        "{\n" + ",\n".join(f"  {json.dumps(key)}: {written(key, one)}" for key, one in found.items()) + "\n}"
    )


def check(folder: Path) -> None:
    """Errors of the written table at nominal points: fitted, left out, held out."""
    for kind in TRAINING:
        found = tube_table(kind)
        nominal = [one for role in (*NOMINAL_ROLES, *HELD_OUT) for one in read(folder, kind, role)]
        left_out = {
            one["name"]: np.array(one["left_out"]) for one in found.facts["points"] if "left_out" in one
        }
        for title, roles in (("fitted", NOMINAL_ROLES), ("left out", NOMINAL_ROLES), ("held out", HELD_OUT)):
            print(f"{kind}, {title}: error of the energy up to {AT.tolist()} deg")
            errors = []
            for one in (each for each in nominal if each.point["role"] in roles):
                own = error_of(found, one)
                errors.append(left_out[one.point["name"]] if title == "left out" else own)
                print(f"  {_row(one, errors[-1])}")
            size = np.abs(np.array(errors))
            inside = " ".join(f"{share:.0%}" for share in (size <= 0.05).mean(axis=0))
            print(f"  within 5 %: {inside}; largest {' '.join(f'{one:.1%}' for one in size.max(axis=0))}")
        print(f"{kind}: energy on the coarse mesh over that on the nominal one, less 1")
        coarse = {
            tuple(one.point[key] for key in PLACE): one
            for role in ("training", "former")
            for one in read(folder, kind, role)
        }
        for one in read(folder, kind, "mesh"):
            own = coarse[tuple(one.point[key] for key in PLACE)].energy / one.energy - 1.0
            print(f"  {_row(one, own)}")


def _row(one: Solved, errors: Floats) -> str:
    return f"{' '.join(f'{one.point[key]:8.4g}' for key in PLACE)}   {percents(errors)}"


def percents(errors: Floats) -> str:
    """Errors in a row of a list."""
    return f"{' '.join(f'{100.0 * error:+6.1f}' for error in errors)} %"


def run_verb(description: str | None, verbs: dict[str, Callable[[Path], None]]) -> None:
    """Run the verb of the command line on the folder of solved points."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("verb", choices=list(verbs))
    parser.add_argument("folder", type=Path)
    given = parser.parse_args()
    verbs[given.verb](given.folder)


if __name__ == "__main__":
    run_verb(__doc__, {"solve": solve_missing, "list": show, "table": table, "check": check})
