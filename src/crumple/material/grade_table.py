"""The table of grades: values of the standards, each with the text in which it was read."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from crumple.material.rate import CowperSymonds


class Family(Enum):
    """What kind of metal; sets elastic constants and rate laws."""

    MILD_STEEL = "mild steel"
    HIGH_STRENGTH_STEEL = "high-strength steel"
    STAINLESS_STEEL = "stainless steel"
    ALUMINIUM = "aluminium"


RATES: dict[Family, tuple[CowperSymonds | None, CowperSymonds | None]] = {
    Family.MILD_STEEL: (CowperSymonds(40.4, 5.0), CowperSymonds(6844.0, 3.91)),
    Family.HIGH_STRENGTH_STEEL: (CowperSymonds(3200.0, 5.0), CowperSymonds(3200.0, 5.0)),
    Family.STAINLESS_STEEL: (CowperSymonds(100.0, 10.0), CowperSymonds(100.0, 10.0)),
    Family.ALUMINIUM: (CowperSymonds(6500.0, 4.0), CowperSymonds(6500.0, 4.0)),
}
"""Pairs at yield and at flow, widely used; their original sources were not read; only mild steel has two
pairs."""


NECKING: dict[Family, tuple[float, float]] = {
    Family.MILD_STEEL: (0.60, 1.00),
    Family.HIGH_STRENGTH_STEEL: (0.60, 1.00),
    Family.STAINLESS_STEEL: (0.75, 1.00),
    Family.ALUMINIUM: (0.52, 0.98),
}
"""True strain at which necking begins, a (b - yield/ultimate): m_2 of ASME BPVC VIII-3 table KM-620 (the
same in VIII-2 annex 3-D), which is the uniform strain of that code's stress-strain curves; read in a program
that reproduces the table and was checked with the edition of 2023 (github.com/nathanrboyer/ASME_Materials).
Stainless steel is the austenitic one."""


@dataclass(frozen=True)
class GradeEntry:
    """One row: stresses in MPa, elongation after fracture [-]."""

    family: Family
    yield_stress: float
    ultimate_stress: float
    elongation: float | None
    evidence: str
    citation: str
    note: str = ""
    also: tuple[str, ...] = ()
    elastic: tuple[float, float, float] | None = None


_STRUCTURAL = "EN 10025-2 table 7, in readle.co.uk/references/steel-grades-eurocodes.php"
_UP_TO_16 = "walls of 3 to 16 mm; below 3 mm the standard asks {} MPa ultimate"
_HOT = "EN 10149-2, in moopec.com/sphe-carbonated-steel-coil-washing"
_BELOW_3 = "elongation on 80 mm for walls below 3 mm"
_MILD, _HIGH = Family.MILD_STEEL, Family.HIGH_STRENGTH_STEEL

GRADES: dict[str, GradeEntry] = {
    "S235": GradeEntry(_MILD, 235, 360, None, "READ", _STRUCTURAL, "walls up to 16 mm", ("S235JR", "1.0038")),
    "S275": GradeEntry(
        _MILD, 275, 410, None, "READ", _STRUCTURAL, _UP_TO_16.format(430), ("S275JR", "1.0044")
    ),
    "S355": GradeEntry(
        _MILD, 355, 470, None, "READ", _STRUCTURAL, _UP_TO_16.format(510), ("S355J2", "S355JR")
    ),
    "S315MC": GradeEntry(_HIGH, 315, 390, 0.20, "READ", _HOT, _BELOW_3, ("1.0972",)),
    "S355MC": GradeEntry(_HIGH, 355, 430, 0.19, "READ", _HOT, _BELOW_3, ("1.0976",)),
    "S420MC": GradeEntry(_HIGH, 420, 480, 0.16, "READ", _HOT, _BELOW_3, ("1.0980",)),
    "S500MC": GradeEntry(_HIGH, 500, 550, 0.12, "READ", _HOT, _BELOW_3, ("1.0984",)),
    "DC04": GradeEntry(
        _MILD,
        210,
        270,
        0.38,
        "READ",
        "EN 10130:1999, in scribd.com/document/93314079",
        "the standard has only an upper limit of yield, 210 MPa; delivered sheet is below it",
        ("1.0338",),
    ),
    "HSLA 340": GradeEntry(
        _HIGH,
        340,
        410,
        0.21,
        "READ",
        "HC340LA of EN 10268:2006+A1:2013, in tatasteeleurope.com/ts/node/5636",
        "across the rolling direction",
        ("HC340LA", "H340LA", "HX340LAD"),
    ),
    "HSLA 420": GradeEntry(
        _HIGH,
        420,
        470,
        0.17,
        "QUOTED",
        "HC420LA of EN 10268:2006+A1:2013",
        "across the rolling direction; the designation itself states the yield stress",
        ("HC420LA", "HX420LAD"),
    ),
    "DP600": GradeEntry(
        _HIGH,
        330,
        590,
        None,
        "DESIGNATION",
        "HCT590X of EN 10338:2015 = CR330Y590T-DP of VDA 239-100, in tatasteeluk.com, dp600-hct590x",
        "hardens much: before forming and paint baking",
        ("HCT590X", "HCT600X", "CR330Y590T-DP", "DP 600"),
    ),
    "DP780": GradeEntry(
        _HIGH,
        440,
        780,
        0.14,
        "READ",
        "HCT780X of EN 10338:2015, in salzgitter-flachstahl.de, hct780xxtend",
        "hardens much: before forming and paint baking",
        ("HCT780X", "DP800", "CR440Y780T-DP"),
    ),
    "22MnB5": GradeEntry(
        _HIGH,
        950,
        1300,
        None,
        "READ",
        "press hardened, least values in ahssinsights.org, PHS grades",
        "hardened state; it may crack in tight folds, which no hinge law here represents",
        ("PHS1500", "1.5528", "Usibor 1500"),
    ),
    "1.4301": GradeEntry(
        Family.STAINLESS_STEEL,
        230,
        540,
        0.45,
        "QUOTED",
        "EN 10088-2, cold rolled strip",
        "hardens strongly and over large strains; in folds its strength is above the proof stress",
        ("304", "AISI 304", "X5CrNi18-10"),
    ),
    "6060-T6": GradeEntry(
        Family.ALUMINIUM,
        150,
        190,
        0.08,
        "READ",
        "EN 755-2 extruded profiles, in scribd.com/document/433597598",
        "walls up to 3 mm",
        ("EN AW-6060 T6", "6060"),
        (69.5e9, 0.33, 2700.0),
    ),
    "6082-T6": GradeEntry(
        Family.ALUMINIUM,
        250,
        290,
        0.08,
        "QUOTED",
        "EN 755-2 extruded profiles, walls up to 5 mm",
        "it may crack in tight folds, which no hinge law here represents",
        ("EN AW-6082 T6", "6082"),
    ),
}
"""Grades by name; names are unique after dropping everything but letters and digits."""
