"""A structure, and how it is analysed."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import AfterValidator, Field, ValidationInfo, model_validator

from crumple.analysis.criteria import Criterion
from crumple.analysis.filters import filter_problems
from crumple.analysis.uncertainty import Uncertainty
from crumple.errors import Problem
from crumple.registry.quantity import Duration
from crumple.registry.refusal import refuse
from crumple.structure import (
    MultibodySettings,
    Outputs,
    ShellSettings,
    Stage,
    Structure,
    history_problems,
    output_problems,
    shell_problems,
    stage_problems,
    time_in_motion,
)
from crumple.structure.schema.mapping import frozen
from crumple.structure.schema.spec import Named, Spec, raise_all
from crumple.units import format_quantity

LONGEST_TITLE = 200
DEFAULT_INTERVALS = 200
"""Number of intervals of the histories if the input gives none: enough for a smooth figure."""
MOST_STAGES = 100
"""Largest number of stages of one run; more is a mistake in the input."""
MOST_SAMPLES = 1_000_000
"""Samples of every channel: more than any figure needs, few enough to store."""


class Settings(Spec):
    """How long to simulate, and the settings of the solvers."""

    duration: Duration | None = None
    """Time to simulate; with `stages` the sum of theirs."""
    stages: Annotated[tuple[Stage, ...], Field(max_length=MOST_STAGES)] = ()
    """What happens in sequence; without it one dynamic stage of `duration`."""
    multibody: MultibodySettings = MultibodySettings()
    """Settings of the multibody solver."""
    shell: ShellSettings = ShellSettings()
    """Settings of the shell solver."""

    @model_validator(mode="after")
    def _one_duration(self) -> Settings:
        if self.duration is None and not self.stages:
            todo = "add 'duration', or stages"
            refuse("the duration is missing", key="duration", allowed="a time, for example 100 ms", todo=todo)
        if self.duration is not None and self.stages:
            refuse("the stages have their own durations", key="duration", todo="remove it")
        return self

    @property
    def total_duration(self) -> float:
        """Sum of the durations of all stages [s]."""
        return self.duration or sum(stage.duration for stage in self.stages)


def _printable(title: str) -> str:
    """Refuse control characters: a title is printed on terminals."""
    if not title.isprintable():
        refuse(
            "the title contains a character that cannot be printed",
            allowed="one line of printable text",
            todo="remove it",
        )
    return title


Title = Annotated[str, Field(max_length=LONGEST_TITLE), AfterValidator(_printable)]


def run_problems(outputs: Outputs, duration: float) -> list[Problem]:
    """More samples than a run may store, an interval longer than it, and pictures after its end.

    Parameters
    ----------
    outputs
        What is reported.
    duration
        Of the run [s].
    """
    problems = []
    samples = duration / (outputs.every or duration / DEFAULT_INTERVALS)
    if samples > MOST_SAMPLES * (1.0 + 1e-9):
        # rounded up to two digits, so that the suggested value is accepted
        step = 10.0 ** (math.floor(math.log10(duration / MOST_SAMPLES)) - 1)
        shortest = math.ceil(duration / MOST_SAMPLES / step) * step
        what = f"this interval gives {samples:.3g} samples of every channel"
        todo = f"write at least {format_quantity(shortest, 's', 3)}, or a shorter duration"
        came = f"{outputs.every:g} s"
        problems.append(Problem(what, came, f"at most {MOST_SAMPLES} samples", todo, "outputs.every"))
    if (outputs.every or 0.0) > duration * (1.0 + 1e-9):
        what, todo = "this interval is longer than the run", "correct the interval or the duration"
        allowed = f"at most {duration:g} s, the duration"
        problems.append(Problem(what, f"{outputs.every:g} s", allowed, todo, "outputs.every"))
    for i, time in enumerate(outputs.pictures):
        if time > duration * (1.0 + 1e-9):
            what, todo = "this picture time is after the end of the run", "correct the time or the duration"
            allowed = f"at most {duration:g} s, the duration"
            problems.append(Problem(what, f"{time:g} s", allowed, todo, f"outputs.pictures[{i}]"))
    return problems


class Analysis(Spec):
    """One run: a structure, how long, with which settings, reporting what.

    Frozen, picklable; contains everything that a solver needs (curves are embedded, not file names).

    Attributes
    ----------
    structure
        What is simulated.
    duration
        [s]; the maximum if a stage may end earlier.
    title
        One line for people.
    stages
        What happens in sequence, with durations that add up to `duration`; empty for one dynamic stage.
    multibody, shell
        Settings of the solvers.
    outputs
        What is reported.
    criteria
        Limits that the structure shall keep, by name.
    uncertainty
        Which numbers scatter, in SI; solved by `crumple.study.with_uncertainty`.
    """

    structure: Structure
    duration: Duration
    title: Title = ""
    stages: tuple[Stage, ...] = ()
    multibody: MultibodySettings = MultibodySettings()
    shell: ShellSettings = ShellSettings()
    outputs: Outputs = Outputs()
    criteria: Named[Criterion] = frozen({})
    uncertainty: Uncertainty | None = None

    @property
    def time_in_motion(self) -> float:
        """Duration without quasi-static stages [s]."""
        return time_in_motion(self.duration, self.stages)

    @model_validator(mode="after")
    def _sound(self, info: ValidationInfo) -> Analysis:
        if info.context and info.context.get("checked"):
            return self
        problems = output_problems(self.outputs, self.structure)
        samples = run_problems(self.outputs, self.duration)
        problems += samples or history_problems(
            self.structure, self.outputs, self.duration / self.output_interval
        )
        problems += shell_problems(self.shell, self.structure)
        problems += stage_problems(self.stages, self.structure)
        total = sum(stage.duration for stage in self.stages)
        if self.stages and not math.isclose(total, self.duration):
            what, todo = "the duration differs from the sum of the stages", "correct one of them"
            problems.append(Problem(what, f"{self.duration:g} s", f"{total:g} s, the sum", todo, "duration"))
        interval = self.output_interval
        raise_all(problems or filter_problems(self.structure, self.outputs, self.duration, interval))
        return self

    @property
    def output_interval(self) -> float:
        """Interval of the histories [s]."""
        return self.outputs.every or self.duration / DEFAULT_INTERVALS
