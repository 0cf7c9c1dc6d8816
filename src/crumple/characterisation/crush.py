"""Sub-model that is crushed along its axis: a straight member between two rigid ends that come nearer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.curve import LawCurve, law_curve
from crumple.characterisation.resolution import NOMINAL, Resolution
from crumple.errors import InputError, Problem
from crumple.hinge.measured.place_hash import Load, place_hash
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import Axis, Section, plastic_interaction
from crumple.structure import Structure

SIDES = 3.0
"""Length over the mean side of the section: longer pieces bend sideways instead of folding."""
KINK = math.radians(0.2)
"""Angle by which the two halves meet, about the strong axis: walls then fold in turns outwards and inwards,
not all outwards, which takes more work [rad]."""
OUTPUTS = 800
"""Points in time at which the sub-model is measured."""
MEAN = 0.35
"""Mean crushing force over the squash force, for the time of the crush alone."""
SLOWER = 1.5
"""Slowness over that of bending: the force is small between two folds, the kinetic energy is not."""
WATCHED = 0.05
"""Shortening over the length from which the kinetic energy is watched."""
INTERVALS = 150
"""Points of the law over the length of the sub-model."""
LESS, ENOUGH = 0.9, 0.45
"""Shortening of another attempt over that which a run reached, and the share of the length it must reach."""
ASIDE = 0.25
"""Displacement of the middle across the axis, over the smaller side, at which the piece bends, not folds."""
CREST, PROMINENCE = 2.0, 4.0
"""Displacement of a crest out of its wall, and its height above the next troughs, over the wall thickness."""
NEAR = 0.9
"""Efficiency over its largest value down to which the folds count as open."""
POINTS = 600
"""Points of the shortening at which the efficiency is compared."""


@dataclass(frozen=True)
class Crush:
    """A straight piece three mean sides long, held at one end and pushed along its axis.

    Attributes
    ----------
    section, material
        Of the piece.
    largest
        Largest shortening over the length [-]; the law ends earlier if the folds close.
    length_factor
        Length over the usual one.
    resolution
        How finely and how slowly it is solved.

    References
    ----------
    docs/theory/characterisation.md.
    """

    section: Section
    material: Material
    largest: float = 0.8
    length_factor: float = 1.0
    resolution: Resolution = NOMINAL

    @property
    def load(self) -> Load:
        """Axial crushing."""
        return "crush"

    @property
    def sense(self) -> int:
        """Shortening is the negative sense of an axial slip."""
        return -1

    @property
    def one_law(self) -> bool:
        """Lengthening has no sub-model: the walls yield."""
        return True

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.section.title}, axial crushing"

    @property
    def place(self) -> str:
        """Hash of the place."""
        return place_hash(self.section, self.material, load=self.load)

    @property
    def origin(self) -> dict[str, str]:
        """Entries of the law file on the place."""
        kink = f"kink of {math.degrees(KINK):.2g} deg in the middle, about {self._strong}"
        gauge = f"{1e3 * self.length:.10g} mm"
        return {"section": self.section.title, "load": self.load, "gauge": gauge, "imperfection": kink}

    @property
    def watched_from(self) -> float:
        """Shortening [m] from which the kinetic energy is watched."""
        return WATCHED * self.length

    @property
    def squash_force(self) -> float:
        """Force at which all walls yield [N]."""
        return float(plastic_interaction(self.section, self.material).squash_force)

    @property
    def size(self) -> float:
        """Length of the elements [m]: as for a bending fold as wide as the mean side, 1.3 H."""
        return 1.3 * 0.5 * self.wave / self.resolution.elements

    @property
    def length(self) -> float:
        """Length between the rigid ends [m]: three mean sides."""
        side = self._mean_side + float(self.section.thickness)
        return SIDES * self.length_factor * side

    @property
    def wave(self) -> float:
        """Length of a fold along the member, 2 H = 1.97 c^(2/3) t^(1/3) [m], c the mean side."""
        return 1.966 * math.cbrt(self._mean_side**2 * self.section.thickness)

    @property
    def duration(self) -> float:
        """T = slowness sqrt(m d/P) [s] for a shortening d against the force P."""
        mass = self.section.mass_per_length(self.material.density) * self.length
        shortening = self.largest * self.length
        mean = MEAN * self.squash_force
        return SLOWER * self.resolution.slowness * math.sqrt(mass * shortening / mean)

    @property
    def _mean_side(self) -> float:
        """Mean mid-line side of the outline's box [m]."""
        return 0.5 * float(np.ptp(self.section.outer_outline(), axis=0).sum()) - float(self.section.thickness)

    @property
    def _strong(self) -> Axis:
        """Axis about which the section is stiffer."""
        return "y" if self.section.second_moment("y") > self.section.second_moment("z") else "z"

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        half, duration = 0.5 * self.length, self.duration
        aside = half * math.tan(0.5 * KINK)
        pushing = {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": -self.largest * self.length}
        piece = {"section": "section", "material": "metal", "up": (0.0, 0.0, 1.0)}
        structure = Structure(
            materials={"metal": self.material},
            sections={"section": self.section},
            nodes={
                "held": (-half, 0.0, 0.0),
                "middle": (0.0, 0.0, aside) if self._strong == "y" else (0.0, aside, 0.0),
                "pushed": (half, 0.0, 0.0),
            },
            members={
                "first": {"nodes": ("held", "middle"), **piece},
                "second": {"nodes": ("middle", "pushed"), **piece},
            },
            supports={
                "held": {"node": "held", "fix": "all"},
                "pushed": {
                    "node": "pushed",
                    "fix": ["y", "z", "rx", "ry", "rz"],
                    "motion": {"x": {"havsin": pushing}},
                },
            },
        )
        return Analysis(
            title=f"Sub-model: {self.title}",
            structure=structure,
            duration=duration,
            shell={"element_size": self.size},
            outputs={"every": duration / OUTPUTS, "nodes": ["middle", "pushed"], "pictures": [duration]},
        )

    def less(self, result: Result) -> float | None:
        """Another `largest`, after a run that failed where folds close; None if it failed before."""
        reached = float(-result["node.pushed.displacement.x"].min()) / self.length
        return LESS * reached if reached > ENOUGH else None

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model: force against shortening, up to the closing of the folds.

        Raises
        ------
        InputError
            If the piece bent as a whole.
        """
        shortening, force = self._histories(result)
        self._check_straight(result)
        end = stroke(shortening, force, self.wave)
        interval = self.length / INTERVALS
        return law_curve(shortening, force, end, first=0.1 * interval, interval=interval)

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Peak force, mean force over the stroke, and folds, as entries of the law file."""
        shortening, force = self._histories(result)
        first = force[shortening <= self.wave]
        end = float(curve.rotation[-1])
        open_ = end > 0.99 * float(shortening.max())
        return {
            "peak_force": f"{1e-3 * float(first.max()):.5g} kN",
            "mean_force": f"{1e-3 * float(curve.energy[-1]) / end:.5g} kN over {1e3 * end:.4g} mm",
            "folds": f"{fold_count(result, self.section.thickness)} when shortened by "
            f"{1e3 * float(shortening.max()):.4g} mm" + (", not closed" if open_ else ""),
        }

    def _histories(self, result: Result) -> tuple[Floats, Floats]:
        """Shortening less the elastic one [m], and compression [N], the mean of both ends."""
        held, pushed = (result[f"support.{name}.force.x"] for name in ("held", "pushed"))
        force = 0.5 * (pushed - held)
        elastic = force * self.length / (self.material.youngs_modulus * self.section.area)
        return np.asarray(-result["node.pushed.displacement.x"] - elastic), force

    def _check_straight(self, result: Result) -> None:
        across = np.hypot(*(result[f"node.middle.displacement.{axis}"] for axis in "yz"))
        smaller = float(np.ptp(self.section.outer_outline(), axis=0).min())
        if across.max() > ASIDE * smaller:
            what, todo = (
                "the sub-model bent sideways instead of folding",
                "describe its hinges by bending alone",
            )
            came = f"{1e3 * float(across.max()):.3g} mm in the middle"
            allowed = f"at most {1e3 * ASIDE * smaller:.3g} mm"
            raise InputError(Problem(what, came, allowed, todo, where=self.title))


def stroke(shortening: Floats, force: Floats, wave: float) -> float:
    """Shortening at which the folds are closed: where the efficiency of absorption begins to fall [m].

    Parameters
    ----------
    shortening, force
        Histories [m], [N], (n,).
    wave
        Length of a fold [m]: the force is averaged over as much shortening, so its swing does not matter.

    Notes
    -----
    Efficiency: the work so far over the force, W(u)/P(u).  It grows with u while the force swings about a
    constant mean, and falls when the closed folds let the force rise.  The stroke ends where it is within
    10 % of its largest value for the last time, since it swings with the force.

    References
    ----------
    Li, Magkiriadis & Harrigan, J. Cell. Plast. 42 (2006) 371-392, as used for foams.
    """
    reached = np.maximum.accumulate(np.maximum(shortening, 0.0))
    new = np.concatenate([[True], np.diff(reached) > 0.0])
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(shortening))])
    at = np.linspace(min(2.0 * wave, 0.5 * float(reached[-1])), float(reached[-1]), POINTS)
    done, before = (np.interp(u, reached[new], work[new]) for u in (at, at - wave))
    efficiency = done / np.maximum(done - before, 1e-12 * done[-1])
    return float(at[np.flatnonzero(efficiency >= NEAR * efficiency.max())[-1]])


def fold_count(result: Result, thickness: float) -> int:
    """Number of folds in the last stored shape of a straight member along x.

    Along each line of the mesh the crests of the wall's displacement are counted, outwards and inwards, that
    stand out by more than a few wall thicknesses; the median of the lines that have any.
    """
    from scipy.signal import find_peaks  # noqa: PLC0415  (takes a second, which the other sub-models save)

    states = result.states
    assert states is not None
    counts = []
    for line in np.unique(states.contour):
        own = np.flatnonzero(states.contour == line)
        own = own[np.argsort(states.points[own, 0])]
        across = states.points[own, 1:]
        outward = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
        moved = (states.displacement[-1][own, 1:] * outward).sum(axis=1)
        ended = np.concatenate([[0.0], moved, [0.0]])
        high, apart = CREST * thickness, PROMINENCE * thickness
        counts.append(sum(len(find_peaks(one, high, prominence=apart)[0]) for one in (ended, -ended)))
    folded = [count for count in counts if count > 0]
    return int(np.median(folded)) if folded else 0
