"""A cylindrical panel thrown inwards deflects as in CalculiX with solid elements.

tests/support/shell/panel.py: 120 degrees of a cylinder, clamped along its sides, hinged at its ends,
perfectly plastic, 143.5 m/s over the middle 60 degrees. Tests of such panels with sheet explosive are a
classic of shell codes (Belytschko, Lin and Tsay, Comput. Methods Appl. Mech. Eng. 42, 1984, 225-251). No
source with data and measured deflection was available: the data are this project's own, and no agreement
with a test is claimed.

Reference: panel_reference.json, CalculiX 2.20, a quarter in 20-node bricks, implicit, made by
tests/benchmark/foreign/calculix_panel.py.  It makes no shell assumption; stretch and shear of the wall are
part of yielding.

The velocity jumps at the border of the thrown part, where a mesh spreads it over an element: the momentum
is exact, but energy is missing, of first order in the element size, in both codes.  Meshes of the same
energy are therefore compared: 32 x 64 shells and the fine mesh of bricks, 1697 and 1699 J of 1769 J.  A
finer pair, too slow for a test, and the causes of its difference, are in docs/theory/shell_panel.md.

Tolerance 2 % of the largest deflection, the sum of the known effects: four elements through the wall
instead of two change the coarse bricks by 1.6 % and the fine ones by 0.5 % (half the step: 0.04 %), ten
points instead of five the shells by 0.5 %.  The middle moves by 0.3 % in 40 us about its largest
deflection, so its time is known to 4 %.

Kind: other code.  Source: run here.
"""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from tests.support.shell.panel import ENERGY, HALF_ANGLE, LENGTH, run

from crumple._core.shell.simulation import Element

KEPT = json.loads((Path(__file__).parent / "panel_reference.json").read_text(encoding="utf-8"))["meshes"]
MESHES = (8, 16, 32)
"""Elements around; twice as many along."""
FINE = KEPT["fine"]
OPEN = 0.02
elements = pytest.mark.parametrize("element", list(Element), ids=lambda e: e.value)


@cache
def panel(around: int, element: Element) -> dict[str, np.ndarray]:
    """Histories over 1 ms; see shell_panel.run."""
    return run(2 * around, around, element)


def permanent(time: np.ndarray, deflection: np.ndarray) -> float:
    """Mean from 0.6 ms on, from the first trough of the elastic ringing to its next crest [m]."""
    return float(deflection[time > 0.6e-3 - 1e-9].mean())


@elements
def test_mesh_converges(element):
    """Energy of the start and largest deflection grow, by less than half as much with every finer mesh."""
    runs = [panel(around, element) for around in MESHES]
    missing = [ENERGY - ours["kinetic"][0] for ours in runs]
    assert missing[0] > 1.5 * missing[1] > 1.5**2 * missing[2] > 0
    coarse, middle, fine = (ours["deflection"].max() for ours in runs)
    assert 0 < fine - middle < (middle - coarse) / 2


@elements
def test_deflection(element, record_figure):
    """Energy of the start, largest and permanent deflection, the whole history."""
    ours, name = panel(32, element), element.value
    start = ours["kinetic"][0]
    record_figure(f"energy of the start, {name}", start, FINE["energy"], 3e-3, "J", relative=True)
    top = int(ours["deflection"].argmax())
    largest = 1e3 * ours["deflection"][top]
    record_figure(f"largest deflection, {name}", largest, 1e3 * FINE["largest"], OPEN, "mm", relative=True)
    at = 1e6 * ours["time"][top]
    record_figure(f"time of it, {name}", at, 1e6 * FINE["time_of_largest"], 0.04, "us", relative=True)
    theirs = np.array(FINE["deflection"])
    times = FINE["every"] * np.arange(len(theirs))
    rest = [1e3 * permanent(ours["time"], ours["deflection"]), 1e3 * permanent(times, theirs)]
    record_figure(f"permanent deflection, {name}", *rest, OPEN, "mm", relative=True)
    apart = abs(np.interp(times, ours["time"], ours["deflection"]) - theirs).max() / FINE["largest"]
    record_figure(f"history, largest difference over largest deflection, {name}", apart, 0.0, OPEN)


@elements
def test_shape(element, record_figure):
    """Lowering of the crown and of the middle arc at 0.4 ms, just after the turn."""
    ours = panel(32, element)
    now = int(np.searchsorted(ours["time"], 0.4e-3 - 1e-9))
    for line, extent in (("crown", LENGTH / 2), ("arc", HALF_ANGLE)):
        own = ours[line][now]
        at = np.linspace(0.0, extent, len(own))
        apart = abs(np.interp(FINE[f"{line}_at"], at, own) - FINE[line]).max() / FINE["largest"]
        record_figure(f"{line} at 0.4 ms, largest difference, {element.value}", apart, 0.0, OPEN)


@elements
@pytest.mark.parametrize("around", MESHES)
def test_energy_balances(around, element, record_figure):
    """The step falls with the mesh, and the residual with the step."""
    ours = panel(around, element)
    start = ours["kinetic"][0]
    residual = abs(ours["residual"]).max() / start
    record_figure(f"residual over energy of the start, {around} around, {element.value}", residual, 0.0, 0.01)
    assert np.all(np.diff(ours["plastic"]) >= 0)
    hourglass = ours["hourglass"].max() / (ours["elastic"] + ours["plastic"]).max()
    if element is Element.BELYTSCHKO_TSAY:
        record_figure(f"hourglass share, {around} around", hourglass, 0.0, 0.01)
