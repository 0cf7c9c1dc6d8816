"""A structure in the form of the spatial kernel; mass and momentum of its bodies, linear in the masses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from crumple._core.spatial.batch import SpatialEndValues, SpatialStage, StagedModel
from crumple._core.spatial.model import SpatialModel
from crumple.errors import InputError, Problem
from crumple.multibody.answer.dents import DentHistory, dent_histories
from crumple.multibody.answer.hinge_histories import RecordedHinge, Rows
from crumple.multibody.answer.poses import SpatialEndPoses
from crumple.multibody.bodies.dead_centres import DeadCentres, dead_centres
from crumple.multibody.bodies.initial_motion import Placed, spatial_initial_motion
from crumple.multibody.bodies.linkage import GROUND, Linkage, check_inertia, link
from crumple.multibody.bodies.obstacles.bodies import Touching, with_obstacles
from crumple.multibody.run import Run
from crumple.multibody.spatial.crushing_contacts import with_crushing
from crumple.multibody.spatial.model import spatial_model, support_drives
from crumple.multibody.spatial.off_dead_centres import off_dead_centres
from crumple.multibody.spatial.stages import kernel_conditions, refuse_floating, stages_of
from crumple.numeric.arrays import Floats
from crumple.structure import Stage, Structure


@dataclass(frozen=True, eq=False)
class SpatialCase:
    """A structure, its linkage, and the data of the kernel; see `Case`.

    Attributes
    ----------
    structure, linkage, touching
        The structure, its bodies and connections, and those of its obstacles.
    case
        Model and stages.
    velocity, impulse
        Motion that every stage adds, at the centres of mass, (stages, bodies, 6).
    dead_centres
        What stands at a dead centre at the start.
    plain
        Model before it is moved off dead centres.
    """

    structure: Structure
    linkage: Linkage
    touching: Touching
    case: StagedModel
    velocity: Floats
    impulse: Floats
    dead_centres: DeadCentres
    plain: SpatialModel

    def again(self, *, aside: bool, crushing: bool) -> SpatialCase:
        """The case with hinges aside of dead centres, or with walls that crush under contacts."""
        model, _ = off_dead_centres(self.plain, self.linkage, self.dead_centres, aside=aside)
        touching = replace(self.touching, model=model)
        if crushing:
            touching = with_crushing(self.structure, touching)
        return replace(self, touching=touching, case=replace(self.case, model=touching.model))

    @property
    def model(self) -> SpatialModel:
        """The kernel's model."""
        return self.case.model

    @property
    def kernel_case(self) -> StagedModel:
        """See `Case`."""
        return self.case

    @cached_property
    def hinges(self) -> tuple[RecordedHinge, ...]:
        """See `Case`."""
        return recorded_hinges(self.linkage, self.model)

    def dents(self, rows: Rows) -> tuple[DentHistory, ...]:
        """See `Case`."""
        return recorded_dents(self.touching, rows)

    @property
    def touched(self) -> bool:
        """See `Case`."""
        return bool(self.model.capsules)

    @property
    def slowed(self) -> bool:
        """See `Case`."""
        return any(stage.quasi_static for stage in self.case.stages)

    @property
    def own_bodies(self) -> int:
        """See `Case`: thrown obstacles have a velocity of their own."""
        return len(self.linkage.bodies) + len(self.touching.walls)

    @property
    def reference_points(self) -> Floats:
        """See `Case`: the centres of mass."""
        return np.array([body.centre for body in self.model.bodies], float)

    @property
    def topology(self) -> tuple[object, ...]:
        """A description of the topology: equal for two models that are variants of each other."""
        model = self.model
        joints = tuple((joint.first, joint.second, joint.held) for joint in model.joints)
        hinges = tuple(tuple(part.freedom for part in hinge.components) for hinge in model.hinges)
        bodies = (
            len(model.bodies),
            tuple(load.body for load in model.loads),
            tuple(self.linkage.node_body.items()),
        )
        counts = len(model.drives), len(model.obstacles), len(model.capsules), len(self.case.stages)
        names = (recorded.hinge.name for recorded in self.hinges)
        return (*names, joints, hinges, bodies, counts)

    @property
    def lumps(self) -> object:
        """See `Case`: not shared, as bodies turn about centres of mass."""
        return id(self)

    def moved_mass(self, raw: Floats, other: SpatialCase) -> Floats:
        """See `Case`."""
        assert other is self
        return raw

    def raw_mass(self, about: Floats) -> Floats:
        """Mass, momenta and impulses of every body about a fixed point of each, (bodies, 13 + 12 stages).

        Mass [kg], mass times centre [kg m] (3), inertia [kg m^2] (9); of every stage angular momentum [N m s]
        (3), momentum [N s] (3) and the same of its impulses.  All are sums over parts, so linear in masses.
        """
        rows = []
        for i, (body, point) in enumerate(zip(self.model.bodies, about, strict=True)):
            arm, mass = np.asarray(body.centre, float) - point, body.mass
            inertia = body.inertia + mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
            row = [[mass], mass * arm, inertia.ravel()]
            for velocity, impulse in zip(self.velocity[:, i], self.impulse[:, i], strict=True):
                momentum = mass * velocity[3:]
                row += [body.inertia @ velocity[:3] + np.cross(arm, momentum), momentum]
                row += [impulse[:3] + np.cross(arm, impulse[3:]), impulse[3:]]
            rows.append(np.concatenate(row))
        return np.array(rows)

    @staticmethod
    def kernel_arrays(raw: Floats, about: Floats) -> tuple[Floats, Floats, Floats]:
        """The kernel's arrays of raw masses, (n, bodies, 13 + 12 stages), about points, (n, bodies, 3).

        Returns
        -------
        bodies
            Centre, mass, inertia about the centre, (n, bodies, 13).
        velocity, impulse
            Of and at the centres, (n, stages, bodies, 6).
        """
        mass = raw[..., :1]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            # a body without mass, or with one beyond all numbers, is refused by the kernel, row by row
            arm = raw[..., 1:4] / mass
            square = (
                np.sum(arm**2, axis=-1)[..., None, None] * np.eye(3) - arm[..., :, None] * arm[..., None, :]
            )
            inertia = raw[..., 4:13].reshape(*raw.shape[:-1], 3, 3) - mass[..., None] * square
            stages = np.moveaxis(raw[..., 13:].reshape(*raw.shape[:-1], -1, 4, 3), 2, 1)
            spin, momentum, blow, force = np.moveaxis(stages, 3, 0)
            arm_now = arm[:, None]
            size = np.abs(np.linalg.det(inertia))
            sound = (size > 0.0) & np.isfinite(size)
            inverse = np.linalg.inv(np.where(sound[..., None, None], inertia, np.nan * np.eye(3)))
            rate = np.einsum("nbij,nsbj->nsbi", inverse, spin - np.cross(arm_now, momentum))
            velocity = np.concatenate([rate, momentum / mass[:, None]], axis=-1)
        impulse = np.concatenate([blow - np.cross(arm_now, force), force], axis=-1)
        bodies = np.concatenate([about + arm, mass, inertia.reshape(*raw.shape[:-1], 9)], axis=-1)
        return bodies, velocity, impulse

    def end_poses(self, ends: SpatialEndValues) -> SpatialEndPoses:
        """See `Case`."""
        return SpatialEndPoses(self.linkage, ends)


def recorded_hinges(linkage: Linkage, model: SpatialModel) -> tuple[RecordedHinge, ...]:
    """Hinges of members in the kernel's order; slips of faces follow them."""
    hinges = [(connection.hinge, connection.free) for connection in linkage.connections]
    placed = [(hinge, free) for hinge, free in hinges if hinge is not None]
    columns = model.component_offsets[: len(placed)]
    return tuple(
        RecordedHinge(hinge, free, first) for (hinge, free), first in zip(placed, columns, strict=True)
    )


def recorded_dents(touching: Touching, rows: Rows) -> tuple[DentHistory, ...]:
    """Dents of all tubes."""
    columns = tuple(touching.model.component_offsets)
    return tuple(dent_histories(touching, columns, rows.hinge, rows.hinge_energy))


def spatial_case(structure: Structure, run: Run) -> SpatialCase:
    """Lower a structure and the stages of its run for the spatial kernel.

    Raises
    ------
    InputError
        If it cannot be solved, or nothing can move.
    """
    linkage = link(structure)
    if not linkage.bodies:
        raise InputError("nothing can move: every part is held and no member has a hinge")
    check_inertia(linkage)
    stages = stages_of(structure, run)
    refuse_floating(structure, linkage, stages)
    _refuse_later_motion(stages)
    longest = max(stage.duration for stage in stages)
    owners = tuple(name for name, _ in support_drives(structure, linkage, longest))
    frequency = run.settings.resolved_frequency
    still = any(stage.kind == "quasi-static" for stage in stages)
    plain = spatial_model(structure, linkage, longest, resolved_frequency=frequency, still=still)
    touching = with_obstacles(structure, linkage, plain, owners, stages)
    centres, unmoved = dead_centres(linkage), touching.model
    touching = replace(touching, model=off_dead_centres(unmoved, linkage, centres)[0])
    motions = [
        added_motion(structure, linkage, touching, stage, first=i == 0)[:2] for i, stage in enumerate(stages)
    ]
    return SpatialCase(
        structure,
        linkage,
        touching,
        StagedModel(touching.model, tuple(kernel_stage(structure, linkage, touching, s) for s in stages)),
        np.stack([velocity for velocity, _ in motions]),
        np.stack([impulse for _, impulse in motions]),
        centres,
        unmoved,
    )


def _refuse_later_motion(stages: Sequence[Stage]) -> None:
    """Refuse motion of a later stage that depends on the positions of the bodies at that time."""
    for i, stage in enumerate(stages[1:], 1):
        partly = any(
            f.rotation or f.nodes is not None or f.members is not None for f in stage.initial_velocity
        )
        if partly or stage.impulses:
            key = f"analysis.stages[{i}].{'initial_velocity' if partly else 'impulses'}"
            what = "variants and sensitivities take what a later stage adds from the start positions"
            allowed = "a translation of the whole structure"
            todo = "add the motion in the first stage, or solve the variants one by one"
            raise InputError(Problem(what, stage.name, allowed, todo, key))


def kernel_stage(structure: Structure, linkage: Linkage, touching: Touching, stage: Stage) -> SpatialStage:
    """Loads, drives and obstacles of a stage, and the conditions that end it, by the kernel's indices."""
    drives = obstacles = None
    if stage.drive is not None:
        drives = tuple(i for i, owner in enumerate(touching.drives) if owner in stage.drive)
    if stage.obstacles is not None:
        obstacles = tuple(k for k, name in enumerate(touching.obstacles) if name in stage.obstacles)
    conditions = kernel_conditions(structure, linkage, touching, stage)
    return SpatialStage(
        stage.duration,
        stage.kind == "quasi-static",
        drives,
        obstacles,
        tuple(condition for _, condition in conditions),
    )


def added_motion(
    structure: Structure,
    linkage: Linkage,
    touching: Touching,
    stage: Stage,
    now: Placed | None = None,
    *,
    first: bool,
) -> tuple[Floats, Floats, float]:
    """Velocities and impulses, (bodies, 6) each, that a stage adds as it begins, and their energy [J].

    Bodies are where they are `now`.  Thrown obstacles are thrown in the `first` stage.
    """
    start = spatial_initial_motion(structure, linkage, stage.initial_velocity, stage.impulses, now)
    further = np.zeros((len(touching.walls) + len(touching.velocity), 6))
    for row, wall in zip(further, touching.walls, strict=False):
        if wall.own != GROUND:
            row[:] = start.velocity[wall.own]
            arm = wall.place - linkage.bodies[wall.own].centre
            row[3:] += np.cross(row[:3], arm if now is None else now.turned(wall.own, arm))
    if first:
        further[len(touching.walls) :, 3:] = touching.velocity
    masses = [body.mass for body in touching.model.bodies[len(linkage.bodies) :]]
    energy = start.given_energy + float(np.sum(masses * np.sum(further[:, 3:] ** 2, axis=1)) / 2.0)
    velocity = np.concatenate([start.velocity, further])
    return velocity, np.concatenate([start.impulse, np.zeros_like(further)]), energy
