"""Solvers by name, as the commands take them."""

from __future__ import annotations

from enum import StrEnum


class Fidelity(StrEnum):
    """Solvers by name."""

    MULTIBODY = "multibody"
    SHELL = "shell"
    BOTH = "both"

    @property
    def solvers(self) -> tuple[Fidelity, ...]:
        """The single solver, or both."""
        return (Fidelity.MULTIBODY, Fidelity.SHELL) if self is Fidelity.BOTH else (self,)
