"""Rows of several base inputs, among which a variable chooses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from crumple.study.rows.model import Model, Row
from crumple.study.space import Axis, Point
from crumple.study.study_file import LAYOUT


class LayoutModel(Model):
    """Rows by the model of the base that each point names.

    Parameters
    ----------
    place
        Number of the variable that names it.
    models
        By name of the base; they solve points without that variable.
    """

    def __init__(self, place: int, models: Mapping[str, Model]) -> None:
        self._place, self._models = place, models

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        for name, model in self._models.items():
            own = [i for i, point in enumerate(points) if point[self._place] == name]
            for found in model.rows([without(points[i], self._place) for i in own]):
                yield [(own[i], row) for i, row in found]


def layout_place(axes: Sequence[Axis]) -> int | None:
    """Number of the variable that chooses among base inputs; None without one."""
    return next((k for k, axis in enumerate(axes) if axis.places == (LAYOUT,)), None)


def without(point: Point, place: int) -> Point:
    """A point without one of its values."""
    return (*point[:place], *point[place + 1 :])
