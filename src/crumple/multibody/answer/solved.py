"""Result of a run of a kernel before it is reported; the same for both kernels."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from crumple._core.outcome import Outcome
from crumple.hinge import Freedom, HingeLaw
from crumple.multibody.answer.dents import DentHistory
from crumple.multibody.answer.poses import Poses
from crumple.numeric.arrays import Floats
from crumple.result import Channel, CrumpledEnd, StageSummary
from crumple.section import AXES, Axis
from crumple.structure import PlacedHinge

Poll = Callable[[float], bool]

YIELDED = 1e-3
"""Plastic rotation [rad] up to which a law is not judged: 0.06 deg, in which no fold begins, and much more
than a locked hinge creeps."""


@dataclass(frozen=True, eq=False)
class HingeHistory:
    """History of one hinge.

    Attributes
    ----------
    hinge
        Where it is and what it can carry.
    columns
        Values, (n,), of ``rotation``, ``rotation_rate``, ``plastic_rotation``, ``moment``,
        ``capacity`` and ``energy``; of a hinge of several components these are lengths of the vectors of its
        rotations, and the components come beside: ``rotation.y`` and so on, and of one along the axis x
        ``slip.x.travel``, ``.rate``, ``.plastic_travel``, ``.force`` and ``.capacity``.
    rotation_max, moment_max
        Largest magnitudes of the columns ``rotation`` [rad] and ``moment`` [N m], over all steps.
    time_of_rest
        After which its plastic rotation no longer changed [s]; None: still turning.
    energy
        Absorbed [J].
    fracture
        When it broke [s], and the moment that it carried until then [N m]; None: it is whole.
    """

    hinge: PlacedHinge
    columns: Mapping[str, Floats]
    rotation_max: float
    moment_max: float
    time_of_rest: float | None
    energy: float
    fracture: tuple[float, float] | None = None

    def values(self, name: str) -> Floats:
        """One of its columns, (n,)."""
        return self.columns[name]

    def bent_by_law(self) -> list[tuple[Axis, HingeLaw, float]]:
        """Axes about which it yielded, with their laws and the largest plastic bending there [rad].

        The curve of a law is one over the plastic rotation: what a hinge bends elastically is no part of it.
        Of axes with one law, as a round tube has, the rotation is the length of their vector.
        """
        hinge, whole = self.hinge, self.values("plastic_rotation")
        if hinge.spatial is None:
            bent = {hinge.axis: whole}
        else:
            axes: list[Axis] = [axis for axis in AXES if Freedom[axis.upper()] in hinge.spatial.freedoms]
            # without others beside it a component has no name of its own
            bent = {axis: self.columns.get(f"plastic_rotation.{axis}", whole) for axis in axes}
        by_law: dict[HingeLaw, dict[Axis, Floats]] = {}
        for axis, values in bent.items():
            by_law.setdefault(hinge.laws.get(axis, hinge.law), {})[axis] = values
        least = self._turned_between_outputs()
        largest = [
            (next(iter(parts)), law, float(np.linalg.norm(list(parts.values()), axis=0).max(initial=least)))
            for law, parts in by_law.items()
        ]
        return [one for one in largest if one[2] > YIELDED]

    def _turned_between_outputs(self) -> float:
        """Plastic bending that was reached at any step at least [rad], of a hinge with one rotation alone.

        What it bends elastically is at most its largest moment over its stiffness.  0 of other hinges: the
        largest length of their rotations, elastic parts and twist included, says nothing of one law.
        """
        spatial = self.hinge.spatial
        if spatial is not None and [freedom for freedom in spatial.freedoms if freedom >= Freedom.X] != [
            Freedom[self.hinge.axis.upper()]
        ]:
            return 0.0
        return max(self.rotation_max - self.moment_max / self.hinge.record.elastic_stiffness, 0.0)

    def judged_by(self) -> tuple[Axis, HingeLaw, float]:
        """Of `bent_by_law` the one by which the hinge is judged.

        One beyond its range, of these and else that of the largest rotation; if nothing yielded, its first
        axis and 0.
        """
        bent = self.bent_by_law()
        beyond = [one for one in bent if one[1].validity.is_left_at(one[2])]
        at_rest = (self.hinge.axis, self.hinge.law, 0.0)
        return max(beyond or bent, key=lambda one: one[2], default=at_rest)


@dataclass(frozen=True)
class CrushedContact:
    """Walls that were crushed at a contact.

    Attributes
    ----------
    member, other
        The member, and what it touched: ``obstacle NAME`` or ``member NAME``.
    depth
        By how much the member and what it touched are closer than their outlines allow [m].
    force
        At which the walls were crushed [N].
    """

    member: str
    other: str
    depth: float
    force: float


@dataclass(frozen=True, eq=False)
class Solved:
    """One run of a kernel.

    Attributes
    ----------
    outcome, reason, residual, unseen, steps, rejected, forced, solves
        As reported by the kernel.
    time
        Output times [s], (n,).
    given, lost
        Energy of the described start, and what of it the joints took [J].
    struck
        Whether impulses act at the start: of these only what the joints let through becomes energy.
    poses
        Where the bodies are.
    hinges
        One history each.
    spread
        Energy that the walls of each elastic member dissipated between its hinges [J], (n,), by member and
        station [m].
    energy
        ``kinetic``, ``elastic``, ``dissipated``, ``external_work`` and, with obstacles, ``contact`` and
        ``friction`` [J], (n,) each.
    further
        Channels that this kernel gives beside.
    stages
        Name, start and end [s], and what ended it, of every stage.
    crushed
        Contacts whose walls were crushed; without any, contacts are rigid.
    crumpled
        Ends of members that crumpled.
    dents
        Dents that obstacles pressed into walls.
    stepping_seconds
        Wall time of the stepping alone [s].
    bending_tried
        Whether members that bend ended an earlier run, so that nothing advises them.
    """

    outcome: Outcome
    reason: str
    residual: float
    unseen: float
    steps: int
    rejected: int
    forced: int
    time: Floats
    solves: int
    given: float
    lost: float
    struck: bool
    poses: Poses
    hinges: tuple[HingeHistory, ...]
    energy: Mapping[str, Floats]
    stepping_seconds: float
    spread: Mapping[tuple[str, float], Floats] = field(default_factory=dict)
    further: tuple[Channel, ...] = ()
    stages: tuple[StageSummary, ...] = ()
    crushed: tuple[CrushedContact, ...] = ()
    crumpled: tuple[CrumpledEnd, ...] = ()
    dents: tuple[DentHistory, ...] = ()
    bending_tried: bool = False

    @property
    def balance(self) -> Floats:
        """Energy that is missing or too much since the start [J], (n,)."""
        sums = sum(values for name, values in self.energy.items() if name != "external_work")
        missing = np.asarray(sums - self.energy["external_work"])
        return missing - (missing[0] if missing.size else 0.0)


class Solver(Protocol):
    """A structure prepared for one kernel."""

    @property
    def kernel(self) -> str:
        """Name of the kernel: ``tree`` or ``spatial``."""

    @property
    def moving(self) -> bool:
        """Whether anything can move."""

    @property
    def hinges(self) -> tuple[PlacedHinge, ...]:
        """Hinges in the kernel's order."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences about the mobility of the structure at the start."""

    def with_hinges(self, hinges: tuple[PlacedHinge, ...]) -> Solver:
        """The same model with other hinges at the same places."""

    def run(self, accuracy: float, poll: Poll | None, *, ends_only: bool = False) -> Solved:
        """Solve with an accuracy, and record at the run's output times or only at the ends of its stages."""
