"""Force over displacement of what drives a structure or is hit by it, and motion of barriers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit, largest, time_unit
from crumple.report.drawing.style import Line, short
from crumple.report.drawing.window import happening
from crumple.report.figures.curves import panel
from crumple.result import Result
from crumple.structure import Obstacle, Structure
from crumple.units import plain_number

MOST = 4
"""Drives, and obstacles, with figures: those with the largest forces."""

Panel = tuple[str, str | None]


def force_panels(result: Result, structure: Structure | None) -> list[Panel]:
    """Force over displacement, or over time of obstacles at rest; velocity and travel of barriers."""
    if structure is None or len(result.time) < 2:
        return []
    found: list[Panel] = []
    for i, (name, kind, unit, x, y) in enumerate(_drives(result, structure), 1):
        found.append((f"drive_{i}", over_path(f"drive-{i}", (f"{kind} of {short(name, 20)}", unit), x, y)))
    for i, name in enumerate(_obstacles(result, structure), 1):
        found += _of_obstacle(result, structure, name, i)
    return found


def vector(result: Result, stem: str) -> Floats | None:
    """Channels ``<stem>.x`` … ``.z`` as columns, (n_times, 3); None unless all are there and finite."""
    channels = [result.channels.get(f"{stem}.{axis}") for axis in "xyz"]
    columns = [channel.values for channel in channels if channel is not None]
    if len(columns) < len(channels):
        return None
    joined = np.stack(columns, axis=1)
    return joined if np.isfinite(joined).all() else None


def over_path(
    figure: str,
    quantity: tuple[str, str],
    path: Floats,
    force: Floats,
    x_name: str = "travel",
    known: tuple[float, float] | None = None,
) -> str | None:
    """Force or moment over the path of its point as SVG, with the largest and the mean value as lines.

    The mean is the work over the longest path, up to which it is done: integral of F dx over x.  Nothing is
    filtered.

    Parameters
    ----------
    figure
        Name of the figure.
    quantity
        What is drawn, and its unit, ``N`` or ``N*m``.
    path, force
        [m] or [rad], and [N] or [N m], shape (n_times,).
    x_name
        What the path is.
    known
        Mean and peak where the result has them, so that no sum over the outputs stands beside them.
    """
    last = int(np.argmax(path))
    if not path[last] > 0.0:
        return None
    unit, factor = display_unit(quantity[1], largest([force]))
    turns = quantity[1] == "N*m"
    x_unit, x_factor = ("deg", np.pi / 180.0) if turns else display_unit("m", largest([path]))
    x, y = path / x_factor, force / factor
    work = float(np.sum((force[1 : last + 1] + force[:last]) / 2.0 * np.diff(path[: last + 1])))
    mean, peak = known or (work / float(path[last]), float(force[: last + 1].max()))
    mean, peak = mean / factor, peak / factor
    lines = [Line("", x, y, 0)]
    if peak > 0.0 and mean > 0.0:
        reach = np.array([0.0, x[last]])
        lines += [Line(f"mean {plain_number(mean, 3)}", reach, np.full(2, mean), 1)]
        lines += [
            Line(
                f"peak {plain_number(peak, 3)}",
                x[int(np.argmax(y[: last + 1]))] + 0 * reach,
                np.full(2, peak),
                2,
            )
        ]
    text = f"{quantity[0]} over {x_name}, unfiltered, with its mean and its peak."
    return panel(figure, text, lines, (f"{x_name}, {x_unit}", f"{quantity[0]}, {unit}"))


def _drives(result: Result, structure: Structure) -> Iterator[tuple[str, str, str, Floats, Floats]]:
    """Name, kind of force, its unit, path and force of supports that drive a node, the largest first."""
    found = []
    for name, support in structure.supports.items():
        for freedom, function in support.driven.items():
            kind, stem = ("Moment", "moment") if freedom.startswith("r") else ("Force", "force")
            channel = result.channels.get(f"support.{name}.{stem}.{freedom[-1]}")
            if channel is None or not np.isfinite(channel.values).all():
                continue
            # functions of stages count from the start of each: then only the path of the node tells
            if result.stages:
                way = "rotation" if stem == "moment" else "displacement"
                moved = result.channels.get(f"node.{support.node}.{way}.{freedom[-1]}")
                path = None if moved is None else moved.values
            else:
                path = np.broadcast_to(function(result.time), result.time.shape)
            if path is None or not largest([path]) > 0.0:
                continue
            side = 1.0 if path[int(np.argmax(np.abs(path)))] > 0.0 else -1.0
            # the channel is what the structure does to the support
            unit = "N*m" if stem == "moment" else "N"
            found.append((f"{name}, {freedom[-1]}", kind, unit, side * path, -side * channel.values))
    for i in largest_first({i: largest([entry[4]]) for i, entry in enumerate(found)})[:MOST]:
        yield found[i]


def _obstacles(result: Result, structure: Structure) -> list[str]:
    """Obstacles with a contact force, the largest first."""
    forces = {name: vector(result, f"obstacle.{name}.force") for name in structure.obstacles}
    peaks = {name: float(np.abs(force).max()) for name, force in forces.items() if force is not None}
    return largest_first({name: peak for name, peak in peaks.items() if peak > 0.0})[:MOST]


def _of_obstacle(result: Result, structure: Structure, name: str, i: int) -> list[Panel]:
    """Force over travel of one that moves, with its motion; of one at rest over time and a mass's travel."""
    force = vector(result, f"obstacle.{name}.force")
    assert force is not None  # chosen because it has one
    moved = vector(result, f"obstacle.{name}.displacement")
    impulse = np.sum((force[1:] + force[:-1]) / 2.0 * np.diff(result.time)[:, None], axis=0)
    if moved is not None and _travels(structure.obstacles[name]) and float(np.abs(moved).max()) > 0.0:
        direction = _unit(moved[int(np.argmax(np.linalg.norm(moved, axis=1)))])
        label = (f"Force on {short(name, 20)}", "N")
        found = [(f"force_{i}", over_path(f"force-{i}", label, moved @ direction, -force @ direction))]
        if structure.obstacles[name].mass is not None:
            found += _barrier(result, name, i, direction)
        return found
    if not float(np.linalg.norm(impulse)) > 0.0:
        return []
    direction = _unit(impulse)
    part = happening(result)
    along = force @ direction
    unit, factor = display_unit("N", largest([along[part]]))
    times = result.time[part] / time_unit(float(result.time[part][-1]))[1]
    names = ("", f"Force on {short(name, 20)}, {unit}")
    text = f"Force on the obstacle {short(name)} against time."
    lines = [Line("", times, along[part] / factor)]
    found = [(f"force_{i}", panel(f"force-{i}", text, lines, names, over=result.time[part]))]
    node = _heaviest(result, structure)
    path = None if node is None else vector(result, f"node.{node}.displacement")
    touched = np.flatnonzero(along > 1e-3 * largest([along]))
    if path is not None and touched.size:
        travel = (path - path[max(int(touched[0]) - 1, 0)]) @ direction
        begin = int(touched[0]) - 1 if touched[0] else 0
        label = (f"Force on {short(name, 14)}", "N")
        way = f"travel of {short(str(node), 14)}"
        svg = over_path(f"force-path-{i}", label, travel[begin:], along[begin:], way)
        found.append((f"force_path_{i}", svg))
    return found


def _travels(obstacle: Obstacle) -> bool:
    """Whether it is displaced; one that only turns has no travel."""
    driven = any(getattr(obstacle.motion, axis) is not None for axis in "xyz")
    return obstacle.mass is not None or driven or any(obstacle.velocity)


def _heaviest(result: Result, structure: Structure) -> str | None:
    """Node with histories that carries the largest lumped mass."""
    masses = {
        mass.node: mass.mass
        for mass in structure.masses.values()
        if f"node.{mass.node}.displacement.x" in result.channels
    }
    return max(masses, key=lambda node: masses[node]) if masses else None


def _barrier(result: Result, name: str, i: int, direction: Floats) -> list[Panel]:
    """Velocity and travel of an obstacle with a mass over time."""
    part = happening(result)
    times = result.time[part] / time_unit(float(result.time[part][-1]))[1]
    found: list[Panel] = []
    for what, stem, unit in (("Velocity", "velocity", "m/s"), ("Travel", "displacement", "m")):
        values = vector(result, f"obstacle.{name}.{stem}")
        if values is None:
            continue
        along = (values @ direction)[part]
        shown, factor = display_unit(unit, largest([along]))
        names = ("", f"{what} of {short(name, 20)}, {shown}")
        text = f"{what} of the obstacle {short(name)} against time."
        lines = [Line("", times, along / factor)]
        key = what.lower()
        found.append((f"{key}_{i}", panel(f"{key}-{i}", text, lines, names, over=result.time[part])))
    return found


def _unit(direction: Floats) -> Floats:
    return np.asarray(direction / np.linalg.norm(direction))
