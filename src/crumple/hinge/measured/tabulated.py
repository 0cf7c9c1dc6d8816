"""Capacity from a table: a bending test, another code, or a drawing.

Linear between the points; beyond the last point the last capacity is kept, with a warning.
The abscissa is the plastic rotation: a test that starts with an elastic rise has that part removed first
(crumple.hinge.measured.table.plastic_part), since the elasticity is modelled by the member or by the elastic
form.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.measured.embedding import MOST_POINTS, FileName, with_curve_read, with_units
from crumple.hinge.measured.table import Curve, plastic_part
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor, rate_warnings
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.keys import As, Key
from crumple.registry.quantity import Angle, Longest, Moment
from crumple.registry.refusal import refuse
from crumple.section import Axis, Section

Angles = Annotated[tuple[Angle, ...], Longest(MOST_POINTS)]
Moments = Annotated[tuple[Moment, ...], Longest(MOST_POINTS)]
FILE_KEYS = (
    Key(
        "file",
        FileName | None,
        None,
        "CSV file with one head such as `rotation [deg], moment [kN*m]`, in the folder of the input file or "
        "below, in place of the lists.",
    ),
    Key(
        "negative_file",
        FileName | None,
        None,
        "CSV file of the negative sense, as positive numbers; without it as in the positive sense.",
    ),
    Key(
        "units",
        Mapping[Literal["rotation", "moment"], str] | None,
        None,
        "Units of plain numbers in the lists, as {rotation: deg, moment: kN*m}; rad and N*m without it.",
    ),
)
"""Keys of an input that name files and units; their content is in the curves when the law is built."""
MEASURED = Source("table", Trust.MEASURED, "accuracy as of the supplied curve")


@dataclass(frozen=True)
class TabulatedLaw:
    """Measured or computed curve of moment against rotation, straight between its points.

    Attributes
    ----------
    rotation
        Plastic rotation [rad], strictly increasing from 0.
    moment
        Capacity [N m], > 0, as many.
    negative_rotation, negative_moment
        The same for the negative sense, as positive numbers; left out: as in the positive sense.
    elastic_stiffness
        Of the elastic rise [N m/rad], if known.
    scatter
        Relative half-width of the band of several specimens [-], if known.
    warnings
        Sentences on the material, for ``validity``.

    References
    ----------
    docs/theory/constant_and_table.md.  Verified in tests/unit/hinge/test_tabulated.py.
    """

    name: ClassVar[str] = "table"
    file_keys: ClassVar[tuple[Key, ...]] = FILE_KEYS
    straight: ClassVar[bool] = True

    rotation: Curve
    moment: Curve
    negative_rotation: Curve | None = None
    negative_moment: Curve | None = None
    elastic_stiffness: float | None = None
    rate: HingeRate | None = None
    source: Source = MEASURED
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    jamming_angle: float | None = None
    stop: Stop | None = None
    scatter: float | None = None
    warnings: tuple[str, ...] = ()
    validity: Validity = field(init=False)

    def __post_init__(self) -> None:
        # tuples: a law must be hashable, and must not change with the caller's list
        for key in ("rotation", "moment", "negative_rotation", "negative_moment"):
            values = getattr(self, key)
            if values is not None:
                object.__setattr__(self, key, tuple(float(value) for value in values))
        problems = _curve_problems(self.rotation, self.moment, "")
        if (self.negative_rotation is None) != (self.negative_moment is None):
            todo = "give both, or neither to mirror the positive sense"
            problems.append(
                Problem("half of the negative curve is missing", todo=todo, where="negative_rotation")
            )
        elif self.negative_rotation is not None and self.negative_moment is not None:
            problems += _curve_problems(self.negative_rotation, self.negative_moment, "negative_")
        if problems:
            raise InputError(problems)
        last = min(self._curve(1)[0][-1], self._curve(-1)[0][-1])
        basis = "the table ends there, and its last capacity is kept beyond"
        object.__setattr__(self, "validity", Validity(float(last), basis, self.warnings, self.scatter))

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        rotation: Annotated[Curve, As(Angles)],
        moment: Annotated[Curve, As(Moments)],
        negative_rotation: Annotated[Curve | None, As(Angles | None)] = None,
        negative_moment: Annotated[Curve | None, As(Moments | None)] = None,
        remove_elastic: bool = False,
        elastic_stiffness: float | None = None,
        static: bool = True,
    ) -> TabulatedLaw:
        """Law from measured points.

        Parameters
        ----------
        section, axis
            Not used: the curve is already for the section.
        material
            Its flow rate gives the rate factor of a static curve.
        rotation
            Rotations, increasing from 0 [rad]; total rotations if the elastic part is to be removed.
        moment
            Moment at each rotation [N m].
        negative_rotation
            Rotations of the negative sense, as positive numbers [rad].
        negative_moment
            Moments of the negative sense, as positive numbers [N m].
        remove_elastic
            Whether to take out the elastic rise with which a test starts.
        elastic_stiffness
            Of the rise [N m/rad]; None: found from the curve where it is removed.
        static
            Whether the test was slow; a dynamic one already contains the rate effect.

        Returns
        -------
        TabulatedLaw
            Frozen law.

        Raises
        ------
        InputError
            If a curve cannot be used.
        """
        if remove_elastic:
            given = elastic_stiffness
            rotation, moment, elastic_stiffness = plastic_part(rotation, moment, given)
            if negative_rotation is not None and negative_moment is not None:
                negative_rotation, negative_moment, _ = plastic_part(
                    negative_rotation, negative_moment, given
                )
        rate, warnings = (hinge_rate(material.flow_rate), rate_warnings(material)) if static else (None, ())
        return cls(
            rotation, moment, negative_rotation, negative_moment, elastic_stiffness, rate, warnings=warnings
        )

    @staticmethod
    def embedded(given: dict[str, Any], folder: Path | None) -> dict[str, Any]:
        """Keys of a description with the points of curve files in place of their names.

        Parameters
        ----------
        given
            Keys of the law, `FILE_KEYS` among them.
        folder
            Folder of the input file, in which the files must lie; None: built in Python, any file.
        """
        given = with_curve_read(with_curve_read(given, folder), folder, "negative_")
        given = with_units(given)
        if given.get("rotation") is None and given.get("moment") is None:
            refuse("the table has no points", allowed="file, or rotation and moment", todo="add one of them")
        for key in ("rotation", "negative_rotation"):
            if isinstance(given.get(key), Sequence) and len(given[key]) == 1:
                todo = "add points, or write a constant law with this moment"
                refuse("the table has one point", key=key, allowed="at least two points", todo=todo)
        return given

    @property
    def title(self) -> str:
        """One line for people."""
        return f"table of {len(self.rotation)} points"

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.negative_rotation is None

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Every point of the table [rad]."""
        return tuple(self._curve(sense)[0])

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a plastic rotation [rad]; see `HingeLaw`."""
        at = np.asarray(rotation, np.float64)
        return np.asarray(np.interp(at, *self._curve(sense)), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)

    def _curve(self, sense: int) -> tuple[Floats, Floats]:
        rotation, moment = self.rotation, self.moment
        if sense < 0 and self.negative_rotation is not None and self.negative_moment is not None:
            rotation, moment = self.negative_rotation, self.negative_moment
        return np.asarray(rotation, np.float64), np.asarray(moment, np.float64)


def _curve_problems(rotation: Curve, moment: Curve, prefix: str) -> list[Problem]:
    """Problems of one curve."""
    where_rotation, where_moment = f"{prefix}rotation", f"{prefix}moment"
    if len(rotation) != len(moment) or len(rotation) == 0:
        came = f"{len(rotation)} rotations, {len(moment)} moments"
        return [
            Problem("the table needs as many moments as rotations", came, "at least one", "", where_rotation)
        ]
    problems = []
    if not np.all(np.isfinite(rotation)) or rotation[0] != 0.0 or np.any(np.diff(rotation) <= 0.0):
        what = "rotations must increase strictly from 0"
        came = ", ".join(f"{value:g}" for value in rotation[:4])
        todo = "begin at plastic rotation 0 and omit repeated points"
        problems.append(Problem(what, f"{came}, ... rad", "0 < 1st < 2nd < ...", todo, where_rotation))
    if not np.all(np.isfinite(moment)) or min(moment) <= 0.0:
        what = "capacities must be positive"
        todo = (
            "remove the elastic rise, the hinge rotation is plastic only: write 'remove_elastic: true', or "
            "begin with the moment at which it yields"
        )
        if moment[0] > 0.0:
            todo = "keep a small residual capacity, or let the hinge break: fracture"
        problems.append(Problem(what, f"{min(moment):g} N m", "> 0 N m", todo, where_moment))
    return problems
