"""Multibody solution of a structure: model, time stepping, and checks of the result."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from crumple._core.outcome import Outcome
from crumple.cancelling import asking
from crumple.errors import CancelledError, InputError, Problem, Status
from crumple.hinge import Form
from crumple.multibody.answer.crush import with_crush
from crumple.multibody.answer.dents import dent_channels, dented_walls, wall_motions
from crumple.multibody.answer.histories import (
    clearance_channels,
    distance_channels,
    energy_channels,
    gravity_channels,
    hinge_channels,
    node_channels,
    section_channels,
    summaries,
)
from crumple.multibody.answer.shapes import refuse_pictures, states_of
from crumple.multibody.answer.solved import Poll, Solved, Solver
from crumple.multibody.answer.stated_errors import StatedErrors, rotation_differences, stated_errors
from crumple.multibody.checks import trust
from crumple.multibody.checks.collapse import changed_capacities, collapse_log, not_unique, scaled_hinge
from crumple.multibody.checks.overlap import obstacle_overlap_warnings
from crumple.multibody.checks.physics import physics_cautions
from crumple.multibody.checks.struck import untouched
from crumple.multibody.kernel_choice import why_spatial
from crumple.multibody.lengthening import members_to_lengthen, with_lengthening_told
from crumple.multibody.planar.solver import TreeSolver
from crumple.multibody.run import (
    CANNOT_GO_ON,
    CHECK_FACTOR,
    Cancel,
    Progress,
    Run,
    outcome_status,
    picture_times,
    poll_of,
)
from crumple.multibody.spatial.solver import SpatialSolver
from crumple.result import Provenance, Result, missing_pictures, sentences
from crumple.structure import (
    Stage,
    Structure,
    any_automatic,
    law_use_about,
    placed_hinges,
    with_elastic_members,
)
from crumple.structure.hinges.lengthening.found import lengthening_members, note_lengthening
from crumple.text.names import listed

FORK = 0.05
"""Difference of the rotations of two runs over the largest one that accuracy alone hardly explains."""
MOST_LENGTHENED = 3
"""Most runs that are repeated with members that change their length."""
NEGLIGIBLE = 1e-9
"""Difference of the rotations of two runs [rad] that is rounding, however small the rotations are."""
CHECKED_FROM = 0.4
"""Share of the progress at which the runs with changed capacities begin, which are four coarse ones."""
FINER = (0.1, 0.01)
"""Shares of the accuracy at which a planar run is repeated whose energy residual exceeds its bound; a
hundredth takes some ten times the steps."""


def solve_multibody(
    structure: Structure, run: Run, progress: Progress | None = None, cancel: Cancel | None = None
) -> Result:
    """Solve a structure as rigid bodies joined by plastic hinges.

    Parameters
    ----------
    structure
        What is simulated.
    run
        How long, with which settings, reporting what.
    progress
        Called with the share done, 0 to 1.
    cancel
        Called at intervals; if it returns True, the run ends with its results so far.

    Returns
    -------
    Result
        Its provenance holds the settings only; the caller adds version and input hash.

    Raises
    ------
    InputError
        If the structure cannot be solved by this engine.

    References
    ----------
    Methods in docs/theory/multibody_stepper.md and docs/theory/spatial_lowering.md.  Verified in
    tests/verification.
    """
    begin = time.perf_counter()
    given, structure = structure, with_elastic_members(structure, run.settings, run.time_in_motion)
    accuracy = run.settings.accuracy
    try:
        with asking(cancel):
            refuse_pictures(structure, len(picture_times(run)))
            solver = solver_of(structure, run)
            if not solver.moving:
                raise _nothing_moves(structure)
            checked = CHECKED_FROM if run.checks and _check_asked(structure, run, solver) else 1.0
            poll = poll_of(run.duration, (0.0, 0.7 * checked), progress, cancel)
            solved = rough = solver.run(accuracy / CHECK_FACTOR, poll)
            poll = poll_of(run.duration, (0.7 * checked, 0.7 * checked), progress, cancel)
            if solved.outcome is Outcome.COMPLETE and not run.capacities:
                structure, solver, solved = _lengthened(given, run, solver, solved, poll)
                rough = solved
            solved, accuracy = _balanced(solver, solved, run, poll)
    except CancelledError as error:
        return _nothing_solved(run, str(error), time.perf_counter() - begin)
    if structure is not given and run.settings.members == "auto" and solved.outcome in CANNOT_GO_ON:
        return _with_rigid_bars(given, run, solved, progress, cancel)
    if solved.outcome is Outcome.COMPLETE and run.checks:
        poll = poll_of(run.duration, (0.7 * checked, checked), progress, cancel)
        try:
            with asking(cancel):
                rough = solver.run(accuracy, poll, ends_only=True)
        except CancelledError:
            reason = "asked to stop while the error was estimated; the run itself is complete"
            solved = rough = replace(solved, outcome=Outcome.CANCELLED, reason=reason)
    errors = None
    if run.checks and solved.outcome is Outcome.COMPLETE and rough.outcome is Outcome.COMPLETE:
        beside = rough
        turned = max((one.rotation_max for one in solved.hinges), default=0.0)
        if rotation_differences(rough, solved).max(initial=0.0) > max(FORK * turned, NEGLIGIBLE):
            poll = poll_of(run.duration, (checked, checked), progress, cancel)
            beside = _finer(solver, accuracy, poll, cancel) or rough
        errors = stated_errors(structure, beside, solved)
    doubt = _doubt(structure, run, solver, rough, (progress, cancel)) if run.checks else None
    seconds = time.perf_counter() - begin
    result = _result(
        structure, run, solver, solved, errors=errors, doubt=doubt, seconds=seconds, accuracy=accuracy
    )
    return with_lengthening_told(result, run, given, structure)


def _lengthened(
    given: Structure, run: Run, solver: Solver, solved: Solved, poll: Poll
) -> tuple[Structure, Solver, Solved]:
    """The run again with members that its forces show to change their length, until they show no more.

    The structure as solved, its solver and run. If none of these runs completes, the first one is the answer.
    """
    told = run.settings, run.time_in_motion
    first = bent = with_elastic_members(given, *told)
    known, found = lengthening_members(given, *told), (solver, solved)
    for _ in range(MOST_LENGTHENED):
        further = members_to_lengthen(bent, found[1])
        if not further:
            break
        note_lengthening(given, *told, lengthening_members(given, *told) | further)
        bent = with_elastic_members(given, *told)
        again = solver_of(bent, run)
        found = again, again.run(run.settings.accuracy / CHECK_FACTOR, poll)
        if found[1].outcome is not Outcome.COMPLETE:
            note_lengthening(given, *told, known)
            return first, solver, solved
    return bent, *found


def _with_rigid_bars(
    structure: Structure, run: Run, solved: Solved, progress: Progress | None, cancel: Cancel | None
) -> Result:
    """Result of rigid bars, where members that bend unless the input says otherwise end a run."""
    bars = run.settings.model_copy(update={"members": "rigid"})
    rigid = replace(run, settings=bars, bending_tried=True)
    result = solve_multibody(structure, rigid, progress, cancel)
    why = f"Members are rigid bars here: with members that bend the run ended early ({solved.reason})."
    settings = {**result.provenance.settings, "members": "rigid"}
    provenance = replace(result.provenance, settings=settings)
    return replace(result, warnings=(why, *result.warnings), provenance=provenance)


def _balanced(solver: Solver, solved: Solved, run: Run, poll: Poll) -> tuple[Solved, float]:
    """A run of the tree kernel, or with elastic hinges, that keeps its energy balance, and its accuracy.

    The accuracy bounds errors of rotations.  Elastic hinges of stiff members vibrate, and the vibration loses
    energy of the order of the accuracy without turning a hinge much.
    """
    accuracy, bound = run.settings.accuracy, run.settings.energy_residual_bound
    vibrates = Form.ELASTIC_PLASTIC in {hinge.record.form for hinge in solver.hinges}
    if not vibrates and solver.kernel != "tree":
        return solved, accuracy
    for share in FINER:
        if solved.outcome is not Outcome.COMPLETE or solved.residual <= bound:
            break
        finer = solver.run(share * run.settings.accuracy / CHECK_FACTOR, poll)
        if finer.outcome is not Outcome.COMPLETE or finer.residual >= solved.residual:
            break
        solved, accuracy = finer, share * run.settings.accuracy
    return solved, accuracy


def _finer(solver: Solver, accuracy: float, poll: Poll, cancel: Cancel | None) -> Solved | None:
    """A run finer than the answer, if it completes: a coarser one may take another path near a fork."""
    try:
        with asking(cancel):
            finer = solver.run(accuracy / CHECK_FACTOR**2, poll, ends_only=True)
    except CancelledError:
        return None
    return finer if finer.outcome is Outcome.COMPLETE else None


def solver_of(structure: Structure, run: Run) -> Solver:
    """The structure prepared for the kernel that suits it, or that the settings name."""
    hinges = placed_hinges(structure)
    if run.capacities:
        hinges = tuple(scaled_hinge(one, run.capacities.get(one.name, 1.0)) for one in hinges)
    if why_spatial(structure, hinges, run) is None:
        return TreeSolver(structure, run, hinges)
    return SpatialSolver(structure, run, hinges)


def _check_asked(structure: Structure, run: Run, solver: Solver) -> bool:
    """Whether the run is to be solved again with changed capacities."""
    asked = run.settings.mechanism_check
    wanted = asked == "on" or (asked == "auto" and any_automatic(structure))
    return wanted and sum(hinge.plastic for hinge in solver.hinges) >= 2


def _doubt(
    structure: Structure,
    run: Run,
    solver: Solver,
    rough: Solved,
    watch: tuple[Progress | None, Cancel | None],
) -> str | None:
    """A warning if the structure folds elsewhere after a small change of the capacities."""
    if not _check_asked(structure, run, solver) or rough.outcome is not Outcome.COMPLETE:
        return None
    progress, cancel = watch
    runs = [rough.hinges]
    cases = list(changed_capacities(placed_hinges(structure)))
    parts = np.linspace(CHECKED_FROM, 1.0, len(cases) + 1).tolist()
    for hinges, part in zip(cases, pairwise(parts), strict=True):
        poll = poll_of(run.duration, part, progress, cancel)
        try:
            with asking(cancel):
                solved = solver.with_hinges(hinges).run(run.settings.accuracy, poll, ends_only=True)
        except CancelledError:
            return "Cancelled before it was checked whether small changes of capacities fold it elsewhere."
        if solved.outcome is Outcome.COMPLETE:
            runs.append(solved.hinges)
    return not_unique(runs)


def _is_in(obstacle: str, stages: Sequence[Stage]) -> bool:
    return any(stage.obstacles is None or obstacle in stage.obstacles for stage in stages)


def _result(
    structure: Structure,
    run: Run,
    solver: Solver,
    solved: Solved,
    *,
    errors: StatedErrors | None,
    doubt: str | None,
    seconds: float,
    accuracy: float,
) -> Result:
    solved = replace(solved, bending_tried=run.bending_tried)
    bound = run.settings.energy_residual_bound
    status, reason = outcome_status(solved.outcome, solved.reason, solved.residual, bound)
    slow = [stage.name for stage in run.stages if stage.kind == "quasi-static"]
    absent = {name for name in structure.obstacles if run.stages and not _is_in(name, run.stages)}
    cautions = (*untouched(structure, solved, absent), *physics_cautions(structure, solved, slow=slow))
    if status.ok and any(caution.violation for caution in cautions):
        status = Status.IMPOSSIBLE
        reason = " ".join(sentences(caution for caution in cautions if caution.violation))
    walls = wall_motions(solved.dents)
    wanted = [
        *node_channels(structure, solved.poses, run.outputs.nodes, solved.time, walls),
        *section_channels(structure, solved.poses, run.outputs),
        *distance_channels(structure, solved.poses, run.outputs, walls),
        *clearance_channels(structure, solved.poses, run.outputs),
    ]
    channels = [
        *hinge_channels(solved.hinges, solved.spread, solved.dents),
        *dent_channels(solved.dents),
        *energy_channels(solved),
        *gravity_channels(structure, solved.poses),
    ]
    channels += [*solved.further, *wanted]
    uses = law_use_about(structure)
    hinges = with_crush(structure, solved.hinges, summaries(solved.hinges, errors, uses))
    openings, threshold = collapse_log(solved.hinges, solved.time)
    return Result(
        status=status,
        reason=reason,
        fidelity="multibody",
        title=run.title,
        time=solved.time,
        channels={channel.name: channel for channel in channels},
        hinges=hinges,
        states=states_of(structure, solved.poses, solved.time, picture_times(run)),
        energy_residual=solved.residual,
        solve_seconds=seconds,
        cautions=cautions,
        warnings=(
            *sentences(caution for caution in cautions if not caution.violation),
            *trust.warnings(structure, hinges, solved, solver.notes),
            *obstacle_overlap_warnings(structure, run.stages),
            *([doubt] if doubt else []),
            *missing_pictures(run.outputs.pictures, float(solved.time[-1])),
        ),
        assumptions=trust.assumptions(structure, solver, run),
        provenance=Provenance(
            version="", input_hash="", isa="scalar", settings=_settings(run, solver, solved, accuracy)
        ),
        output_names=tuple(channel.name for channel in wanted),
        collapse=openings,
        collapse_threshold=threshold,
        stages=solved.stages,
        crumpled_ends=solved.crumpled,
        dents=dented_walls(solved.dents),
        displacement_errors={} if errors is None else errors.displacement,
        yielded=_yielded(solved),
    )


def _yielded(solved: Solved) -> dict[str, tuple[tuple[float, float], ...]]:
    """Station [m] and energy [J] of what elastic members dissipated between their hinges, by member."""
    found: dict[str, list[tuple[float, float]]] = {}
    for (member, station), energy in solved.spread.items():
        if energy.size:
            found.setdefault(member, []).append((station, float(energy[-1])))
    return {member: tuple(sorted(places)) for member, places in found.items()}


def _settings(run: Run, solver: Solver, solved: Solved, accuracy: float) -> dict[str, float | int | str]:
    finer = {"accuracy_used": accuracy} if accuracy != run.settings.accuracy else {}
    return {
        **finer,
        "kernel": solver.kernel,
        "accuracy": run.settings.accuracy,
        "minimum_time_step": run.settings.minimum_time_step,
        "maximum_time_step": run.settings.maximum_time_step,
        "energy_residual_bound": run.settings.energy_residual_bound,
        "steps": solved.steps,
        "rejected_steps": solved.rejected,
        "newton_steps": solved.solves,
    }


def _nothing_solved(run: Run, reason: str, seconds: float) -> Result:
    """Result of a run that was cancelled before its first step: no histories, no hinges, no shapes."""
    return Result(
        status=Status.CANCELLED,
        reason=reason,
        fidelity="multibody",
        title=run.title,
        time=np.zeros(0),
        channels={},
        hinges={},
        states=None,
        energy_residual=0.0,
        solve_seconds=seconds,
        warnings=(),
        assumptions=(),
        provenance=Provenance(version="", input_hash="", isa="scalar"),
    )


def _nothing_moves(structure: Structure) -> InputError:
    driven = [name for name, support in structure.supports.items() if support.driven]
    pushed = f"support{'s' if len(driven) > 1 else ''} {listed(driven)} cannot move what others clamp"
    return InputError(
        Problem(
            "nothing can move: every part is held and no member has a hinge",
            pushed if driven else "",
            "at least one hinge, or a part that is not clamped",
            "add hinges to the members that are to fold ('hinges: auto'), free what a motion is to move, or "
            "let members bend: 'analysis: {multibody: {members: elastic}}'",
            "members",
        )
    )
