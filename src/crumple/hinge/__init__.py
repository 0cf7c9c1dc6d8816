"""Collapse laws of a section and a material, with source and range, and their records for the solver."""

from crumple.hinge.axial.axial_collapse import AxialCollapse
from crumple.hinge.axial.axial_law import AxialLaw, CrushDistance, CrushRate, CrushValidity, absorbed_by
from crumple.hinge.band import Band, Bound, ScaledLaw, band_of
from crumple.hinge.bending.circular import CircularLaw
from crumple.hinge.bending.constant import ConstantLaw
from crumple.hinge.bending.jamming import AfterJamming
from crumple.hinge.bending.kecman import KecmanLaw, Start
from crumple.hinge.bending.oblique import ObliqueLaw
from crumple.hinge.bending.wierzbicki import WierzbickiLaw
from crumple.hinge.energy import absorbed_energy, rotation_absorbing
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.measured.law_file import read_law, stored_law, write_law
from crumple.hinge.measured.stored import StoredLaw, bounded
from crumple.hinge.measured.table import plastic_part, read_table
from crumple.hinge.measured.tabulated import TabulatedLaw
from crumple.hinge.rate import HingeRate
from crumple.hinge.record.record import Envelope, Form, HingeRecord
from crumple.hinge.record.recording import record_of, tributary_stiffness
from crumple.hinge.record.spatial_record import (
    Coupling,
    Freedom,
    HingeComponent,
    HingeSurface,
    SpatialHingeRecord,
)
from crumple.hinge.record.spatial_recording import spatial_record
from crumple.hinge.registry import (
    axial_law_types,
    build_axial_law,
    build_law,
    build_torsion_law,
    fitting_laws,
    law_options,
    law_types,
    needs_curve,
    torsion_law_types,
)
from crumple.hinge.stop import Stop
from crumple.hinge.torsion.torsion_law import TorsionLaw

__all__ = [
    "AfterJamming",
    "AxialCollapse",
    "AxialLaw",
    "Band",
    "Bound",
    "CircularLaw",
    "ConstantLaw",
    "Coupling",
    "CrushDistance",
    "CrushRate",
    "CrushValidity",
    "Envelope",
    "Form",
    "Freedom",
    "HingeComponent",
    "HingeLaw",
    "HingeRate",
    "HingeRecord",
    "HingeSurface",
    "KecmanLaw",
    "ObliqueLaw",
    "ScaledLaw",
    "SofteningVariable",
    "Source",
    "SpatialHingeRecord",
    "Start",
    "Stop",
    "StoredLaw",
    "TabulatedLaw",
    "TorsionLaw",
    "Trust",
    "Validity",
    "WierzbickiLaw",
    "absorbed_by",
    "absorbed_energy",
    "axial_law_types",
    "band_of",
    "bounded",
    "build_axial_law",
    "build_law",
    "build_torsion_law",
    "fitting_laws",
    "law_options",
    "law_types",
    "needs_curve",
    "plastic_part",
    "read_law",
    "read_table",
    "record_of",
    "rotation_absorbing",
    "spatial_record",
    "stored_law",
    "torsion_law_types",
    "tributary_stiffness",
    "write_law",
]
