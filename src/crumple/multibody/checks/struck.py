"""Obstacles that meet what cannot give way (between hinges, or slowly), and obstacles that meet nothing.

Members with hinges of the input's own may have none where an obstacle strikes between their nodes.

They cannot fold there: rigid bars stop the obstacle at once.  Automatic hinges have a candidate there.  A
hinge within one fold, two half lengths, stands for the fold, and so does what is at a node within one fold.
Members without any hinge are meant to keep their shape.

Folds that keep little of their moment for a dent that the obstacle does not press: the law assumes that what
holds the tube stays where it is.  Folds of hats into which poles sink, which the model lacks.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import numpy as np

from crumple._core.outcome import Outcome
from crumple.hinge.bending.dented import DentedLaw
from crumple.multibody.answer.solved import Solved
from crumple.multibody.checks.names import named
from crumple.numeric.arrays import Floats
from crumple.result import Caution
from crumple.section import AXES, RectangularTube, half_fold_length
from crumple.structure import Structure, plastic_hinges
from crumple.structure.hinges.asked import automatic_of, folds_at_ends
from crumple.structure.hinges.corner_laws import corner_laws
from crumple.structure.hinges.lengthening.nodes_met import nodes_met
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.structure.hinges.spatial_hinges import interaction_of
from crumple.structure.hinges.struck.dented_tubes import left_by, struck_without_dents, undented_tubes
from crumple.structure.keys.motion import Support
from crumple.structure.keys.obstacles import CylinderObstacle, Obstacle, SphereObstacle, gap
from crumple.structure.struck_places import struck_places
from crumple.units import format_quantity

LOOKS = 101
"""Times at which the way of a driven obstacle is looked at: some milliseconds of a crash apart."""
DEEPER = 0.15
"""Share of its moment that a fold has to keep more by the dent of the run than by that of its law, for a
sentence: a bending moment is known about as well."""
SLENDER, NARROW = 30.0, 5.5
"""Width of a hat's crown over its wall from which on, and radius of a pole over half a fold up to which folds
turned too far in all four hats that folded in shells (30 to 47, 2.2 to 4.9); a hat with 25 under a pole of
5.7 and one with 30 under poles of 8.9 and more did not.  docs/theory/dents.md."""
SHALLOW = 5e-3
"""Depth of a dent up to which poles go further in shells by more than that [m]; in a longer push the tension
of the held member presses deeper dents in the model, too."""
FOLDED = float(np.radians(2.0))
"""Plastic rotation [rad] from which on a hat folds under a pole, in place of only being dented."""


def struck_cautions(structure: Structure, solved: Solved | None = None) -> Iterator[Caution]:
    """A caution for every place without a hinge at which a member lies in the path of an obstacle.

    Parameters
    ----------
    structure
        Sound.
    solved
        Its result, if there is one: obstacles that touched nothing are left out.
    """
    if not structure.obstacles:
        return
    touched = _touched(structure, solved)
    stations: dict[str, list[float]] = {}
    for hinge in plastic_hinges(structure):
        stations.setdefault(hinge.member, []).append(hinge.station)
    for member, own in stations.items():
        if automatic_of(structure, member) is not None or folds_at_ends(structure, member):
            continue
        section, length = structure.section_of(member), structure.frame_of(member).length
        fold = 2.0 * max(half_fold_length(section, axis) for axis in AXES)
        rigid, first = structure.members[member].rigid_parts(length), structure.members[member].nodes[0]
        for place in struck_places(structure, member):
            at = place.station
            apart = min(abs(at - station) for station in own)
            if place.obstacle not in touched or min(apart, at, length - at) <= fold:
                continue
            if any(start <= at <= end for start, end in rigid):
                continue
            where = f"{at * 1e3:.4g} mm"
            yield Caution(
                "struck_between_hinges",
                apart,
                fold,
                "m",
                f"member {member}",
                f"Member {member} is in the path of obstacle {place.obstacle}, {where} from node {first}, "
                f"where it has no hinge: it cannot fold there. Give it a hinge at {where}, or "
                "'hinges: auto', which puts one there.",
            )


def pressed_beyond(structure: Structure, solved: Solved, slow: Collection[str]) -> Iterator[Caution]:
    """A caution for every obstacle that presses slowly with more than all members can carry along their axes.

    Parameters
    ----------
    structure, solved
        The structure and its result.
    slow
        Names of the quasi-static stages: in an impact forces between rigid bodies have no bound.

    Notes
    -----
    Where nothing gives way in the direction of a slow obstacle, the force jumps within a step.  The sum of
    squash forces is an upper bound of what a structure carries; derived here.
    """
    stages = [stage for stage in solved.stages if stage.name in slow]
    if not stages:
        return
    force = {channel.name: channel.values for channel in solved.further}
    # an output at the border of two stages belongs to the first
    still = np.logical_or.reduce([(solved.time > one.start) & (solved.time <= one.end) for one in stages])
    metals = ((structure.section_of(name), structure.material_of(name)) for name in structure.members)
    limit = sum(interaction_of(section, material).squash_force for section, material in metals)
    for name in structure.obstacles:
        own = np.linalg.norm([force[f"obstacle.{name}.force.{axis}"] for axis in "xyz"], axis=0)
        most = float(own[still].max(initial=0.0))
        if most > limit:
            found, allowed = (format_quantity(one, "N", 3) for one in (most, limit))
            yield Caution(
                "pressed_beyond",
                most,
                limit,
                "N",
                f"obstacle {name}",
                f"Obstacle {name} presses with up to {found} in a quasi-static stage, more than all members "
                f"together carry along their axes ({allowed}): "
                "nothing gives way there, and the force is not to be used. Let members bend and shorten "
                "(analysis.multibody.members: elastic, or 'axial: true' of hinges).",
            )


def untouched(structure: Structure, solved: Solved, absent: Collection[str] = ()) -> Iterator[Caution]:
    """A caution for obstacles that no member touched: all, if none was, else those that moved.

    Parameters
    ----------
    structure, solved
        The structure and its result.
    absent
        Obstacles that no stage has.

    Notes
    -----
    A ground that waits for parts which do not come that far is no mistake, while something else is struck.
    """
    if solved.outcome is not Outcome.COMPLETE:
        return
    touched = _touched(structure, solved)
    present = [name for name in structure.obstacles if name not in absent]
    channels = {channel.name: channel.values for channel in solved.further}
    paths = {name: _path(channels, name) for name in present if name not in touched}
    missed = {name: path for name, path in paths.items() if path > 0.0 or not touched.intersection(present)}
    if not missed:
        return
    moved = [
        f"{name} (moves {format_quantity(path, 'm', 3)})" if path > 0.0 else name
        for name, path in missed.items()
    ]
    alone, time = len(missed) == 1, format_quantity(float(solved.time[-1]), "s", 3)
    text = (
        f"{named('Obstacle', moved)} touch{'es' if alone else ''} nothing in {time}: the results are those "
        f"without {'it' if alone else 'them'}. Check place, direction and velocity, of the structure too, "
        "and the duration."
    )
    for name, path in missed.items():
        yield Caution("untouched_obstacle", path, 0.0, "m", f"obstacle {name}", text)


def _path(channels: Mapping[str, Floats], name: str) -> float:
    """Largest displacement of an obstacle [m]; 0 for fixed ones."""
    if f"obstacle.{name}.displacement.x" not in channels:
        return 0.0
    travel = [channels[f"obstacle.{name}.displacement.{axis}"] for axis in "xyz"]
    return float(np.linalg.norm(travel, axis=0).max(initial=0.0))


def _touched(structure: Structure, solved: Solved | None) -> set[str]:
    """Obstacles on which any force acted; all before a run."""
    if solved is None:
        return set(structure.obstacles)
    force = {channel.name: channel.values for channel in solved.further}
    return {
        name
        for name in structure.obstacles
        if any(force[f"obstacle.{name}.force.{axis}"].any() for axis in "xyz")
    }


def struck_near_ends(structure: Structure, solved: Solved | None = None) -> Iterator[str]:
    """A sentence for every tube that an obstacle strikes too near its end to dent it in the model.

    Parameters
    ----------
    structure
        Sound.
    solved
        Its result, if there is one: obstacles that touched nothing are left out.
    """
    touched = _touched(structure, solved)
    for name in structure.obstacles:
        found = undented_tubes(structure, name) if name in touched else []
        for member, apart, node in found:
            fold = max(half_fold_length(structure.section_of(member), axis) for axis in AXES)
            yield (
                f"Obstacle {name} strikes member {member} {apart * 1e3:.3g} mm from node {node}, where no "
                f"fold fits beside that of the end (half length {fold * 1e3:.3g} mm): no dent is modelled "
                "there, and the force may be too large. Solve with shells to see it."
            )
        spec = structure.obstacles[name]
        if name in touched and isinstance(spec, CylinderObstacle | SphereObstacle) and spec.dents:
            for member in struck_without_dents(structure, name):
                yield (
                    f"Obstacle {name} strikes member {member} ({structure.section_of(member).title}), whose "
                    "walls have no dent in the model: the force may be too large. Solve with shells to "
                    "see it."
                )
            for node in _corners_met(structure, spec):
                yield (
                    f"Obstacle {name} meets corner {node}: no dent is modelled at corners, and the force may "
                    "be too large (at a bend of 8 deg in a hat a pole went 11 mm into the walls in shells). "
                    "Solve with shells to see it."
                )


def _corners_met(structure: Structure, obstacle: Obstacle) -> Iterator[str]:
    """Mitred corners of automatic hinges that an obstacle meets first."""
    for node, _ in nodes_met(structure, obstacle):
        if node in corner_laws(structure):
            yield node


def undented(structure: Structure, solved: Solved) -> Iterator[str]:
    """A sentence for every fold whose law assumes a far deeper dent than is pressed in the run."""
    deepest: dict[str, tuple[float, float, str]] = {}
    for dent in solved.dents:
        depth = float(dent.depth.max(initial=0.0))
        for member in straight_run(structure, dent.tube.member).stretches:
            deepest[member] = depth, left_by(structure, dent.tube, depth), dent.tube.obstacle
    for history in solved.hinges:
        hinge = history.hinge
        for _, law, turned in history.bent_by_law():
            if not isinstance(law, DentedLaw) or hinge.member not in deepest:
                continue
            depth, left, obstacle = deepest[hinge.member]
            if depth <= SHALLOW and turned >= FOLDED and sunk_in_shells(structure, obstacle, hinge.member):
                continue
            if left > law.left + DEEPER:
                yield (
                    f"Hinge {hinge.name} has at most {law.left:.0%} of its moment, for the dent that "
                    f"obstacle {obstacle} would press if the ends of the tube stayed where they are; in "
                    f"this run it is {format_quantity(depth, 'm')} deep, which leaves {left:.0%}. "
                    f"Compare with obstacles.{obstacle}.dents: false."
                )


def too_stiff_hats(structure: Structure, solved: Solved) -> Iterator[str]:
    """A sentence on the hats that fold under each obstacle which sinks into such folds in shells."""
    depths: dict[str, dict[str, float]] = {}
    for dent in solved.dents:
        member, obstacle = dent.tube.member, dent.tube.obstacle
        if sunk_in_shells(structure, obstacle, member) and _folds_in_dent(structure, solved, member):
            depths.setdefault(obstacle, {})[member] = float(dent.depth.max(initial=0.0))
    for obstacle, by_member in depths.items():
        if max(by_member.values()) > SHALLOW:
            continue
        deepest = format_quantity(max(by_member.values()), "m")
        yield (
            f"{named('Member', list(by_member))}: the crown of the hat is too stiff under obstacle "
            f"{obstacle}: its dent is {deepest} deep, and in shells such poles sank 7 to 9 mm further into "
            "folds of 8 to 19 deg. What that absorbs is missing: folds of such members turned 21 to 27 % too "
            "far. Solve with shells."
        )


def _folds_in_dent(structure: Structure, solved: Solved, member: str) -> bool:
    """Whether the straight run of a member folds where it is dented."""
    run = straight_run(structure, member).stretches
    return any(
        isinstance(law, DentedLaw) and turned >= FOLDED
        for history in solved.hinges
        if history.hinge.member in run
        for _, law, turned in history.bent_by_law()
    )


def sunk_in_shells(structure: Structure, obstacle: str, member: str) -> bool:
    """Whether a pole is of those that sink into the folding crown of a hat."""
    spec, section = structure.obstacles[obstacle], structure.section_of(member)
    if not isinstance(spec, CylinderObstacle):
        return False
    from crumple.section import ClosedHat  # noqa: PLC0415  (its walls take time to load)

    if not isinstance(section, ClosedHat):
        return False
    tube = RectangularTube(section.width, section.depth, section.thickness)
    slender = section.width >= SLENDER * section.thickness
    return slender and spec.radius <= NARROW * half_fold_length(tube, "y")


def swept_supports(structure: Structure, duration: float) -> Iterator[str]:
    """A sentence for every driven obstacle that passes over nodes which supports hold.

    Parameters
    ----------
    structure
        Sound.
    duration
        Of a run without stages [s].

    Notes
    -----
    Displacements alone are looked at, at `LOOKS` times, and the nodes where they stand at the start.
    """
    nodes = [node for node, own in structure.supports_at.items() if any(_holds(one) for _, one in own)]
    times = np.linspace(0.0, duration, LOOKS)
    for name, obstacle in structure.obstacles.items():
        moved = np.zeros((LOOKS, 3))
        for i, function in enumerate((obstacle.motion.x, obstacle.motion.y, obstacle.motion.z)):
            if function is not None:
                moved[:, i] = function(times)
        ends = [node for node in nodes if _can_meet(structure, obstacle, node)]
        if not moved.any() or not ends:
            continue
        places = np.array([structure.nodes[node] for node in ends])
        apart = np.array([gap(obstacle, places - shift) for shift in moved])
        first = {
            node: times[int(np.argmax(row < 0.0))]
            for node, row in zip(ends, apart.T, strict=True)
            if row[0] > 0.0 and row.min() < 0.0
        }
        if first:
            yield (
                f"Obstacle {name} is driven over {named('node', list(first)).lower()}, which supports hold, "
                f"from {format_quantity(float(min(first.values())), 's', 3)} on: nothing there can give way, "
                "and shells press the walls between both without a limit. End its motion earlier."
            )


def _holds(support: Support) -> bool:
    """Whether a support keeps its node in place."""
    return {"x", "y", "z"} <= set(support.held)


def _can_meet(structure: Structure, obstacle: Obstacle, node: str) -> bool:
    """Whether a member at a node may touch an obstacle."""
    return any(
        obstacle.members is None or name in obstacle.members for name in structure.members_at.get(node, ())
    )
