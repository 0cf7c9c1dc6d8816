"""Sub-model of a mitred corner that is loaded out of its plane.

Two pieces of one section meet at an angle.  One end is held, the other turned about the direction e in the
corner's plane that is perpendicular to the second piece, and free otherwise: the moment is along e
everywhere.  At a right angle it twists the first piece and bends the second one out of the plane; a moment
along the second piece does the same with the pieces exchanged, so both have one law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.bending import elastic_flexibility, second_piece
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution
from crumple.characterisation.sub_model import corner_piece, is_mirrored, largest_side
from crumple.errors import InputError, Problem
from crumple.hinge.measured.place_hash import CORNER, Load, place_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import Axis, Section, plastic_interaction
from crumple.structure import Structure

STUB = 2.75
"""Length of each piece over the largest side: one side is the corner's, the rest room for end effects."""
OUTPUTS = 400
"""Points in time at which it is measured."""
OVERSHOOT, ELASTIC_TURN = 1.05, math.radians(4.0)
"""End rotation over the plastic rotation of the law, and what is added to it."""
STRONG = 0.97
"""Moment over the plastic moment of the pieces from which these may yield too."""


@dataclass(frozen=True)
class OutOfPlane:
    """A mitred corner turned out of its plane.

    Attributes
    ----------
    section, material
        Of both pieces; the section must be its own mirror image about the corner's plane.
    axis
        Axis of the section that is normal to the corner's plane.
    angle
        Angle between the axes of the pieces [rad].
    largest
        Plastic rotation at which the law ends [rad].
    length_factor
        Length of the pieces over the usual one.
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/characterisation.md.
    """

    section: Section
    material: Material
    axis: Axis = "y"
    angle: float = math.pi / 2.0
    largest: float = math.radians(30.0)
    length_factor: float = 1.0
    resolution: Resolution = NOMINAL

    def __post_init__(self) -> None:
        if not is_mirrored(self.section, self._across):
            what = "the section is not its own mirror image about the corner's plane"
            raise InputError(Problem(what, self.section.title, "a symmetric section"))

    @property
    def load(self) -> Load:
        """Out of the corner's plane."""
        return "out-of-plane"

    @property
    def sense(self) -> int:
        """Both senses are mirror images."""
        return 1

    @property
    def one_law(self) -> bool:
        """Both senses are mirror images."""
        return True

    @property
    def title(self) -> str:
        """One line for people."""
        angle = f"{math.degrees(self.angle):.4g} deg"
        return f"{self.section.title}, corner of {angle} with normal {self.axis}, out of its plane"

    @property
    def place(self) -> str:
        """Hash of the place."""
        return place_hash(self.section, self.material, self.axis, self.angle, load=self.load)

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        angle = f"{math.degrees(self.angle):.6g} deg"
        return {
            "section": self.section.title,
            "axis": self.axis,
            "load": self.load,
            CORNER: angle,
            "gauge": f"{1e3 * self.length:.4g} mm, both pieces",
            "imperfection": "none",
        }

    @property
    def watched_from(self) -> float:
        """Plastic rotation [rad] from which the kinetic energy is watched."""
        return math.radians(2.0)

    @property
    def size(self) -> float:
        """Length of the elements [m], as in the plane."""
        return self.resolution.element_size(self.section, self.axis)

    @property
    def piece(self) -> float:
        """Length of each piece [m], long enough for a mitre."""
        usual = STUB * self.length_factor * largest_side(self.section)
        return max(usual, corner_piece(self.section, self.axis, self.angle))

    @property
    def length(self) -> float:
        """Length of both pieces [m]."""
        return 2.0 * self.piece

    @property
    def turn(self) -> float:
        """End rotation [rad]."""
        return OVERSHOOT * self.largest + 1.5 * self._flexibility * self.strength + ELASTIC_TURN

    @property
    def duration(self) -> float:
        """Time of the turn [s]."""
        return self.resolution.duration(self.section, self.material, self._across, self.length, self.turn)

    @property
    def strength(self) -> float:
        """Moment along e at which a straight piece yields [N m]."""
        walls = plastic_interaction(self.section, self.material)
        bending = float(walls.scales[1 if self._across == "y" else 2])
        twist, bend = self._parts
        return min(bending, 1.0 / math.hypot(twist / float(walls.plastic_torque), bend / bending))

    @property
    def _across(self) -> Axis:
        """Axis of the section in the corner's plane: bending about it is out of the plane."""
        return "z" if self.axis == "y" else "y"

    @cached_property
    def _direction(self) -> Floats:
        """Unit vector e."""
        along = second_piece(self.angle, self.axis)[0]
        first = np.array([1.0, 0.0, 0.0])
        across = first - (first @ along) * along
        return np.asarray((across / np.linalg.norm(across)).round(12))

    @property
    def _parts(self) -> tuple[float, float]:
        """Parts of the moment that twist and bend the first piece."""
        return math.sin(self.angle), abs(math.cos(self.angle))

    @property
    def _flexibility(self) -> float:
        """Elastic rotation of both straight pieces about e over the moment [rad/(N m)]."""
        torsion = self.material.shear_modulus * self.section.torsion_constant
        bending = self.material.youngs_modulus * self.section.second_moment(self._across)
        twist, bend = self._parts
        return float(self.piece * (twist**2 / torsion + bend**2 / bending + 1.0 / bending))

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        along, up = second_piece(self.angle, self.axis)
        duration = self.duration
        motion = {
            f"r{axis}": {"havsin": {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": part * self.turn}}
            for axis, part in zip("xyz", self._direction.tolist(), strict=True)
            if part
        }
        piece = {"section": "section", "material": "metal"}
        structure = Structure(
            materials={"metal": self.material},
            sections={"section": self.section},
            nodes={
                "held": (-self.piece, 0.0, 0.0),
                "middle": (0.0, 0.0, 0.0),
                "turned": tuple(self.piece * along),
            },
            members={
                "first": {"nodes": ("held", "middle"), "up": (0.0, 0.0, 1.0), **piece},
                "second": {"nodes": ("middle", "turned"), "up": tuple(up), **piece},
            },
            supports={
                "held": {"node": "held", "fix": "all"},
                "turned": {"node": "turned", "motion": motion},
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
        """Law measured in the solved sub-model, with the corner's own elastic stiffness.

        Raises
        ------
        InputError
            If the pieces yielded as well: the corner is as strong as its members.
        """
        rotation, moment = self._histories(result)
        largest = float(moment.max())
        if largest > STRONG * self.strength:
            what = "the corner is as strong as its members out of its plane: these yield too"
            came, allowed = f"{largest:.4g} N m", f"below {STRONG * self.strength:.4g} N m"
            todo = "the laws of the member in torsion and bending hold there"
            raise InputError(Problem(what, came, allowed, todo, where=self.title))
        flexibility = max(elastic_flexibility(rotation, moment), 0.0)
        curve = law_curve(rotation - flexibility * moment, moment, self.largest)
        return curve if flexibility == 0.0 else curve.with_stiffness(1.0 / flexibility)

    def histories(self, result: Result) -> tuple[Floats, Floats]:
        """Plastic rotation about e [rad] and moment [N m] at the times of the result."""
        rotation, moment = self._histories(result)
        return rotation - max(elastic_flexibility(rotation, moment), 0.0) * moment, moment

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Strength of the pieces."""
        return {"members": f"yield at {self.strength:.4g} N m"}

    def _histories(self, result: Result) -> tuple[Floats, Floats]:
        """Rotation about e less that of straight elastic pieces, and the mean moment of both ends."""
        moment, rotation = np.zeros(len(result.time)), np.zeros(len(result.time))
        for axis, part in zip("xyz", self._direction.tolist(), strict=True):
            if part:
                held, turned = (result[f"support.{name}.moment.{axis}"] for name in ("held", "turned"))
                moment += 0.5 * part * (held - turned)
                rotation += part * result[f"node.turned.rotation.{axis}"]
        return rotation - self._flexibility * moment, moment
