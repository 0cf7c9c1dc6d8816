"""Key figures of a result: the numbers that the page shows large."""

from __future__ import annotations

import numpy as np

from crumple.numeric.ranking import largest_first
from crumple.report.wording.wording import degrees, percent
from crumple.result import Result
from crumple.units import format_quantity

MATTERS = 0.1
"""Energy of crushing over that of all hinges from which it is what is said first."""
ENERGIES = ("energy.kinetic", "energy.elastic", "energy.dissipated", "energy.external_work")
"""Channels of what a structure has and gets."""
ROUNDING = 1e-3
"""Part of the energy that the structure absorbed or stored that is not worth a word where hinges and dents
did not take it: members that only vibrate lose a little in the dampers beside their springs."""

NOISE = 1e-9
"""Part of the largest energy of any kind that is rounding."""
LEAST = 1e-12
"""Energy [J] that is rounding in any structure: the fold of a wire of a tenth of a millimetre takes a
million times more."""


def key_figures(result: Result) -> list[tuple[str, str, str]]:
    """Key figures: name, value, note."""
    figures: list[tuple[str, str, str]] = []
    several = len(result.hinges) > 1
    bending = {name: hinge for name, hinge in result.hinges.items() if hinge.bends}
    crushed = _crush_figures(result)
    figures += crushed if crush_matters(result) else []
    if bending:
        name = largest_first({name: hinge.rotation_max for name, hinge in bending.items()})[0]
        most = bending[name]
        figures.append(
            (
                "Largest rotation",
                f"{degrees(most.rotation_max)}°",
                _note(f"{most.rotation_max:.4g} rad", name, several),
            )
        )
        figures.append(_rest(result, several))
        total = format_quantity(sum(hinge.energy for hinge in result.hinges.values()), "J")
        rest = between_hinges(result)
        more = f"{format_quantity(rest, 'J')} more along members" if rest > 0.0 else ""
        label = "Energy absorbed in hinges" if several else "Energy absorbed in the hinge"
        figures.append((label, total, more))
        name = largest_first({name: hinge.moment_max for name, hinge in bending.items()})[0]
        most = bending[name]
        figures.append(("Peak moment", format_quantity(most.moment_max, "N*m"), _note("", name, several)))
    figures += [] if crush_matters(result) else crushed
    figures.append(("Energy residual", percent(result.energy_residual), "of the energy input"))
    figures.append(("Solve time", format_quantity(result.solve_seconds, "s", 2), ""))
    return figures


def between_hinges(result: Result) -> float:
    """Energy that members dissipated in neither hinges nor dents [J]; 0: next to nothing."""
    channel = result.channels.get("energy.dissipated")
    if channel is None or not len(channel.values):
        return 0.0
    absorbed = float(channel.values[-1])
    folded = sum(hinge.energy for hinge in result.hinges.values()) + sum(dent.energy for dent in result.dents)
    elastic = result.channels.get("energy.elastic")
    stored = 0.0 if elastic is None else float(np.nanmax(elastic.values, initial=0.0))
    least = max(ROUNDING * (absorbed + stored), rounding(result))
    return absorbed - folded if absorbed - folded > least else 0.0


def rounding(result: Result) -> float:
    """Energy of a result that is rounding [J]."""
    energies = (result.channels[name].values for name in ENERGIES if name in result.channels)
    largest = max((float(np.nanmax(np.abs(one), initial=0.0)) for one in energies), default=0.0)
    return max(NOISE * largest, LEAST)


def crush_matters(result: Result) -> bool:
    """Whether crushing took enough of the energy of the hinges to be said first, or nothing turns."""
    zones = [hinge.crush for hinge in result.hinges.values() if hinge.crush is not None]
    total = sum(hinge.energy for hinge in result.hinges.values())
    bends = any(hinge.bends and hinge.rotation_max > 0.0 for hinge in result.hinges.values())
    return bool(zones) and (not bends or sum(zone.energy for zone in zones) >= MATTERS * total)


def _crush_figures(result: Result) -> list[tuple[str, str, str]]:
    """The crush zone that shortened most: crush length, peak and mean force, energy."""
    zones = {name: hinge.crush for name, hinge in result.hinges.items() if hinge.crush is not None}
    if not zones:
        return []
    name = largest_first({name: zone.length for name, zone in zones.items()})[0]
    most = zones[name]
    note = name if len(result.hinges) > 1 else ""
    efficiency = f"{percent(most.efficiency)} of the member" + (", bottomed out" if most.bottomed_out else "")
    return [
        ("Crush length", format_quantity(most.length, "m"), _note(efficiency, name, bool(note))),
        ("Peak force", format_quantity(most.peak_force, "N"), note),
        ("Mean force", format_quantity(most.mean_force, "N"), note),
        ("Energy of crushing", format_quantity(sum(zone.energy for zone in zones.values()), "J"), ""),
    ]


def _note(text: str, hinge: str, several: bool) -> str:
    return " · ".join(part for part in (text, hinge if several else "") if part)


def _rest(result: Result, several: bool) -> tuple[str, str, str]:
    times = {name: hinge.time_of_rest for name, hinge in result.hinges.items()}
    moving = [name for name, time in times.items() if time is None]
    if moving:
        return (
            "At rest after",
            "—",
            f"{len(moving)} of {len(times)} still rotating" if several else "still rotating",
        )
    known = {name: time for name, time in times.items() if time is not None}
    name = largest_first(known)[0]
    return ("At rest after", format_quantity(known[name], "s"), name if several else "")
