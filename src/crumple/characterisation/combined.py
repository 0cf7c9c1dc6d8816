"""Sub-model of a member that bends about any axis under a constant axial force, to check how hinges do it.

Both ends turn against each other about a fixed axis, and one of them carries the force; the force acts along
the line between the ends, so the moment of the fold in the middle includes its arm to that line.

A fold that softens cannot carry a given force at every rotation.  `FixedRatio` prescribes the shortening u of
the fold in place of the force: u = 2 r sin(theta/2), r the ratio.  Two straight halves of the length l that
meet in the fold then have the distance 2 l cos(theta/2) - u between their far ends, so these are moved by

    D = 2 l (cos(theta/2) - 1) - u,   to the second order in theta   -r theta - l theta^2/4.

With r half the depth between the flanges (b/2) this is a rotation about the tension flange.  Moment and force
are not given apart, the work of both is: dW = M d(theta) + N dD, less the elastic energy of the piece.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.curve import INTERVAL, LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution
from crumple.characterisation.sub_model import largest_side
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import AXES, Axis, Section, half_fold_length, plastic_interaction
from crumple.structure import Structure

STUB = 0.5
"""Length between fold and rigid end over the largest side: in a longer piece tension folds its ends first."""
KINK = math.radians(0.2)
"""Angle by which the two halves meet, so that the fold is in the middle [rad]."""
OUTPUTS = 400
"""Points in time at which it is measured."""
LOADING = 0.15
"""Share of the time of the turn in which the force is applied before."""
OVERSHOOT, ELASTIC_TURN = 1.1, math.radians(3.0)
"""Turn over the plastic rotation, and what is added to it."""


@dataclass(frozen=True)
class Combined:
    """Two halves of a member, turned against each other.

    Attributes
    ----------
    section, material
        Of the member.
    angle
        Of the axis of rotation, from the section's y towards z [rad].
    share
        Axial force over the squash force, positive in tension.
    largest
        Plastic rotation up to which it is compared [rad].
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/characterisation.md.
    """

    section: Section
    material: Material
    angle: float = 0.0
    share: float = 0.0
    largest: float = math.radians(30.0)
    resolution: Resolution = NOMINAL

    @property
    def title(self) -> str:
        """One line for people."""
        about = f"bending about an axis at {math.degrees(self.angle):.0f} deg"
        return f"{self.section.title}, {about}, {self.share:+.2g} of squash"

    @property
    def watched_from(self) -> float:
        """Plastic rotation [rad] from which the kinetic energy is watched."""
        return math.radians(2.0)

    @property
    def force(self) -> float:
        """Axial force, positive in tension [N]."""
        return self.share * float(plastic_interaction(self.section, self.material).squash_force)

    @property
    def half(self) -> float:
        """Half of the length [m]: the longer of both half folds, and a stub."""
        fold = max(half_fold_length(self.section, axis) for axis in AXES)
        return fold + STUB * largest_side(self.section)

    @property
    def _about(self) -> dict[Axis, float]:
        """Components of the axis of rotation."""
        return {"y": round(math.cos(self.angle), 12), "z": round(math.sin(self.angle), 12)}

    @property
    def _turn(self) -> float:
        return OVERSHOOT * self.largest + ELASTIC_TURN

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        axis: Axis = "y" if self._about["y"] > self._about["z"] else "z"
        length = 4.0 * largest_side(self.section)
        time = self.resolution.duration(self.section, self.material, axis, length, self._turn)
        loading = LOADING * time if self.share else 0.0
        duration = loading + time
        rotation = {
            end: {
                f"r{a}": havsin(loading, duration, sign * c * self._turn / 2.0)
                for a, c in self._about.items()
                if c
            }
            for end, sign in (("held", -1.0), ("turned", 1.0))
        }
        held = {"x", "y", "z", "rx", "ry", "rz"}
        piece = {"section": "section", "material": "metal", "up": (0.0, 0.0, 1.0)}
        step = {"step": {"x0": 0.0, "h0": 0.0, "x1": loading, "h1": self.force}}
        aside = self.half * math.tan(0.5 * KINK)
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=Structure(
                materials={"metal": self.material},
                sections={"section": self.section},
                nodes={
                    "held": (-self.half, 0.0, 0.0),
                    "middle": (0.0, -self._about["z"] * aside, self._about["y"] * aside),
                    "turned": (self.half, 0.0, 0.0),
                },
                members={
                    "first": {"nodes": ("held", "middle"), **piece},
                    "second": {"nodes": ("middle", "turned"), **piece},
                },
                supports={
                    "held": {
                        "node": "held",
                        "fix": sorted(held - set(rotation["held"])),
                        "motion": rotation["held"],
                    },
                    "turned": {
                        "node": "turned",
                        "fix": sorted(held - {"x"} - set(rotation["turned"])),
                        "motion": rotation["turned"] | self._along(loading, duration),
                    },
                },
                loads=[{"node": "turned", "force": {"x": step}}] if self.share else [],
            ),
            duration=duration,
            shell={"element_size": min(self.resolution.element_size(self.section, a) for a in AXES)},
            outputs={"every": duration / OUTPUTS, "nodes": ["held", "middle", "turned"]},
        )

    def _along(self, loading: float, duration: float) -> dict[str, object]:
        """Prescribed motion of the turned end along the line between the ends; none, it is free."""
        return {}

    def curve(self, result: Result) -> LawCurve:
        """Moment about the axis of rotation in the middle, against plastic rotation of the whole length."""
        moments = self._moments(result)
        elastic = sum(
            c * moments[a] * 2.0 * self.half / (self.material.youngs_modulus * self.section.second_moment(a))
            for a, c in self._about.items()
        )
        moment = sum(c * moments[a] for a, c in self._about.items())
        return law_curve(np.asarray(self._rotation(result) - elastic), np.asarray(moment), self.largest)

    def _rotation(self, result: Result) -> Floats:
        """Rotation of the ends against each other [rad]."""
        return np.asarray(
            sum(
                c * (result[f"node.turned.rotation.{a}"] - result[f"node.held.rotation.{a}"])
                for a, c in self._about.items()
            )
        )

    def _axial(self, result: Result) -> Floats | float:
        """Axial force [N], positive in tension."""
        return 0.5 * (result["support.held.force.x"] + self.force) if self.share else 0.0

    def _moments(self, result: Result) -> dict[Axis, Floats]:
        """Moments in the middle [N m]: mean of both ends, and the axial force times its arm."""
        force = self._axial(result)
        aside = self.half * math.tan(0.5 * KINK)
        arm = {
            "y": self._about["y"] * aside + result["node.middle.displacement.z"],
            "z": self._about["z"] * aside - result["node.middle.displacement.y"],
        }
        return {
            a: np.asarray(
                0.5 * (result[f"support.held.moment.{a}"] - result[f"support.turned.moment.{a}"])
                - force * arm[a]
            )
            for a in AXES
        }


@dataclass(frozen=True)
class FixedRatio(Combined):
    """Two halves of a member, turned against each other about one axis and pushed together.

    Attributes
    ----------
    ratio
        Shortening of the fold over its rotation [m/rad], positive.

    References
    ----------
    docs/theory/characterisation.md.
    """

    ratio: float = 0.0

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{super().title}, shortened by {1e3 * self.ratio:.3g} mm a radian"

    def _along(self, loading: float, duration: float) -> dict[str, object]:
        """Motion of the turned end: theta = H h with the half wave h, h^2 = h - g/4 with g up and down."""
        turn, middle = self._turn, 0.5 * (loading + duration)
        square = self.half * turn**2 / 4.0
        up, down = havsin(loading, middle, square / 4.0), havsin(middle, duration, -square / 4.0)
        return {"x": {"sum": [havsin(loading, duration, -self.ratio * turn - square), up, down]}}

    def curve(self, result: Result) -> LawCurve:
        """Plastic work of moment and force, and this work over the rotation, against plastic rotation."""
        moments, force, turned = (
            self._moments(result),
            np.asarray(self._axial(result)),
            self._rotation(result),
        )
        length, modulus = 2.0 * self.half, self.material.youngs_modulus
        axis = max(self._about, key=lambda a: self._about[a])
        moment, stiffness = moments[axis], modulus * self.section.second_moment(axis)
        ends = 0.5 * (result[f"support.held.moment.{axis}"] - result[f"support.turned.moment.{axis}"])
        apart = result["node.turned.displacement.x"] - result["node.held.displacement.x"]
        elastic = moment**2 * length / stiffness + force**2 * length / (modulus * self.section.area)
        work = _integral(ends, turned) + _integral(force, apart) - 0.5 * elastic
        plastic = np.maximum.accumulate(np.maximum(turned - moment * length / stiffness, 0.0))
        new = np.concatenate([[True], np.diff(plastic) > 0.0])
        end = min(float(plastic[-1]), self.largest)
        rotation = np.linspace(0.0, end, max(math.ceil(end / INTERVAL), 4) + 1)
        energy = np.interp(rotation, plastic[new], work[new]) - work[0]
        return LawCurve(rotation, np.gradient(energy, rotation), energy)

    def _axial(self, result: Result) -> Floats | float:
        """Axial force [N], positive in tension: mean of what both supports feel."""
        return np.asarray(0.5 * (result["support.held.force.x"] - result["support.turned.force.x"]))


def havsin(start: float, end: float, height: float) -> dict[str, dict[str, float]]:
    """Half a sine wave from 0 at the start to a height at the end."""
    return {"havsin": {"x0": start, "h0": 0.0, "x1": end, "h1": height}}


def _integral(values: Floats, over: Floats) -> Floats:
    """Integral up to each point."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(over))])
