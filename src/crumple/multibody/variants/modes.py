"""Which modes of collapse an impact may take if capacities, friction, contact or stiffness change a little.

Two runs have the same mode unless the final plastic rotation of a hinge differs by more than `APART` of the
largest rotation of all runs, and by more than `ROOM`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from crumple.multibody.checks.collapse import NOTHING, PART, patterns
from crumple.multibody.run import Cancel, Progress, Run
from crumple.multibody.variants.contact_points import contact_points
from crumple.multibody.variants.law_range import WIDEST, run_as_solved
from crumple.multibody.variants.variants import OTHER_PARTS, VariantTable, solve_variants
from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.result.nearby import Mode, Modes
from crumple.result.result import Result
from crumple.structure import (
    Structure,
    any_automatic,
    changed,
    plastic_hinges,
    value_at,
    with_elastic_members,
)

BAND = 0.05
"""Half-width for laws without a known band [-]."""
FRICTION = 0.25
"""Change of coefficients of friction [-]."""
STIFFNESS = 0.10
"""Change of Young's moduli [-]."""
APART = 0.3
"""Difference of a hinge's rotation between two modes over the largest rotation of all runs [-]."""
ROOM = math.radians(2.0)
"""Difference up to which two runs have the same mode in any case [rad]."""
SHORT = 1e-3
"""Slip of a hinge along its member below which it is not named [m]."""
YIELDS = 1e-3
"""Energy that members take between hinges over all that there is from which it is named [-]."""
RESULT = "as given"
"""Name of the run that is the result itself."""
Changes = dict[str, float]
"""Values [SI] or factors by path."""


def modes(
    structure: Structure,
    run: Run,
    result: Result,
    threads: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Modes | None:
    """Modes of collapse that appear beside that of a result.

    Parameters
    ----------
    structure, run
        As they were solved.
    result
        The complete result; its mode comes first.
    threads, progress, cancel
        As in `crumple.multibody.solve_variants`.

    Returns
    -------
    Modes or None
        None without an impact, with a single hinge, or where `mechanism_check` is off (``auto``: without
        automatic hinges).

    Raises
    ------
    CancelledError
        If it is cancelled.

    References
    ----------
    docs/theory/modes.md.  Verified in tests/unit/multibody/variants/test_modes.py.
    """
    run = run_as_solved(run, result)
    structure = with_elastic_members(structure, run.settings, run.time_in_motion)
    asked = run.settings.mechanism_check
    unasked = asked == "off" or (asked == "auto" and not any_automatic(structure))
    names = [hinge.name for hinge in plastic_hinges(structure)]
    if unasked or len(names) < 2 or not is_impact(structure, run):
        return None
    # nothing is changed in the first one, which leads the others
    runs: dict[str, Changes] = {RESULT: {}, **_capacities(structure), **_friction(structure)}
    runs |= contact_points(structure, run) | _stiffness(structure, run)
    table = solve_variants(structure, run, _columns(structure, runs), threads, progress, cancel, guided=True)
    table.need_all("the modes of collapse are")
    last = {name: channel.values[-1] for name, channel in result.channels.items()}
    found: dict[str, _Ended | None] = {}
    for i, (name, changes) in enumerate(runs.items()):
        if name == RESULT:
            found[name] = _ended(last, names)
        elif table.reason[i] == OTHER_PARTS:
            found[name] = _alone(changed(structure, changes), run, changes, threads, cancel)
        else:
            found[name] = _row(table, i, names) if table.status[i].ok else None
    ended = {name: one for name, one in found.items() if one is not None}
    folds = list(dict.fromkeys(hinge for one in ended.values() for hinge in one.rotations))
    sizes = {
        name: np.array([abs(one.rotations.get(hinge, 0.0)) for hinge in folds]) for name, one in ended.items()
    }
    slips = {name: one.slips for name, one in ended.items()}
    between = {name: one.between for name, one in ended.items()}
    return Modes(grouped(folds, sizes, slips, between), tuple(name for name in found if name not in ended))


@dataclass(frozen=True)
class _Ended:
    """Plastic rotations [rad] and slips along the members [m] of the hinges at the end of a run.

    And the energy that members took without hinges [J], 0 where dents, or next to nothing, may be all of it.
    """

    rotations: Mapping[str, float]
    slips: Mapping[str, float]
    between: float


def _ended(last: Mapping[str, float], hinges: list[str]) -> _Ended:
    """From the last values of channels by name."""
    slips = {name: last.get(f"hinge.{name}.slip.x.plastic_travel") for name in hinges}
    return _Ended(
        {name: float(last[f"hinge.{name}.plastic_rotation"]) for name in hinges},
        {name: float(slip) for name, slip in slips.items() if slip is not None},
        _between(last, hinges),
    )


def _between(last: Mapping[str, float], hinges: list[str]) -> float:
    """Energy that members took without hinges [J], from the last values of channels by name."""
    absorbed = float(last.get("energy.dissipated", 0.0))
    rest = absorbed - sum(float(last.get(f"hinge.{name}.energy", 0.0)) for name in hinges)
    dents = any(value > 0.0 for name, value in last.items() if name.endswith(".dent"))
    given = absorbed + float(last.get("energy.kinetic", 0.0))
    return rest if not dents and rest > YIELDS * given else 0.0


def _row(table: VariantTable, row: int, hinges: list[str]) -> _Ended:
    return _ended({name: values[row] for name, values in table.quantities.items()}, hinges)


def _alone(
    structure: Structure, run: Run, changes: Changes, threads: int | None, cancel: Cancel | None
) -> _Ended | None:
    """The end of a run whose parts no batch has: an obstacle that strikes elsewhere folds another place."""
    table = solve_variants(structure, run, changes, threads, None, cancel)
    table.need_all("the modes of collapse are")
    names = [hinge.name for hinge in plastic_hinges(structure)]
    return _row(table, 0, names) if table.status[0].ok else None


def is_impact(structure: Structure, run: Run) -> bool:
    """Whether something is thrown, or meets an obstacle, with inertia."""
    thrown = bool(structure.initial_velocity or structure.impulses)
    if not run.stages:
        return thrown or bool(structure.obstacles)
    dynamic = [stage for stage in run.stages if stage.kind == "dynamic"]
    met = any(stage.obstacles is None or stage.obstacles for stage in dynamic) and bool(structure.obstacles)
    return bool(dynamic) and (thrown or met or any(s.initial_velocity or s.impulses for s in dynamic))


def grouped(
    names: list[str],
    ended: Mapping[str, Floats],
    slips: Mapping[str, Mapping[str, float]] | None = None,
    between: Mapping[str, float] | None = None,
) -> tuple[Mode, ...]:
    """Runs by mode.

    Parameters
    ----------
    names
        Of the hinges.
    ended
        Rotations at the end of each run [rad], without sign, in the order of the hinges' names.
    slips
        Slips of hinges along their members at the end of each run [m].
    between
        Energy that members took without hinges in each run [J].
    """
    largest = max(float(values.max()) for values in ended.values())
    apart = max(APART * largest, ROOM)
    groups: list[tuple[Floats, list[str]]] = []
    for name, values in ended.items():
        for first, runs in groups:
            if float(np.abs(values - first).max()) <= apart:
                runs.append(name)
                break
        else:
            groups.append((values, [name]))
    found = (_mode(names, first, (slips or {}).get(runs[0], {}), runs, largest) for first, runs in groups)
    return tuple(
        mode if mode.hinges or mode.slips else replace(mode, between=(between or {}).get(mode.runs[0], 0.0))
        for mode in found
    )


def _mode(
    names: list[str], turned: Floats, slips: Mapping[str, float], runs: list[str], largest: float
) -> Mode:
    """A mode by what its first run has; `largest`: rotation of all runs [rad]."""
    own = float(turned.max())
    small = own <= PART * largest or own <= NOTHING
    part = max(PART * (own if small else largest), NOTHING)
    order = largest_first({k: float(value) for k, value in enumerate(turned) if value > part})
    crushed: list[str] = []
    if small:
        sizes = {name: abs(slip) for name, slip in slips.items()}
        least = max(PART * max(sizes.values(), default=0.0), SHORT)
        crushed = largest_first({name: size for name, size in sizes.items() if size > least})
    return Mode(
        tuple(names[k] for k in order),
        tuple(float(turned[k]) for k in order),
        tuple(runs),
        tuple((name, slips[name]) for name in crushed),
    )


def _columns(structure: Structure, runs: Mapping[str, Changes]) -> dict[str, Floats]:
    """One value per run of everything that any of them changes."""
    paths = dict.fromkeys(path for changes in runs.values() for path in changes)
    columns = {}
    for path in paths:
        rest = 1.0 if path.startswith("hinges.") else value_at(structure, path)
        columns[path] = np.array([changes.get(path, rest) for changes in runs.values()])
    return columns


def _capacities(structure: Structure) -> dict[str, Changes]:
    """Laws at the edges of their bands: alternately along the structure, at random, and both reversed."""
    hinges = plastic_hinges(structure)
    widths = [min(hinge.law.validity.uncertainty or BAND, WIDEST) for hinge in hinges]
    return {
        f"capacities {name}": {
            f"hinges.{hinge.name}.capacity": 1.0 + float(sign) * width
            for hinge, sign, width in zip(hinges, signs, widths, strict=True)
        }
        for name, signs in patterns(len(hinges)).items()
    }


def _friction(structure: Structure) -> dict[str, Changes]:
    given = {
        f"obstacles.{name}.friction": o.friction for name, o in structure.obstacles.items() if o.friction
    }
    if structure.member_contact is not None and structure.member_contact.friction:
        given["member_contact.friction"] = structure.member_contact.friction
    if not given:
        return {}
    return {
        "less friction": {path: value * (1.0 - FRICTION) for path, value in given.items()},
        "more friction": {path: value * (1.0 + FRICTION) for path, value in given.items()},
    }


def _stiffness(structure: Structure, run: Run) -> dict[str, Changes]:
    """None where nothing is elastic."""
    bends = run.settings.members == "elastic" or any(member.elastic for member in structure.members.values())
    springs = any(math.isfinite(hinge.record.elastic_stiffness) for hinge in plastic_hinges(structure))
    if not (bends or springs):
        return {}
    moduli = {f"materials.{name}.youngs_modulus": m.youngs_modulus for name, m in structure.materials.items()}
    return {
        "less stiff": {path: value * (1.0 - STIFFNESS) for path, value in moduli.items()},
        "stiffer": {path: value * (1.0 + STIFFNESS) for path, value in moduli.items()},
    }
