"""The law type ``measured``: bending tests of one or several specimens, as a mean with its band.

The abscissa is by default the accumulated plastic rotation of both senses: a fold that is bent back does not
regain its virgin moment, and bending it back weakens it further.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.band import band_of
from crumple.hinge.law import HingeLaw, SofteningVariable
from crumple.hinge.measured.embedding import FileName, with_curve_read
from crumple.hinge.measured.measured import COVERAGE, bending_band, measured_band
from crumple.hinge.measured.stored import Points, StoredCurve, StoredLaw
from crumple.hinge.measured.tabulated import Angles, Moments
from crumple.hinge.rate import hinge_rate
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.keys import As, Key
from crumple.registry.quantity import Fraction, Longest, NonNegativeNumber, PositiveAngle
from crumple.registry.refusal import refuse
from crumple.section import Axis, Section

MOST_SPECIMENS = 50
"""Curves of one law."""
Curves = tuple[tuple[float, ...], ...]
FILE_KEYS = (
    Key(
        "file",
        FileName | None,
        None,
        "CSV file of one specimen, elastic rise included; its head as `rotation [deg], moment [kN*m]`.",
    ),
    Key(
        "files",
        Annotated[tuple[FileName, ...], Longest(MOST_SPECIMENS)] | None,
        None,
        "CSV files of several specimens.",
    ),
)


@dataclass(frozen=True)
class MeasuredLaw(StoredLaw):
    """Bending tests of one or several specimens: their mean, with the band of their scatter."""

    name: ClassVar[str] = "measured"
    file_keys: ClassVar[tuple[Key, ...]] = FILE_KEYS

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        rotations: Annotated[Curves, As(Annotated[tuple[Angles, ...], Longest(MOST_SPECIMENS)])],
        moments: Annotated[Curves, As(Annotated[tuple[Moments, ...], Longest(MOST_SPECIMENS)])],
        window: PositiveAngle | None = None,
        coverage: NonNegativeNumber = COVERAGE,
        scatter: Fraction | None = None,
        dynamic_factor: NonNegativeNumber = 1.0,
        elastic_stiffness: float | None = None,
    ) -> MeasuredLaw:
        """Law of measured points.

        Parameters
        ----------
        section, axis
            Not used: the curves are already for the section.
        material
            Its flow rate gives the rate factor, unless a dynamic factor is given.
        rotations
            Total rotations of each specimen, increasing, elastic rise included [rad].
        moments
            Moments of each specimen [N m].
        window
            Window over which each curve is smoothed [rad]; without it, none.
        coverage
            Standard deviations in the half-width of the band.
        scatter
            Relative half-width of the band in place of that of the specimens; needed for a single one.
        dynamic_factor
            Dynamic over static moment, at least 1, in place of the material's strain-rate law.
        elastic_stiffness
            Of the elastic rise [N m/rad]; without it, found from each curve.

        Raises
        ------
        InputError
            If a curve cannot be used.
        """
        if len(rotations) != len(moments) or not rotations:
            came = f"{len(rotations)} and {len(moments)} curves"
            raise InputError(
                Problem("each specimen needs rotations and moments", came, "as many", "", "moments")
            )
        found = measured_band(
            [(np.asarray(x), np.asarray(y)) for x, y in zip(rotations, moments, strict=True)],
            window=window,
            elastic_stiffness=elastic_stiffness,
            coverage=coverage,
            dynamic_factor=dynamic_factor,
        )
        rate = hinge_rate(material.flow_rate) if dynamic_factor == 1.0 else None
        band = bending_band(found, rate=rate)
        nominal = band.nominal
        if scatter is not None:
            band = band_of(nominal, scatter)
        known = scatter is not None or len(rotations) > 1
        validity = nominal.validity if scatter is None else replace(nominal.validity, uncertainty=scatter)
        return cls(
            title=f"measured, {len(rotations)} specimen{'s' if len(rotations) > 1 else ''}",
            law="measured",
            origin=(("method", "measured"),),
            curve=_curve(nominal, found.abscissa),
            source=nominal.source,
            validity=validity,
            softening_variable=SofteningVariable.ACCUMULATED,
            elastic_stiffness=nominal.elastic_stiffness,
            rate=nominal.rate,
            lower=_curve(band.lower, found.abscissa) if known else None,
            upper=_curve(band.upper, found.abscissa) if known else None,
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
        given = {"softening": SofteningVariable.ACCUMULATED.value, **given}
        names = given.pop("files", None)
        one = given.pop("file", None)
        if one is not None and names is not None:
            refuse("the curves are given twice", key="files", todo="give 'file' or 'files'")
        if names is None:
            names = [] if one is None else [one]
        if not isinstance(names, Sequence) or isinstance(names, str) or len(names) > MOST_SPECIMENS:
            refuse("a list of files is needed here", key="files", allowed=f"at most {MOST_SPECIMENS} names")
        if not names and given.get("rotations") is None:
            refuse("the law has no curves", key="file", allowed="file, files, or rotations and moments")
        if names and (given.get("rotations") is not None or given.get("moments") is not None):
            refuse("the curves are given twice", key="files", todo="give files or the lists")
        if names:
            read = [with_curve_read({"file": name}, folder) for name in names]
            given["rotations"] = [one["rotation"] for one in read]
            given["moments"] = [one["moment"] for one in read]
        return given


def _curve(law: HingeLaw, at: Floats) -> StoredCurve:
    rotation = tuple(float(one) for one in at)
    moment = tuple(float(one) for one in law.moment_capacity(at))
    points: Points = (rotation, moment)
    return StoredCurve(points, points)
