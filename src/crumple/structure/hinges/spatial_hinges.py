"""Records of hinges with several components, from the axes in the input."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from crumple.hinge import (
    HingeLaw,
    HingeRecord,
    SofteningVariable,
    build_axial_law,
    build_torsion_law,
    record_of,
)
from crumple.hinge.axial.axial_collapse import AxialCollapse
from crumple.hinge.axial.hardened_peak import strain_at
from crumple.hinge.bending.edge_fold import CROSSED, edge_relief
from crumple.hinge.measured.stored import StoredLaw
from crumple.hinge.measured.stored_crushing import StoredCrushing
from crumple.hinge.record.record import Envelope, Form
from crumple.hinge.record.spatial_record import (
    Coupling,
    Freedom,
    HingeComponent,
    SpatialHingeRecord,
    Spread,
)
from crumple.hinge.record.spatial_recording import scaled, spatial_record
from crumple.hinge.registry import DEFAULT_TORSION, OPEN_TORSION
from crumple.hinge.tube_library.hardening import hardens
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube, RectangularTube, Section
from crumple.structure.hinges.runs.bars import is_closed
from crumple.structure.keys.hinge_axes import AxialSlip, BendingAxis, HingeAxes, Twist
from crumple.structure.remembered import remembered

if TYPE_CHECKING:
    from crumple.hinge import AxialLaw
    from crumple.section import InteractionFit, PlasticInteraction
    from crumple.structure.hinges.shares import HingeShares

BENDING = {"y": Freedom.Y, "z": Freedom.Z}
ROWS = 16
"""Linear forms of the fitted surface: 3 to 4 % off for tubes, as with more, and cheap at every step."""
FLAT, ROUND_FLAT = 0.65, 0.5
"""Power of the share of the moment of a fold that is left, in the share of its torque; of round tubes [-]."""
TWISTED = 0.4
"""Share of the work of twist that softens a fold of metal that hardens [-]: its walls fold late in shear."""
APART = ("none", "tension-flange")
"""Couplings whose components soften apart."""
KEPT = 64
"""Interactions and laws kept; a structure has few pairs of section and material."""


def spatial_hinge_record(
    keys: HingeAxes,
    record_about: Callable[[BendingAxis], HingeRecord],
    axis: BendingAxis,
    metal: tuple[Section, Material],
    shares: HingeShares,
    *,
    torsion: HingeLaw | None = None,
    crush: StoredLaw | None = None,
) -> SpatialHingeRecord:
    """Record of a hinge.

    Parameters
    ----------
    keys
        Axes as given in the input.
    record_about
        Gives the record of a bending axis.
    axis
        Bending axis where the keys name none.
    metal
        Section and material of its member.
    shares
        Lengths of member that it stands for.
    torsion, crush
        Stored laws of its twist and its shortening, where the keys name none.

    Raises
    ------
    InputError
        If the axes and their laws do not fit together.
    """
    section, material = metal
    bending = keys.bending or (axis,)
    components = [HingeComponent(BENDING[about], record_about(about)) for about in bending]
    first = components[0].record
    if "x" in (keys.axes or ()):
        law = torsion if keys.twist is None else None
        own, spring = law_of_twist(keys.twist, metal, shares)
        if law is not None:
            own, spring = law, _uniform_spring(metal, shares.twist)
        twist, softens = _like(first, own, spring), 1.0
        if own.name == DEFAULT_TORSION and keys.twist is None and keys.coupling not in APART:
            power = ROUND_FLAT if isinstance(section, CircularTube) else FLAT
            softens = TWISTED if hardens(material) else 1.0
            twist = flattened(twist, [component.record for component in components], power, softens)
        components.append(HingeComponent(Freedom.X, twist, softens=softens))
    coupling = Coupling(keys.coupling or "section")
    if keys.axial is not None:
        law_of_slip, slip = _axial(keys.axial, crush, first, metal, shares)
        alone = coupling.value in APART or slip.form is Form.REGULARISED
        doubts = law_of_slip.validity.warnings
        whole = HingeComponent(Freedom.AXIAL, slip, origin=law_of_slip.origin, warnings=doubts)
        components.append(whole if alone else _after_rise(law_of_slip, whole, first))
    if coupling is Coupling.SECTION and isinstance(section, CircularTube) and keys.axial is None:
        # its walls share every moment alike, so the ellipsoid is their interaction and needs no fit
        coupling = Coupling.ELLIPSOID
    fitted = len(components) > 1 and coupling is Coupling.SECTION
    record = spatial_record(
        components,
        coupling=coupling,
        interaction=interaction_fit_of(section, material) if fitted else None,
        arm=(section.bending_depth(bending[0]) - section.thickness) / 2.0,
        fracture=math.inf if keys.fracture is None else keys.fracture,
    )
    if fitted and len(bending) > 1 and isinstance(section, RectangularTube):
        record = replace(record, cross_softening=CROSSED, edge_relief=edge_relief(section))
    return beside_shear(record, section, material)


def beside_shear(record: SpatialHingeRecord, section: Section, material: Material) -> SpatialHingeRecord:
    """The same hinge, whose torque leaves its part of the walls to the shear force, if it is coupled."""
    if record.surface.coupling is Coupling.NONE or Freedom.X not in record.freedoms:
        return record
    lost, alike = interaction_of(section, material).torque_lost_to_shear, isinstance(section, CircularTube)
    return replace(record, shear_loss=lost, round_shear=alike)


def _like(
    first: HingeRecord, law: object, stiffness: float | None = None, one_sided: bool = False
) -> HingeRecord:
    """Record of a further component in the form of the first; a one-sided stop is that of shortening."""
    stop = getattr(law, "stop", None)
    return record_of(
        law,  # type: ignore[arg-type]
        form=first.form,
        elastic_stiffness=stiffness,
        softening=SofteningVariable(first.softening_variable),
        stops=(None if one_sided else stop, stop),
        regularisation_rate=first.regularisation_rate,
        rate=math.isfinite(first.rate_reference),
    )


# the hinges of a member, and of members of one section and length, share the laws of twist and collapse
@remembered(KEPT)
def _torsion_law(keys: Twist, section: Section, material: Material, length: float) -> HingeLaw:
    return build_torsion_law(keys.law, section, material, length, **keys.own)


def law_of_twist(
    keys: Twist | None, metal: tuple[Section, Material], shares: HingeShares
) -> tuple[HingeLaw, float]:
    """Law of a hinge's twist, and its spring [N m/rad].

    Open walls that warp do so along all of the member: law and spring are shares of those of its length.
    """
    law = keys.law if keys else DEFAULT_TORSION if is_closed(metal[0]) else OPEN_TORSION
    if law != OPEN_TORSION:
        return _torsion_law(keys or Twist(), *metal, shares.twisted), _uniform_spring(metal, shares.twist)
    given = {key: value for key, value in (keys.own if keys else {}).items() if value is not None}
    whole = Twist(law=law, **{"span": shares.span, "held_ends": shares.held_ends} | given)
    warping = _torsion_law(whole, *metal, shares.twist)
    return warping, float(warping.elastic_stiffness or 0.0)


def _uniform_spring(metal: tuple[Section, Material], length: float) -> float:
    """Stiffness of a length [m] that twists alike all along [N m/rad]."""
    section, material = metal
    return material.shear_modulus * section.torsion_constant / length


def twist_component(
    first: HingeRecord, metal: tuple[Section, Material], shares: HingeShares, *, firm: float = 1.0
) -> HingeComponent:
    """Twist of a length of member beside a component of its bending, with its law.

    Its damper is to its spring as that of the bending.  `firm`: factor on the torque, so that it only twists
    elastically.
    """
    law, spring = law_of_twist(None, metal, shares)
    record = scaled(_like(first, law, spring), firm)
    damping = first.viscous_damping / first.elastic_stiffness * record.elastic_stiffness
    return HingeComponent(Freedom.X, replace(record, viscous_damping=damping))


def flattened(
    twist: HingeRecord, bending: Sequence[HingeRecord], power: float, softens: float = 1.0
) -> HingeRecord:
    """Twist whose torque falls as a fold flattens the section, with a power of what is left of its moment.

    All components of a hinge share one measure of their rotations, a work, in which the twist has the weight
    `softens`; see docs/theory/torsion.md.
    """
    first = softens * float(twist.positive.moment[0])
    curves = [curve for one in bending for curve in (one.positive, one.negative)]
    works = [first * twist.positive.rotation, *(curve.rotation * curve.moment[0] for curve in curves)]
    # works that differ by rounding are of one rotation
    turns = np.unique(np.concatenate(works) / first)
    left = np.mean([_left(curve, first * turns) for curve in curves], axis=0)
    torque = np.interp(turns, twist.positive.rotation, twist.positive.moment) * left**power
    envelope = Envelope(turns, torque)
    return replace(twist, positive=envelope, negative=envelope)


def _left(curve: Envelope, work: Floats) -> Floats:
    """Share of its largest moment that a fold has left after a work of its rotation [J]; it never rises."""
    moment = np.interp(work / curve.moment[0], curve.rotation, curve.moment)
    return np.asarray(np.minimum.accumulate(moment / np.maximum.accumulate(moment)))


def _axial(
    keys: AxialSlip,
    stored: StoredLaw | None,
    first: HingeRecord,
    metal: tuple[Section, Material],
    shares: HingeShares,
) -> tuple[AxialCollapse, HingeRecord]:
    """Law of the slip, and its record as if it had no other component beside it."""
    section, material = metal
    law = _collapse(keys, stored, metal, shares.stretch, shares.axial)
    elastic = material.youngs_modulus * section.area / shares.axial
    return law, _like(first, law, elastic, one_sided=True)


def _after_rise(law: AxialCollapse, whole: HingeComponent, first: HingeRecord) -> HingeComponent:
    """Slip that shares its measure of softening with other components: its rise counts apart."""
    if not any(slip for slip, _ in law.rises):
        return whole
    lengthening, shortening = ((np.array(slip), np.array(share)) for slip, share in law.rises)
    later = _like(first, law.folding, whole.record.elastic_stiffness, one_sided=True)
    return replace(whole, record=later, spread=Spread(lengthening, shortening))


@remembered(KEPT)
def _collapse(
    keys: AxialSlip,
    stored: StoredLaw | None,
    metal: tuple[Section, Material],
    length: float,
    spread: float,
) -> AxialCollapse:
    """Law of a slip: folds along a length [m], before which the metal hardens over another."""
    section, material = metal
    stiffness = material.youngs_modulus * section.area / length
    squash = interaction_of(section, material).squash_force
    tension, neck = keys.tension or squash, keys.tension is None
    crushing: AxialLaw | None = None
    if keys.law is not None:
        crushing = build_axial_law(keys.law, section, material)
    elif keys.yields and stored is not None:
        crushing = StoredCrushing.of(stored)
    if crushing is None:
        law = AxialCollapse.given(
            keys.peak or squash,
            keys.mean or squash,
            keys.stroke or math.inf,
            tension=tension,
            closed_stiffness=stiffness,
        )
        if keys.peak or keys.mean:
            law = replace(law, crushing="forces given in the input")
        return law.hardening(material, 0.0, spread, neck=neck)
    strain = crushing.peak_strain or strain_at(material, crushing.peak_force / squash)
    law = AxialCollapse.of(crushing, length, tension=tension, closed_stiffness=stiffness)
    return law.hardening(material, strain, spread, neck=neck)


@remembered(KEPT)
def interaction_of(section: Section, material: Material) -> PlasticInteraction:
    """Plastic interaction of a section, as the hinges of all its members share it."""
    from crumple.section import plastic_interaction  # noqa: PLC0415  (tubes with plain hinges need no walls)

    return plastic_interaction(section, material)


@remembered(KEPT)
def interaction_fit_of(section: Section, material: Material) -> InteractionFit:
    """The same as its hinges have it: a compact fit."""
    from crumple.section import fitted_interaction  # noqa: PLC0415

    return fitted_interaction(interaction_of(section, material), rows=ROWS)
