"""Which figures the page of a run has, in their order, and their captions."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from crumple.report.drawing.plots import Plots
    from crumple.result import Result
    from crumple.structure import Outputs, Structure

MAX_MOMENT_FIGURES = 12
"""Most hinges drawn with their laws; each figure adds some 8 kB to the page."""


def draw(
    result: Result, bound: float | None, structure: Structure | None = None, outputs: Outputs | None = None
) -> list[Plots]:
    """Every figure for which the result has data; those with the answers of the analysis first.

    Parameters
    ----------
    result
        Complete or not.
    bound
        Largest energy residual allowed, over the energy input [-]; None if unknown.
    structure, outputs
        What was described and requested; without them forces over displacement, intrusions and pulses are
        not drawn.
    """
    from crumple.report.drawing.plots import plots  # noqa: PLC0415
    from crumple.report.drawing.style import drawing  # noqa: PLC0415
    from crumple.report.figures import curves, fold, scatter, shape, welds  # noqa: PLC0415

    with drawing():
        loads = welds.weld_loads(result)
        requested = enumerate(curves.outputs(result), 1)
        figures = [
            plots(
                "deformation",
                [("deformation", shape.deformation(result))],
                "Deformed member walls at the picture times over the undeformed shape in grey, "
                "all at one scale. Circles mark hinges.",
            ),
            *(
                plots(f"fold_{i}", [(f"fold_{i}", svg)], caption)
                for i, (svg, caption) in enumerate(fold.folds(result), 1)
            ),
            scatter.scatter_plots(result),
            answers(result, structure, outputs),
            plots(
                "hinges",
                [
                    ("rotation", curves.rotation(result)),
                    ("angular_velocity", curves.angular_velocity(result)),
                    ("energy_rotation", curves.energy_over_rotation(result)),
                ],
                "Rotation and angular velocity of the hinges over time, and the energy dissipated in each "
                "over its rotation, positive in the sense of its largest rotation."
                + _named(result, curves.NAMED, curves.DRAWN),
            ),
            _moments(result),
            *([] if loads is None else [plots("welds", [("welds", loads[0])], loads[1])]),
            plots(
                "energy",
                [("energy", curves.energies(result)), ("residual", curves.residual(result, bound))],
                _ledger_caption(result),
            ),
            plots("outputs", [(f"output_{i}", svg) for i, svg in requested], "Requested outputs over time."),
        ]
    return [figure for figure in figures if figure.panels]


def answers(result: Result, structure: Structure | None, outputs: Outputs | None) -> Plots:
    """What is asked of this kind of analysis: forces, travel, crush, intrusion, pulses, energy by zone."""
    from crumple.report.drawing.plots import plots  # noqa: PLC0415
    from crumple.report.figures.answers.force import force_panels  # noqa: PLC0415
    from crumple.report.figures.answers.space import (  # noqa: PLC0415
        crush_panels,
        pulse_panels,
        space_panels,
        zone_panels,
    )

    parts = (
        (force_panels(result, structure), "Forces of drives and obstacles, and motion of barriers"),
        (crush_panels(result), "axial force over crush of the zones"),
        (space_panels(result, outputs), "intrusion and clearance"),
        (pulse_panels(result, structure, outputs), "filtered accelerations"),
        (zone_panels(result), "energy by zone"),
    )
    shown = [(panels, what) for panels, what in parts if any(svg is not None for _, svg in panels)]
    caption = "; ".join(what for _, what in shown)
    if any(name.startswith(("drive_", "force_", "crush_")) for panels, _ in shown for name, _ in panels):
        caption += ". A mean force is the work over the longest path"
    return plots(
        "answers", [p for panels, _ in shown for p in panels], caption[:1].upper() + caption[1:] + "."
    )


def _named(result: Result, named: int, drawn: int) -> str:
    count = len(result.hinges)
    only = f"Of {count} hinges the {drawn} that absorbed most energy are drawn. " if count > drawn else ""
    return f" {only}The {named} hinges that absorbed most energy are named." if count > named else ""


def _moments(result: Result) -> Plots:
    """Moment over rotation of the hinges that absorbed most, under one caption with their laws."""
    from crumple.report.drawing.plots import plots  # noqa: PLC0415
    from crumple.report.figures.curves import ranked_hinges  # noqa: PLC0415
    from crumple.report.figures.moment import moment_over_rotation  # noqa: PLC0415
    from crumple.report.wording.wording import angle, sentence_case  # noqa: PLC0415

    ranked = ranked_hinges(result)[:MAX_MOMENT_FIGURES]
    panels = [
        (f"moment_{i}", moment_over_rotation(result, hinge, f"moment-{i}"))
        for i, hinge in enumerate(ranked, 1)
    ]
    laws: dict[str, list[str]] = {}
    for hinge in ranked:
        summary = result.hinges[hinge]
        named = (("Law", summary.law), ("Source", summary.source))
        parts = [sentence_case(f"{name}: {text}") for name, text in named if text]
        if summary.validity_rotation is not None and isfinite(summary.validity_rotation):
            limit = summary.validity_rotation
            parts.append(f"Range of validity: {f'up to {angle(limit)}' if limit > 0.0 else 'none'}.")
        laws.setdefault(" ".join(parts), []).append(hinge)
    which = "hinge" if len(ranked) == 1 else "hinges"
    caption = f"Moment over rotation of {which} {', '.join(ranked)}: paths of the run and laws."
    several = len(laws) > 1
    told = [f"{', '.join(names)}: {text}" if several else text for text, names in laws.items() if text]
    return plots("moments", panels, " ".join([caption, *told]))


def _ledger_caption(result: Result) -> str:
    shown = "Energies over time"
    if "energy.residual" not in result.channels:
        return f"{shown}."
    return (
        f"{shown} and, for the whole run, the residual of their balance: kinetic, elastic and dissipated "
        f"energy{_further_energies(result)} minus external work and the energy at the start. "
        "Dissipation is integrated independently."
    )


def _further_energies(result: Result) -> str:
    """Terms that only some solvers have."""
    named = [name for name in ("hourglass", "contact", "damping") if f"energy.{name}" in result.channels]
    return f", energy of {' and '.join(named)}," if named else ""
