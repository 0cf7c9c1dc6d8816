"""Sub-models that bend: a straight member that folds in its middle, or a mitred corner in its plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution, scaled_step
from crumple.characterisation.sub_model import (
    Histories,
    StrongCornerError,
    corner_piece,
    is_mirrored,
    largest_side,
)
from crumple.errors import InputError, Problem
from crumple.hinge.measured.place_hash import Load, place_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import Axis, Section, half_fold_length
from crumple.structure import Structure

STUB = 1.75
"""Length of each piece outside the gauge over the largest side of the section: room for end effects."""
KINK = math.radians(0.2)
"""Usual kink of a straight member [rad]."""
OUTPUTS = 400
"""Points in time at which a sub-model is measured, at most."""
OVERSHOOT, ELASTIC_TURN = 1.15, math.radians(5.0)
"""End rotation: plastic rotation of the law times the one plus the other; the piece also bends elsewhere."""
TURNING = 0.1
"""Share of the rotation at the end that must be between the planes of measurement if little was before."""
STARTING = 200
"""Straight pieces of the first half of the turn; the speed changes by at most 0.8 % from one to the next."""
RISE = (0.05, 0.3)
"""Shares of the peak moment between which the elastic stiffness is measured."""


@dataclass(frozen=True)
class Bending:
    """Two pieces of one section, end to end in line or at an angle, bent in their plane by end moments.

    Attributes
    ----------
    section, material
        Of both pieces.
    axis
        Axis of the section about which it bends; that of a corner is normal to its plane.
    sense
        +1 or -1: sense of rotation about the axis.  +1 closes a corner of a positive angle, -1 opens it.
    angle
        Angle by which the second piece is turned about the axis [rad], pi/2 for a right-angled corner; None:
        a straight member.  If negative, the section has its other side inside.
    largest
        Plastic rotation at which the law ends [rad].
    kink
        Angle between the two halves of a straight member, so that its fold is in the middle [rad].
    length_factor
        Length of the pieces outside the gauge over the usual one; others give the same law.
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/characterisation.md.
    """

    section: Section
    material: Material
    axis: Axis = "y"
    sense: int = 1
    angle: float | None = None
    largest: float = math.radians(30.0)
    kink: float = KINK
    length_factor: float = 1.0
    resolution: Resolution = NOMINAL

    @property
    def load(self) -> Load:
        """Bending."""
        return "bending"

    @property
    def place(self) -> str:
        """Hash of the place."""
        return place_hash(self.section, self.material, self.axis, self.angle)

    @property
    def one_law(self) -> bool:
        """Whether both senses have one law: those of a straight member that is its own mirror image."""
        return self.angle is None and is_mirrored(self.section, self.axis)

    @property
    def closes(self) -> bool:
        """Whether it closes a corner."""
        return self.angle is not None and self.sense * self.angle > 0.0

    @property
    def watched_from(self) -> float:
        """Plastic rotation [rad] from which the kinetic energy is watched."""
        return math.radians(2.0)

    @property
    def title(self) -> str:
        """One line for people."""
        if self.angle is None:
            return f"{self.section.title}, bending about {self.axis}, sense {self.sense:+d}"
        doing = "closed" if self.closes else "opened"
        angle = f"{math.degrees(self.angle):.4g} deg"
        return f"{self.section.title}, corner of {angle}, {doing} about {self.axis}"

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        own = {"section": self.section.title, "axis": self.axis}
        if self.angle is None:
            kink = f"kink of {math.degrees(self.kink):.2g} deg in the middle"
            return {**own, "gauge": f"{1e3 * self.gauge:.4g} mm", "imperfection": kink}
        angle = f"{math.degrees(self.angle):.6g} deg"
        return {**own, "corner": angle, "gauge": f"{1e3 * self.gauge:.4g} mm", "imperfection": "none"}

    @property
    def gauge(self) -> float:
        """Distance of the planes between which the rotation is measured, along the axes [m].

        Two half fold lengths of a member, two section sides of a corner.
        """
        if self.angle is None:
            return 2.0 * half_fold_length(self.section, self.axis)
        return 2.0 * largest_side(self.section)

    @property
    def piece(self) -> float:
        """Length of each piece [m]; those of a corner are long enough for a mitre."""
        usual = 0.5 * self.gauge + self.length_factor * STUB * largest_side(self.section)
        return usual if self.angle is None else max(usual, corner_piece(self.section, self.axis, self.angle))

    @property
    def turn(self) -> float:
        """End rotation [rad]."""
        return OVERSHOOT * self.largest + ELASTIC_TURN * max(self.length_factor, 1.0)

    @property
    def size(self) -> float:
        """Length of the elements [m]."""
        return self.resolution.element_size(self.section, self.axis)

    @property
    def length(self) -> float:
        """Length of both pieces [m]."""
        return 2.0 * self.piece

    @property
    def duration(self) -> float:
        """Time up to the end rotation [s]; the run ends with its law."""
        return (0.5 + 1.0 / math.pi) * self._half_wave

    @property
    def _half_wave(self) -> float:
        """Time of half a sine wave up to the end rotation [s]."""
        return self.resolution.duration(self.section, self.material, self.axis, self.length, self.turn)

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        duration = self.duration
        scaled = None if self.angle is None else scaled_step(self.size, self.material)
        near, far = 0.5 * self.gauge, self.piece - 0.5 * self.gauge
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=self._structure(duration),
            duration=duration,
            shell={"element_size": self.size, "mass_scaling": scaled},
            outputs={
                "every": duration / OUTPUTS,
                "nodes": ["turned"],
                "section_rotations": {
                    "first": {"member": "first", "from": 0.0, "to": far},
                    "second": {"member": "second", "from": near, "to": self.piece},
                },
                "pictures": [duration],
            },
        )

    def _structure(self, duration: float) -> Structure:
        """One end held, the other turned about the axis and free to move: one moment everywhere."""
        kink = self.sense * self.kink if self.angle is None else self.angle
        along, across = second_piece(kink, self.axis)
        held = [f"r{axis}" for axis in "xyz" if axis != self.axis]
        turning = started(self._half_wave, self.sense * self.turn, duration)
        piece = {"section": "section", "material": "metal"}
        return Structure(
            materials={"metal": self.material},
            sections={"section": self.section},
            nodes={
                "held": (-self.piece, 0.0, 0.0),
                "middle": (0.0, 0.0, 0.0),
                "turned": tuple(self.piece * along),
            },
            members={
                "first": {"nodes": ("held", "middle"), "up": (0.0, 0.0, 1.0), **piece},
                "second": {"nodes": ("middle", "turned"), "up": tuple(across), **piece},
            },
            supports={
                "held": {"node": "held", "fix": "all"},
                "turned": {"node": "turned", "fix": held, "motion": {f"r{self.axis}": turning}},
            },
        )

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model.

        Raises
        ------
        InputError
            If nothing folded between the planes; of a corner `StrongCornerError`.
        """
        plastic, moment, flexibility = self._plastic(result)
        if plastic.max() < 0.5 * self.largest and not self._folds_late(result, plastic):
            came = f"{math.degrees(plastic.max()):.2g} deg between the planes of measurement"
            if self.angle is not None:
                what = "the corner is as strong as its members: the sub-model folded beside it"
                todo = "use the law of the member there"
                raise StrongCornerError(Problem(what, came, "", todo, where=self.title))
            what, todo = "the sub-model folded elsewhere", "give these hinges a law of their own"
            raise InputError(Problem(what, came, "", todo, where=self.title))
        curve = law_curve(plastic, moment, self.largest)
        return curve if flexibility == 0.0 else curve.with_stiffness(1.0 / flexibility)

    def _folds_late(self, result: Result, plastic: Floats) -> bool:
        """Whether a member's rotation of the last tenth of the times is between the planes.

        Thick walls that harden yield along the whole sub-model before they fold: their law ends earlier.
        """
        turned = self.sense * result[f"node.turned.rotation.{self.axis}"]
        since = -max(len(turned) // 10, 2)
        between, whole = plastic[-1] - plastic[since], turned[-1] - turned[since]
        return self.angle is None and bool(between > TURNING * whole)

    def histories(self, result: Histories) -> tuple[Floats, Floats]:
        """Plastic rotation of the fold [rad] and moment [N m] at the times of the result."""
        return self._plastic(result)[:2]

    def _plastic(self, result: Histories) -> tuple[Floats, Floats, float]:
        """Plastic rotation, moment, and the flexibility of a corner's own that was taken off."""
        moment = self._moment(result)
        pieces = result["first"] + result["second"]
        between = self.sense * (result[f"node.turned.rotation.{self.axis}"] - pieces)
        stiffness = self.material.youngs_modulus * self.section.second_moment(self.axis)
        own = between - moment * self.gauge / stiffness
        flexibility = 0.0 if self.angle is None else max(elastic_flexibility(own, moment), 0.0)
        return own - flexibility * moment, moment, flexibility

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Nothing more."""
        return {}

    def _moment(self, result: Histories) -> Floats:
        """Moment in the middle [N m]: the mean of both ends, free of inertia to first order.

        The channels hold what the structure exerts on its supports.
        """
        held, turned = (result[f"support.{name}.moment.{self.axis}"] for name in ("held", "turned"))
        return 0.5 * self.sense * (held - turned)


def started(half_wave: float, height: float, end: float) -> dict[str, dict[str, list[float]]]:
    """Half a sine wave up to its middle, where it is fastest, and then this speed.

    Parameters
    ----------
    half_wave, height
        Time [s] and height [rad] of half a sine wave.
    end
        Where it ends [s], after the middle.
    """
    rise = np.linspace(0.0, 0.5 * half_wave, STARTING + 1)
    value = 0.5 * height * (1.0 - np.cos(math.pi * rise / half_wave))
    last = 0.5 * height * (1.0 + math.pi * (end / half_wave - 0.5))
    return {"table": {"time": [*rise.tolist(), end], "value": [*value.tolist(), last]}}


def second_piece(angle: float, axis: Axis) -> tuple[Floats, Floats]:
    """Direction of the second piece, turned by an angle about the section's axis, and of its section's z."""
    cos, sin = math.cos(angle), math.sin(angle)
    if axis == "y":
        return np.array([cos, 0.0, -sin]), np.array([sin, 0.0, cos])
    return np.array([cos, sin, 0.0]), np.array([0.0, 0.0, 1.0])


def elastic_flexibility(rotation: Floats, moment: Floats) -> float:
    """Rotation over moment in the elastic rise [rad/(N m)]: slope of a straight line fitted there."""
    peak = int(np.argmax(moment))
    if moment[peak] <= 0.0:
        return 0.0
    share = moment[: peak + 1] / moment[peak]
    rise = (share > RISE[0]) & (share < RISE[1])
    if np.count_nonzero(rise) < 2:
        return 0.0
    return float(np.polyfit(moment[: peak + 1][rise], rotation[: peak + 1][rise], 1)[0])
