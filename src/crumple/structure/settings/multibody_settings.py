"""Settings of the solvers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from crumple.registry.quantity import Accuracy, Fraction, PositiveFrequency, PositiveTime
from crumple.registry.refusal import refuse
from crumple.structure.keys.member import MOST_SEGMENTS, SEGMENTS
from crumple.structure.schema.spec import Spec


class MultibodySettings(Spec):
    """Settings of the multibody solver."""

    kernel: Literal["auto", "tree", "spatial"] = "auto"
    """Solver kernel: planar tree, spatial, or the tree wherever it is applicable."""
    members: Literal["auto", "elastic", "rigid"] = "auto"
    """Whether members between their hinges are rigid bars, or bend and yield along their length; auto: they
    bend if automatic hinges are asked for anywhere, in motions of up to 0.5 s, quasi-static stages not
    counted."""
    segments: Annotated[int, Field(ge=2, le=MOST_SEGMENTS)] = SEGMENTS
    """Segments of each elastic member, or of a straight run of them together; a member that states its own
    keeps them, and of a run the largest number counts."""
    resolved_frequency: PositiveFrequency = 500.0
    """Vibration of elastic hinges and members above it does not shorten the steps; it keeps its energy, but
    not its phase."""
    accuracy: Accuracy = 1e-3
    """Relative error allowed in the rotations."""
    minimum_time_step: PositiveTime = 1e-9
    """Below this step the run stops with a status."""
    maximum_time_step: PositiveTime = 3e-3
    """Largest step."""
    mechanism_check: Literal["auto", "on", "off"] = "auto"
    """Whether to solve four times more with capacities changed by 1 % and warn where other hinges open; auto:
    where hinges find their places automatically."""
    energy_residual_bound: Fraction = 1e-3
    """Energy residual above which the status marks the result as not reliable."""

    @model_validator(mode="after")
    def _steps(self) -> MultibodySettings:
        if self.minimum_time_step > self.maximum_time_step:
            refuse(
                "the smallest time step is above the largest",
                key="minimum_time_step",
                allowed=f"at most {self.maximum_time_step:g} s, the maximum_time_step",
                todo="correct one of them",
            )
        return self
