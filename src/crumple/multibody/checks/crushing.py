"""Members struck along their axis whose hinges cannot shorten: the model has no axial folding there.

A hinge without an axial component carries any axial force.  What would fold the walls is the peak of the
first axial law that takes the section, or its squash load.  Against it stands, at every hinge, the axial
force that two outputs in a row reach; and, where impacts took most of the energy, the force of an obstacle on
members that lie along it: its impulse over the time in which an elastic wave goes along the member and back,
since a rigid impact takes none.

Rigid bars do not buckle either.  Under slow loading the same force, of hinges that shorten too, is compared
with Euler's load of the member between pinned ends, pi^2 E I/L^2 with the smaller second moment.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from crumple.errors import InputError
from crumple.hinge import AxialLaw, Freedom, axial_law_types, build_axial_law
from crumple.hinge.axial.hardened_peak import necking_strain
from crumple.multibody.answer.crush import crush_of
from crumple.multibody.answer.forces import on_second
from crumple.multibody.answer.poses import SpatialPoses
from crumple.multibody.answer.solved import Solved
from crumple.multibody.checks.names import named
from crumple.numeric.arrays import Floats
from crumple.numeric.crossing import first_above
from crumple.numeric.rotation import turned
from crumple.result import Caution
from crumple.section import AXES, plastic_interaction
from crumple.structure import Structure
from crumple.structure.checks.doubtful import double_members
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.joint_reach import strikes_joint
from crumple.structure.hinges.lengthening.stopped import stopped
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.units import format_quantity, plain_number

ALONG = np.cos(np.radians(30.0))
"""Cosine of the angle between a blow and a member's axis below which it counts as bending, not crushing."""

CLOSED = 1.02
"""Crushed length over the stroke above which a caution is given: stops yield a little."""
CLOSEST = 0.86
"""Shortening over length at which folds are closed where no law takes the section: the largest of any law,
that of the thinnest round tubes."""
ELONGATION = 0.2
"""Lengthening over length at which metals without a hardening curve and a failure strain break: structural
steels reach 0.20 to 0.26 between the marks of a bar in tension (EN 10025-2), most others less."""
BEND = (
    "or 'members: elastic' in analysis.multibody, with which automatic hinges shorten where an impact "
    "would stop the structure, "
)
"""What else helps rigid members with automatic hinges."""


def crushing_cautions(structure: Structure, solved: Solved, *, struck: bool) -> Iterator[Caution]:
    """A caution for every member that would fold along its axis, and cannot in this model.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.  The planar kernel gives no forces, and so no cautions.
    struck
        Whether impacts took most of the energy.
    """
    found: dict[str, float] = {}
    at_hinges = _pressed(structure, solved, shortening=False)
    for member, force in (*at_hinges, *(_blows(structure, solved) if struck else ())):
        found[member] = max(force, found.get(member, 0.0))
    hinged = {history.hinge.member for history in solved.hinges}
    alike: dict[tuple[str, str, bool], dict[str, float]] = {}
    for member, force in found.items():
        spec = structure.members[member]
        alike.setdefault((spec.section, spec.material, member in hinged), {})[member] = force
    for (_, _, has_hinges), members in alike.items():
        law, peak = folding(structure, next(iter(members)))
        beyond = {member: force for member, force in members.items() if force > peak}
        if not beyond:
            continue
        one = len(beyond) == 1
        it = "it" if one else "them"
        what = f"by the law {law}" if law else "the squash load"
        text = (
            f"{named('Member', list(beyond))} {'carries' if one else 'carry'} up to "
            f"{plain_number(max(beyond.values()) / 1e3)} kN along {'its axis' if one else 'their axes'}, and "
            f"{plain_number(peak / 1e3)} kN fold the walls ({what}), but "
            f"{f'nothing in {it} can shorten' if has_hinges else _bare(len(beyond))}: axial folding is not "
            f"modelled. Give {it} hinges with 'axial: {{law: {law or 'superfolding'}}}', "
            f"{'' if solved.bending_tried else _bending(structure, beyond)}or solve with shells."
        )
        for member, force in beyond.items():
            yield Caution("axial_compression", force, peak, "N", f"member {member}", text)


def _bare(number: int) -> str:
    return f"without hinges {'it is one rigid body' if number == 1 else 'each is one rigid body'}"


def _closed_together(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members whose hinges together are crushed by more than the stroke of their folds.

    Every hinge has the stroke of the whole member, since the folds begin where the peak is reached first.
    """
    found: dict[str, list[tuple[float, Floats]]] = {}
    for history in solved.hinges:
        crush = crush_of(structure, history)
        if crush is not None and crush.stroke is not None:
            short = np.maximum(-history.values("slip.x.travel"), 0.0)
            found.setdefault(history.hinge.member, []).append((crush.stroke, short))
    for member, zones in found.items():
        stroke, short = zones[0][0], np.sum([one for _, one in zones], axis=0)
        when = first_above(solved.time, short, CLOSED * stroke)
        # where the others do next to nothing the force rises to that of a stop: another caution
        others = float(short.max()) - max(float(one.max()) for _, one in zones)
        if when is not None and others > (CLOSED - 1.0) * stroke:
            text = (
                f"Member {member} is crushed by {format_quantity(float(short.max()), 'm', 3)} at its hinges "
                f"together, and its folds are closed at {format_quantity(stroke, 'm', 3)}, reached at "
                f"{format_quantity(when, 's', 3)}: from then on forces are too small and displacements too "
                "large. Give it one hinge with 'axial', or solve with shells."
            )
            yield Caution("bottomed_out", float(short.max()), stroke, "m", f"member {member}", text)


def lengths_beyond(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members that are shorter than closed folds, or longer than metal stretches.

    Notes
    -----
    Hinges that yield along the member in place of folding have no stroke, and none has an end in tension.
    The folds of a section are closed at the effective stroke of the first axial law that takes it, else at
    `CLOSEST`.  Metal stretches evenly up to its neck (Considere's condition on its hardening curve) or its
    failure strain; what comes later is in a length of about a side, which tears.
    """
    yield from _closed_together(structure, solved)
    for members, slip in _changes_of_length(structure, solved).items():
        if _unstopped(structure, solved, members):
            yield from _shorter(structure, members, solved.time, slip)
        yield from _longer(structure, members, solved.time, slip)


def _shorter(structure: Structure, members: tuple[str, ...], time: Floats, slip: Floats) -> Iterator[Caution]:
    """A caution if members are shorter than closed folds; `slip`: by how much they are longer [m], (n,)."""
    length = sum(structure.frame_of(name).length for name in members)
    law, share = _closing(structure, members[0])
    when, most = first_above(time, -slip, CLOSED * share * length), -float(slip.min())
    if when is None:
        return
    lengths = [format_quantity(one, "m", 3) for one in (most, length, abs(length - most), share * length)]
    left = f"{lengths[2]} are left" if most < length else "its ends have passed each other"
    given = f"'axial: {{law: {law}}}'" if law else "peak, mean and stroke under 'axial'"
    text = (
        f"{named('Member', list(members))}, {lengths[1]} long, {_is(members)} crushed by {lengths[0]} "
        f"({left}): folds of the section are closed at {lengths[3]}{f' (law {law})' if law else ''}, reached "
        f"at {format_quantity(when, 's', 3)}, but no stroke on the member ends that at its hinges. "
        "From then on forces are too small and displacements too large. "
        f"Give the hinges {given}, or solve with shells."
    )
    yield Caution("crushed_beyond", most, share * length, "m", f"member {members[0]}", text)


def _longer(structure: Structure, members: tuple[str, ...], time: Floats, slip: Floats) -> Iterator[Caution]:
    """A caution if members are longer than their metal stretches."""
    length = sum(structure.frame_of(name).length for name in members)
    strain, why = _stretchable(structure, members[0])
    when, most = first_above(time, slip, strain * length), float(slip.max())
    if when is None:
        return
    text = (
        f"{named('Member', list(members))}, {format_quantity(length, 'm', 3)} long, {_is(members)} pulled "
        f"longer by {format_quantity(most, 'm', 3)}, {most / length:.3g} of the length: {why} {strain:.3g}, "
        f"reached at {format_quantity(when, 's', 3)}. A real member tears soon after, and what it carries "
        "and absorbs from then on is too much. Solve with shells and a failure_strain, or hold it less "
        "firmly."
    )
    yield Caution("stretched_beyond", most, strain * length, "m", f"member {members[0]}", text)


def _is(members: Sequence[str]) -> str:
    return "is" if len(members) == 1 else "are together"


def _changes_of_length(structure: Structure, solved: Solved) -> dict[tuple[str, ...], Floats]:
    """Members that change their length, and by how much [m], (n,); positive: longer.

    The automatic hinges of members in line stand for all of them.  After a fracture nothing counts.
    """
    found: dict[tuple[str, ...], Floats] = {}
    for history in solved.hinges:
        spatial, member = history.hinge.spatial, history.hinge.member
        if spatial is None or Freedom.AXIAL not in spatial.freedoms:
            continue
        slip = history.values("slip.x.travel")
        if history.fracture is not None:
            whole = max(int(np.searchsorted(solved.time, history.fracture[0])) - 1, 0)
            slip = np.where(np.arange(len(slip)) > whole, slip[whole], slip)
        asked = automatic_of(structure, member)
        members = (member,) if asked is None else tuple(straight_run(structure, member).stretches)
        found[members] = found.get(members, 0.0) + slip
    return found


def _unstopped(structure: Structure, solved: Solved, members: Iterable[str]) -> bool:
    """Whether no hinge of these members has a stroke on them: of others there are cautions of their own."""
    length = sum(structure.frame_of(name).length for name in members)
    zones = (crush_of(structure, one) for one in solved.hinges if one.hinge.member in members)
    return all(zone is None or zone.stroke is None or zone.stroke >= length for zone in zones)


def _closing(structure: Structure, member: str) -> tuple[str, float]:
    """Law of a member's section and its effective stroke over the length; without a law `CLOSEST`."""
    name, law = _axial_law(structure, member)
    return name, CLOSEST if law is None else law.effective_stroke


def _stretchable(structure: Structure, member: str) -> tuple[float, str]:
    """Lengthening over length that the metal of a member bears, and why."""
    material = structure.material_of(member)
    limits = []
    if material.hardening is not None:
        neck = math.expm1(necking_strain(material.hardening))
        limits.append((neck, "its metal necks (by its hardening curve) at"))
    if material.failure_strain is not None:
        limits.append((math.expm1(material.failure_strain), "its failure strain is reached at"))
    return min(limits, default=(ELONGATION, "structural metals break at about"))


def buckling_cautions(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """One caution for all rigid members that carry more than Euler's load between pinned ends.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run, with slow loading.
    """
    found: dict[str, tuple[float, float]] = {}
    for member, force in _pressed(structure, solved, shortening=True):
        limit = _euler(structure, member)
        if not structure.members[member].elastic and force > max(limit, found.get(member, (0.0, 0.0))[0]):
            found[member] = force, limit
    if found:
        worst = max(found, key=lambda member: found[member][0] / found[member][1])
        force, limit = found[worst]
        advice = "" if solved.bending_tried else "let members bend (analysis.multibody.members: elastic), or "
        text = (
            f"{named('Member', list(found))} {'carries' if len(found) == 1 else 'carry'} up to "
            f"{force / limit:.3g} times the load of Euler between pinned ends ({worst}: "
            f"{plain_number(force / 1e3)} kN, {plain_number(limit / 1e3)} kN). Rigid bars do not buckle: "
            f"forces and energies may be several times too large; {advice}"
            "make the quasi-static stage a slow dynamic one, or solve "
            "with shells."
        )
        for member, (force, limit) in found.items():
            yield Caution("buckling", force, limit, "N", f"member {member}", text)


def _euler(structure: Structure, member: str) -> float:
    section = structure.section_of(member)
    smaller = min(section.second_moment(axis) for axis in AXES)
    bending = structure.material_of(member).youngs_modulus * smaller
    return float(np.pi**2 * bending / structure.frame_of(member).length ** 2)


def _bending(structure: Structure, members: Iterable[str]) -> str:
    """What else helps rigid members with automatic hinges; those without any get them where members bend."""
    if not (stopped(structure) or strikes_joint(structure)):
        return ""
    for name in members:
        spec = structure.members[name]
        if spec.elastic or (automatic_of(structure, name) is None and spec.hinges is not None):
            return ""
        if spec.bars.number > 1:
            return ""
    return BEND


def _pressed(structure: Structure, solved: Solved, *, shortening: bool) -> Iterator[tuple[str, float]]:
    """Members and the largest axial compression [N] at a hinge that persists for two outputs.

    `shortening`: at hinges that shorten too.
    """
    poses = solved.poses
    if not isinstance(poses, SpatialPoses):
        return
    # of two in one place, equal and opposite forces of any size are a possible set
    double = double_members(structure)
    for i, connection in enumerate(poses.linkage.connections):
        hinge = connection.hinge
        if hinge is None or not hinge.plastic or (int(Freedom.AXIAL) in connection.free and not shortening):
            continue
        if hinge.member in double:
            continue
        axis = turned(poses.quaternion(connection.first), structure.frame_of(hinge.member).x)
        pressed = np.einsum("ni,ni->n", on_second(poses, i).force, np.broadcast_to(axis, (len(axis), 3)))
        if pressed.size > 1:
            yield hinge.member, float(np.minimum(pressed[1:], pressed[:-1]).max())


def _blows(structure: Structure, solved: Solved) -> Iterator[tuple[str, float]]:
    """Members along a blow that cannot shorten, and the largest force of an obstacle along them [N]."""
    channels = {channel.name: channel.values for channel in solved.further}
    shortening = {
        history.hinge.member
        for history in solved.hinges
        if history.hinge.spatial is not None and Freedom.AXIAL in history.hinge.spatial.freedoms
    }
    for name in structure.obstacles:
        force = np.column_stack([channels[f"obstacle.{name}.force.{axis}"] for axis in "xyz"])
        if len(force) < 2:
            continue
        for member in structure.members:
            frame, material = structure.frame_of(member), structure.material_of(member)
            wave = math.sqrt(material.youngs_modulus / material.density)
            blow = _strongest(solved.time, force, 2.0 * frame.length / wave)
            along = abs(float(blow @ frame.x))
            # what the input calls rigid is to carry everything, in shells too
            meant = structure.members[member].rigid is True
            if member not in shortening and not meant and along > ALONG * np.linalg.norm(blow):
                yield member, along


def _strongest(time: Floats, force: Floats, lasting: float) -> Floats:
    """Largest mean force (3,) over a time in which a blow lasts [s], of means between outputs, (n, 3).

    Where outputs are farther apart, the blow is all of an impact that happened between two of them: the force
    depends on neither a short nor a long interval.
    """
    # the first value is that of one shortest step, not a mean
    impulse = np.cumsum(np.vstack([np.zeros(3), force[1:] * np.diff(time)[:, None]]), axis=0)
    ends = np.maximum(time[:-1] + lasting, time[1:])
    until = np.column_stack([np.interp(ends, time, one) for one in impulse.T])
    blows = (until - impulse[:-1]) / lasting
    return np.asarray(blows[int(np.argmax(np.linalg.norm(blows, axis=1)))])


def folding(structure: Structure, member: str) -> tuple[str, float]:
    """The axial law that applies to a member's section, and its peak [N]; without a name: the squash load."""
    name, law = _axial_law(structure, member)
    if law is not None:
        return name, float(law.peak_force)
    section, material = structure.section_of(member), structure.material_of(member)
    return "", plastic_interaction(section, material).squash_force


def _axial_law(structure: Structure, member: str) -> tuple[str, AxialLaw | None]:
    """The first axial law that takes a member's section, with its name."""
    section, material = structure.section_of(member), structure.material_of(member)
    for name in axial_law_types():
        try:
            return name, build_axial_law(name, section, material)
        except InputError:
            continue
    return "", None
