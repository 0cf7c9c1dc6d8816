"""Sub-model of a welded T-joint at a right angle: the branch turned in or across the plane, the chord held.

The chord's ends are held.  The branch's far end is turned about one axis of its section and is free to move,
so the moment is the same along the branch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.bending import elastic_flexibility
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution
from crumple.characterisation.sub_model import largest_side
from crumple.errors import InputError, Problem
from crumple.hinge.measured.place_hash import JOINT, Load, t_joint_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import AXES, Axis, plastic_interaction
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.structure import Structure

REACH = 2.75
"""Length of the branch beyond the face, and of the chord on both sides, over the largest side."""
OUTPUTS = 400
"""Points in time at which it is measured."""
OVERSHOOT, ELASTIC_TURN = 1.05, math.radians(4.0)
"""End rotation over the plastic rotation of the law, and what is added to it."""
EARLY = math.radians(2.0)
"""Rotation of the joint up to which its elastic stiffness is sought [rad]."""
STRONG = 0.97
"""Moment over the branch's plastic moment from which the branch may yield too."""


@dataclass(frozen=True)
class TJoint:
    """A branch on the face of a chord, both of one metal.

    Attributes
    ----------
    section
        Of the branch; its width lies along the chord.
    chord
        Section of the chord; the branch stands on a face across its z axis.
    material
        Of both.
    plane
        `in`: turned in the plane of both axes; `across`: turned about the chord's axis.
    largest
        Plastic rotation at which the law ends [rad].
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/t_joint.md.
    """

    section: RectangularTube
    chord: RectangularTube
    material: Material
    plane: Literal["in", "across"] = "in"
    largest: float = math.radians(20.0)
    resolution: Resolution = NOMINAL

    def __post_init__(self) -> None:
        if self.section.depth > self.chord.width:
            what, todo = "the branch is wider than the face of the chord", "exchange its width and depth"
            came, allowed = f"{1e3 * self.section.depth:.4g} mm", f"at most {1e3 * self.chord.width:.4g} mm"
            raise InputError(Problem(what, came, allowed, todo))

    @property
    def load(self) -> Load:
        """Bending of the branch."""
        return "bending"

    @property
    def sense(self) -> int:
        """Both senses are mirror images."""
        return 1

    @property
    def one_law(self) -> bool:
        """Both senses are mirror images."""
        return True

    @property
    def axis(self) -> Axis:
        """Axis of the branch's section about which it is turned: its width lies along the chord."""
        return "z" if self.plane == "in" else "y"

    @property
    def title(self) -> str:
        """One line for people."""
        how = "in the plane" if self.plane == "in" else "across the plane"
        return f"T-joint of {self.section.title} on {self.chord.title}, {how}"

    @property
    def place(self) -> str:
        """Hash of the place."""
        return t_joint_hash(self.section, self.chord, self.material, across=self.plane == "across")

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        return {
            "section": self.section.title,
            "axis": self.axis,
            "chord": self.chord.title,
            JOINT: f"welded T, turned {'in' if self.plane == 'in' else 'across'} the plane",
            "gauge": f"{1e3 * self.branch:.4g} mm of the branch, {2e3 * self.half:.4g} mm of the chord",
            "imperfection": "none",
        }

    @property
    def watched_from(self) -> float:
        """Plastic rotation [rad] from which the kinetic energy is watched."""
        return math.radians(2.0)

    @property
    def size(self) -> float:
        """Length of the elements [m]."""
        sections = (self.section, self.chord)
        return min(self.resolution.element_size(one, axis) for one in sections for axis in AXES)

    @property
    def branch(self) -> float:
        """Length of the branch from the mid-plane of the face [m]."""
        return REACH * largest_side(self.section)

    @property
    def half(self) -> float:
        """Half the length of the chord [m]."""
        return REACH * largest_side(self.chord)

    @property
    def length(self) -> float:
        """Length of all pieces [m]."""
        return self.branch + 2.0 * self.half

    @property
    def turn(self) -> float:
        """End rotation [rad]."""
        return OVERSHOOT * self.largest + ELASTIC_TURN

    @property
    def duration(self) -> float:
        """Time of the turn [s]."""
        return self.resolution.duration(self.section, self.material, self.axis, 2 * self.branch, self.turn)

    @property
    def strength(self) -> float:
        """Plastic moment of the branch [N m]."""
        walls = plastic_interaction(self.section, self.material)
        return float(walls.scales[1 if self.axis == "y" else 2])

    @property
    def _turned(self) -> str:
        """Direction about which the end is turned."""
        return "y" if self.plane == "in" else "x"

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        duration, half = self.duration, self.half
        top = (self.chord.depth - self.chord.thickness) / 2 + self.branch
        motion = {"havsin": {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": self.turn}}
        chord = {"section": "chord", "material": "metal", "up": (0.0, 0.0, 1.0)}
        structure = Structure(
            materials={"metal": self.material},
            sections={"chord": self.chord, "branch": self.section},
            nodes={
                "left": (-half, 0.0, 0.0),
                "joint": (0.0, 0.0, 0.0),
                "right": (half, 0.0, 0.0),
                "turned": (0.0, 0.0, top),
            },
            members={
                "first": {"nodes": ("left", "joint"), **chord},
                "second": {"nodes": ("joint", "right"), **chord},
                "branch": {
                    "nodes": ("joint", "turned"),
                    "section": "branch",
                    "material": "metal",
                    "up": (0.0, 1.0, 0.0),
                },
            },
            supports={
                "left": {"node": "left", "fix": "all"},
                "right": {"node": "right", "fix": "all"},
                "turned": {
                    "node": "turned",
                    "fix": [f"r{a}" for a in "xyz" if a != self._turned],
                    "motion": {f"r{self._turned}": motion},
                },
            },
        )
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=structure,
            duration=duration,
            shell={"element_size": self.size, "t_joints": "welded"},
            outputs={"every": duration / OUTPUTS, "nodes": ["turned"], "pictures": [duration]},
        )

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model, with the joint's own elastic stiffness.

        Raises
        ------
        InputError
            If the branch yielded as well: the joint is as strong as it.
        """
        own, moment = self._histories(result)
        largest = float(moment.max())
        if largest > STRONG * self.strength:
            what = "the T-joint is as strong as its branch, which yields too"
            came, allowed = f"{largest:.4g} N m", f"below {STRONG * self.strength:.4g} N m"
            todo = "the law of the member holds there"
            raise InputError(Problem(what, came, allowed, todo, where=self.title))
        # membrane forces of the face raise the moment later, far above the one at which it yields
        early = slice(0, max(int(np.searchsorted(own, EARLY)), 2))
        flexibility = max(elastic_flexibility(own[early], moment[early]), 0.0)
        curve = law_curve(own - flexibility * moment, moment, self.largest)
        return curve if flexibility == 0.0 else curve.with_stiffness(1.0 / flexibility)

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Strength of the branch."""
        return {"members": f"the branch yields at {self.strength:.4g} N m"}

    def _histories(self, result: Result) -> tuple[Floats, Floats]:
        """Rotation less that of the branch as an elastic beam [rad], and the moment at its end [N m]."""
        moment = -result[f"support.turned.moment.{self._turned}"]
        stiffness = self.material.youngs_modulus * self.section.second_moment(self.axis)
        rotation = result[f"node.turned.rotation.{self._turned}"]
        return rotation - moment * self.branch / stiffness, moment
