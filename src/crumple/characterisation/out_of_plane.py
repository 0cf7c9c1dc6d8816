"""Sub-models of a mitred corner that is loaded out of its plane, about one of its two principal directions.

Two pieces of one section meet at an angle.  One end is held, the other turned about a direction in the
corner's plane, and free otherwise: the moment is along this direction everywhere.  The corner is its own
mirror image about the plane of the mitre, and so is its law: the *bisector*, the line in which this plane
cuts that of the corner, and the *tangent* across it are its principal directions.  In line (0 degrees) the
moment along the bisector bends the member and the one along the tangent twists it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeGuard

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.bending import elastic_flexibility, second_piece
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution, scaled_step
from crumple.characterisation.sub_model import Histories, corner_piece, is_mirrored, largest_side
from crumple.errors import InputError, Problem
from crumple.hinge.corner.mitred_corner_across import distorted_length
from crumple.hinge.measured.place_hash import ABOUT, CORNER, Direction, Load, place_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import Axis, RectangularTube, Section, plastic_interaction
from crumple.structure import Structure

STUB = 2.75
"""Length of each piece over the largest side: one side is the corner's, the rest room for end effects."""
DISTORTED = 1.4
"""Length of each piece of a rectangular tube about the bisector over the length that the corner distorts, at
least: a rigid end within it holds the walls."""
OUTPUTS = 400
"""Points in time at which it is measured."""
OVERSHOOT, ELASTIC_TURN = 1.05, math.radians(4.0)
"""End rotation over the plastic rotation of the law, and what is added to it."""
LONG_PIECES = Resolution(elements=5.0)
"""Mesh of corners with such long pieces: 8 elements along half a fold take four times as long."""
STRONG = 0.97
"""Moment over the plastic moment of the pieces from which these may yield too."""


def usual_resolution(section: Section, about: Direction) -> Resolution:
    """Of a corner that is characterised for use: coarser than the nominal one where its pieces are long."""
    return LONG_PIECES if _is_long(section, about) else NOMINAL


def _is_long(section: Section, about: Direction) -> TypeGuard[RectangularTube]:
    """Whether the corner distorts its members over more than their sides."""
    return about == "bisector" and isinstance(section, RectangularTube)


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
    about
        Direction of the moment: the corner's bisector or its tangent.
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
    about: Direction = "bisector"
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
        where = f"{self.section.title}, corner of {angle} with normal {self.axis}"
        return f"{where}, out of its plane about its {self.about}"

    @property
    def place(self) -> str:
        """Hash of the place."""
        place = self.section, self.material, self.axis, self.angle
        return place_hash(*place, load=self.load, about=self.about)

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        angle = f"{math.degrees(self.angle):.6g} deg"
        return {
            "section": self.section.title,
            "axis": self.axis,
            "load": self.load,
            CORNER: angle,
            ABOUT: self.about,
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
        """Length of each piece [m], long enough for a mitre, and for the walls that the corner distorts."""
        usual = STUB * largest_side(self.section)
        if _is_long(self.section, self.about):
            usual = max(usual, DISTORTED * distorted_length(self.section))
        return max(self.length_factor * usual, corner_piece(self.section, self.axis, self.angle))

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
        """Moment along the direction at which a straight piece yields [N m]; both pieces do so alike."""
        walls = plastic_interaction(self.section, self.material)
        bending = float(walls.scales[1 if self._across == "y" else 2])
        twist, bend = self._parts
        return 1.0 / math.hypot(twist / float(walls.plastic_torque), bend / bending)

    @property
    def _across(self) -> Axis:
        """Axis of the section in the corner's plane: bending about it is out of the plane."""
        return "z" if self.axis == "y" else "y"

    @property
    def _driven(self) -> str:
        """Global axis along the direction: x is the tangent."""
        return "x" if self.about == "tangent" else self._across

    @property
    def _parts(self) -> tuple[float, float]:
        """Parts of the moment that twist and bend a piece."""
        along, aside = math.cos(0.5 * self.angle), math.sin(0.5 * self.angle)
        return (along, aside) if self.about == "tangent" else (aside, along)

    @property
    def _flexibility(self) -> float:
        """Elastic rotation of both straight pieces about the direction over the moment [rad/(N m)]."""
        torsion = self.material.shear_modulus * self.section.torsion_constant
        bending = self.material.youngs_modulus * self.section.second_moment(self._across)
        twist, bend = self._parts
        return float(self.length * (twist**2 / torsion + bend**2 / bending))

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        return self.seen_in(np.eye(3))

    def seen_in(self, axes: Floats) -> Analysis:
        """The same with other global axes, of which the moment is along the one that is driven.

        Parameters
        ----------
        axes
            As rows, (3, 3), in those in which x is the tangent.
        """
        half = 0.5 * self.angle
        (before, up), (after, up_after) = (second_piece(s * half, self.axis) for s in (-1.0, 1.0))
        duration = self.duration
        turning = {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": self.turn}
        piece = {"section": "section", "material": "metal"}
        structure = Structure(
            materials={"metal": self.material},
            sections={"section": self.section},
            nodes={
                "held": tuple(axes @ before * -self.piece),
                "middle": (0.0, 0.0, 0.0),
                "turned": tuple(axes @ after * self.piece),
            },
            members={
                "first": {"nodes": ("held", "middle"), "up": tuple(axes @ up), **piece},
                "second": {"nodes": ("middle", "turned"), "up": tuple(axes @ up_after), **piece},
            },
            supports={
                "held": {"node": "held", "fix": "all"},
                "turned": {"node": "turned", "motion": {f"r{self._driven}": {"havsin": turning}}},
            },
        )
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=structure,
            duration=duration,
            shell={"element_size": self.size, "mass_scaling": scaled_step(self.size, self.material)},
            outputs={"every": duration / OUTPUTS, "nodes": ["turned"], "pictures": [duration]},
        )

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model, with the corner's own elastic stiffness.

        Raises
        ------
        InputError
            If the pieces yielded as well about the bisector: the corner is as strong as its members.

        Notes
        -----
        About its tangent a mitre is nearly as strong as its members, and yields with them.
        """
        rotation, moment = self._histories(result)
        largest = float(moment.max())
        if self.about == "bisector" and largest > STRONG * self.strength:
            what = "the corner is as strong as its members out of its plane: these yield too"
            came, allowed = f"{largest:.4g} N m", f"below {STRONG * self.strength:.4g} N m"
            todo = "the law of the member in bending holds there"
            raise InputError(Problem(what, came, allowed, todo, where=self.title))
        return self.curve_of(rotation, moment)

    def curve_of(self, rotation: Floats, moment: Floats) -> LawCurve:
        """Law from histories of rotation less that of straight elastic pieces [rad] and moment [N m]."""
        flexibility = max(elastic_flexibility(rotation, moment), 0.0)
        curve = law_curve(rotation - flexibility * moment, moment, self.largest)
        return curve if flexibility == 0.0 else curve.with_stiffness(1.0 / flexibility)

    def histories(self, result: Histories) -> tuple[Floats, Floats]:
        """Plastic rotation about the direction [rad] and moment [N m] at the times of the result."""
        rotation, moment = self._histories(result)
        return rotation - max(elastic_flexibility(rotation, moment), 0.0) * moment, moment

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Strength of the pieces."""
        return {"members": f"yield at {self.strength:.4g} N m"}

    def _histories(self, result: Histories) -> tuple[Floats, Floats]:
        """Rotation about the direction less that of straight elastic pieces, and mean moment of both ends."""
        held, turned = (result[f"support.{name}.moment.{self._driven}"] for name in ("held", "turned"))
        moment = 0.5 * (held - turned)
        rotation = result[f"node.turned.rotation.{self._driven}"]
        return rotation - self._flexibility * moment, moment
