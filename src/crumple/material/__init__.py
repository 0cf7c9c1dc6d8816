"""What the metal does: elasticity, hardening, yield and flow stress, strain-rate law, named grades."""

from crumple.material.flow_stress import (
    bending_flow_stress,
    mean_flow_stress,
    membrane_flow_stress,
    power_law_flow_stress,
)
from crumple.material.grades import Evidence, FlowRule, Grade, grade, grade_curve, grade_material, grades
from crumple.material.hardening.curve import HardeningCurve
from crumple.material.hardening.perfectly_plastic import PerfectlyPlastic
from crumple.material.hardening.swift import Swift, swift_from_tensile_test
from crumple.material.hardening.table import HardeningTable
from crumple.material.hardening.voce import Voce
from crumple.material.material import Material
from crumple.material.rate import CowperSymonds, JohnsonCook, RateLaw

__all__ = [
    "CowperSymonds",
    "Evidence",
    "FlowRule",
    "Grade",
    "HardeningCurve",
    "HardeningTable",
    "JohnsonCook",
    "Material",
    "PerfectlyPlastic",
    "RateLaw",
    "Swift",
    "Voce",
    "bending_flow_stress",
    "grade",
    "grade_curve",
    "grade_material",
    "grades",
    "mean_flow_stress",
    "membrane_flow_stress",
    "power_law_flow_stress",
    "swift_from_tensile_test",
]
