"""Motion of each hinge, in one form for both fidelities.

A multibody result contains it in its channels.  In a shell result it is measured:

- rotation: of the section plane beyond the fold relative to the one before it, about the hinge's axis, which
  moves with the plane before it;
- plastic work: the energy dissipated between the planes;
- moment: the channel of that name if the result has one, else the moment conjugate to plastic work, that is,
  work over rotation in a window of rotation;
- plastic rotation: rotation - M/k, k = EI over the distance of the planes.

A hinge about two bending axes has one rotation here: the angle by which it bends, whatever the axis, in both
results, with 1/k = cos^2/k_y + sin^2/k_z in the direction in which it bends most.

In every source the rate of rotation is computed from the rotations of successive shapes: a rate at one
instant shows vibration that a rate over an interval does not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crumple.comparison.measure.fold_moment import ELASTIC_WORK, Bent, moment_in
from crumple.comparison.measure.folds import Fold, find_folds
from crumple.comparison.measure.sections import Sections, sections_of
from crumple.hinge import Freedom
from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.result import Result
from crumple.structure import PlacedHinge, Structure

REACH = 2.0
"""Distance along the member within which a fold belongs to a hinge, over the section's largest side."""


@dataclass(frozen=True, eq=False)
class HingeMotion:
    """History of one hinge or fold.

    Attributes
    ----------
    name
        Of the hinge; for a fold without a hinge ``MEMBER at 123 mm``.
    member, station
        Position along a member [m].
    time
        [s], (n,).
    rotation, rotation_rate, plastic_rotation
        Signed [rad], [rad/s], (n,); the rate is the change of rotation from shape to shape.
    moment
        In the sense of the rotation rate [N m], (n,).
    plastic_work
        Dissipated so far [J], (n,).
    how
        How it was measured, in one sentence.
    far
        Rotation seen from the far end of the member [rad], (n,): rotation of the line between the ends of
        the member relative to the section at the nearer end; None without shapes.
    extent
        Range of the fold [m], or None.
    planes
        Stations of the planes [m] that the rotation is measured between, or None.
    crushed
        Largest shortening between the planes beyond that of a bend in their middle, over their distance at
        the start [-]; 0 where it was not measured.
    fold
        Whether a fold was found here; a multibody hinge counts once it has turned plastically.
    """

    name: str
    member: str
    station: float
    time: Floats
    rotation: Floats
    rotation_rate: Floats
    plastic_rotation: Floats
    moment: Floats
    plastic_work: Floats
    how: str
    far: Floats | None = None
    extent: tuple[float, float] | None = None
    planes: tuple[float, float] | None = None
    crushed: float = 0.0
    fold: bool = True

    @property
    def sense(self) -> float:
        """+1 or -1: the sense of the largest rotation."""
        if not self.rotation.size:
            return 1.0
        return float(np.sign(self.rotation[int(np.argmax(np.abs(self.rotation)))]) or 1.0)

    def until(self, end: float) -> HingeMotion:
        """The same motion up to the first output time not before a time [s]."""
        last = int(np.searchsorted(self.time, end))
        if last + 1 >= self.time.size:
            return self
        histories = ("time", "rotation", "rotation_rate", "plastic_rotation", "moment", "plastic_work")
        kept = {name: getattr(self, name)[: last + 1] for name in histories}
        return replace(self, far=None if self.far is None else self.far[: last + 1], **kept)


def channel_motions(
    result: Result, hinges: Sequence[PlacedHinge], sections: Mapping[str, Sections]
) -> list[HingeMotion]:
    """Hinges of a result that has their channels, in the order given."""
    found = []
    for hinge in hinges:
        prefix = f"hinge.{hinge.name}."
        if prefix + "rotation" not in result.channels:
            continue
        rotation = result[prefix + "rotation"]
        zero = np.zeros_like(rotation)
        rate, plastic, moment, work = (
            result[prefix + key] if prefix + key in result.channels else zero
            for key in ("rotation_rate", "plastic_rotation", "moment", "energy")
        )
        if bends_two_ways(hinge):
            rotation, plastic, moment = (
                np.hypot(result[f"{prefix}{key}.y"], result[f"{prefix}{key}.z"])
                for key in ("rotation", "plastic_rotation", "moment")
            )
        moved = float(np.ptp(plastic)) if rotation.size else 0.0
        own, far = sections.get(hinge.member), None
        if own is not None:
            seen = np.interp(own.times, result.time, rotation)
            rate = np.interp(result.time, own.times, rate_of(seen, own.times))
            far = np.interp(result.time, own.times, _far(own, hinge))
        found.append(
            HingeMotion(
                name=hinge.name,
                member=hinge.member,
                station=hinge.station,
                time=result.time,
                rotation=rotation,
                rotation_rate=rate,
                plastic_rotation=plastic,
                moment=moment,
                plastic_work=work,
                how="The hinge's own histories.",
                far=far,
                fold=moved > 0.0,
            )
        )
    return found


@dataclass(frozen=True, eq=False)
class Measured:
    """Sections, folds and hinges measured in the shapes of one result."""

    sections: dict[str, Sections]
    folds: tuple[Fold, ...]
    hinges: tuple[HingeMotion, ...]
    extra: tuple[HingeMotion, ...]
    """Folds without a hinge."""


def measured(result: Result, structure: Structure, hinges: Sequence[PlacedHinge]) -> Measured:
    """Measure the motion of each hinge in a result with shapes, and folds elsewhere.

    Parameters
    ----------
    result
        With states; its histories of energy are used if available.
    structure
        For sections, materials and axes.
    hinges
        Of the structure.
    """
    states = result.states
    if states is None or not len(states.times):
        return Measured({}, (), (), ())
    sections = member_sections(result, structure)
    depths = {m: largest_side(structure, m) for m in sections}
    folds = find_folds(states, sections, depths)
    pairs = matched(folds, hinges, depths)
    motions = []
    for hinge in hinges:
        if hinge.member not in sections:
            continue
        fold = next((folds[i] for i, name in pairs.items() if name == hinge.name), None)
        planes = _planes(sections[hinge.member], hinge, fold, hinges, depths[hinge.member])
        motions.append(_measure(result, structure, sections[hinge.member], _Site(hinge, fold, planes)))
    extra = []
    for i, fold in enumerate(folds):
        if i not in pairs:
            site = _Site(_stand_in(structure, sections[fold.member], fold), fold, fold.planes)
            extra.append(_measure(result, structure, sections[fold.member], site))
    return Measured(sections, tuple(folds), tuple(motions), tuple(extra))


def member_sections(result: Result, structure: Structure) -> dict[str, Sections]:
    """Sections of every member that the result has shapes of."""
    if result.states is None:
        return {}
    return {m: own for m in structure.members if (own := sections_of(result.states, m)) is not None}


@dataclass(frozen=True)
class _Where:
    """The data of a placed hinge that the measurement needs."""

    name: str
    member: str
    station: float
    axis: str
    direction: Floats


@dataclass(frozen=True)
class _Site:
    """Hinge (or one created for a fold without a hinge), its fold if any, and the sections on both sides."""

    hinge: PlacedHinge | _Where
    fold: Fold | None
    planes: tuple[int, int]


def largest_side(structure: Structure, member: str) -> float:
    """Largest side of a member's section along its mid-line [m]."""
    return float(np.ptp(structure.section_of(member).outline(), axis=0).max())


def matched(folds: Sequence[Fold], hinges: Sequence[PlacedHinge], depths: dict[str, float]) -> dict[int, str]:
    """Hinge that each fold belongs to, by the fold's index: nearest pairs first, one to one."""
    distances = sorted(
        (abs(fold.station - hinge.station), i, hinge.name)
        for i, fold in enumerate(folds)
        for hinge in hinges
        if hinge.member == fold.member
    )
    pairs: dict[int, str] = {}
    for distance, i, name in distances:
        near = distance <= REACH * depths[folds[i].member]
        if near and i not in pairs and name not in pairs.values():
            pairs[i] = name
    return pairs


def _planes(
    own: Sections, hinge: PlacedHinge, fold: Fold | None, hinges: Sequence[PlacedHinge], depth: float
) -> tuple[int, int]:
    """Sections on both sides of a hinge: those of its fold, but no farther than half-way to other hinges."""
    along = sorted(other.station for other in hinges if other.member == hinge.member)
    place = along.index(hinge.station)
    low = (along[place - 1] + hinge.station) / 2 if place else -np.inf
    high = (along[place + 1] + hinge.station) / 2 if place + 1 < len(along) else np.inf
    start, end = (
        (hinge.station - depth, hinge.station + depth)
        if fold is None
        else (float(own.stations[fold.planes[0]]), float(own.stations[fold.planes[1]]))
    )
    first, last = own.nearest(max(start, low)), own.nearest(min(end, high))
    if first == last:
        first, last = max(first - 1, 0), min(last + 1, len(own.stations) - 1)
    return first, last


def _stand_in(structure: Structure, own: Sections, fold: Fold) -> _Where:
    """A hinge for a fold without one, about the section axis about which it rotated more."""
    frame = structure.frame_of(fold.member)
    first, last = fold.planes
    turns = {
        axis: float(np.abs(own.relative_rotation(frame.axis(axis), first, last)).max()) for axis in ("y", "z")
    }
    axis = largest_first(turns)[0]
    name = f"{fold.member} at {fold.station * 1e3:.0f} mm"
    return _Where(name, fold.member, fold.station, axis, frame.axis(axis))


def _measure(result: Result, structure: Structure, own: Sections, site: _Site) -> HingeMotion:
    hinge, fold = site.hinge, site.fold
    first, last = site.planes
    a, b = float(own.stations[first]), float(own.stations[last])
    two_ways = bends_two_ways(hinge)
    rotation = own.bend(first, last) if two_ways else own.relative_rotation(hinge.direction, first, last)
    stiffness = _stiffness(structure, own, site)
    work = _work(result, own.times, fold)
    # along the axis of the bend: the hinge's own channels contain its twist
    axes, axis = (own.bend_axes(first, last), None) if two_ways else (None, hinge.axis)
    moment, origin = moment_in(result, hinge.name, Bent(own.times, rotation, work, stiffness, axes, axis))
    plastic = rotation - moment / stiffness if fold is not None else np.zeros_like(rotation)
    elastic = work < ELASTIC_WORK * max(float(work.max(initial=0.0)), 1e-300)
    plastic = np.where(elastic, 0.0, plastic)
    where = (
        f"the fold found from {fold.start * 1e3:.0f} to {fold.end * 1e3:.0f} mm"
        if fold
        else "no fold found here"
    )
    how = (
        f"{'The angle between' if two_ways else 'Between'} best-fit planes of the sections at {a * 1e3:.0f} "
        f"and {b * 1e3:.0f} mm of member {hinge.member} ({where}); {origin}; elastic part M/k "
        f"with k = {stiffness / 1e3:.3g} kN m/rad."
    )
    return HingeMotion(
        name=hinge.name,
        member=hinge.member,
        station=fold.station if fold is not None else hinge.station,
        time=own.times,
        rotation=rotation,
        rotation_rate=rate_of(rotation, own.times),
        plastic_rotation=plastic,
        moment=moment,
        plastic_work=work,
        how=how,
        far=_far(own, hinge),
        extent=(fold.start, fold.end) if fold is not None else None,
        planes=(a, b),
        crushed=_crushed(own, first, last),
        fold=fold is not None,
    )


def _crushed(own: Sections, first: int, last: int) -> float:
    """Largest shortening between two sections beyond that of a kink half-way, over their distance [-]."""
    at_start = float(np.linalg.norm(own.start_centres[last] - own.start_centres[first]))
    now = np.linalg.norm(own.centres[:, last] - own.centres[:, first], axis=1)
    return max(float((np.cos(own.bend(first, last) / 2) - now / at_start).max()), 0.0)


def bends_two_ways(hinge: PlacedHinge | _Where) -> bool:
    """Whether a hinge bends about both axes of its section."""
    spatial = None if isinstance(hinge, _Where) else hinge.spatial
    return spatial is not None and {Freedom.Y, Freedom.Z} <= set(spatial.freedoms)


def _stiffness(structure: Structure, own: Sections, site: _Site) -> float:
    """Elastic bending stiffness between the planes [N m/rad]."""
    hinge, (first, last) = site.hinge, site.planes
    section, modulus = structure.section_of(hinge.member), structure.material_of(hinge.member).youngs_modulus
    length = float(own.stations[last] - own.stations[first])
    if not bends_two_ways(hinge):
        return modulus * section.second_moment(hinge.axis) / length  # type: ignore[arg-type]
    frame = structure.frame_of(hinge.member)
    turned = {axis: own.relative_rotation(frame.axis(axis), first, last) for axis in ("y", "z")}
    most = int(np.argmax(np.hypot(turned["y"], turned["z"])))
    y, z = float(turned["y"][most]), float(turned["z"][most])
    share = y * y / (y * y + z * z) if y or z else 1.0
    soft = share / section.second_moment("y") + (1.0 - share) / section.second_moment("z")
    return modulus / (soft * length)


def _far(own: Sections, hinge: PlacedHinge | _Where) -> Floats:
    """Rotation of a hinge seen from the far end of its member [rad], (n_states,)."""
    if bends_two_ways(hinge):
        near = hinge.station <= (own.stations[0] + own.stations[-1]) / 2
        return own.chord_bend(0 if near else len(own.stations) - 1)
    return far_rotation(own, hinge.station, hinge.direction)


def far_rotation(own: Sections, station: float, axis: Floats) -> Floats:
    """Rotation of a hinge seen from the far end of its member [rad], (n_states,).

    For a hinge in the member's first half: rotation of the line between the ends relative to the first
    section; in the second half: rotation of the last section relative to that line.  For a single hinge at
    a clamp this is the angle at which the free end appears from the clamp.
    """
    if station <= (own.stations[0] + own.stations[-1]) / 2:
        return own.chord_rotation(axis, 0)
    return -own.chord_rotation(axis, len(own.stations) - 1)


def rate_of(values: Floats, time: Floats) -> Floats:
    """Derivative by central differences; zero for a single time."""
    return np.asarray(np.gradient(values, time)) if time.size > 1 else np.zeros_like(values)


def _work(result: Result, times: Floats, fold: Fold | None) -> Floats:
    """Energy dissipated in a fold [J] at the times of the shapes."""
    if fold is None or "energy.dissipated" not in result.channels:
        return np.zeros_like(times)
    total = np.interp(times, result.time, result["energy.dissipated"])
    return np.asarray(np.maximum.accumulate(fold.share * total))
