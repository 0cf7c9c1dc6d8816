"""Choice of the kernel: the planar tree where it is exact and fast, else the spatial one.

The tree kernel solves parallel hinges in the plane across them.  That is exact if nothing leads out of the
plane, or if the hinges and supports carry everything across it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.errors import InputError, Problem
from crumple.multibody.bodies.dead_centres import dead_centres
from crumple.multibody.bodies.linkage import GROUND, Linkage, link
from crumple.multibody.bodies.mobility import floating_bodies, mobility, too_large
from crumple.multibody.planar.plane import PARALLEL, plane_of
from crumple.multibody.run import Run
from crumple.numeric.arrays import Floats
from crumple.structure import FREEDOMS, PlacedHinge, Structure, across_plane, driven_across, placed_hinges

MOST_LOOPS = 8
"""Number of closed loops up to which the tree kernel is used: its cost grows with their square."""
LOPSIDED = 1e-6
"""Product of inertia, and distance of centres from one plane, below which they are rounding (relative)."""


def why_spatial(structure: Structure, hinges: tuple[PlacedHinge, ...], run: Run) -> str | None:
    """Reason why the spatial kernel must solve a structure; None if the tree kernel can.

    Parameters
    ----------
    structure, hinges
        The structure and its hinges.
    run
        Settings, stages and outputs.

    Raises
    ------
    InputError
        If a hinge or joint joins a part with itself.
    """
    asked = run.settings.kernel
    if asked != "auto":
        return "asked for" if asked == "spatial" else None
    return next(_reasons(structure, hinges, run), None)


def refuse_spatial(structure: Structure, run: Run) -> None:
    """Refuse what only the spatial kernel can solve, if the planar kernel is required.

    Raises
    ------
    InputError
        With the reason.
    """
    reason = why_spatial(structure, placed_hinges(structure), run)
    if reason is not None:
        what, todo = "this is available for planar motion only", "select the spatial kernel in the settings"
        raise InputError(Problem(what, reason, "a structure that moves in a plane", todo))


def _reasons(structure: Structure, hinges: tuple[PlacedHinge, ...], run: Run) -> Iterator[str]:
    """Reasons for the spatial kernel, the cheapest to determine first."""
    given = {
        "joints": structure.joints,
        "obstacles": structure.obstacles,
        "contact between members": structure.member_contact,
        "stages": run.stages,
        "forces in sections": run.outputs.section_forces,
    }
    yield from (f"there are {what}" for what, part in given.items() if part)
    if any(hinge.spatial is not None for hinge in hinges):
        yield "there are hinges with several components, or that break"
    directions = np.array([hinge.direction for hinge in hinges]).reshape(-1, 3)
    if np.any(np.linalg.norm(np.cross(directions[:1], directions), axis=1) > PARALLEL):
        yield "hinges turn about axes that are not parallel"
    linkage = link(structure, hinges)
    if _hangs_on_clamps(structure, linkage):
        return
    loops = len(linkage.connections) - len(linkage.bodies)
    if loops > MOST_LOOPS:
        yield f"there are {loops} closed loops"
    if too_large(linkage):
        yield "there are too many hinges in closed loops"
        return
    normal = plane_of(structure, hinges).normal
    leaning = _leaning(structure, normal)
    if leaning is not None:
        yield f"{leaning} holds a direction that leans to the plane across the hinges"
    driven = driven_across(structure, normal)
    if driven is not None:
        # nothing can move out of the plane by itself, but it is driven there
        yield f"{driven} leads out of the plane across the hinges"
    if dead_centres(linkage):
        yield "hinges or joints are at a dead centre"
    if not mobility(linkage, locked=True).motions:
        return
    across = across_plane(structure, normal)
    if across is not None:
        yield f"{across} leads out of the plane across the hinges"
    if not any(GROUND in (c.first, c.second) for c in linkage.connections) and _lopsided(linkage, normal):
        yield "a floating structure is not symmetric to the plane across the hinges"


def _hangs_on_clamps(structure: Structure, linkage: Linkage) -> bool:
    """Whether every body is connected to clamps by hinges only, without loops: the most frequent case."""
    if any(len(support.held) < len(FREEDOMS) for support in structure.supports.values()):
        return False
    # as many connections as bodies, and all of them reached: a tree fixed to the ground
    return len(linkage.connections) == len(linkage.bodies) and not floating_bodies(linkage)


def _leaning(structure: Structure, normal: Floats) -> str | None:
    """Path of a support that holds some directions, one of which is neither in the plane nor normal to it."""
    for name, support in structure.supports.items():
        for kind in (FREEDOMS[:3], FREEDOMS[3:]):
            held = [freedom for freedom in kind if freedom in (*support.held, *support.driven)]
            along = [abs(float(normal["xyz".index(freedom[-1])])) for freedom in held]
            if len(held) < 3 and any(PARALLEL < part < 1.0 - PARALLEL for part in along):
                return f"supports.{name}"
    return None


def _lopsided(linkage: Linkage, normal: Floats) -> bool:
    """Whether motion in the plane would rotate bodies out of it: unequal centres or products of inertia."""
    centres = np.array([body.centre for body in linkage.bodies])
    spread = np.ptp(centres @ normal) > LOPSIDED * max(float(np.ptp(centres, axis=0).max()), 1e-3)
    return bool(spread) or any(
        np.linalg.norm(np.cross(body.inertia @ normal, normal)) > LOPSIDED * np.linalg.norm(body.inertia)
        for body in linkage.bodies
    )
