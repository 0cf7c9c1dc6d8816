"""Interface of every torsion law of a member: torque against twist, with source and range of validity.

It is a hinge law whose rotation is the twist between the ends of the twisted length, so the solver uses it
like any other.
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from crumple.hinge.law import HingeLaw


@runtime_checkable
class TorsionLaw(HingeLaw, Protocol):
    """A hinge law in torsion; "moment" is the torque [N m], "rotation" the twist [rad].

    Attributes
    ----------
    initial_torque
        Torque at which the walls begin to fold [N m].
    steady_torque
        Torque at which they continue to fold [N m].
    """

    @property
    def initial_torque(self) -> float: ...
    @property
    def steady_torque(self) -> float: ...
