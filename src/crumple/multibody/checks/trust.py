"""Assumptions and warnings of a multibody result."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.hinge import Form, Freedom, SofteningVariable
from crumple.hinge.law import BEYOND_RANGE, HingeLaw
from crumple.multibody.answer.crush import crush_of
from crumple.multibody.answer.solved import HingeHistory, Solved, Solver
from crumple.multibody.bodies.crumpling_ends import crumpling_ends
from crumple.multibody.bodies.initial_motion import stretched
from crumple.multibody.bodies.linkage import link
from crumple.multibody.bodies.mobility import free_parts
from crumple.multibody.checks.broken import broken_warnings
from crumple.multibody.checks.elastic_energy import energy_left_out
from crumple.multibody.checks.held_parts import held_part_warnings
from crumple.multibody.checks.names import named
from crumple.multibody.checks.overlap import overlap_warnings
from crumple.multibody.checks.physics import energy_put_in
from crumple.multibody.checks.struck import struck_near_ends, too_stiff_hats, undented
from crumple.multibody.checks.stuck_drives import loose_drives
from crumple.multibody.run import Run
from crumple.result import HingeSummary
from crumple.structure import PlacedHinge, Structure, corners_without_law, dented_tubes, rigid_for_long
from crumple.structure.checks.partly_driven import driven_assumptions
from crumple.text.names import listed
from crumple.units import format_quantity, plain_number

LOST_SHARE = 0.05
"""Share of the energy input that may be lost at the start before a warning is given: a node that is thrown
alone takes a piece of its members along, which costs some percent."""
MOST = 0.5
"""The same share from which the parts are taken to be locked, as bars of fixed length in a triangle are."""
ELASTIC_SHARE = 0.05
"""Share of elastic energy above which rigid bars need a warning: as large as the laws' own scatter."""
ERROR_SHARE = 0.01
"""Estimated error of a rotation relative to the largest rotation above which a warning is given."""
SMALL_ERROR = 5e-4
"""Estimated error [rad] that is negligible, however small the rotations are: 0.03 deg."""
BEND = "; use analysis.multibody.members: elastic"
"""What helps rigid bars that could store more."""
SLOW_SHARE = 0.05
"""Energy removed from the motion over that in the structure above which a stage is not quasi-static."""
LOCKED = (
    " If members must change their length for it, as in a triangle, give their hinges 'axial: true', or "
    "solve with shells."
)
NEARLY = 0.8
"""Share of its first moment from which a hinge at rest is told what is unsure of its law: the laws' own
scatter; a hinge that is loaded less stays at rest in spite of it."""
OFF_AXIS = 0.5
"""Angle [deg] between a hinge's axis and the normal of the plane above which bending across counts."""
SOFTENING = {
    SofteningVariable.PEAK: "the largest plastic rotation of both senses (bent back, it stays weak)",
    SofteningVariable.ROTATION: "the present plastic rotation (bent back, it regains its strength)",
    SofteningVariable.ACCUMULATED: "the sum of all plastic rotation, both senses together",
}


PLANAR = "The motion is planar: hinges turn about parallel axes and carry everything across them rigidly."
SHEARED = (
    "Shear forces leave hinges of closed sections less torque, as their walls carry both; "
    "members do not slip sideways where they yield."
)
AT_OUTPUTS = (
    "Forces in members and on obstacles, speeds of nodes and depths of dents are judged at the outputs: what "
    "lasts shorter than their interval may have no caution."
)
SPATIAL = "The motion is spatial: hinges carry rigidly what is not about their own axes."


def assumptions(structure: Structure, solver: Solver, run: Run) -> tuple[str, ...]:
    """Sentences with the assumptions of the model."""
    jointed = dict.fromkeys(hinge.member for hinge in solver.hinges if not hinge.plastic)
    long = rigid_for_long(structure, run.settings, run.time_in_motion)
    rigid = [] if long else [name for name in structure.members if name not in jointed]
    found = [
        *([long or "Members are rigid between their hinges."] if long or not jointed else []),
        *([f"{named('Member', rigid)} are rigid between hinges."] if jointed and len(rigid) > 1 else []),
        *([f"Member {rigid[0]} is rigid between hinges."] if jointed and len(rigid) == 1 else []),
        "Masses are rigid lumps.",
        PLANAR if solver.kernel == "tree" else SPATIAL,
        _contact(structure),
        *(
            f"End {end.node} of member {end.member} crumples on obstacle {end.obstacle} at "
            f"{plain_number(end.force / 1e3)} kN when its whole face is touched."
            for end in crumpling_ends(structure)
        ),
        *_dents(structure),
        *driven_assumptions(structure),
        *([AT_OUTPUTS] if solver.kernel != "tree" else []),
        *free_parts(link(structure)),
        *solver.notes,
    ]
    found += corners_without_law(structure)
    for name, welds in structure.spot_welds.items():
        if len(welds.members) == 2:
            first, second = welds.members
            found.append(f"Spot welds {name} join members {first} and {second} rigidly and do not fail.")
        elif welds.fails:
            found.append(f"Spot welds {name} of member {welds.members[0]} do not fail.")
    alike: dict[tuple[Form, bool, SofteningVariable], list[PlacedHinge]] = {}
    for hinge in solver.hinges:
        if not hinge.plastic:
            continue
        key = (hinge.record.form, math.isfinite(hinge.record.rate_reference), hinge.record.softening_variable)
        alike.setdefault(key, []).append(hinge)
    found += [_carries(structure, hinges) for hinges in alike.values()]
    if any(hinge.spatial is not None and any(hinge.spatial.shear_loss) for hinge in solver.hinges):
        found.append(SHEARED)
    if jointed:
        found.append(
            f"{named('Member', list(jointed))} also bend{'s' if len(jointed) == 1 else ''} at "
            f"{sum(not hinge.plastic for hinge in solver.hinges)} joint(s) between the hinges, which are "
            "together as stiff as the member and yield as its section does with plane walls."
        )
    return tuple(found)


def _carries(structure: Structure, hinges: list[PlacedHinge]) -> str:
    """What hinges of one kind resist: one with its place, or several together."""
    records = [hinge.record for hinge in hinges]
    form = {
        Form.SET_VALUED: "rigid until {} capacity is reached",
        Form.ELASTIC_PLASTIC: f"elastic, {_span([r.elastic_stiffness / 1e3 for r in records])} kN m/rad, to "
        "{} capacity",
        Form.REGULARISED: "{} capacity times a HAVSIN ramp of "
        f"{_span([r.regularisation_rate for r in records], 3)} rad/s",
    }[records[0].form]
    rate = ", raised with the strain rate" if math.isfinite(records[0].rate_reference) else ""
    curve = f"run{'s' if len(hinges) == 1 else ''} on {SOFTENING[records[0].softening_variable]}"
    if len(hinges) > 1:
        names = listed(hinge.name for hinge in hinges)
        return f"{len(hinges)} hinges ({names}) are {form.format('their')}{rate}; their curves {curve}."
    (hinge,) = hinges
    first = structure.members[hinge.member].nodes[0]
    place = f"{hinge.station * 1e3:.4g} mm from node {first} of member {hinge.member}"
    return f"Hinge {hinge.name} lies {place} and is {form.format('its')}{rate}; its curve {curve}."


def _span(values: list[float], digits: int = 4) -> str:
    """The common value, or the smallest and the largest."""
    ends = dict.fromkeys(f"{value:.{digits}g}" for value in (min(values), max(values)))
    return " to ".join(ends)


def _contact(structure: Structure) -> str:
    touching = [f"members with {', '.join(structure.obstacles)}"] if structure.obstacles else []
    touching += ["members with members that share no node"] if structure.member_contact is not None else []
    if not touching:
        return "There is no contact but the hinges' own stops."
    return (
        f"Contact is rigid, of {' and of '.join(touching)}, and there is no other but the hinges' own stops."
    )


def _dents(structure: Structure) -> Iterator[str]:
    for name in structure.obstacles:
        members = [tube.member for tube in dented_tubes(structure, name)]
        if members:
            yield (
                f"Obstacle {name} dents {named('member', members)}; the force over the depth is known within "
                "some 20 %, and other members that it meets also push its face back."
            )


def warnings(
    structure: Structure, hinges: dict[str, HingeSummary], solved: Solved, notes: tuple[str, ...] = ()
) -> tuple[str, ...]:
    """Sentences to be read before the result is used; `notes` if motion is lost at the start."""
    found: list[str] = []
    largest = max((summary.rotation_max for summary in hinges.values()), default=0.0)
    by_text: dict[str, dict[str, float]] = {}
    for history in solved.hinges:
        for text, turned in _of_hinge(structure, history):
            by_text.setdefault(text, {})[history.hinge.name] = math.degrees(turned)
    for text, by_name in by_text.items():
        span = _span(list(by_name.values()), 3)
        found.append(f"{named('Hinge', list(by_name))}: {text.format(turned=span)}")
    found += broken_warnings(solved.hinges)
    found += [*struck_near_ends(structure, solved), *undented(structure, solved)]
    found += too_stiff_hats(structure, solved)
    found += overlap_warnings(structure)
    found += held_part_warnings(structure, solved)
    found += loose_drives(structure, link(structure))
    found += inaccurate(hinges, largest)
    found += [
        f"Material {name}: {spec.statement}" for name, spec in structure.materials.items() if spec.statement
    ]
    kinetic = float(solved.energy["kinetic"][0])
    # later stages add motion that is not there at the start
    vanished = solved.lost if len(solved.stages) > 1 else max(solved.given - kinetic, solved.lost)
    lost = vanished > LOST_SHARE * max(solved.given, kinetic)
    if lost or solved.struck:
        found += notes
    if lost and not solved.struck:
        found.append(
            f"{vanished:.4g} J of the given {max(solved.given, kinetic + solved.lost):.4g} J is lost "
            "at the start: the given motion does not fit the supports and hinges."
            + _why_lost(structure, vanished > MOST * max(solved.given, kinetic))
        )
    stored = energy_left_out(structure, solved.hinges)
    total = energy_put_in(solved)
    if total > 0.0 and stored > ELASTIC_SHARE * total:
        found.append(
            f"The bars are rigid, but the members could store up to {stored:.3g} J elastically "
            f"({_share(stored / total)}), by their moments at the outputs: rotations lack the elastic part "
            f"and the plastic ones are too large{'' if solved.bending_tried else BEND}."
        )
    found += _slowed(solved)
    if solved.forced:
        steps = "One step was" if solved.forced == 1 else f"{solved.forced} steps were"
        found.append(f"{steps} taken at the smallest step without meeting the accuracy.")
    return tuple(found)


def _why_lost(structure: Structure, mostly: bool) -> str:
    """What of a motion does not fit, where that is known: members that keep their length."""
    rates = stretched(structure, structure.initial_velocity)
    if not rates:
        return LOCKED if mostly else ""
    most = format_quantity(max(abs(rate) for rate in rates.values()), "m/s", 3)
    keep, their = ("keeps", "its ends") if len(rates) == 1 else ("keep", "their ends")
    return (
        f" {named('Member', list(rates))} {keep} the length, elastic or not, and the motion moves {their} "
        f"relative to each other by up to {most} along the axis: give the hinges 'axial: true', or solve "
        "with shells."
    )


def _share(part: float) -> str:
    """A fraction of the energy input, in words if it exceeds the input."""
    return f"{part:.0%} of the energy input" if part <= 1.0 else "more than the energy input"


def _slowed(solved: Solved) -> list[str]:
    """Warning about motion in quasi-static stages, or from snap-through, if its energy is large."""
    taken = float(solved.energy.get("damping", np.zeros(1))[-1])
    stored = float(solved.energy["dissipated"][-1] + solved.energy["elastic"][-1])
    if taken <= SLOW_SHARE * stored:
        return []
    return [
        f"Quasi-static stages removed {taken:.3g} J from the motion, compared with {stored:.3g} J in the "
        "structure: "
        "it moved when they began, or snapped through; with inertia it may move elsewhere."
    ]


def _bends_both_ways(hinge: PlacedHinge) -> bool:
    """Whether a hinge can rotate about both section axes, so that no bending is carried rigidly."""
    return hinge.spatial is not None and {Freedom.Y, Freedom.Z} <= set(hinge.spatial.freedoms)


def _of_hinge(structure: Structure, history: HingeHistory) -> Iterator[tuple[str, float]]:
    """Sentences about one hinge, with its plastic rotation [rad] for a field that they may have.

    Those of many hinges are equal but for it.
    """
    hinge = history.hinge
    bent = history.bent_by_law()
    # what its law says of section and metal matters where the hinge folds or is about to
    told = [
        text
        for law in dict.fromkeys(law for _, law, _ in bent) or _nearly_bent(history)
        for text in law.validity.warnings
    ]
    yield from ((_literal(text), 0.0) for text in told)
    # of slip that nobody asked for, and that did not happen, nothing is to be said
    if hinge.spatial is not None and crush_of(structure, history) is not None:
        along = [text for part in hinge.spatial.components for text in part.warnings if text not in told]
        yield from ((f"crushing along the member: {_literal(text)}", 0.0) for text in along)
    several = len(set(hinge.laws.values())) > 1
    for axis, law, turned in bent:
        jammed = law.jamming_angle is not None and turned > law.jamming_angle
        # a closed fold has a caution of its own
        if not jammed and law.validity.is_left_at(turned):
            limit = _literal(law.validity.range_text)
            about = f" about the section's {axis} axis; there" if several else ";"
            yield f"turned by {{turned}} deg{about} the law {limit}. {BEYOND_RANGE}", turned
    normal = structure.normal_of(hinge.member)
    if normal is not None and not _bends_both_ways(hinge):
        off = math.degrees(math.acos(min(1.0, abs(float(hinge.direction @ np.asarray(normal))))))
        if off > OFF_AXIS:
            yield (
                f"turns about the section's {hinge.axis} axis, {off:.3g} deg off the normal of the plane of "
                "bending; what bends it across is carried rigidly: set up, roll or axis of the member",
                0.0,
            )


def _nearly_bent(history: HingeHistory) -> tuple[HingeLaw, ...]:
    """Law of a hinge at rest whose moment came close to what it carries; none of others."""
    law = history.hinge.law
    least = min(float(law.moment_capacity(0.0, sense)) for sense in (1, -1))
    return (law,) if history.moment_max >= NEARLY * least else ()


def _literal(text: str) -> str:
    """Text that `str.format` leaves as it is."""
    return text.replace("{", "{{").replace("}", "}}")


def inaccurate(hinges: dict[str, HingeSummary], largest: float) -> list[str]:
    """One sentence for all rotations with a large estimated error."""
    errors = [summary.rotation_error or 0.0 for summary in hinges.values() if summary.bends]
    allowed = max(ERROR_SHARE * largest, SMALL_ERROR)
    worst, number = max(errors, default=0.0), sum(error > allowed for error in errors)
    if number == 0:
        return []
    return [
        f"The rotations of {number} of {len(errors)} hinges err by up to {math.degrees(worst):.2g} deg "
        "(estimated): give a smaller analysis.multibody.accuracy."
    ]
