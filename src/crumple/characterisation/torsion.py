"""Sub-model that is twisted: a straight member of a closed section between two rigid ends.

Every section carries the same torque, and the fold forms where it will.  The rotation of the law is that of
the whole length less the elastic one, so it does not matter where it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution
from crumple.characterisation.sub_model import Histories, is_mirrored, largest_side
from crumple.errors import InputError, Problem
from crumple.hinge.measured.place_hash import Load, place_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import AXES, Section, plastic_interaction, walls_of
from crumple.structure import Structure

SIDES = 4.0
"""Length between the rigid ends over the largest side of the section."""
KINK = math.radians(0.2)
"""Angle by which the two halves meet: without it a round tube is too perfect to fold [rad]."""
OUTPUTS = 400
"""Points in time at which the sub-model is measured."""
OVERSHOOT = 1.05
"""End rotation less the elastic one, over the plastic rotation of the law."""


@dataclass(frozen=True)
class Torsion:
    """A straight piece of a closed section, held at one end and twisted at the other, which may shorten.

    Attributes
    ----------
    section, material
        Of the piece.
    sense
        +1 or -1: sense of the twist about the member's axis.
    largest
        Plastic twist at which the law ends [rad].
    length_factor
        Length between the rigid ends over the usual one; others give the same law.
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/characterisation.md.
    """

    section: Section
    material: Material
    sense: int = 1
    largest: float = math.radians(30.0)
    length_factor: float = 1.0
    resolution: Resolution = NOMINAL

    def __post_init__(self) -> None:
        if not walls_of(self.section).skeleton.cells:
            what = "the torsion of an open section has no law of its own"
            todo = "its torque depends on where its ends are held against warping"
            raise InputError(Problem(what, self.section.title, "a closed section", todo))

    @property
    def load(self) -> Load:
        """Torsion."""
        return "torsion"

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.section.title}, torsion, sense {self.sense:+d}"

    @property
    def place(self) -> str:
        """Hash of the place."""
        return place_hash(self.section, self.material, load=self.load)

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        kink = f"kink of {math.degrees(KINK):.2g} deg in the middle"
        gauge = f"{1e3 * self.length:.4g} mm"
        torque = f"{self.plastic_torque:.5g} N m (closed form)"
        return {
            "section": self.section.title,
            "load": self.load,
            "gauge": gauge,
            "plastic_torque": torque,
            "imperfection": kink,
        }

    @property
    def one_law(self) -> bool:
        """A mirror image is twisted the other way."""
        return any(is_mirrored(self.section, axis) for axis in AXES)

    @property
    def watched_from(self) -> float:
        """Plastic twist [rad] from which the kinetic energy is watched."""
        return math.radians(2.0)

    @property
    def plastic_torque(self) -> float:
        """Closed form of the largest torque [N m]: Bredt with the shear yield stress, T_p = 2 A_m t k."""
        return float(plastic_interaction(self.section, self.material).plastic_torque)

    @property
    def size(self) -> float:
        """Length of the elements [m]: of the shorter of the bending folds."""
        return min(self.resolution.element_size(self.section, axis) for axis in AXES)

    @property
    def length(self) -> float:
        """Length between the rigid ends [m]."""
        return SIDES * self.length_factor * largest_side(self.section)

    @property
    def turn(self) -> float:
        """End rotation [rad]."""
        return OVERSHOOT * self.largest + 1.5 * self.plastic_torque * self._flexibility

    @property
    def duration(self) -> float:
        """T = slowness sqrt(m L^2 theta/T_p) [s], as for bending."""
        mass = self.section.mass_per_length(self.material.density) * self.length
        return self.resolution.slowness * self.length * math.sqrt(mass * self.turn / self.plastic_torque)

    @property
    def _flexibility(self) -> float:
        """Elastic twist over torque, L/(G J) [rad/(N m)]."""
        return self.length / (self.material.shear_modulus * self.section.torsion_constant)

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        half, duration = 0.5 * self.length, self.duration
        turning = {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": self.sense * self.turn}
        piece = {"section": "section", "material": "metal", "up": (0.0, 0.0, 1.0)}
        structure = Structure(
            materials={"metal": self.material},
            sections={"section": self.section},
            nodes={
                "held": (-half, 0.0, 0.0),
                "middle": (0.0, 0.0, half * math.tan(0.5 * KINK)),
                "turned": (half, 0.0, 0.0),
            },
            members={
                "first": {"nodes": ("held", "middle"), **piece},
                "second": {"nodes": ("middle", "turned"), **piece},
            },
            supports={
                "held": {"node": "held", "fix": "all"},
                "turned": {
                    "node": "turned",
                    "fix": ["y", "z", "ry", "rz"],
                    "motion": {"rx": {"havsin": turning}},
                },
            },
        )
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=structure,
            duration=duration,
            shell={"element_size": self.size},
            outputs={"every": duration / OUTPUTS, "nodes": ["turned"], "pictures": [duration]},
        )

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model: torque against plastic twist of the whole length."""
        twist, torque = self.histories(result)
        return law_curve(twist, torque, self.largest)

    def histories(self, result: Histories) -> tuple[Floats, Floats]:
        """Plastic twist [rad] and torque [N m] at the times of the result."""
        held, turned = (result[f"support.{name}.moment.x"] for name in ("held", "turned"))
        torque = 0.5 * self.sense * (held - turned)
        twist = self.sense * result["node.turned.rotation.x"]
        return np.asarray(twist - self._flexibility * torque), torque

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Nothing more."""
        return {}
