"""Solve sub-models: both senses where they differ, slowly enough, on finer meshes for an error estimate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from crumple.analysis import solve
from crumple.characterisation.bending import Bending
from crumple.characterisation.coupling.oblique_corner import coupling_errors
from crumple.characterisation.crush import Crush
from crumple.characterisation.curve import LawCurve
from crumple.characterisation.interaction import interaction_errors
from crumple.characterisation.law import law_of
from crumple.characterisation.out_of_plane import OutOfPlane
from crumple.characterisation.rate import Turned, at_rest, faster, rate_law, rate_pair
from crumple.characterisation.sub_model import Model, Solvable, StrongCornerError, SubModel
from crumple.errors import InputError, Problem, Status
from crumple.hinge.measured.stored import StoredLaw
from crumple.material import CowperSymonds
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.shell import LongRun

MOST_KINETIC = 0.02
"""Kinetic over internal energy at which the sub-model is solved again, more slowly."""
ATTEMPTS = 3
"""Times that a sub-model is slowed down before it is given up."""
FINER = (1.25, 1.5625)
"""Elements of the finer meshes over those of the nominal one: steps of one ratio."""
FIRST_COMPARED = np.deg2rad(5.0)
"""Rotation from which the energies of meshes are compared [rad]."""


@dataclass(frozen=True)
class Characterised:
    """Law of a sub-model with the runs that it came from.

    Attributes
    ----------
    law
        Ready for its file.
    curve
        In the sense of the model.
    result
        Shell run of the nominal mesh in this sense; in the other one where a corner folds only in that.
    kinetic
        Largest kinetic over internal energy after 2 degrees [-].
    error
        Estimated relative error of the energy from the mesh [-]; None where one mesh was solved.
    """

    law: StoredLaw
    curve: LawCurve
    result: Result
    kinetic: float
    error: float | None


def characterise(
    model: SubModel,
    *,
    converge: bool = False,
    interaction: bool = False,
    threads: int = 1,
    progress: Callable[[str, float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Characterised:
    """Law of a sub-model from shells.

    Parameters
    ----------
    model
        What folds.
    converge
        Solve two finer meshes too, and state the error of the energy.
    interaction
        Of a straight member in bending: solve it with axial force and about an oblique axis too; of a corner
        about its bisector: solve it with bending in its plane too. The errors of the ways in which hinges
        combine these are stated. Without effect for other models.
    threads
        Threads of the shell solver.
    progress
        Called with what is being solved and the share done, 0 to 1.
    cancel
        Called at intervals; if it returns True, the work ends with `KeyboardInterrupt`.

    Raises
    ------
    InputError
        If the section cannot be meshed, the run ended early, or the kinetic energy stayed too large.
    KeyboardInterrupt
        If `cancel` returned True.

    References
    ----------
    docs/theory/characterisation.md.  Verified in tests/verification/characterisation.
    """
    solver = _Solver(threads, progress, cancel)
    pair = rate_pair(model.material)
    static = model if pair is None else at_rest(model)
    try:
        result, curve, kinetic, slow = solver.run(static, "nominal mesh")
        folds = model.sense
    except StrongCornerError:
        result, curve, kinetic, slow = solver.run(replace(static, sense=-model.sense), "other sense")
        folds = -model.sense
    opposite, borrowed = (None, {}) if model.one_law else solver.opposite(slow, known=folds != model.sense)
    error = None
    if converge:
        elements = slow.resolution.elements
        finer = [
            solver.run(
                replace(slow, resolution=replace(slow.resolution, elements=ratio * elements)),
                f"mesh {ratio:.3g} times finer",
            )[1]
            for ratio in FINER
        ]
        error = energy_error(curve, *finer)
    facts = {
        **borrowed,
        **slow.measured(result, curve),
        "mesh": f"{slow.resolution.elements:g} elements along half a fold",
        "kinetic_energy": f"at most {kinetic:.2%} of the internal energy after {_amount(slow)}",
        "energy_residual": f"{result.energy_residual:.2g} of the energy input",
    }
    added = float(result.provenance.settings["added_mass"])
    if added:
        facts["mass_scaling"] = f"{1e3 * added:.3g} g added at the smallest elements"
    if interaction and isinstance(slow, Bending) and slow.angle is None:
        facts |= interaction_errors(slow, lambda one: solver.run(one, one.title)[1])
    if interaction and isinstance(slow, OutOfPlane) and slow.about == "bisector":
        facts |= coupling_errors(slow, curve, lambda one: solver.run(one, one.title)[1])
    moving = replace(slow, material=model.material)
    law = replace(law_of(moving, curve, opposite, facts, error), title=model.title)
    if pair is not None and isinstance(moving, Turned):
        law = solver.with_rate(law, moving, pair, curve)
    own = curve if folds == model.sense or opposite is None else opposite
    return Characterised(law, own, result, kinetic, error)


@dataclass(frozen=True)
class _Solver:
    """Solves sub-models slowly enough."""

    threads: int
    progress: Callable[[str, float], None] | None
    cancel: Callable[[], bool] | None

    def result(self, one: Solvable, what: str) -> Result:
        """Result of a sub-model that reached its end."""
        result = self.attempt(one, what)
        if not result.status.ok:
            raise InputError(Problem(f"the sub-model ended early: {result.reason}", one.title))
        return result

    def attempt(self, one: Solvable, what: str) -> Result:
        """Result of a sub-model."""

        def report(share: float) -> None:
            if self.progress is not None:
                self.progress(what, share)

        def enough(channels: Mapping[str, Floats]) -> bool:
            """Whether the fold has turned up to the end of its law."""
            return isinstance(one, Turned) and bool(one.histories(channels)[0].max() >= one.largest)

        options = LongRun(enough=enough)
        result = solve(one.analysis(), "shell", self.threads, report, self.cancel, long_run=options)
        if result.status is Status.CANCELLED:
            raise KeyboardInterrupt
        return result

    def run(self, one: Model, what: str) -> tuple[Result, LawCurve, float, Model]:
        """Result, curve, share of kinetic energy, and the model as slow as it was solved."""
        for _ in range(ATTEMPTS):
            result = self.attempt(one, what)
            failed = Problem(f"the sub-model ended early: {result.reason}", one.title)
            if not result.status.ok:
                less = one.less(result) if isinstance(one, Crush) else None
                if less is None:
                    break
                one = replace(one, largest=less)
                continue
            curve = one.curve(result)
            kinetic = kinetic_share(result, curve.energy_at(one.watched_from))
            if kinetic <= MOST_KINETIC:
                return result, curve, kinetic, one
            what_failed = f"kinetic energy is {kinetic:.1%} of the internal energy"
            failed = Problem(what_failed, one.title, f"at most {MOST_KINETIC:.0%}")
            slower = one.resolution.slowness * 1.2 * float(np.sqrt(kinetic / MOST_KINETIC))
            one = replace(one, resolution=replace(one.resolution, slowness=slower))
        raise InputError(failed)

    def opposite(self, one: SubModel, *, known: bool) -> tuple[LawCurve, dict[str, str]]:
        """Law in the other sense, and an entry of the law file if a corner has that of its members there.

        Parameters
        ----------
        one
            Solved in its own sense.
        known
            Whether the corner is known to be as strong as its members in the other sense.
        """
        other = replace(one, sense=-one.sense)
        if not known:
            try:
                return self.run(other, "other sense")[1], {}
            except StrongCornerError:
                pass
        curve = self.run(replace(other, angle=None), "the member, where the corner is as strong")[1]
        closes = other.closes if isinstance(other, Bending) else other.sense > 0
        doing = "closed" if closes else "opened"
        return curve, {doing: "as strong as the members, so it has the law of the straight member"}

    def with_rate(self, law: StoredLaw, model: Turned, pair: CowperSymonds, static: LawCurve) -> StoredLaw:
        """The law with the rate law of its fold, and its check in the origin."""
        runs = (model, faster(model))
        first, second = (
            self.result(one, what) for one, what in zip(runs, ("strain rate", "another speed"), strict=True)
        )
        rate, sentence = rate_law(pair, static, ((runs[0], first), (runs[1], second)))
        return replace(law, rate=rate, origin=(*law.origin, ("rate", sentence)))


def _amount(model: SubModel) -> str:
    """Rotation or shortening from which the kinetic energy is watched."""
    at = model.watched_from
    return f"{1e3 * at:.3g} mm" if model.load == "crush" else f"{np.degrees(at):.3g} deg"


def kinetic_share(result: Result, work: float) -> float:
    """Largest kinetic over internal energy [-] once the law has taken a work [J]."""
    internal = result["energy.elastic"] + result["energy.dissipated"]
    later = result["energy.dissipated"] >= work
    if not later.any():
        return 0.0
    return float((result["energy.kinetic"][later] / internal[later]).max())


def energy_error(nominal: LawCurve, fine: LawCurve, finest: LawCurve) -> float:
    """Relative error of the energy on the nominal mesh, by extrapolation from two finer ones [-].

    The order p follows from the three energies, E(h) = E_0 + C h^p, within 1 to 2; the error is that at the
    rotation where it is largest.
    """
    end = min(curve.rotation[-1] for curve in (nominal, fine, finest))
    at = np.linspace(min(float(FIRST_COMPARED), 0.5 * end), end, 50)
    one, two, three = (np.interp(at, curve.rotation, curve.energy) for curve in (nominal, fine, finest))
    first, second = np.abs(one - two), np.maximum(np.abs(two - three), 1e-12 * np.abs(three))
    ratio = FINER[0]
    order = np.clip(np.log(np.maximum(first, 1e-300) / second) / np.log(ratio), 1.0, 2.0)
    limit = three + (three - two) / (ratio**order - 1.0)
    return float(np.abs((one - limit) / limit).max())
