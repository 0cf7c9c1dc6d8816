"""Small meshes that the tests of the shell engine share."""

from __future__ import annotations

from typing import Any

import numpy as np

from crumple._core.shell.simulation import Sheet, ShellMaterial, ShellModel, ShellSettings

STEEL = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=488e6)
ELASTIC = ShellMaterial(7850.0, 210e9, 0.3)


def grid(nx: int, ny: int, lx: float = 1.0, ly: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Flat rectangle in x, y: nodes ((nx+1)(ny+1), 3), x running slowest, and quadrilaterals."""
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    nodes = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    a = i * (ny + 1) + j
    return nodes, np.stack([a, a + ny + 1, a + ny + 2, a + 1], axis=1)


def rotation(vector: np.ndarray) -> np.ndarray:
    """Matrix of a rotation vector."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    k = np.cross(np.eye(3), vector / angle)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def model(
    position: np.ndarray,
    elements: np.ndarray,
    thickness: float = 2e-3,
    material: ShellMaterial = ELASTIC,
    points: int = 5,
    settings: dict[str, Any] | None = None,
    **more: Any,
) -> ShellModel:
    """A model of one sheet."""
    return ShellModel(
        position=position,
        elements=elements,
        thickness=thickness,
        materials=[material],
        sheets=[Sheet(points=points)],
        settings=ShellSettings(**(settings or {})),
        **more,
    )


def distorted_patch() -> tuple[np.ndarray, np.ndarray]:
    """Five quadrilaterals of which none is a rectangle (MacNeal and Harder's patch, 0.24 x 0.12 m)."""
    x = [(0, 0), (0.24, 0), (0.24, 0.12), (0, 0.12), (0.04, 0.02), (0.18, 0.03), (0.16, 0.08), (0.08, 0.08)]
    quads = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
    return np.array([(*p, 0.0) for p in x]), np.array(quads)


def bits(state):
    """The whole state, to be compared to the last bit."""
    return {name: values.tobytes() for name, values in state.checkpoint().items()}
