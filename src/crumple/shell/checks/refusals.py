"""Checks of the settings against the mesh, before the first step."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.shell.mesh.contour import Contour
from crumple.structure import ShellSettings, Stage, Structure

FEWEST_STEPS = 10
"""Steps of a stage below which nothing is resolved: mass scaling to longer steps is a mistake in the
input."""
MOST_DAMPED = 0.1
"""Share of the momentum that damping may take in one step: above it the structure hardly moves, and the
energy residual, of second order in this share, exceeds its bound."""
LARGEST_WAVE = 0.25
"""Imperfection over the smallest side of an element up to which no element can be crossed: two neighbours
move by one each, and at a corner along its diagonal."""
SLOW_DAMPING = 40.0
"""Damping rate of a quasi-static stage times its duration: vibration loses 1/e within a twentieth of it."""


def damping_of(settings: ShellSettings, stage: Stage) -> float:
    """Damping rate of a stage [1/s]."""
    if stage.kind == "quasi-static" and not settings.damping:
        return SLOW_DAMPING / stage.duration
    return settings.damping


def refuse_sizes(structure: Structure, settings: ShellSettings) -> None:
    """Refuse elements that are longer than a section is wide: no fold could form.

    Raises
    ------
    InputError
        By member.
    """
    key = "fine_size" if settings.fine_size is not None else "element_size"
    size, problems = settings.fine_size or settings.element_size, []
    for name in structure.members:
        widest = float(np.ptp(structure.section_of(name).outer_outline(), axis=0).max())
        if size > widest:
            what = f"the elements are larger than the section of member {name}"
            allowed, todo = f"at most {1e3 * widest:.4g} mm, recommended a tenth", "give smaller elements"
            problems.append(Problem(what, f"{1e3 * size:.4g} mm", allowed, todo, f"analysis.shell.{key}"))
    if problems:
        raise InputError(problems)


def refuse_waves(settings: ShellSettings, contours: dict[str, Contour], rings: dict[str, Floats]) -> None:
    """Refuse an imperfection that would fold the mesh over.

    Raises
    ------
    InputError
        With the largest imperfection that the mesh allows.
    """
    around = [np.linalg.norm(np.diff(c.points[c.sides], axis=1), axis=2).min() for c in contours.values()]
    smallest = float(min(*around, *(np.diff(at).min() for at in rings.values())))
    if settings.imperfection > LARGEST_WAVE * smallest:
        what, came = "the imperfection is too large for the elements", f"{1e3 * settings.imperfection:.4g} mm"
        allowed = f"at most {1e3 * LARGEST_WAVE * smallest:.3g} mm, a quarter of the smallest side"
        todo = "give the waviness of a real wall, a few hundredths of its thickness"
        raise InputError(Problem(what, came, allowed, todo, "analysis.shell.imperfection"))


def refuse_steps(
    settings: ShellSettings, stages: tuple[Stage, ...], first_step: float, slowest: str = ""
) -> None:
    """Refuse bounds, scaling and damping that the first stable step [s] cannot meet; `slowest` sets it.

    Raises
    ------
    InputError
        With every setting that does not fit.
    """
    if problems := [*_step_problems(settings, stages, first_step, slowest)]:
        raise InputError(problems)


def _step_problems(
    settings: ShellSettings, stages: tuple[Stage, ...], first_step: float, slowest: str
) -> Iterator[Problem]:
    shortest = min(stage.duration for stage in stages)
    if (settings.mass_scaling or 0.0) > shortest / FEWEST_STEPS:
        what, todo = "mass scaling to this step leaves too few steps", "give a shorter step"
        came, allowed = f"{settings.mass_scaling:g} s", f"at most {shortest / FEWEST_STEPS:.3g} s"
        reason = f"{allowed}, {FEWEST_STEPS} steps of the shortest stage"
        yield Problem(what, came, reason, todo, "analysis.shell.mass_scaling")
    if first_step < settings.minimum_time_step:
        what = "the first stable time step is below the minimum time step"
        what += f" ({slowest})" if slowest else ""
        came, todo = f"{settings.minimum_time_step:g} s", "give a smaller minimum, or larger elements"
        allowed = f"below {first_step:.3g} s"
        yield Problem(what, came, allowed, todo, "analysis.shell.minimum_time_step")
    for i, stage in enumerate(stages):
        damping = damping_of(settings, stage)
        if damping * first_step <= MOST_DAMPED:
            continue
        what = "the damping is so large that it stops all motion within a few steps"
        most = f"at most {MOST_DAMPED / first_step:.3g} 1/s"
        if settings.damping:
            yield Problem(what, f"{damping:g} 1/s", most, "give less damping", "analysis.shell.damping")
            return
        what = f"the quasi-static stage {stage.name} is so short that its damping stops all motion"
        least = f"at least {SLOW_DAMPING * first_step / MOST_DAMPED:.3g} s"
        where = f"analysis.stages[{i}].duration"
        yield Problem(what, f"{stage.duration:g} s", least, "give it a longer duration", where)
