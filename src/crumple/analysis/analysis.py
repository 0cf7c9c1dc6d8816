"""A structure and what is to be done with it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from crumple.structure import (
    MultibodySettings,
    Outputs,
    ShellSettings,
    Structure,
    output_problems,
    shell_problems,
)
from crumple.structure.quantity import PositiveTime
from crumple.structure.spec import Spec, raise_all

LONGEST_TITLE = 200
DEFAULT_INTERVALS = 200
"""Intervals of the histories where the input gives none: enough for a smooth figure."""


class Settings(Spec):
    """How long to simulate, and the settings of the solvers."""

    duration: PositiveTime
    """Time to simulate."""
    multibody: MultibodySettings = MultibodySettings()
    """Settings of the multibody solver."""
    shell: ShellSettings = ShellSettings()
    """Settings of the shell solver."""


Title = Annotated[str, Field(max_length=LONGEST_TITLE)]


class Analysis(Spec):
    """One run: a structure, how long, with which settings, reporting what.

    Frozen, picklable; everything a solver needs and nothing outside it (curves are embedded, not named).

    Attributes
    ----------
    structure
        What is simulated.
    duration
        [s].
    title
        One line for people.
    multibody, shell
        Settings of the solvers.
    outputs
        What is reported.
    """

    structure: Structure
    duration: PositiveTime
    title: Title = ""
    multibody: MultibodySettings = MultibodySettings()
    shell: ShellSettings = ShellSettings()
    outputs: Outputs = Outputs()

    @model_validator(mode="after")
    def _sound(self) -> Analysis:
        from crumple.analysis.filters import filter_problems  # noqa: PLC0415  (filters know this class)

        problems = output_problems(self.outputs, self.structure)
        problems += shell_problems(self.shell, self.structure)
        interval = self.output_interval
        raise_all(problems or filter_problems(self.structure, self.outputs, self.duration, interval))
        return self

    @property
    def output_interval(self) -> float:
        """Interval of the histories [s]."""
        return self.outputs.every or self.duration / DEFAULT_INTERVALS
