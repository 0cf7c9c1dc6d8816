"""What every sub-model offers: input of the shell solver, the law measured in its result, and its place."""

from __future__ import annotations

from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.curve import LawCurve
from crumple.characterisation.resolution import Resolution
from crumple.errors import InputError
from crumple.hinge.measured.place_hash import Load
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import Axis, Section
from crumple.shell.mesh.joints import shortest_with_mitre


class StrongCornerError(InputError):
    """A corner did not fold: its members did, beside it."""


class Histories(Protocol):
    """Channels by name: a result, or those of a run so far."""

    def __getitem__(self, name: str, /) -> Floats: ...


class Solvable(Protocol):
    """What shells solve slowly, and a curve is read from.

    Attributes
    ----------
    title
        One line for people.
    resolution
        How finely and how slowly it is solved.
    watched_from
        Plastic rotation [rad], or shortening [m], from which the kinetic energy is watched.
    """

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def title(self) -> str: ...
    @property
    def resolution(self) -> Resolution: ...
    @property
    def watched_from(self) -> float: ...

    def analysis(self) -> Analysis:
        """Input of the shell solver."""
        ...

    def curve(self, result: Result) -> LawCurve:
        """Law measured in the solved sub-model; `InputError` if it did not fold where it should."""
        ...


class SubModel(Solvable, Protocol):
    """A piece of a structure that is solved by shells for the law of its fold; a frozen dataclass.

    Attributes
    ----------
    section, material, sense, largest
        See `Bending`; of crushing the largest shortening over the length.
    load
        What it is loaded by.
    origin
        Entries of the law file on the place.
    place
        Hash of the place, by which structures find the law.
    one_law
        Whether both senses have the same law, so that one of them is solved.
    size, length, duration
        Length of the elements [m], of the sub-model [m], and the time simulated [s].
    """

    @property
    def section(self) -> Section: ...
    @property
    def material(self) -> Material: ...
    @property
    def sense(self) -> int: ...
    @property
    def largest(self) -> float: ...
    @property
    def load(self) -> Load: ...
    @property
    def origin(self) -> dict[str, str]: ...
    @property
    def place(self) -> str: ...
    @property
    def one_law(self) -> bool: ...
    @property
    def size(self) -> float: ...
    @property
    def length(self) -> float: ...
    @property
    def duration(self) -> float: ...

    def measured(self, result: Result, curve: LawCurve) -> dict[str, str]:
        """Further entries of the law file that were measured."""
        ...


Model = TypeVar("Model", bound=Solvable)


def largest_side(section: Section) -> float:
    """Largest extent of the outer outline [m]."""
    return float(np.ptp(section.outer_outline(), axis=0).max())


def corner_piece(section: Section, axis: Axis, angle: float) -> float:
    """Least length of the pieces of a corner [m], so that shells join them by a mitre."""
    across = 1 if axis == "y" else 0
    reach = float(np.abs(section.outer_outline()[:, across]).max())
    return shortest_with_mitre(reach, abs(angle))


def is_mirrored(section: Section, axis: Axis) -> bool:
    """Whether a section is its own mirror image about an axis of bending: both senses have one law then."""
    points = section.outline()
    across = 1 if axis == "y" else 0
    image: Floats = points.copy()
    image[:, across] *= -1.0
    apart = np.linalg.norm(points[:, None] - image[None, :], axis=2).min(axis=0)
    return bool(apart.max() < 1e-6 * np.ptp(points, axis=0).max())
