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
from dataclasses import asdict, replace
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
    THICKEST,
    TRAINING,
    YIELD_STRAIN,
    Point,
    Role,
    points,
)
from tools.law_fit import AT, KNOTS, Solved, best_fit, energy_of, rounded

from crumple.analysis import solve
from crumple.characterisation import Bending
from crumple.characterisation.needed import Needed
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import ATTEMPTS, MOST_KINETIC, kinetic_share
from crumple.errors import CrumpleError
from crumple.hinge.tube_library.table import Coordinate, tube_table
from crumple.hinge.tube_library.tube import coordinate
from crumple.numeric.arrays import Floats
from crumple.version import __version__

LARGEST = math.radians(40.0)
"""Plastic rotation at which the laws end."""

PLACE = ("slenderness", "ratio", "yield_strain", "hardening")
ROLES: tuple[Role, ...] = ("training", "earlier", "former", "mesh")
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
BAND = {"rectangular_tube": 0.3, "circular_tube": 0.3}
"""Relative half-width of the band of the moment: docs/theory/tube_library.md."""
METAL = (
    Coordinate("yield_strain", *YIELD_STRAIN, True),
    Coordinate("hardening", *HARDENING, True),
    Coordinate("mesh", 1.0 / NOMINAL, 1.0 / COARSE, False),
)
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
        (Coordinate("slenderness", *SLENDERNESS, True), *METAL),
        (Coordinate("flange_buckling", *BUCKLING, True), *METAL),
    ),
}
"""Coordinates that are tried; leaving one out chooses."""


def model(point: Point, slowness: float = Resolution().slowness) -> Bending:
    """Sub-model of a point."""
    resolution = Resolution(point.elements, slowness)
    return Bending(point.section, point.material, largest=LARGEST, resolution=resolution)


def answer(point: Point) -> dict[str, Any]:
    """Law of a point over its plastic moment, or why it has none.

    The histories are kept, so that a law can be read from them in another way.
    """
    one = model(point)
    plastic_moment = point.material.yield_stress * point.section.plastic_section_modulus("y")
    found: dict[str, Any] = {"point": asdict(point), "crumple": __version__}
    begun = time.process_time()
    for attempt in range(ATTEMPTS):
        result = solve(one.analysis(), "shell", 1)
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
            curve = one.curve(result)
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
        training = [one for role in ROLES for one in read(folder, kind, role)]
        held_out = [one for role in HELD_OUT for one in read(folder, kind, role)]
        moments = np.stack([one.on_knots for one in training])
        fits = [
            best_fit(coordinates, np.stack([columns(coordinates, one) for one in training]), moments)
            for coordinates in CHOICES[kind]
        ]
        fit = min(fits, key=lambda one: float((one.left_out**2).sum()))
        for one in fits:
            keys = [coordinate.key for coordinate in one.coordinates]
            print(kind, keys, f"degree {one.degree}, noise {one.noise:.2g}, lengths {one.lengths.round(2)}")
            print(f"  left out, root mean square {np.sqrt((one.left_out**2).mean()):.2%}")
        written = {
            "provenance": PROVENANCE | {"crumple": __version__, "elements along half a fold": COARSE},
            "coordinates": [asdict(one) for one in fit.coordinates],
            "ranges": ranges(kind),
            "rotation_deg": KNOTS.tolist(),
            "band": BAND[kind],
            "fit": {"degree": fit.degree, "noise": float(f"{fit.noise:.3g}")} | fit.entries,
            "points": [entry(one) for one in (*training, *held_out)],
        }
        path = Path(__file__).parent.parent / "src/crumple/hinge/tube_library" / f"{kind}.json"
        path.write_text(lines_of(written) + "\n")


def columns(coordinates: tuple[Coordinate, ...], one: Solved) -> Floats:
    """Values of the coordinates of a solved point."""
    place = one.point | {"mesh": 1.0 / one.point["elements"]}
    return np.array([coordinate(which, place) for which in coordinates])


def ranges(kind: str) -> dict[str, tuple[float, float]]:
    """Range of the table by name."""
    own = {"slenderness": SLENDERNESS, "yield_strain": YIELD_STRAIN, "hardening": HARDENING}
    return (
        own
        if kind == "circular_tube"
        else {**own, "slenderness": (THICKEST, SLENDERNESS[1]), "ratio": (DEEPEST, RATIO[1])}
    )


def entry(one: Solved) -> dict[str, Any]:
    """A solved point in the file of the table."""
    keys = ("name", "role", "slenderness", "ratio", "yield_strain", "hardening", "elements")
    numbers = {"moment": rounded(one.on_knots), "energy": rounded(one.energy)}
    return {key: one.point[key] for key in keys} | numbers


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
    """Errors of the written table at the points held out, and of the mesh of its points."""
    for kind in TRAINING:
        found = tube_table(kind)
        for role in (*ROLES, *HELD_OUT):
            print(f"{kind}, {role}: error of the energy up to {AT.tolist()} deg")
            errors = []
            for one in read(folder, kind, role):
                moment = found.moment(tuple(columns(found.coordinates, one).tolist()))
                errors.append(energy_of(found.rotation, moment) / one.energy - 1.0)
                if role != "training":
                    print(f"  {_row(one, errors[-1])}")
            if not errors:
                continue
            size = np.abs(np.array(errors))
            inside = " ".join(f"{share:.0%}" for share in (size <= 0.05).mean(axis=0))
            print(f"  within 5 %: {inside}; largest {' '.join(f'{one:.1%}' for one in size.max(axis=0))}")
        coarse = {one.point["name"]: one for one in read(folder, kind, "training")}
        print(f"{kind}: energy of the mesh of the library over that of the nominal one, less 1")
        for one in read(folder, kind, "mesh"):
            own = coarse.get(one.point["name"].replace("mesh", "training"))
            if own is not None:
                print(f"  {_row(one, own.energy / one.energy - 1.0)}")


def _row(one: Solved, errors: Floats) -> str:
    place = " ".join(f"{one.point[key]:8.4g}" for key in PLACE)
    return f"{place}   {' '.join(f'{100.0 * error:+6.1f}' for error in errors)} %"


def main() -> None:
    """Verbs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    verbs = {"solve": solve_missing, "list": show, "table": table, "check": check}
    parser.add_argument("verb", choices=list(verbs))
    parser.add_argument("folder", type=Path)
    given = parser.parse_args()
    verbs[given.verb](given.folder)


if __name__ == "__main__":
    main()
