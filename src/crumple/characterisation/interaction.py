"""Error of the ways in which a hinge combines axial force and bending, or bending about both axes.

Sub-models with combined loads are compared with what a hinge would carry that has the law of each load
alone, over the same rotation.  The error is that of the work, hinge over shells less one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from crumple.characterisation.bending import Bending
from crumple.characterisation.combined import Combined, FixedRatio
from crumple.characterisation.coupling.errors_of_work import errors_of_work
from crumple.characterisation.curve import LawCurve
from crumple.hinge.bending.edge_fold import CROSSED, EVENNESS, edge_relief
from crumple.numeric.arrays import Floats
from crumple.section import RectangularTube, plastic_interaction

SHARE = 0.2
"""Axial force over the squash force."""
PARTS = {1.0: "b/2", 0.5: "b/4"}
"""Ratios of shortening to rotation over b/2, half the depth between the flanges, in words."""


def interaction_errors(model: Bending, solved: Callable[[Combined], LawCurve]) -> dict[str, str]:
    """Errors of the interaction as entries of the law file of a straight member.

    Parameters
    ----------
    model
        Straight member bent about one of its axes.
    solved
        Solves a sub-model and gives its curve.

    Returns
    -------
    dict
        Sentences by key: ``axial_compression``, ``axial_tension``, ``axial_fixed_ratio``, and
        ``oblique_45_deg`` if it is not round.

    References
    ----------
    docs/theory/characterisation.md.  Verified in tests/verification/characterisation/test_interaction.py.
    """
    angle = 0.0 if model.axis == "y" else math.pi / 2.0
    base = Combined(model.section, model.material, angle, 0.0, model.largest, model.resolution)
    alone = solved(base)
    found = {}
    for name, share in (("compression", -SHARE), ("tension", SHARE)):
        combined = replace(base, share=share)
        shells = solved(combined)
        walls = errors_of_work(shells, partial(_with_walls, combined, alone))
        flange = errors_of_work(shells, partial(_about_flange, combined, model, alone))
        found[f"axial_{name}"] = f"{SHARE:g} of squash: coupling section {walls}; tension-flange {flange}"
    arm, words = _arm(model), []
    for part, name in PARTS.items():
        fixed = FixedRatio(
            base.section, base.material, angle, 0.0, base.largest, base.resolution, ratio=part * arm
        )
        errors = errors_of_work(solved(fixed), partial(_fixed_ratio, part, alone))
        words.append(f"shortening of {name} a radian: coupling tension-flange {errors}")
    found["axial_fixed_ratio"] = "; ".join(words)
    if model.section.kind != "circular_tube":
        other = solved(replace(base, angle=math.pi / 2.0 - angle))
        about = (alone, other) if model.axis == "y" else (other, alone)
        oblique = replace(base, angle=math.pi / 4.0)
        errors = errors_of_work(solved(oblique), partial(_oblique, oblique, about))
        found["oblique_45_deg"] = f"coupling section {errors}"
    return found


def _capacity(alone: LawCurve, at: Floats) -> Floats:
    return np.asarray(np.interp(at, alone.rotation, alone.moment))


def _with_walls(model: Combined, alone: LawCurve, at: Floats) -> Floats:
    """Capacity times the share that the walls' plastic interaction leaves to the moment."""
    outline = plastic_interaction(model.section, model.material).force_moment_curve(model.angle)
    upper = outline[outline[:, 1] >= 0.0]
    upper = upper[np.argsort(upper[:, 0])]
    left = np.interp([model.force, 0.0], upper[:, 0], upper[:, 1])
    return np.asarray(_capacity(alone, at) * left[0] / left[1])


def _about_flange(model: Combined, bending: Bending, alone: LawCurve, at: Floats) -> Floats:
    """|M| + N_c b/2 <= C(theta), |M| <= C(0): docs/theory/spatial_hinge.md."""
    capacity = _capacity(alone, at)
    return np.asarray(np.clip(capacity + model.force * _arm(bending), 0.0, capacity[0]))


def _arm(bending: Bending) -> float:
    """Distance of the flanges from the middle of the section, b/2 [m]."""
    return (bending.section.bending_depth(bending.axis) - bending.section.thickness) / 2.0


def _fixed_ratio(part: float, alone: LawCurve, at: Floats) -> Floats:
    """Work of the same set a radian, if the hinge shortens by a part of b/2 a radian, 0 to 1.

    The normals at the corner |M| = C(0), N_c b/2 = C(theta) - C(0) are between those of the two sides, (0, 1)
    and (b/2, 1).
    """
    capacity = _capacity(alone, at)
    return np.asarray((1.0 - part) * capacity[0] + part * capacity)


def _oblique(model: Combined, about: tuple[LawCurve, LawCurve], at: Floats) -> Floats:
    """Largest moment about the axis in the set of the walls, scaled to the capacities about y and z.

    These soften by a measure of the rotation: docs/theory/spatial_hinge.md.
    """
    turn = np.array([math.cos(model.angle), math.sin(model.angle)])
    outline = plastic_interaction(model.section, model.material).moment_curve()
    shares = outline / np.abs(outline).max(axis=0)
    first = np.array([float(_capacity(one, np.zeros(1))[0]) for one in about])
    work = first * turn
    measure = (shares * work).sum(axis=1).max() * at
    own = np.hypot(*work)
    if isinstance(model.section, RectangularTube):
        even = 2.0 * float(np.prod(work)) / own**2
        relieved = 1.0 - edge_relief(model.section) * even**EVENNESS
        own = relieved * np.hypot(work, CROSSED * first * turn[::-1])
    softened = measure[:, None] * own / np.hypot(*work) / first
    capacity = np.stack([_capacity(one, softened[:, k]) for k, one in enumerate(about)], axis=1)
    return np.asarray((shares[None] * (capacity * turn)[:, None]).sum(axis=2).max(axis=1))
