"""Checks of a mesh, and its quality and time step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.errors import InputError, Problem
from crumple.material import Material
from crumple.numeric.arrays import Floats, Integers
from crumple.shell.mesh.mesh import Mesh
from crumple.structure import Structure
from crumple.text.names import listed

MOST_PLACES = 3
"""Places that one refusal names; their names are long."""
LEAST_AREA = 1e-6
"""Area of an element over its longest side squared, below which it has none."""


@dataclass(frozen=True)
class MeshReport:
    """Size, quality and time step of a mesh.

    Attributes
    ----------
    elements, nodes, triangles
        Numbers; reference nodes of rigid bodies are not counted, triangles are elements too.
    smallest_side, largest_side
        [m].
    worst_aspect
        Largest ratio of mean opposite sides of one element, of a triangle's longest and shortest side.
    worst_warp
        Largest angle [rad] of a corner out of its element's plane.
    mass
        Of the walls [kg].
    time_step
        Stable step of the first shape, safety and mass scaling included [s]; 0 before it is known.
    slowest
        Place of the element that sets it; empty if added mass does, or it is not known.
    """

    elements: int
    nodes: int
    smallest_side: float
    largest_side: float
    worst_aspect: float
    worst_warp: float
    mass: float
    triangles: int = 0
    time_step: float = 0.0
    slowest: str = ""

    def __str__(self) -> str:
        step = f", time step {1e6 * self.time_step:.3g} us" if self.time_step else ""
        step += f", the least that an element allows ({self.slowest})" if self.slowest else ""
        three = f" ({self.triangles} of them triangles)" if self.triangles else ""
        return (
            f"{self.elements} elements{three}, {self.nodes} nodes, sides {1e3 * self.smallest_side:.3g} to "
            f"{1e3 * self.largest_side:.3g} mm, aspect at most {self.worst_aspect:.3g}, "
            f"warp at most {np.degrees(self.worst_warp):.2g} deg{step}"
        )


def areas(mesh: Mesh) -> Floats:
    """Areas of the elements [m^2], (m,)."""
    corner = mesh.position[mesh.quads]
    return np.asarray(
        np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1) / 2
    )


def wall_thickness(mesh: Mesh) -> Floats:
    """Thickness of every element [m], (m,)."""
    return np.concatenate([tube.thickness for tube in mesh.tubes.values()])


def wall_metals(structure: Structure, mesh: Mesh) -> tuple[tuple[Material, ...], Integers]:
    """Metals of the walls, each once, and the number of every element's among them, (m,)."""
    sides = {name: tube.contour.metals_of(structure.material_of(name)) for name, tube in mesh.tubes.items()}
    metals = tuple(dict.fromkeys(metal for member in sides.values() for metal in member))
    number = [
        np.array([metals.index(metal) for metal in sides[name]])[tube.bays.side]
        for name, tube in mesh.tubes.items()
    ]
    return metals, np.concatenate(number)


def wall_density(structure: Structure, mesh: Mesh) -> Floats:
    """Density of every element [kg/m^3], (m,)."""
    metals, number = wall_metals(structure, mesh)
    return np.asarray(np.array([metal.density for metal in metals])[number])


def report_of(structure: Structure, mesh: Mesh) -> MeshReport:
    """Measure a mesh.

    Raises
    ------
    InputError
        Naming elements without area, crossed ones, and nodes that coincide.
    """
    corner = mesh.position[mesh.quads]
    side = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
    three = mesh.triangles
    # a triangle repeats its third corner: there is no side between
    side[three, 2] = side[three, 1]
    _check(mesh, corner, side)
    pair = np.stack([side[:, 0] + side[:, 2], side[:, 1] + side[:, 3]])
    pair[0, three], pair[1, three] = side[three].max(axis=1), side[three].min(axis=1)
    mass = areas(mesh) * wall_thickness(mesh) * wall_density(structure, mesh)
    return MeshReport(
        elements=len(mesh.quads),
        nodes=mesh.walls,
        smallest_side=float(side.min()),
        largest_side=float(side.max()),
        worst_aspect=float((pair.max(axis=0) / pair.min(axis=0)).max()),
        worst_warp=float(_warp(corner).max()),
        mass=float(mass.sum()),
        triangles=int(three.sum()),
    )


def _warp(corner: Floats) -> Floats:
    """Angle of the corners out of the plane through the middle [rad], (m,)."""
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    out = np.abs(np.einsum("mij,mj->mi", corner - corner.mean(axis=1)[:, None], normal)).max(axis=1)
    reach = np.linalg.norm(corner - corner.mean(axis=1)[:, None], axis=2).min(axis=1)
    return np.asarray(np.arctan2(out, reach))


def _check(mesh: Mesh, corner: Floats, side: Floats) -> None:
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    before = corner - np.roll(corner, 1, axis=1)
    after = np.roll(corner, -1, axis=1) - corner
    turning = np.einsum("mij,mj->mi", np.cross(before, after), normal).min(axis=1)
    # three corners cannot cross
    turning[mesh.triangles] = 1.0
    flat = np.linalg.norm(normal, axis=1) / 2 < LEAST_AREA * side.max(axis=1) ** 2
    faults = (
        ("an element has no area", flat),
        ("an element is crossed or not convex", ~flat & (turning <= 0.0)),
        ("two corners of an element coincide", side.min(axis=1) < 1e-9 * np.median(side)),
    )
    todo = "change the element size, or the members that meet there"
    problems = [
        Problem(what, places, "elements with four distinct corners", todo, "analysis.shell")
        for what, bad in faults
        if (places := listed(np.flatnonzero(bad).tolist(), MOST_PLACES, "; ", mesh.place_of))
    ]
    if problems:
        raise InputError(problems)
