"""Figures of deformed shapes: hinges move with the walls around them; thin members are drawn as lines."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_frame import PORTAL, frame_states

from crumple.report.figures import shape
from crumple.report.figures.shape import Neighbours


@pytest.mark.parametrize("rounded", [False, True])
def test_the_nearest_points_are_those_of_all(rounded):
    """Of a line of points and of a cloud; of equal distances the lower numbers."""
    random = np.random.default_rng(3)
    for size in ((10.0, 0.02, 0.02), (1.0, 1.0, 1.0)):
        points = random.normal(size=(1500, 3)) * size
        points = np.round(points, 1) if rounded else points
        around = Neighbours(points)
        for place in points[random.integers(0, 1500, 20)] + 0.01 * random.normal(size=(20, 3)):
            distance = np.linalg.norm(points - place, axis=1)
            expected = np.argsort(distance, kind="stable")[:8]
            near, found = around.nearest(place)
            assert (near == expected).all()
            assert (found == distance[expected]).all()


def drawn_with(states, monkeypatch):
    """Names of the functions that draw walls or centre lines of states, as often as they are called."""
    called = []
    for name in ("draw_walls", "draw_centre_lines"):
        monkeypatch.setattr(shape, name, lambda *given, name=name: called.append(name))
    monkeypatch.setattr(shape, "hinge_places", lambda result, states: {})
    monkeypatch.setattr(shape, "to_svg", lambda *given: "")
    monkeypatch.setattr(shape, "_RASTER_FROM", 0)
    shape.deformation(type("Result", (), {"states": states, "hinges": {}})())
    return {*called}


def test_members_thinner_than_a_line_are_drawn_as_centre_lines(monkeypatch):
    states = frame_states(PORTAL, np.linspace(0.0, 0.08, 3), 0.3)
    assert drawn_with(states, monkeypatch) == {"draw_walls"}
    # the same sections on members a thousand times as long
    centres, ring = shape.ring_centres(states)
    far = states.points + 999.0 * centres[0][ring]
    assert drawn_with(replace(states, points=far), monkeypatch) == {"draw_centre_lines"}
