"""Channels and hats in bending, either side in compression, by mechanisms scaled from the tube's.

Unknown: M(theta) for both senses about the axis that runs along the face (z for a channel, y for a hat).
Per sense min(Mmax, M_mech), with Mmax the section's own moment capacity and the mechanism by the side that is
compressed:

    a closed face (web of a channel,          the tube's mechanism with the faces that exist
    crown of a hat)
    the plate of a closed hat                 plate and flanges folding as strips
                                              (crumple.hinge.bending.profiles.compressed_plate)
    an open side (edges, with lips or         the same with those lips alone as its face, or walls folding
    outward flanges)                          sideways (crumple.hinge.bending.profiles.free_edge)

Of two mechanisms the one that needs less work up to half the smaller jamming angle governs.  A closing plate
of another thickness or metal counts by its own m_p and yield force.  Limits: lip -> 0 leaves the free edge;
a face as wide as the webs are apart on both sides is the tube.  Positive rotation about y compresses the
lower side (-z), about z the right side (+y).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.bending.capped import CappedMechanism, Mechanism
from crumple.hinge.bending.jamming import AfterJamming, continued, continued_kinks
from crumple.hinge.bending.profiles.compressed_plate import CompressedPlate
from crumple.hinge.bending.profiles.free_edge import FreeEdgeMechanism
from crumple.hinge.bending.profiles.profile_mechanism import ProfileMechanism
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.options import choice, number_between
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor, rate_warnings
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import RollingWeight
from crumple.section import Axis, Section
from crumple.section.capacity.capacity import MomentCapacity, moment_capacity
from crumple.section.shapes.channel import Channel
from crumple.section.shapes.closed_hat import ClosedHat
from crumple.section.shapes.hat import Hat

SOURCE = Source(
    "Kecman-type mechanism with the faces of the profile, and folding of free edges",
    Trust.FITTED,
    "after D. Kecman, Int. J. Mech. Sci. 25 (1983) 623-636 for the idea; which lines a profile has, and the "
    "folding of free edges, are derived here; the work of the latter has a factor from shells",
)
HAT_SOURCE = Source(
    "closed hat: plate and flanges that fold as strips; Kecman-type mechanism with the crown as its face",
    Trust.FITTED,
    "three constants of the strips fitted to eight hats solved by shells, and checked against five others",
)
FREE_EDGE = 1.4
"""Factor on the work of free edges that fold [-], from shells of seven channels."""
UNCERTAINTY = 0.35
"""Half-width of the band of open profiles [-]: the largest difference from shells in the work up to 10 and 20
degrees is 0.21 of what the shells take, 0.33 of plain channels whose edges buckle before they yield; and of
other closed hats, with 0.155, what plane strain in the folds would add (2/sqrt(3))."""
HAT_UNCERTAINTY = 0.2
"""Half-width of the band of closed hats like those that were compared [-]: largest difference from shells in
the work up to 10 and 20 degrees, 0.13 with the plate compressed and 0.19 with the crown."""
COMPARED = {
    "width/thickness": (25.0, 90.0),
    "depth/width": (0.5, 1.2),
    "flange/width": (0.2, 0.4),
    "yield/E": (0.0013, 0.0029),
}
"""Closed hats that were compared with shells: sharp corners, plate like the hat, no hardening."""


@dataclass(frozen=True)
class FoldedProfileLaw:
    """Channel about z, hat or closed hat about y: folding mechanisms of each side, scaled from the tube's.

    Not the same in both senses.

    Attributes
    ----------
    positive, negative
        Largest moment and mechanism of each sense.
    after_jamming, rate, stop
        As in the Kecman-type law.

    References
    ----------
    docs/theory/folded_profile.md.  Verified in tests/verification/profiles/test_folded_profiles.py.
    """

    name: ClassVar[str] = "folded_profile"

    positive: CappedMechanism
    negative: CappedMechanism
    validity: Validity
    after_jamming: AfterJamming = AfterJamming.HOLD
    rate: HingeRate | None = None
    stop: Stop | None = None
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    source: Source = SOURCE
    elastic_stiffness: float | None = None

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        rolling_weight: RollingWeight = 1.0,
        after_jamming: AfterJamming | str = AfterJamming.HOLD,
    ) -> FoldedProfileLaw:
        """Law of a profile.

        Parameters
        ----------
        section
            Channel (about z), hat or closed hat (about y).
        material
            Of walls without their own material: yield stress and elastic constants for the largest moment,
            flow stress for the mechanisms, flow rate for the rate factor.
        axis
            Along the face that is compressed or stretched.
        rolling_weight
            Weight of the second rolling line of each web.
        after_jamming
            What follows when the walls touch: a further fold in series, an elastic stop, or the moment held.

        Raises
        ------
        InputError
            If the section is not such a profile, the axis is the other one, or an option is unknown.
        """
        after = choice("after_jamming", after_jamming, AfterJamming)
        weight = number_between("rolling_weight", rolling_weight, 0.0, 1.0)
        peaks = [moment_capacity(section, material, axis, sense=sense) for sense in (1, -1)]
        positive, negative = _folds(section, material, axis, weight, peaks)
        jamming = min(positive.jamming_angle, negative.jamming_angle)
        length = section.flange_width(axis)
        stop = Stop(jamming, material.youngs_modulus * section.second_moment(axis) / length)
        return cls(
            positive,
            negative,
            _validity(section, material, peaks, jamming),
            after,
            hinge_rate(material.flow_rate),
            stop if after is AfterJamming.STOP else None,
            source=HAT_SOURCE if isinstance(section, ClosedHat) else SOURCE,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        names = {
            FreeEdgeMechanism: "free edges",
            ProfileMechanism: "folding faces",
            CompressedPlate: "folding plate and flanges",
        }
        words = [names[type(each.mechanism)] for each in (self.positive, self.negative)]
        return f"folded profile: {words[0]} in the positive sense, {words[1]} in the negative"

    @property
    def jamming_angle(self) -> float:
        """Smaller jamming angle of the two senses [rad]."""
        return min(self.positive.jamming_angle, self.negative.jamming_angle)

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.positive == self.negative

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]."""
        fold = self._fold(sense)
        return continued_kinks(fold.kinks, fold.jamming_angle, self.after_jamming)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        fold = self._fold(sense)
        return continued(fold.moment, rotation, fold.jamming_angle, self.after_jamming)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)

    def _fold(self, sense: int) -> CappedMechanism:
        return self.positive if sense > 0 else self.negative


def _folds(
    section: Section, material: Material, axis: Axis, weight: float, peaks: list[MomentCapacity]
) -> tuple[CappedMechanism, CappedMechanism]:
    """Governing mechanism of the positive and of the negative sense, under its largest moment."""
    if isinstance(section, ClosedHat) and axis == "y":
        return _closed_hat(section, material, weight, peaks)
    if isinstance(section, Channel) and axis == "z":
        spacing, depth, edge = section.depth, section.width, section.lip
    elif isinstance(section, Hat) and axis == "y":
        spacing, depth, edge = section.width, section.depth, section.flange
    else:
        allowed = "a channel about z, a hat or a closed hat about y"
        what, todo = (
            "no folding mechanism is available for this section and axis",
            "use a table or a constant law",
        )
        raise InputError(Problem(what, f"{section.title} about {axis}", allowed, todo, "section"))
    sizes = (spacing, depth, section.thickness, material.flow_stress, weight)
    opened = _governing(
        FreeEdgeMechanism(depth, section.thickness, material.flow_stress, spacing, edge, FREE_EDGE),
        ProfileMechanism(*sizes, compressed_face=2.0 * edge, stretched_face=spacing),
    )
    closed = ProfileMechanism(*sizes, compressed_face=spacing, stretched_face=2.0 * edge)
    return CappedMechanism(peaks[0].moment, opened), CappedMechanism(peaks[1].moment, closed)


def _closed_hat(
    section: ClosedHat, material: Material, weight: float, peaks: list[MomentCapacity]
) -> tuple[CappedMechanism, CappedMechanism]:
    """Plate compressed, up to the rotation at which a folded crown jams; crown compressed."""
    hat, plate = section.hat_material or material, section.plate_material or material
    layer = (section.plate_thickness or section.thickness) / section.thickness
    doubled = 2.0 * section.flange
    plate_face = doubled + (section.width + doubled) * layer**2 * plate.flow_stress / hat.flow_stress
    sizes = (section.width, section.depth, section.thickness, hat.flow_stress, weight)
    crown = ProfileMechanism(*sizes, compressed_face=section.width, stretched_face=plate_face)
    flat, folded = (
        CompressedPlate.of(section, material, crown.jamming_angle, flows=flows) for flows in (False, True)
    )
    start = min(flat.peak, peaks[0].plastic_moment)
    return CappedMechanism(start, folded), CappedMechanism(peaks[1].moment, crown)


def _governing(*mechanisms: Mechanism) -> Mechanism:
    """Mechanism that needs the least work up to half the smallest jamming angle."""
    reach = min(each.jamming_angle for each in mechanisms) / 2.0
    return min(mechanisms, key=lambda each: float(each.energy(np.float64(reach))))


def _validity(section: Section, material: Material, peaks: list[MomentCapacity], jamming: float) -> Validity:
    warnings = dict.fromkeys(sentence for peak in peaks for sentence in peak.warnings)
    uncertainty = UNCERTAINTY
    basis = (
        "twenty open profiles take within 21 % of this work in shells up to 20 deg, plain channels whose "
        "edges buckle before they yield up to half as much again"
    )
    sentences = ["compared with shells of channels of 1.2 to 2.5 mm and hats of 1 to 2 mm, not with tests"]
    if isinstance(section, ClosedHat):
        outside = not_compared(section, material)
        sentences = ["the spot welds do not fail in this law"]
        if outside:
            basis = "the band is the one of open profiles"
            sentences.append(f"compared with shells only for other hats ({outside})")
        else:
            uncertainty = HAT_UNCERTAINTY
            basis = "the band is the largest difference from shells in the work up to 20 deg, thirteen hats"
    sentences += [*warnings, *rate_warnings(material)]
    return Validity(
        jamming, f"{basis}; one side jams at {np.degrees(jamming):.1f} deg", tuple(sentences), uncertainty
    )


def not_compared(section: ClosedHat, material: Material) -> str:
    """What of a closed hat lies outside of those that were compared with shells; empty if nothing does."""
    shares = {
        "width/thickness": section.width / section.thickness,
        "depth/width": section.depth / section.width,
        "flange/width": section.flange / section.width,
        "yield/E": material.yield_stress / material.youngs_modulus,
    }
    found = [
        f"{name} {low:g} to {high:g}"
        for name, (low, high) in COMPARED.items()
        if not low * (1.0 - 1e-9) <= shares[name] <= high * (1.0 + 1e-9)
    ]
    if (
        section.plate_thickness not in (0.0, section.thickness)
        or section.hat_material
        or section.plate_material
    ):
        found.append("plate like the hat")
    if section.corner_radius:
        found.append("sharp corners")
    if material.flow_stress != material.yield_stress:
        found.append("no hardening")
    return ", ".join(found)
