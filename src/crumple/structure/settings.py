"""Settings of the solvers."""

from __future__ import annotations

from crumple.structure.quantity import Accuracy, Fraction, PositiveTime
from crumple.structure.spec import Spec


class MultibodySettings(Spec):
    """Settings of the multibody solver."""

    accuracy: Accuracy = 1e-3
    """Relative error allowed in the rotations."""
    minimum_time_step: PositiveTime = 1e-9
    """Below this step the run stops with a status."""
    maximum_time_step: PositiveTime = 3e-3
    """Largest step."""
    energy_residual_bound: Fraction = 1e-3
    """Energy residual above which the run ends with a status that says not to trust it."""
