"""Rows of a study in a SQLite file with one writer; known rows are not solved again."""

from __future__ import annotations

import csv
import math
import sqlite3
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.portable import replacing
from crumple.study.models import Model, Row
from crumple.study.space import Axis, Point

FILE, CSV = "study.sqlite", "study.csv"


class Table:
    """Rows in the order in which a method asked for them.

    Parameters
    ----------
    axes, responses
        Variables, and names of the measured responses.
    model
        Solves what is not known yet.
    path
        SQLite file; None keeps the rows in memory alone.
    identity
        Hash of the study and its base; a file with another one is refused.

    Attributes
    ----------
    points, rows
        All so far.
    solved
        Number of points that were solved in this process.
    """

    def __init__(
        self, axes: Sequence[Axis], responses: Sequence[str], model: Model, path: Path | None, identity: str
    ) -> None:
        self.axes, self.responses, self._model = axes, responses, model
        self.points: list[Point] = []
        self.rows: list[Row] = []
        self.solved = 0
        self._known: dict[Point, Row] = {}
        self._stored: set[int] = set()
        self._file = sqlite3.connect(path if path is not None else ":memory:")
        names = [*(axis.name for axis in axes), *responses]
        columns = ", ".join(f'"{name}"' for name in names)
        marks = ", ".join("?" * (len(names) + 3))
        self._insert = f'INSERT INTO rows ("row ", {columns}, "status ", "reason ") VALUES ({marks})'
        try:
            self._begin(columns, identity, path)
        except sqlite3.DatabaseError as error:
            what, todo = f"the rows cannot be read: {error}", "choose another folder with --out"
            raise InputError(Problem(what, "", "", todo, file=str(path or ""))) from None

    def _begin(self, columns: str, identity: str, path: Path | None) -> None:
        with self._file as file:
            file.execute("CREATE TABLE IF NOT EXISTS study (identity TEXT)")
            # a space keeps these names apart from those of variables and responses
            head = f'"row " INTEGER PRIMARY KEY, {columns}, "status " TEXT, "reason " TEXT'
            file.execute(f"CREATE TABLE IF NOT EXISTS rows ({head})")
            own = file.execute("SELECT identity FROM study").fetchone()
            if own is None:
                file.execute("INSERT INTO study VALUES (?)", (identity,))
            elif own[0] != identity:
                what, todo = "these rows belong to another study", "choose another folder with --out"
                raise InputError(Problem(what, "", "rows of the same study and base", todo, file=str(path)))
        width = len(self.axes)
        for number, *cells in self._file.execute('SELECT * FROM rows ORDER BY "row "'):
            values = tuple(math.nan if value is None else value for value in cells[width:-2])
            self._known[tuple(cells[:width])] = Row(values, cells[-2], cells[-1])
            self._stored.add(number)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def solve(self, points: Sequence[Point]) -> list[Row]:
        """Rows of further points; equal points are solved once."""
        first = len(self.points)
        self.points += points
        numbers: dict[Point, list[int]] = {}
        for i, point in enumerate(points, first):
            numbers.setdefault(point, []).append(i)
        self._store([(i, self._known[p]) for p, own in numbers.items() if p in self._known for i in own])
        missing = [point for point in numbers if point not in self._known]
        for group in self._model.rows(missing):
            for i, row in group:
                self._known[missing[i]] = row
            self._store([(k, row) for i, row in group for k in numbers[missing[i]]])
            self.solved += len(group)
        found = [self._known[point] for point in points]
        self.rows += found
        return found

    def _store(self, rows: list[tuple[int, Row]]) -> None:
        new = [(i, row) for i, row in rows if i not in self._stored]
        self._stored.update(i for i, _ in new)
        with self._file as file:
            file.executemany(
                self._insert,
                ((i, *self.points[i], *row.values, row.status, row.reason) for i, row in new),
            )

    @property
    def ok(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which rows have usable values, (n,)."""
        return np.array([row.ok for row in self.rows], bool)

    def columns(self) -> dict[str, Floats]:
        """Numeric variables and responses, (n,) each; NaN in failed rows' responses."""
        found = {
            axis.name: np.array([point[k] for point in self.points], float)
            for k, axis in enumerate(self.axes)
            if axis.numeric
        }
        values = np.array([row.values if row.ok else (math.nan,) * len(row.values) for row in self.rows])
        values = values.reshape(len(self.rows), len(self.responses))
        return found | {name: values[:, k] for k, name in enumerate(self.responses)}


def write_csv(table: Table, derived: dict[str, Floats], path: Path) -> None:
    """Write all rows, numbers with all their digits, in SI units.

    Parameters
    ----------
    table
        The rows.
    derived
        Further columns, (n,) each.
    path
        CSV file with one line of names.
    """
    names = [*(axis.name for axis in table.axes), *table.responses, *derived]
    with replacing(path) as file, file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["row", *names, "status", "reason"])
        more = [column.tolist() for column in derived.values()]
        for i, (point, row) in enumerate(zip(table.points, table.rows, strict=True)):
            numbers = [*row.values, *(column[i] for column in more)]
            cells = ["" if math.isnan(number) else repr(number) for number in numbers]
            writer.writerow([i, *point, *cells, row.status, row.reason.replace("\n", " ")])
