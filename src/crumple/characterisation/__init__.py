"""Hinge laws from shells: sub-models of members and corners, solved slowly, measured, kept as law files."""

from crumple.characterisation.bending import Bending
from crumple.characterisation.crush import Crush
from crumple.characterisation.curve import LawCurve
from crumple.characterisation.out_of_plane import OutOfPlane
from crumple.characterisation.solving import Characterised, characterise
from crumple.characterisation.store import LawStore
from crumple.characterisation.t_joint import TJoint
from crumple.characterisation.torsion import Torsion

__all__ = [
    "Bending",
    "Characterised",
    "Crush",
    "LawCurve",
    "LawStore",
    "OutOfPlane",
    "TJoint",
    "Torsion",
    "characterise",
]
