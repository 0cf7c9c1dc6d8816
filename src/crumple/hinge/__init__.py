"""Section and material to collapse law, with a source and a range, and to the record of the stepper."""

from crumple.hinge.energy import absorbed_energy, rotation_absorbing
from crumple.hinge.jamming import AfterJamming
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.laws.constant import ConstantLaw
from crumple.hinge.laws.kecman import KecmanLaw, Start
from crumple.hinge.laws.tabulated import TabulatedLaw
from crumple.hinge.laws.wierzbicki import WierzbickiLaw
from crumple.hinge.rate import HingeRate
from crumple.hinge.record import Envelope, Form, HingeRecord
from crumple.hinge.recording import record_of, tributary_stiffness
from crumple.hinge.registry import build_law, law_options, law_types
from crumple.hinge.stop import Stop
from crumple.hinge.table import plastic_part, read_table

__all__ = [
    "AfterJamming",
    "ConstantLaw",
    "Envelope",
    "Form",
    "HingeLaw",
    "HingeRate",
    "HingeRecord",
    "KecmanLaw",
    "SofteningVariable",
    "Source",
    "Start",
    "Stop",
    "TabulatedLaw",
    "Trust",
    "Validity",
    "WierzbickiLaw",
    "absorbed_energy",
    "build_law",
    "law_options",
    "law_types",
    "plastic_part",
    "read_table",
    "record_of",
    "rotation_absorbing",
    "tributary_stiffness",
]
