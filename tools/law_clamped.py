"""Bending laws of tubes beside a clamp: which cantilevers are solved, and with what result.

    python -m tools.law_clamped solve tools/tube_library     solve what is missing; may be stopped at any time
    python -m tools.law_clamped table tools/tube_library     fit, and write the tables that are shipped
    python -m tools.law_clamped short tools/tube_library     the same of short cantilevers
    python -m tools.law_clamped place tools/tube_library     the same of the places of folds

A cantilever is clamped at one end; its tip is driven across, and free to turn and to move along.  With the
moment M and the force F at the clamp, a hinge at x from the clamp (`fold_distance`: where candidates are)
has the moment M - F x, and turns by the plastic rotation of the two half folds g beside the clamp:

    rotation of the section at g  -  (M g - F g^2/2)/(E I)

up to the largest moment, and from there on by as much as the tip, whose elastic rotation is F L^2/(2 E I):
the fold may lie further from the clamp.  Bending beyond is that of the member.

Of round tubes four without hardening and the four of the library are fitted on the nominal mesh; five of
them, and the tubes of the library with hardening, on the coarse mesh; held out are two tubes without
hardening and three with it.  Of rectangular tubes all points of the library are solved, with the same meshes
and the same ones held out.  Nobody chooses anything by the tubes that are held out.
"""

from __future__ import annotations

import json
import math
import time
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from tools.law_design import COARSE, NOMINAL, Kind, Point, Role, points
from tools.law_fit import KNOTS, Solved
from tools.law_library import (
    HELD_OUT,
    LARGEST,
    PLACE,
    error_of,
    fits_of,
    percents,
    run_verb,
    write_table,
)

from crumple.analysis import Analysis, solve
from crumple.characterisation.curve import law_curve
from crumple.characterisation.resolution import Resolution
from crumple.hinge.tube_library.clamped import TABLES
from crumple.numeric.arrays import Floats
from crumple.section import Section, fold_distance, half_fold_length
from crumple.structure import Structure

METHOD = "clamped cantilevers, driven across at their tips, docs/theory/tube_library.md"
LENGTH = {"circular_tube": 8.0, "rectangular_tube": 6.0}
"""Length of the cantilevers over the diameter or the larger side."""
SHORT = (4.0, 2.5)
"""The same of short cantilevers of rectangular tubes, in whose folds the moment falls faster."""
PLACED = (math.radians(8.0), math.radians(25.0))
"""Plastic rotations of the tip over which the place of its fold is taken."""
PLACES = {kind: f"place_in_{name}" for kind, name in TABLES.items()}
"""Names of the tables of places of folds, by kind of section."""
END = math.radians(42.0)
"""Rotation of the chord of the tip at the end."""
SLOWNESS = {"circular_tube": 5.0, "rectangular_tube": 4.0}
"""As in `Resolution`, of the whole cantilever."""
ROUND: Kind = "circular_tube"
PLASTIC = ((17.0, 0.0032), (24.0, 0.0013), (40.0, 0.0017), (57.0, 0.0028))
"""Fitted tubes without hardening: diameter over wall, yield strain."""
SEED = 20263
"""Of the two tubes without hardening that are held out: uniform in the logarithms of the range."""
HARDENED_HELD_OUT = ("held-out-03", "held-out-05", "held-out-06")
"""Of the held-out round tubes of the library with hardening, those that are solved."""
PAIRS = ("plastic-training-01", "plastic-training-03", "mesh-01", "mesh-02", "mesh-03")
"""Round tubes that are solved on both meshes."""


def design(kind: Kind) -> tuple[Point, ...]:
    """Cantilevers in the order of solution; their names are those of the free tubes."""
    own = [one for one in points() if one.kind == kind]
    return _round(own) if kind == ROUND else tuple(own)


def short_design() -> tuple[Point, ...]:
    """Rectangular tubes whose short cantilevers are solved: those on the coarse mesh, and held-out ones."""
    roles = ("training", "former", "strong", *HELD_OUT)
    return tuple(one for one in design("rectangular_tube") if one.role in roles)


def _round(own: list[Point]) -> tuple[Point, ...]:
    strong = [one for one in own if one.role == "strong"]
    free = {one.name: one for one in own if one.elements == NOMINAL}
    mesh = [one for one in free.values() if one.role == "mesh"]
    hardened = [one for one in free.values() if one.role == "hardened"]
    plastic = [_plastic("training", number, *place) for number, place in enumerate(PLASTIC)]
    pairs = [one for one in (*plastic, *mesh) if one.name.removeprefix(f"{ROUND}-") in PAIRS]
    random = np.random.default_rng(SEED).uniform(size=(2, 2))
    places = [(15.0 * 4.0**a, 0.0012 * (0.004 / 0.0012) ** b) for a, b in random]
    held_out = [_plastic("held-out", number, *place) for number, place in enumerate(places)]
    coarse = [replace(one, name=f"{one.name}-coarse", elements=COARSE) for one in (*pairs, *hardened)]
    hardened_held_out = (free[f"{ROUND}-{name}"] for name in HARDENED_HELD_OUT)
    return (*plastic, *mesh, *coarse, *strong, *held_out, *hardened_held_out)


def _plastic(role: Role, number: int, slenderness: float, strain: float) -> Point:
    name = f"{ROUND}-plastic-{role}-{number:02d}"
    return Point(name, ROUND, role, round(slenderness, 6), 1.0, round(strain, 6), 1.0, NOMINAL)


def cantilever(point: Point, sides_long: float | None = None) -> Analysis:
    """Cantilever of a tube, its tip driven across; `LENGTH` or so many of its larger side long."""
    section, material = point.section, point.material
    sides = _sides(section)
    half, length = half_fold_length(section), (sides_long or LENGTH[point.kind]) * max(sides)
    duration = Resolution(slowness=SLOWNESS[point.kind]).duration(section, material, "y", length, END)
    drive = {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": -length * math.sin(END)}
    return Analysis(
        structure=Structure(
            materials={"metal": material},
            sections={"tube": section},
            nodes={"foot": (0.0, 0.0, 0.0), "tip": (length, 0.0, 0.0)},
            members={"arm": {"nodes": ("foot", "tip"), "section": "tube", "material": "metal"}},
            supports={
                "foot": {"node": "foot", "fix": "all"},
                "tip": {"node": "tip", "fix": ["y", "rx", "rz"], "motion": {"z": {"havsin": drive}}},
            },
        ),
        duration=duration,
        shell={
            "element_size": max(min(sides) / 5.0, half / point.elements),
            "fine_size": half / point.elements,
            "fine_length": 3.0 * half,
        },
        outputs={
            "every": duration / 400.0,
            "nodes": ["tip"],
            "section_rotations": {"fold": {"member": "arm", "from": 0.0, "to": 2.0 * half}},
        },
    )


def _sides(section: Section) -> tuple[float, float]:
    """Width and depth, or the diameter twice [m]."""
    low, high = section.outline().min(axis=0), section.outline().max(axis=0)
    return tuple((high - low).tolist())


def histories(point: Point, analysis: Analysis) -> dict[str, list[float]]:
    """Plastic rotation of fold and tip [rad], M/M_p at the hinge, deflection over length, work [J]."""
    section, material = point.section, point.material
    result = solve(analysis, "shell", threads=1)
    reach, length = 2.0 * half_fold_length(section), float(analysis.structure.frame_of("arm").length)
    rigidity = material.youngs_modulus * section.second_moment("y")
    moment, force = (np.abs(result[f"support.foot.{name}"]) for name in ("moment.y", "force.z"))
    down, turned = (np.abs(result[f"node.tip.{name}"]) for name in ("displacement.z", "rotation.y"))
    found = {
        "fold": np.abs(result["fold"]) - (moment * reach - force * reach**2 / 2.0) / rigidity,
        "moment": (moment - force * fold_distance(section))
        / (material.yield_stress * section.plastic_section_modulus("y")),
        "tip": turned - force * length**2 / (2.0 * rigidity),
        "down": down / length,
        "work": result["energy.external_work"],
    }
    return {name: [float(f"{one:.5g}") for one in values] for name, values in found.items()}


def solve_missing(folder: Path) -> None:
    """Solve the cantilevers that the folder lacks."""
    for point in (point for kind in TABLES for point in design(kind)):
        _solve(folder / f"clamped-{point.name}.json", point, cantilever(point))
    for point in short_design():
        for length in SHORT:
            _solve(folder / f"short-{length:g}-{point.name}.json", point, cantilever(point, length))


def _solve(path: Path, point: Point, analysis: Analysis) -> None:
    if not path.exists():
        begun = time.process_time()
        found = {"point": asdict(point), "histories": histories(point, analysis)}
        path.write_text(json.dumps(found) + "\n")
        print(f"{path.stem} {time.process_time() - begun:.0f} s", flush=True)


def read(folder: Path, kind: Kind, *, held_out: bool) -> list[Solved]:
    """Solved cantilevers."""
    found = []
    for point in design(kind):
        if (point.role in HELD_OUT) is held_out:
            found.append(_solved(folder / f"clamped-{point.name}.json"))
    return found


def _solved(path: Path) -> Solved:
    stored = json.loads(path.read_text())
    own = stored["histories"]
    curve = law_curve(fold_rotation(own), np.array(own["moment"]), LARGEST)
    return Solved(stored["point"], curve.rotation, curve.moment)


def fold_rotation(own: dict[str, list[float]]) -> Floats:
    """Plastic rotation of the fold of a cantilever [rad], wherever it is.

    Up to the largest moment walls yield over a length of the member, of which the fold has the part beside
    the clamp.  From there on only the fold turns, and the rest of the member is elastic.
    """
    fold, tip = np.array(own["fold"]), np.array(own["tip"])
    peak = int(np.argmax(own["moment"]))
    return np.asarray(np.concatenate([fold[:peak], fold[peak] + tip[peak:] - tip[peak]]))


def read_short(folder: Path, *, held_out: bool) -> list[Solved]:
    """Of each tube with short cantilevers how its moment grows: e^s at every rotation, see `short`."""
    found = []
    for point in short_design():
        if (point.role in HELD_OUT) is held_out:
            long = _solved(folder / f"clamped-{point.name}.json").on_knots
            logs = [
                np.log(_solved(folder / f"short-{one:g}-{point.name}.json").on_knots / long) for one in SHORT
            ]
            shorter = np.array([1.0 / one - 1.0 / LENGTH[point.kind] for one in SHORT])
            slope = shorter @ np.array(logs) / (shorter @ shorter)
            # each tube was solved on one mesh, so the fit has no step
            own = asdict(replace(point, elements=NOMINAL))
            found.append(Solved(own, np.radians(KNOTS), np.exp(slope)))
    return found


def short(folder: Path) -> None:
    """Fit and write the table of short spans: s of M/M_6 = exp(s (D/a - 1/6)), with D the larger side."""
    fitted, held_out = (read_short(folder, held_out=out) for out in (False, True))
    provenance = {"method": f"{METHOD}; of 4 and 2.5 larger sides over those of 6", "imperfection": "none"}
    fits = fits_of("clamped_rectangular_tube", "rectangular_tube", fitted)
    found = write_table("short_rectangular_tube", "rectangular_tube", provenance, fits, (fitted, held_out))
    for one, own in zip((*fitted, *held_out), found.facts["points"], strict=True):
        place = " ".join(f"{own[key]:8.4g}" for key in PLACE)
        print(f"{own['role']:9} {place}   {percents(np.array(own.get('left_out', error_of(found, one))))}")


def read_places(folder: Path, kind: Kind, *, held_out: bool) -> list[Solved]:
    """Place of the fold of each cantilever, its distance from the clamp over half a fold, at every rotation.

    Member and fold turn the tip by p and deflect it by w, both plastic, about the place L - w/sin p: its
    mean over the rotations `PLACED`.
    """
    found = []
    for point in design(kind):
        if (point.role in HELD_OUT) is held_out:
            own = json.loads((folder / f"clamped-{point.name}.json").read_text())["histories"]
            section, material = point.section, point.material
            length, half = LENGTH[kind] * max(_sides(section)), half_fold_length(section)
            force = np.array(own["moment"]) * material.yield_stress * section.plastic_section_modulus("y")
            force /= length - fold_distance(section)
            bent = force * length**3 / (3.0 * material.youngs_modulus * section.second_moment("y"))
            turned, down = np.array(own["tip"]), np.array(own["down"]) * length - bent
            chosen = (turned >= PLACED[0]) & (turned <= PLACED[1])
            about = length - float((down[chosen] / np.sin(turned[chosen])).mean())
            found.append(Solved(asdict(point), np.radians(KNOTS), np.full(KNOTS.size, about / half)))
    return found


def place(folder: Path) -> None:
    """Fit and write the tables of the places of folds, with errors of places."""
    for kind, name in PLACES.items():
        fitted, held_out = (read_places(folder, kind, held_out=out) for out in (False, True))
        provenance = {"method": f"{METHOD}: place of the fold over half its length", "imperfection": "none"}
        fits = fits_of(TABLES[kind], kind, fitted)
        found = write_table(name, kind, provenance, fits, (fitted, held_out), columns=1)
        for one, own in zip((*fitted, *held_out), found.facts["points"], strict=True):
            where = " ".join(f"{own[key]:8.4g}" for key in PLACE)
            error = own.get("left_out", error_of(found, one))[0]
            print(f"{own['role']:9} {where}   {one.moment[0]:5.2f} {100.0 * error:+6.1f} %")


def table(folder: Path) -> None:
    """Fit and write the tables, with errors at tubes that were left out or held out."""
    for kind, name in TABLES.items():
        fitted, held_out = (read(folder, kind, held_out=out) for out in (False, True))
        provenance = {"method": METHOD, "imperfection": "none"}
        found = write_table(name, kind, provenance, fits_of(name, kind, fitted), (fitted, held_out))
        for one, own in zip((*fitted, *held_out), found.facts["points"], strict=True):
            errors = own.get("left_out", error_of(found, one))
            place = " ".join(f"{own[key]:8.4g}" for key in PLACE)
            print(f"{own['role']:9} {place}   {percents(errors)}")


if __name__ == "__main__":
    run_verb(__doc__, {"solve": solve_missing, "table": table, "short": short, "place": place})
