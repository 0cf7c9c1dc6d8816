"""Record of a run: the state at every output time, as plain arrays that a restart file can store."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from crumple._core.shell.simulation import ShellState
from crumple.numeric.arrays import Floats, Integers
from crumple.shell.answer.sections import mean_spin, section_frame, section_rotation
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.bodies import body_numbers
from crumple.shell.model.model import ShellCase
from crumple.shell.model.spaces import clearance_now
from crumple.structure import Outputs

ENERGIES = (
    "kinetic", "elastic", "plastic", "hourglass", "contact", "damping", "external_work", "residual", "eroded",
)  # fmt: skip
"""Columns of the energies, by the stepper's names."""

IMPULSE = slice(11, 14)
"""Columns of the impulse in the stepper's states of obstacles."""

Ring = tuple[str, int]


@dataclass(frozen=True, eq=False)
class Sampler:
    """Reads histories from the moving state.

    Attributes
    ----------
    case
        What is computed.
    nodes
        Names of the structure nodes that are followed: those requested, then ends of distances.
    rings
        Sections whose rotation is followed: member and ring.
    """

    case: ShellCase
    nodes: tuple[str, ...]
    rings: tuple[Ring, ...]

    @classmethod
    def of(cls, case: ShellCase, outputs: Outputs) -> Sampler:
        """Sampler of everything that the outputs and the hinges need."""
        rings = [ring for zone in case.zones for ring in (zone.first, zone.last)]
        for asked in outputs.section_rotations.values():
            tube = case.mesh.tubes[asked.member]
            rings += [(asked.member, tube.ring_at(station)) for station in (asked.start, asked.end)]
        ends = [end for asked in outputs.distances.values() for end in (asked.start, asked.end)]
        return cls(case, tuple(dict.fromkeys([*outputs.nodes, *ends])), tuple(dict.fromkeys(rings)))

    @cached_property
    def _sections(self) -> list[tuple[Integers, Floats]]:
        """Nodes of the sections that are followed, and their axes at the start."""
        start = self.case.mesh.position
        rings = [self.case.mesh.tubes[member].nodes[ring] for member, ring in self.rings]
        return [(nodes, section_frame(start[nodes], start[nodes])) for nodes in rings]

    def sample(self, state: ShellState) -> dict[str, Floats]:
        """Histories now.

        time (), energy (9,), zone (h,), cut (c, 9), ring (r, 3, 3), node (k, 6, 3), obstacle (o, 15),
        weld (w, 5), clearance (s,)
        """
        mesh, position = self.case.mesh, state.position
        velocity = state.velocity[0]
        plastic = state.element_field("plastic_energy")
        energies = state.energies
        cuts = [np.concatenate(state.cut(i)) for i in range(len(self.case.model.cuts))]
        rotations = [
            section_rotation(mesh.position[nodes], position[nodes], frame) for nodes, frame in self._sections
        ]
        motions = [self._motion(state, name, position, velocity) for name in self.nodes]
        return {
            "time": np.array(state.time),
            "energy": np.array([energies[name] for name in ENERGIES]),
            "zone": np.array([plastic[zone.elements].sum() for zone in self.case.zones]),
            "cut": np.array(cuts).reshape(-1, 9),
            "ring": np.array(rotations).reshape(-1, 3, 3),
            "node": np.array(motions).reshape(-1, 6, 3),
            "obstacle": state.obstacles,
            "weld": state.spot_welds,
            "clearance": np.array(
                [clearance_now(space, mesh.position, position) for space in self.case.spaces]
            ),
        }

    def _motion(self, state: ShellState, name: str, position: Floats, velocity: Floats) -> Floats:
        """Displacement, velocity, angular velocity, and the rotation matrix of a node, (6, 3)."""
        mesh = self.case.mesh
        if name in mesh.reference:
            which = body_numbers(self.case.bodies)[name]
            body, at = state.rigid_sets[which], mesh.reference[name]
            centre, linear, spin = body[:3], body[3:6], body[6:9]
            moved = position[at] - mesh.position[at]
            return np.vstack(
                [moved, linear + np.cross(spin, position[at] - centre), spin, body[9:].reshape(3, 3)]
            )
        nodes = ring_of_node(mesh, name)
        moved = (position[nodes] - mesh.position[nodes]).mean(axis=0)
        spin = mean_spin(position[nodes], velocity[nodes])
        turned = section_rotation(mesh.position[nodes], position[nodes])
        return np.vstack([moved, velocity[nodes].mean(axis=0), spin, turned])


def ring_of_node(mesh: Mesh, node: str) -> Integers:
    """Nodes of the first section that ends at a structure node."""
    end = mesh.joints[node].ends[0]
    return mesh.end_ring(end.member, end.second)


@dataclass
class Record:
    """Rows of samples, and the stored shapes."""

    rows: dict[str, list[Floats]] = field(default_factory=dict)
    shapes: dict[str, list[Floats]] = field(default_factory=dict)

    def add(self, sample: Mapping[str, Floats]) -> None:
        """Append one row of histories."""
        for name, values in sample.items():
            self.rows.setdefault(name, []).append(values)

    def add_shape(self, shape: Mapping[str, Floats]) -> None:
        """Append one stored shape."""
        for name, values in shape.items():
            self.shapes.setdefault(name, []).append(values)

    def __len__(self) -> int:
        return len(self.rows.get("time", ()))

    def __getitem__(self, name: str) -> Floats:
        """All rows of one kind, (n, ...)."""
        return np.array(self.rows[name])

    def is_like(self, other: Record) -> bool:
        """Whether it has rows and stored shapes of the same names and forms as another, all rows complete."""
        if not self.rows:
            return not self.shapes
        mine, theirs = self.to_arrays(), other.to_arrays()
        if not self.shapes:
            theirs = {name: values for name, values in theirs.items() if name.startswith("rows/")}
        return (
            {name: (values.dtype, *values.shape[1:]) for name, values in mine.items()}
            == {name: (values.dtype, *values.shape[1:]) for name, values in theirs.items()}
            and {len(values) for values in self.rows.values()} == {len(self)}
            and len({len(values) for values in self.shapes.values()}) <= 1
        )

    def to_arrays(self) -> dict[str, Floats]:
        """Everything as named arrays."""
        rows = {f"rows/{name}": np.array(values) for name, values in self.rows.items()}
        return rows | {f"shapes/{name}": np.array(values) for name, values in self.shapes.items()}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Floats]) -> Record:
        """Record from the arrays of `to_arrays`; other names are ignored."""
        record = cls()
        for key, values in arrays.items():
            kind, _, name = key.partition("/")
            if kind in ("rows", "shapes"):
                getattr(record, kind)[name] = list(values)
        return record


def slope(values: Floats, time: Floats) -> Floats:
    """Slope against time (n, ...); outputs nearer together than a time step were noted at one time."""
    at, first, again = np.unique(time, return_index=True, return_inverse=True)
    return np.asarray(np.gradient(values[first], at, axis=0))[again] if at.size > 1 else 0.0 * values
