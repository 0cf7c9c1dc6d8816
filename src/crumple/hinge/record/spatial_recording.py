"""From records of single axes and the section's interaction to the record of a hinge of several components.

The fit of the section's surface gives linear forms in the shares of N, M_y and M_z.  The hinge uses the
columns of its components: rigid degrees of freedom do not interact.  Each column is scaled so that a
load about its axis alone reaches exactly that axis' capacity.

A component whose two senses differ (shortening folds, lengthening yields) has its force divided by the
capacity of the sense in which it acts.  That keeps the set convex only if the surface is mirror-symmetric in
that component, so its rows are doubled with that column's sign turned, each times 2^(-1/p): the mean of a
surface and its image.  The fit of a section with that symmetry has the images among its rows, which stay.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from crumple.errors import InputError, Problem
from crumple.hinge.record.record import Form, HingeRecord
from crumple.hinge.record.spatial_record import (
    Coupling,
    Freedom,
    HingeComponent,
    HingeSurface,
    SpatialHingeRecord,
)
from crumple.numeric.arrays import Floats

if TYPE_CHECKING:
    from crumple.section import InteractionFit

COLUMN = {Freedom.AXIAL: 0, Freedom.Y: 1, Freedom.Z: 2}
"""Columns of the rows of an `InteractionFit`."""


def spatial_record(
    components: Sequence[HingeComponent],
    *,
    coupling: Coupling = Coupling.SECTION,
    interaction: InteractionFit | None = None,
    arm: float = 0.0,
    fracture: float = math.inf,
) -> SpatialHingeRecord:
    """Record of a hinge with one to four components.

    Parameters
    ----------
    components
        Each freedom at most once; all of one form and one softening variable.
    coupling
        Their interaction; without effect for one component.
    interaction
        Fit of the section's surface, needed by the coupling of the section.
    arm
        Distance from the centroid to the tension flange [m], needed by the coupling about it.
    fracture
        Plastic rotation [rad] at which the hinge breaks.

    Returns
    -------
    SpatialHingeRecord
        Record for the solver.

    Raises
    ------
    InputError
        If the components do not match each other or the coupling.

    References
    ----------
    docs/theory/spatial_hinge.md.  Verified in tests/unit/hinge/record/test_spatial_recording.py and
    tests/verification/spatial/test_spatial_hinge.py.
    """
    ordered = tuple(sorted(components, key=lambda component: component.freedom))
    problems = [*_component_problems(ordered), *_coupling_problems(ordered, coupling, interaction, arm)]
    if not fracture > 0.0:
        problems.append(
            Problem("the angle of fracture must be positive", f"{fracture:g} rad", "> 0 rad", "", "fracture")
        )
    if problems:
        raise InputError(problems)
    if len(ordered) == 1:
        coupling = Coupling.NONE
    surface = HingeSurface(coupling, arm=arm if coupling is Coupling.TENSION_FLANGE else 0.0)
    if coupling is Coupling.SECTION and interaction is not None:
        surface = section_surface(ordered, interaction)
    return SpatialHingeRecord(ordered, surface, fracture)


def section_surface(components: Sequence[HingeComponent], interaction: InteractionFit) -> HingeSurface:
    """Surface of a section's interaction for the components of a hinge."""
    freedoms = [component.freedom for component in components]
    axisymmetric = interaction.axisymmetric and {Freedom.Y, Freedom.Z} <= set(freedoms)
    if axisymmetric and Freedom.AXIAL not in freedoms:
        return HingeSurface(Coupling.ELLIPSOID, error=interaction.error)
    rows = np.zeros((len(interaction.rows), len(freedoms)))
    for k, component in enumerate(components):
        if component.freedom in COLUMN:
            resultant = interaction.axisymmetric and component.freedom is Freedom.Z
            rows[:, k] = interaction.rows[:, COLUMN[Freedom.Y if resultant else component.freedom]]
    for k, component in enumerate(components):
        if component.freedom in COLUMN and not senses_agree(component.record):
            rows = _mirrored(rows, k, interaction.power)
    if axisymmetric:
        rows = rows[:, [0, -1]]
    # without the columns of rigid freedoms some rows are equal
    rows = _merged(rows[np.abs(rows).max(axis=1) > 0.0], interaction.power)
    # a load about one axis alone reaches its capacity
    pure = (np.abs(rows) ** interaction.power).sum(axis=0) ** (1.0 / interaction.power)
    rows = rows / np.where(pure > 0.0, pure, 1.0)
    return HingeSurface(
        Coupling.SECTION,
        rows,
        interaction.power,
        interaction.torque_power,
        freedoms.index(Freedom.X) if Freedom.X in freedoms else -1,
        error=interaction.error,
        axisymmetric=axisymmetric,
    )


def senses_agree(record: HingeRecord) -> bool:
    """Whether both senses have the same curve."""
    one, other = record.positive, record.negative
    return np.array_equal(one.rotation, other.rotation) and np.array_equal(one.moment, other.moment)


def scaled(record: HingeRecord, factor: float) -> HingeRecord:
    """Record with both curves times a factor: a change of metal or wall that keeps the shape."""
    return replace(
        record,
        positive=replace(record.positive, moment=record.positive.moment * factor),
        negative=replace(record.negative, moment=record.negative.moment * factor),
    )


def _mirrored(rows: Floats, column: int, power: float) -> Floats:
    """Rows of the mean of a surface and its image; a row whose image is among them, up to its sign, stays."""
    image = rows.copy()
    image[:, column] *= -1.0
    alone = _alike(image, rows).any(axis=1)
    pairs = np.vstack([rows[~alone], image[~alone]]) * 2.0 ** (-1.0 / power)
    return np.asarray(np.vstack([rows[alone], pairs]))


def _merged(rows: Floats, power: float) -> Floats:
    """Rows without repetitions: one in place of k equal ones, times k^(1/p)."""
    alike = _alike(rows, rows)
    first = alike.argmax(axis=1) == np.arange(len(rows))
    return np.asarray(rows[first] * alike.sum(axis=1)[first, None] ** (1.0 / power))


def _alike(one: Floats, other: Floats) -> NDArray[np.bool_]:
    """Whether rows are equal but for their sign and rounding, shapes (n, k) and (m, k) to (n, m)."""
    apart = [np.abs(one[:, None] + sign * other).max(axis=2) for sign in (1.0, -1.0)]
    return np.asarray(np.minimum(*apart) <= 1e-12 * np.abs(other).max(initial=0.0))


def _component_problems(components: tuple[HingeComponent, ...]) -> list[Problem]:
    freedoms = [component.freedom.label for component in components]
    if not 1 <= len(set(freedoms)) == len(freedoms):
        return [
            Problem(
                "a hinge needs one to four different components",
                ", ".join(freedoms) or "none",
                "axial, x, y, z, each at most once",
                "",
                "axes",
            )
        ]
    problems = []
    for what, seen in (
        ("form", {component.record.form.value for component in components}),
        ("softening", {component.record.softening_variable.value for component in components}),
    ):
        if len(seen) > 1:
            came, todo = " and ".join(sorted(seen)), f"give all laws of the hinge one {what}"
            problems.append(Problem(f"the components of a hinge differ in {what}", came, "one", todo, "laws"))
    return problems


def _coupling_problems(
    components: tuple[HingeComponent, ...], coupling: Coupling, interaction: InteractionFit | None, arm: float
) -> list[Problem]:
    if len(components) < 2:
        return []
    if coupling is Coupling.SECTION and interaction is None:
        return [
            Problem(
                "the interaction of the section is not known",
                todo="use the coupling ellipsoid",
                where="coupling",
            )
        ]
    if coupling is Coupling.TENSION_FLANGE:
        return _flange_problems(components, arm)
    return _ball_problems(components) if coupling is Coupling.BALL else []


def _flange_problems(components: tuple[HingeComponent, ...], arm: float) -> list[Problem]:
    freedoms = {component.freedom for component in components}
    problems = []
    if freedoms not in ({Freedom.AXIAL, Freedom.Y}, {Freedom.AXIAL, Freedom.Z}):
        what = "a fold about its tension flange has one bending axis and the axial slip"
        came = _names(components)
        todo = ""
        if {Freedom.Y, Freedom.Z} <= freedoms:
            if Freedom.X in freedoms:
                came += " (automatic hinges of a spatial frame bend about both axes and twist)"
            todo = "write the axis beside it, as axes: [y] or axes: [z], or leave out the coupling"
        elif Freedom.AXIAL not in freedoms:
            todo = "write axial: true beside it, or leave out the coupling"
        problems.append(Problem(what, came, "axial and y, or axial and z", todo, "coupling"))
    if components[0].record.form is Form.REGULARISED:
        what, todo = "a fold about its tension flange has no regularised form", "choose another form"
        problems.append(Problem(what, "regularised", "set-valued, elastic-plastic", todo, "coupling"))
    if not arm > 0.0:
        what = "the arm of the tension flange must be positive"
        problems.append(Problem(what, f"{arm:g} m", "> 0 m", "", "coupling"))
    return problems


def _ball_problems(components: tuple[HingeComponent, ...]) -> list[Problem]:
    first = components[0].record.positive
    curves = [
        curve for component in components for curve in (component.record.positive, component.record.negative)
    ]
    same = all(
        np.array_equal(curve.moment, first.moment) and np.array_equal(curve.rotation, first.rotation)
        for curve in curves
    )
    if same and components[0].freedom is not Freedom.AXIAL:
        return []
    what = "a ball hinge has only rotations, with one curve for all axes and senses"
    return [Problem(what, _names(components), "", "use the coupling ellipsoid", "coupling")]


def _names(components: tuple[HingeComponent, ...]) -> str:
    return ", ".join(component.freedom.label for component in components)
