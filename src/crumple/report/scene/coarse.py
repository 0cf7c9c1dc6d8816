"""Fewer walls for the page: points in one cell of a grid become one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crumple.result import States


def coarsened(states: States, most: int) -> States:
    """The same shapes with at most `most` points; unchanged where they have no more.

    Points of one member in one cell of a grid over the undeformed shape become its first point; walls that
    shrink to a line go.  The cells grow until the points are few enough.  Only for drawing.
    """
    if len(states.points) <= most:
        return states
    low, high = states.points.min(axis=0), states.points.max(axis=0)
    size = float(np.linalg.norm(high - low)) / 400.0
    while True:
        cells = np.column_stack([states.member, np.floor((states.points - low) / size).astype(np.int64)])
        _, first, cell = np.unique(cells, axis=0, return_index=True, return_inverse=True)
        if len(first) <= most:
            break
        size *= 1.25
    # points stay in the order of the members
    order = np.argsort(first)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    kept = first[order]
    quads = place[cell.reshape(-1)][states.quads]
    corners = np.sort(quads, axis=1)
    whole = (np.diff(corners, axis=1) != 0).sum(axis=1) >= 2
    return replace(
        states,
        points=states.points[kept],
        quads=quads[whole],
        member=states.member[kept],
        station=states.station[kept],
        contour=states.contour[kept],
        displacement=states.displacement[:, kept],
        point_data={},
        cell_data={name: values[:, whole] for name, values in states.cell_data.items()},
    )
