"""Solution of a structure in space by the spatial kernel, stage by stage."""

from __future__ import annotations

import time
from collections.abc import Iterator, MutableMapping
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from crumple._core.outcome import Outcome
from crumple._core.records import joined
from crumple._core.spatial.model import SpatialHinge
from crumple._core.spatial.simulation import SpatialRecord, SpatialSimulation
from crumple.errors import InputError, Problem
from crumple.multibody.answer.forces import check_sections, force_channels, section_force_channels
from crumple.multibody.answer.hinge_histories import hinge_histories, ledger, spread_energy
from crumple.multibody.answer.poses import SpatialHistory
from crumple.multibody.answer.pressed_folds import with_fold_moments
from crumple.multibody.answer.solved import Poll, Solved
from crumple.multibody.bodies.dead_centres import dead_centres
from crumple.multibody.bodies.initial_motion import Placed
from crumple.multibody.bodies.linkage import check_inertia, described, link, with_laws
from crumple.multibody.bodies.mobility import free_parts
from crumple.multibody.bodies.obstacles.bodies import with_obstacles
from crumple.multibody.checks.infinitesimal import dead_centre_notes
from crumple.multibody.checks.stuck_drives import stuck_drives, stuck_note
from crumple.multibody.run import CANNOT_GO_ON, Run, output_times, refuse_unbegun, step_bounds
from crumple.multibody.spatial.case import added_motion, kernel_stage, recorded_dents, recorded_hinges
from crumple.multibody.spatial.crushing_contacts import crumpled_ends, crushed_contacts, with_crushing
from crumple.multibody.spatial.model import kernel_hinges, spatial_model, support_drives
from crumple.multibody.spatial.off_dead_centres import off_dead_centres, with_held_moments
from crumple.multibody.spatial.stages import (
    end_reason,
    kernel_conditions,
    lost_equilibrium,
    refuse_floating,
    stages_of,
)
from crumple.numeric.arrays import Floats
from crumple.result import Channel, StageSummary
from crumple.result.channels import channels_along
from crumple.structure import PlacedHinge, Stage, Structure

HISTORIES = (
    "time", "centre", "rotation", "velocity", "acceleration", "travel", "step", "hinge", "hinge_energy",
    "joint_force", "obstacle_force", "energy",
)  # fmt: skip
"""Fields of a record with a row for every output time."""
COUNTS = ("steps", "rejected", "forced", "solves")


class SpatialSolver:
    """Bodies and connections in space, ready for time integration.

    Parameters
    ----------
    structure, run
        The structure, and duration, settings and outputs of the run.
    hinges
        The structure's.

    Raises
    ------
    InputError
        If the structure cannot be solved.
    """

    kernel = "spatial"

    def __init__(self, structure: Structure, run: Run, hinges: tuple[PlacedHinge, ...]) -> None:
        self._structure, self._run = structure, run
        self.linkage = link(structure, hinges)
        check_inertia(self.linkage)
        check_sections(structure, self.linkage, run.outputs)
        self._stages = stages_of(structure, run)
        refuse_floating(structure, self.linkage, self._stages)
        longest = max(stage.duration for stage in self._stages)
        frequency = run.settings.resolved_frequency
        plain = spatial_model(
            structure, self.linkage, longest, resolved_frequency=frequency, still=self._still
        )
        owners = tuple(name for name, _ in support_drives(structure, self.linkage, longest))
        touching = with_obstacles(structure, self.linkage, plain, owners, self._stages)
        self._model, self._dead_centres = touching.model, dead_centres(self.linkage)
        self._touching = touching
        self._touch(aside=False, crushing=False)
        # hinges with other laws: the changed capacities are two sets in several patterns
        self._changed: MutableMapping[PlacedHinge, SpatialHinge] = WeakKeyDictionary()
        # steps of the run with outputs, of the one that estimates its error, and those that guide this model
        self._steps: Any = None
        self._guide: Any = None
        self._lead: Any = None

    @property
    def _still(self) -> bool:
        """Whether the run has quasi-static stages."""
        return any(stage.kind == "quasi-static" for stage in self._stages)

    @property
    def moving(self) -> bool:
        """See `Solver`."""
        return bool(self.linkage.bodies)

    @property
    def hinges(self) -> tuple[PlacedHinge, ...]:
        """See `Solver`."""
        return self.linkage.hinges

    @property
    def notes(self) -> tuple[str, ...]:
        """See `Solver`."""
        return dead_centre_notes(self.linkage, self._dead_centres, aside=self._aside)

    def with_hinges(self, hinges: tuple[PlacedHinge, ...]) -> SpatialSolver:
        """See `Solver`; bodies, contacts, dead centres and what the runs so far needed are shared."""
        other = copy(self)
        other.linkage = with_laws(self.linkage, hinges)
        own = kernel_hinges(other.linkage, self._changed, still=self._still)
        model = replace(self._model, hinges=(*own, *self._model.hinges[len(own) :]))
        other._model, other._touching = model, replace(self._touching, model=model)
        other._touch(aside=self._aside, crushing=self._crushing)
        other._steps, other._guide, other._lead = None, None, self._guide
        return other

    def run(self, accuracy: float, poll: Poll | None, *, ends_only: bool = False) -> Solved:
        """See `Solver`.

        Where several ways go on from the start, loads mostly decide for one.  Where they do not, the motion
        is a mixture that soon cannot go on; the run is then repeated with hinges a little aside of their
        places, which leaves one way.  What then still presses on parts that cannot give way crushes their
        walls.
        """
        first = solved = self._run_once(accuracy, poll, ends_only)
        if _failed(solved) and self._dead_centres.aside and not self._aside:
            self._touch(aside=True, crushing=self._crushing)
            solved = self._run_once(accuracy, poll, ends_only)
        lost = solved.residual > self._run.settings.energy_residual_bound
        if (_failed(solved) or lost) and self._touching.model.capsules and not self._crushing:
            self._touch(aside=self._aside, crushing=True)
            solved = self._run_once(accuracy, poll, ends_only)
        if _failed(solved) and solved is not first:
            self._touch(aside=False, crushing=False)
            return first
        return solved

    def _touch(self, *, aside: bool, crushing: bool) -> None:
        """Prepare the model, with hinges aside of dead centres, and with walls that crush under contacts."""
        self._aside, self._crushing = aside, crushing
        model, self._holding = off_dead_centres(self._model, self.linkage, self._dead_centres, aside=aside)
        touching = replace(self._touching, model=model)
        self._touching = with_crushing(self._structure, touching) if crushing else touching

    def _run_once(self, accuracy: float, poll: Poll | None, ends_only: bool) -> Solved:
        model, settings = self._touching.model, self._run.settings
        longest, least_parts = step_bounds(self._run, ends_only=ends_only)
        if not ends_only and self._run.every / 2 < settings.minimum_time_step:
            raise _too_close(self._run.every, settings.minimum_time_step)
        if not ends_only and self._still:
            longest = min(longest, self._run.every / 2)
        simulation = SpatialSimulation(
            model, accuracy, settings.minimum_time_step, longest, parts=least_parts
        )
        self._guide_by_last(simulation, ends_only)
        grid = output_times(self._run, ends_only=ends_only)
        records: list[SpatialRecord] = []
        stages: list[StageSummary] = []
        given = lost = seconds = 0.0
        for stage in self._stages:
            begin = simulation.time
            begun, gone = self._begin(simulation, stage, records[-1] if records else None)
            given, lost = given + begun, lost + gone
            times = _stage_times(grid, begin, begin + stage.duration)
            clock = time.perf_counter()
            records.append(simulation.run(times, poll))
            seconds += time.perf_counter() - clock
            if len(records) == 1:
                refuse_unbegun(records[0].outcome, records[0].time)
            conditions = kernel_conditions(self._structure, self.linkage, self._touching, stage)
            ended = end_reason(stage, conditions, records[-1], list(self._structure.obstacles))
            # a stage that was cancelled at its beginning has no output
            reached = float(records[-1].time[-1]) if len(records[-1].time) else begin
            lasted = records[-1].ended_by < 0 and not np.isfinite(records[-1].lost_time)
            stages.append(StageSummary(stage.name, begin, reached, ended, lasted))
            if records[-1].outcome is not Outcome.COMPLETE:
                break
        record = with_held_moments(_joined(records), self.linkage, model, self._holding)
        record = with_fold_moments(record, self._touching.walls, model, ends_only=ends_only)
        if self._stages[0].kind == "quasi-static":
            # no impulse acts yet; the kernel reports the jump of a drive that starts with a velocity
            record.joint_force[0] = 0.0
        if record.outcome in (Outcome.UNHELD, Outcome.LIMIT_LOAD):
            stage, begin = self._stages[len(stages) - 1], stages[-1].start
            where = lost_equilibrium(self._structure, stage, begin, record.lost_time)
            parts = [f"{record.reason}.", where, *free_parts(self.linkage)]
            record = replace(record, reason=" ".join(parts))
        elif 0 <= record.stuck_body < len(self.linkage.bodies):
            what, _ = described(self.linkage, record.stuck_body)
            record = replace(record, reason=f"{record.reason} (at {what})")
        stuck = (
            stuck_drives(self._structure, self.linkage) if record.outcome is Outcome.STEP_COLLAPSED else ()
        )
        if stuck:
            record = replace(record, reason=f"{record.reason}. {stuck_note(stuck)}")
        sums = (given, lost, seconds)
        return self._solved(record, stages, sums, simulation.crushed, ends_only=ends_only)

    def _guide_by_last(self, simulation: SpatialSimulation, ends_only: bool) -> None:
        """Keep the steps of a run, and guide one without outputs by those of the run before."""
        if ends_only and self._lead is not None:
            simulation.be_guided_by(self._lead)
            return
        if ends_only and self._steps is not None:
            simulation.be_guided_by(self._steps, pairs=True)
        simulation.keep_guide()
        if ends_only:
            self._guide = simulation.guide
        else:
            self._steps = simulation.guide

    def _begin(
        self, simulation: SpatialSimulation, stage: Stage, before: SpatialRecord | None
    ) -> tuple[float, float]:
        """Start a stage; energy of the added motion, and the part of it that was lost in the joints [J]."""
        parts = (self._structure, self.linkage, self._touching, stage)
        lowered = kernel_stage(*parts)
        simulation.stage(
            quasi_static=lowered.quasi_static,
            drives=lowered.drives,
            obstacles=lowered.obstacles,
            until=lowered.until,
        )
        if before is None:
            velocity, impulse, energy = self._start
        else:
            now = Placed(before.centre[-1], before.rotation[-1])
            velocity, impulse, energy = added_motion(*parts, now, first=False)
        return energy, simulation.set_motion(velocity, impulse)

    @cached_property
    def _start(self) -> tuple[Floats, Floats, float]:
        """What the first stage adds, the same in every run."""
        return added_motion(self._structure, self.linkage, self._touching, self._stages[0], first=True)

    def _solved(
        self,
        record: SpatialRecord,
        stages: list[StageSummary],
        sums: tuple[float, float, float],
        crushed: list[tuple[int, int, int, float]],
        *,
        ends_only: bool,
    ) -> Solved:
        poses = SpatialHistory(self.linkage, record)
        given, lost, seconds = sums
        return Solved(
            outcome=record.outcome,
            reason=record.reason,
            residual=record.residual,
            unseen=record.unseen,
            steps=record.steps,
            rejected=record.rejected,
            forced=record.forced,
            time=record.time,
            solves=record.solves,
            given=given,
            lost=lost,
            struck=any(stage.impulses for stage in self._stages),
            poses=poses,
            hinges=tuple(
                hinge_histories(recorded_hinges(self.linkage, self._touching.model), record, record.summary)
            ),
            energy=ledger(
                record,
                touched=bool(self._touching.model.capsules),
                slowed=self._still,
            ),
            stepping_seconds=seconds,
            spread=spread_energy(recorded_hinges(self.linkage, self._touching.model), record),
            # of a run that checks another only the hinges are compared
            further=() if ends_only else self._further(poses, record, stages),
            stages=tuple(stages) if self._run.stages else (),
            crushed=tuple(crushed_contacts(self._structure, self._touching, crushed)),
            crumpled=tuple(crumpled_ends(self._touching, crushed)),
            dents=recorded_dents(self._touching, record),
        )

    def _further(
        self, poses: SpatialHistory, record: SpatialRecord, stages: list[StageSummary]
    ) -> tuple[Channel, ...]:
        """Channels of forces and obstacles."""
        begins = np.array([stage.start for stage in stages])
        # an output at the border of two stages belongs to the first
        local = record.time - begins[np.maximum(np.searchsorted(begins, record.time) - 1, 0)]
        return (
            *force_channels(self._structure, poses, local),
            *section_force_channels(self._structure, poses, self._run.outputs),
            *self._obstacle_channels(record),
        )

    def _obstacle_channels(self, record: SpatialRecord) -> Iterator[Channel]:
        for name in self._structure.obstacles:
            parts = [k for k, of in enumerate(self._touching.obstacles) if of == name]
            columns = {"force": record.obstacle_force[:, parts].sum(axis=1)}
            joint = self._touching.joint.get(name)
            if joint is not None:
                body = self._touching.model.joints[joint].second
                start = self._touching.model.bodies[body].centre
                columns["displacement"] = record.centre[:, body] - start
                columns["velocity"] = record.velocity[:, body, 3:]
            for quantity, values in columns.items():
                yield from channels_along(f"obstacle.{name}.{quantity}", values)


def _failed(solved: Solved) -> bool:
    return solved.outcome in CANNOT_GO_ON


def _stage_times(grid: Floats, begin: float, end: float) -> Floats:
    """Output times of a stage: those of the grid within it, and its end."""
    inside = grid[(grid > begin * (1 + 1e-12)) & (grid < end * (1 - 1e-12))]
    return np.concatenate([[0.0] if begin == 0.0 else [], inside, [end]])


def _joined(records: list[SpatialRecord]) -> SpatialRecord:
    """One record of several stages, each of which continues the one before."""
    if len(records) == 1:
        return records[0]
    histories: dict[str, Any] = {
        name: joined([getattr(record, name) for record in records]) for name in HISTORIES
    }
    counts: dict[str, Any] = {name: sum(getattr(record, name) for record in records) for name in COUNTS}
    residual = max(record.residual for record in records)
    unseen = max(record.unseen for record in records)
    return replace(records[-1], **histories, **counts, residual=residual, unseen=unseen)


def _too_close(every: float, minimum: float) -> InputError:
    what = "the outputs are closer together than two of the smallest time steps"
    allowed, todo = (
        f"at least {2.0 * minimum:g} s",
        "write a longer duration, or a larger interval of outputs",
    )
    return InputError(Problem(what, f"{every:g} s", allowed, todo, "outputs.every"))
