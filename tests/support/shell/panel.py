"""Cylindrical panel thrown inwards over its middle: the data, and its mesh for the shell kernel.

A panel of these dimensions, defined by this project: 120 degrees of a cylinder of 2.9375 in (mid-surface),
0.125 in thick, 12.56 in long, of an elastic-perfectly plastic aluminium.  Straight sides clamped, curved ends
hinged (no displacement of the mid-surface, free to turn).  5650 in/s towards the axis over the middle 60
degrees and 10.205 in, as sheet explosive gives it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from crumple._core.shell.simulation import Element, ShellMaterial, ShellModel, ShellSettings, ShellState

INCH = 0.0254
RADIUS, WALL, LENGTH = 2.9375 * INCH, 0.125 * INCH, 12.56 * INCH
HALF_ANGLE = np.radians(60.0)
LOADED_ANGLE, LOADED_LENGTH = 1 / 2, 13 / 16
"""Shares of the angle and of the length that are thrown."""
SPEED = 5650.0 * INCH
DENSITY, YOUNGS_MODULUS, POISSONS_RATIO, YIELD_STRESS = 2671.7, 72.395e9, 0.33, 303.4e6
METAL = ShellMaterial(DENSITY, YOUNGS_MODULUS, POISSONS_RATIO, yield_stress=YIELD_STRESS)
ENERGY = DENSITY * WALL * RADIUS * 2 * HALF_ANGLE * LOADED_ANGLE * LENGTH * LOADED_LENGTH * SPEED**2 / 2
"""What the thrown part brings along [J]."""


def _loaded(count: int, share: float) -> np.ndarray:
    """Part of each node's length within the middle ``share`` of a side of ``count`` elements."""
    ends = np.clip((np.arange(count + 2) - 0.5) / count, 0.0, 1.0)
    return np.diff(np.clip(ends, (1 - share) / 2, (1 + share) / 2)) / np.diff(ends)


def panel(along: int, around: int, **settings: Any) -> ShellModel:
    """Model of ``along`` by ``around`` elements, both even; nodes run around fastest.

    Nodes get the momentum of their share of the loaded area: those on its border half the speed, so
    that the energy is too small by the order of an element.
    """
    x = np.linspace(-LENGTH / 2, LENGTH / 2, along + 1)
    angle = np.linspace(-HALF_ANGLE, HALF_ANGLE, around + 1)
    x, angle = np.meshgrid(x, angle, indexing="ij")
    outwards = np.stack([np.zeros_like(angle), np.sin(angle), np.cos(angle)], axis=-1)
    position = RADIUS * outwards
    position[..., 0] = x
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    fixed = np.zeros((*x.shape, 6), dtype=bool)
    fixed[[0, -1], :, :3] = True
    fixed[:, [0, -1]] = True
    loaded = np.outer(_loaded(along, LOADED_LENGTH), _loaded(around, LOADED_ANGLE))
    return ShellModel(
        position=position.reshape(-1, 3),
        elements=quads.reshape(-1, 4),
        thickness=WALL,
        materials=[METAL],
        fixed=fixed.reshape(-1, 6),
        velocity=(-SPEED * loaded[..., None] * outwards).reshape(-1, 3),
        settings=ShellSettings(**settings),
    )


def run(
    along: int, around: int, element: Element, end: float = 1e-3, outputs: int = 200
) -> dict[str, np.ndarray]:
    """Histories: time, deflection in the middle, energies; lowering along crown and middle arc."""
    model = panel(along, around, element=element)
    state = ShellState(model)
    number = np.arange(len(model.position)).reshape(along + 1, around + 1)
    crown, arc = number[along // 2 :, around // 2], number[along // 2, around // 2 :]
    rows = []
    for time in np.linspace(0.0, end, outputs + 1):
        status = state.advance(time)
        assert status.ok, state.reason
        down = model.position[:, 2] - state.position[:, 2]
        row = {"time": state.time, "deflection": down[crown[0]], "crown": down[crown], "arc": down[arc]}
        rows.append(row | dict(state.energies))
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}
