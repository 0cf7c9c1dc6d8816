"""From a `ShellModel` to the model of the compiled core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from crumple._core import _kernels
from crumple._core.shell.model import (
    Element,
    History,
    Hourglass,
    Indices,
    RigidObstacle,
    RigidSet,
    ShellMaterial,
    ShellModel,
    ShellSettings,
)
from crumple.numeric.arrays import Floats

kernel: Any = _kernels.shell
_DOFS = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5}


def floats(values: ArrayLike) -> Floats:
    """Contiguous doubles, as the core takes them."""
    return np.ascontiguousarray(values, dtype=np.float64)


def _indices(values: ArrayLike) -> Indices:
    return np.ascontiguousarray(values, dtype=np.uint32)


def _or_zero(values: ArrayLike | None, shape: tuple[int, ...]) -> Floats:
    return np.zeros(shape) if values is None else floats(np.broadcast_to(floats(values), shape))


def _bits(dofs: Sequence[str]) -> int:
    return sum(1 << _DOFS[dof] for dof in set(dofs))


def built(model: ShellModel) -> Any:
    """Model of the core from the arrays of a `ShellModel`."""
    core = kernel.Model()
    n, m = len(model.position), len(model.elements)
    fixed = np.zeros((n, 6), dtype=bool) if model.fixed is None else np.asarray(model.fixed, dtype=bool)
    core.nodes(
        floats(model.position),
        _or_zero(model.velocity, (n, 3)),
        _or_zero(model.spin, (n, 3)),
        _or_zero(model.mass, (n,)),
        _or_zero(model.inertia, (n,)),
        (fixed @ (1 << np.arange(6))).astype(np.uint8),
    )
    thickness = np.broadcast_to(floats(model.thickness), (m,))
    core.elements(_indices(model.elements), floats(thickness), _indices(np.broadcast_to(model.sheet, (m,))))
    for material in model.materials:
        _add_material(core, material)
    for sheet in model.sheets:
        core.sheet(sheet.material, sheet.points, sheet.lobatto)
    _add_sets(core, model)
    _add_settings(core, model.settings)
    return core


def _add_material(core: Any, material: ShellMaterial) -> None:
    strain, stress = material.table()
    names = ("density", "youngs_modulus", "poissons_ratio", "hardening_modulus", "failure_strain")
    names += ("rate_reference", "rate_exponent", "rate_logarithm", "rate_time")  # type: ignore[assignment]
    names += ("fails_at_any_point", "rigid")  # type: ignore[assignment]
    values = {name: getattr(material, name) for name in names}
    core.material({**values, "plastic_strain": strain, "yield_stress": stress})


def _add_sets(core: Any, model: ShellModel) -> None:
    for rigid in [*model.rigid_sets, *_rigid_sheets(model)]:
        nodes = _indices(rigid.nodes)
        at = model.position[nodes].mean(axis=0) if rigid.at is None else rigid.at
        pin = floats(() if rigid.pin is None else rigid.pin)
        core.rigid_set(nodes, rigid.mass, floats(at), floats(rigid.inertia), _bits(rigid.fixed), pin)
    for weld in model.spot_welds:
        nodes = np.concatenate([weld.first, weld.second])
        weight = np.concatenate([weld.first_weight, weld.second_weight])
        strength = weld.normal_strength, weld.shear_strength
        core.spot_weld(_indices(nodes), floats(weight), len(weld.first), *strength)
    for load in model.loads:
        core.load(load.node, _DOFS[load.dof], floats(load.time), floats(load.value))
    for motion in model.motions:
        core.motion(
            motion.rigid_set, motion.target, _DOFS[motion.dof], floats(motion.time), floats(motion.value)
        )
    for obstacle in model.obstacles:
        core.obstacle(_obstacle(model, obstacle))
    for cut in model.cuts:
        core.cut(_indices(cut.elements), _indices(cut.nodes))


def _obstacle(model: ShellModel, obstacle: RigidObstacle) -> dict[str, Any]:
    vectors = ("point", "axis", "edge", "guide", "velocity", "turn_about", "turn_axis")
    numbers = ("radius", "length", "friction", "gap", "mass", "active")
    nodes = np.unique(model.elements)
    if obstacle.nodes is not None:
        # a node of no element and no rigid set has nothing that could touch; the kernel refuses unknown ones
        solid = np.concatenate([nodes, *(rigid.nodes for rigid in model.rigid_sets)])
        nodes = np.setdiff1d(obstacle.nodes, np.setdiff1d(np.arange(len(model.position)), solid))
    damping = model.settings.contact_damping if obstacle.damping is None else obstacle.damping
    return {
        **{name: floats(getattr(obstacle, name)) for name in vectors},
        **{name: getattr(obstacle, name) for name in numbers},
        "damping": damping,
        "shape": obstacle.shape.value,
        "motion": [_history(history) for history in obstacle.motion],
        "turning": _history(obstacle.turning),
        "nodes": _indices(nodes),
    }


def _history(history: History | None) -> tuple[Floats, Floats] | None:
    return None if history is None else (floats(history[0]), floats(history[1]))


def _rigid_sheets(model: ShellModel) -> list[RigidSet]:
    """One rigid body of each sheet of a rigid material; sheets that share nodes are one."""
    taken = {int(node) for rigid in model.rigid_sets for node in np.asarray(rigid.nodes)}
    sheet_of = np.broadcast_to(model.sheet, (len(model.elements),))
    bodies: list[set[int]] = []
    for i, sheet in enumerate(model.sheets):
        if model.materials[sheet.material].rigid:
            nodes = {int(n) for n in np.unique(model.elements[sheet_of == i])} - taken
            touching = [body for body in bodies if body & nodes]
            bodies = [body for body in bodies if not body & nodes] + [nodes.union(*touching)]
    return [RigidSet(sorted(nodes)) for nodes in bodies if nodes]


def _add_settings(core: Any, s: ShellSettings) -> None:
    names = ("safety", "scaled_step", "least_step", "damping", "thickness_update", "warping_correction")
    coefficients = ("hourglass_membrane", "hourglass_shear", "hourglass_bending")
    values = {name: getattr(s, name) for name in (*names, *coefficients, "drill_stiffness")}
    values["stabilised"] = s.element is Element.STABILISED
    viscous = s.hourglass is Hourglass.VISCOUS
    core.settings({**values, "gravity": floats(s.gravity), "viscous_hourglass": viscous})
    contact = {"on": s.self_contact, "gap": s.contact_gap, "stiffness": s.contact_stiffness}
    core.contact({**contact, "friction": s.contact_friction, "damping": s.contact_damping})
