"""Rows by a function of the caller's."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from crumple.analysis.criteria import Measured
from crumple.errors import Status
from crumple.numeric.arrays import Floats
from crumple.study.rows.model import Model, Row, rows_of
from crumple.study.space import Axis, Point


class FunctionModel(Model):
    """Rows by a function of the caller's, for models other than Crumple's.

    Parameters
    ----------
    function
        Takes columns of variables by name, (n,) each, and gives columns of responses, (n,) each; a value
        that is not finite is a failed row.
    axes, measured
        Variables and responses.
    """

    def __init__(
        self,
        function: Callable[[Mapping[str, Floats]], Mapping[str, Floats]],
        axes: Sequence[Axis],
        measured: Sequence[Measured],
    ) -> None:
        self._function, self._axes, self._measured = function, axes, measured

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        columns = {axis.name: np.array([p[k] for p in points], float) for k, axis in enumerate(self._axes)}
        found = self._function(columns)
        given = [np.broadcast_to(np.asarray(found[one.name], float), len(points)) for one in self._measured]
        count = len(points)
        yield list(enumerate(rows_of(np.stack(given, axis=1), [Status.COMPLETE] * count, [""] * count)))
