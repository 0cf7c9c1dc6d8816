"""Where runs in space ended, as named quantities; see `crumple.multibody.answer.end_values`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple._core.planar.simulation import Outcome
from crumple._core.spatial.batch import SpaceFinals
from crumple._core.spatial.simulation import SpaceRecord
from crumple.multibody.answer.end_values import place_quantities
from crumple.multibody.answer.poses import SpacePoses
from crumple.multibody.bodies.linkage import GROUND
from crumple.multibody.spatial.case import SpaceLowered
from crumple.multibody.spatial.solver import energy_in_space, hinge_columns
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import inverse, product, quaternion_vector, turned
from crumple.structure import Outputs


@dataclass(frozen=True, eq=False)
class FinalPoses(SpacePoses):
    """Poses whose rows are runs.

    No row follows another, so rotation vectors are the shortest; and every row has its own `start`, the
    centres of mass at the start, (n, bodies, 3).
    """

    start: Floats

    def place(self, body: int, point: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return super().place(body, point)
        arm = turned(self.quaternion(body), point - self.start[:, body])
        spin, velocity = np.split(self.record.velocity[:, body], 2, axis=1)
        return self.record.centre[:, body] + arm, velocity + np.cross(spin, arm)

    def rotation(self, body: int) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return super().rotation(body)
        return quaternion_vector(self.quaternion(body)), self.record.velocity[:, body, :3]

    def relative(self, first: int, second: int) -> Floats:
        """See `Poses`."""
        return quaternion_vector(product(inverse(self.quaternion(first)), self.quaternion(second)))


def space_quantities(model: SpaceLowered, finals: SpaceFinals, outputs: Outputs) -> dict[str, Floats]:
    """Named quantities of runs that share a model, (n,) each."""
    n = finals.time.size
    none = np.zeros((n, 0))
    record = SpaceRecord(
        time=np.arange(n, dtype=float),
        centre=finals.centre,
        rotation=finals.rotation,
        velocity=finals.velocity,
        acceleration=none,
        hinge_rotation=finals.hinge_rotation,
        hinge_rate=finals.hinge_rate,
        hinge_plastic=finals.hinge_plastic,
        hinge_moment=finals.hinge_moment,
        hinge_capacity=finals.hinge_capacity,
        hinge_energy=finals.hinge_energy,
        joint_force=none,
        obstacle_force=none,
        energy=finals.energy,
        summary=finals.summary,
        peaks=none,
        outcome=Outcome.COMPLETE,
        reason="",
        ended_by=-1,
        lost_time=float("nan"),
        residual=0.0,
        steps=0,
        rejected=0,
        forced=0,
        solves=0,
    )
    found: dict[str, Floats] = {}
    offsets = model.model.component_offsets
    for k, (hinge, columns) in enumerate(hinge_columns(model.linkage, offsets, record)):
        found |= {
            f"hinge.{hinge.name}.{name}": values
            for name, (_, values) in columns.items()
            if not name.startswith("rotation_rate")
        }
        found[f"hinge.{hinge.name}.rotation_max"] = finals.summary[:, k, 0]
        found[f"hinge.{hinge.name}.moment_max"] = finals.summary[:, k, 1]
    slowed = any(stage.quasi_static for stage in model.case.stages)
    energy = energy_in_space(record, touched=bool(model.model.capsules), slowed=slowed)
    found |= {f"energy.{name}": values for name, values in energy.items()}
    poses = FinalPoses(model.linkage, record, finals.start)
    found |= place_quantities(model.structure, poses, outputs)
    found["energy_residual"] = finals.residual
    return found
