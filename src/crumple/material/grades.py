"""Named grades: minimum values of the standards, for a first model.

The values are typical, not design values.  A standard gives limits that every delivery keeps, so real metal
is mostly stronger; the structure is then stronger than the model, and its crushing forces are higher.  Where
only an upper limit of yield exists (deep drawing steel) that is used, with a note.  Every entry gives the
source of its numbers; `QUOTED` marks those whose text was not seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

from crumple.errors import InputError, Problem
from crumple.material.flow_stress import mean_flow_stress
from crumple.material.grade_table import GRADES, NECKING, RATES, Family, GradeEntry
from crumple.material.hardening.swift import Swift, swift_from_tensile_test
from crumple.material.material import Material


class Evidence(Enum):
    """How the numbers of a grade are known."""

    READ = "limits of the standard or the manufacturer, read in the text named"
    DESIGNATION = "limits that the standard's designation itself states"
    QUOTED = "limits as widely quoted, not read in the standard"


class FlowRule(Enum):
    """Which stress folds work against."""

    CURVE = "curve"
    """Hardening curve of the grade, see `grade_curve`."""
    MEAN = "mean"
    """(yield + ultimate)/2; a rule in common use."""
    ULTIMATE = "ultimate"
    """Nominal ultimate strength, as Kecman-type mechanisms take it."""
    YIELD = "yield"
    """Yield stress: no hardening."""


@dataclass(frozen=True)
class Grade:
    """One grade of the table.

    Attributes
    ----------
    name
        As in the table; other spellings are accepted by `grade`.
    material
        Metal with yield and ultimate stress, and the hardening curve that follows from them; no rate law.
    elongation
        Least elongation after fracture [-], or None where no text with it was read.
    citation
        Standard and where its limits were read.
    evidence
        How far to trust the numbers.
    note
        What else to know, in one sentence.
    """

    name: str
    material: Material
    elongation: float | None
    citation: str
    evidence: Evidence
    note: str

    @property
    def statement(self) -> str:
        """One line for reports: kind and source of the values."""
        words = f"{self.name}: typical, not design values; {self.evidence.value} ({self.citation})"
        curve = "hardening from yield, ultimate stress and a typical uniform strain"
        return "; ".join(part for part in (words, curve, self.note) if part)


def grades() -> dict[str, Grade]:
    """Every grade by its name, in the order of the table."""
    return {name: _grade(name, entry) for name, entry in GRADES.items()}


def grade(name: str) -> Grade:
    """Return the grade of a name such as ``S355``, ``hsla-340`` or ``DP600``.

    Raises
    ------
    InputError
        If the name is unknown.
    """
    wanted = _plain(name)
    for known, entry in GRADES.items():
        if wanted in {_plain(spelling) for spelling in (known, *entry.also)}:
            return _grade(known, entry)
    raise InputError(
        Problem("unknown grade", repr(name)[:40], ", ".join(GRADES), "choose one of these", "grade")
    )


def grade_curve(
    name: str, yield_stress: float | None = None, ultimate_stress: float | None = None
) -> Swift | None:
    """Hardening curve of a grade: through its yield stress, necking at its ultimate stress.

    Parameters
    ----------
    name
        As for `grade`.
    yield_stress, ultimate_stress
        In place of the grade's [Pa].

    Returns
    -------
    Swift or None
        None where the ultimate stress is hardly above the yield stress: perfectly plastic.

    Raises
    ------
    InputError
        If the name is unknown.

    References
    ----------
    True strain at necking: ASME BPVC VIII-3 table KM-620 (`NECKING`), at most that of the elongation after
    fracture, which holds the neck too.  docs/theory/hardening.md.
    """
    entry = GRADES[grade(name).name]
    lowest = 1e6 * entry.yield_stress if yield_stress is None else yield_stress
    highest = 1e6 * entry.ultimate_stress if ultimate_stress is None else ultimate_stress
    return _curve(entry, lowest, highest)


def _curve(entry: GradeEntry, yield_stress: float, ultimate_stress: float) -> Swift | None:
    share, least = NECKING[entry.family]
    strain = share * (least - yield_stress / ultimate_stress)
    if entry.elongation is not None:
        strain = min(strain, math.log1p(entry.elongation))
    return (
        swift_from_tensile_test(yield_stress, ultimate_stress, math.expm1(strain)) if strain > 0.0 else None
    )


def grade_material(name: str, *, flow: FlowRule | str = FlowRule.CURVE, rate: bool = False) -> Material:
    """Material of a grade.

    Parameters
    ----------
    name
        As for `grade`.
    flow
        Rule of the flow stress.
    rate
        Whether the Cowper-Symonds pairs that are widely used for its family are added; they are quoted, not
        measured on this grade.

    Returns
    -------
    Material
        Named like the grade.

    Raises
    ------
    InputError
        If the name or the rule is unknown.
    """
    try:
        rule = FlowRule(flow)
    except ValueError:
        allowed = ", ".join(member.value for member in FlowRule)
        raise InputError(
            Problem("unknown flow rule", repr(flow), allowed, "choose one of these", "flow")
        ) from None
    found = grade(name)
    metal, entry = found.material, GRADES[found.name]
    stresses = {
        FlowRule.MEAN: mean_flow_stress(1e6 * entry.yield_stress, 1e6 * entry.ultimate_stress),
        FlowRule.ULTIMATE: 1e6 * entry.ultimate_stress,
    }
    curve = metal.hardening if rule is FlowRule.CURVE else None
    at_yield, at_flow = RATES[entry.family] if rate else (None, None)
    return replace(
        metal, given_flow_stress=stresses.get(rule), hardening=curve, yield_rate=at_yield, flow_rate=at_flow
    )


def _grade(name: str, entry: GradeEntry) -> Grade:
    modulus, ratio, density = entry.elastic or _ELASTIC[entry.family]
    yielding, ultimate = 1e6 * entry.yield_stress, 1e6 * entry.ultimate_stress
    curve = _curve(entry, yielding, ultimate)
    metal = Material(name, modulus, ratio, density, yielding, ultimate, hardening=curve)
    return Grade(name, metal, entry.elongation, entry.citation, Evidence[entry.evidence], entry.note)


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())


# Young's modulus [Pa], Poisson's ratio [-], density [kg/m^3]: usual values of the family
_ELASTIC = {
    Family.MILD_STEEL: (210e9, 0.3, 7850.0),
    Family.HIGH_STRENGTH_STEEL: (210e9, 0.3, 7850.0),
    Family.STAINLESS_STEEL: (193e9, 0.3, 7900.0),
    Family.ALUMINIUM: (70e9, 0.33, 2700.0),
}
