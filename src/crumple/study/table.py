"""Rows of a study in a SQLite file with one writer; known rows are not solved again."""

from __future__ import annotations

import errno
import math
import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from importlib import import_module
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.portable import write_text
from crumple.result.tables import imported_pandas
from crumple.study.rows import COMPLETE, Model, Row
from crumple.study.space import Axis, Point

if TYPE_CHECKING:
    import pandas as pd

FILE, CSV, VERIFY_FILE, FRONT = "study.sqlite", "study.csv", "verify.sqlite", "front.csv"

COMMITTING = 0.05
"""Share of the time that commits may take."""
LATEST = 0.5
"""Time since the last commit [s] from which new rows are committed at once in any case."""

Progress = Callable[[float], object]
"""Called with the share that is done, 0 to 1."""


def unwatched(share: float) -> None:
    """Progress that nobody looks at."""


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
    by_point
        The file has each point once, in the order of their solution, instead of a line for each row: other
        points may be asked for when it is resumed.

    Attributes
    ----------
    points, rows
        All so far.
    solved
        Number of points that were solved in this process.
    derived
        Responses by formulas, (n,) each, as soon as the study has ended.
    """

    def __init__(
        self,
        axes: Sequence[Axis],
        responses: Sequence[str],
        model: Model,
        path: Path | None,
        identity: str,
        *,
        by_point: bool = False,
    ) -> None:
        self.axes, self.responses, self._model, self._by_point = axes, responses, model, by_point
        self.points: list[Point] = []
        self.rows: list[Row] = []
        self.solved = 0
        self.derived: dict[str, Floats] = {}
        self._known: dict[Point, Row] = {}
        self._stored: set[int] = set()
        self._kept: set[Point] = set()
        self._committed, self._cost = time.perf_counter(), 0.0
        self._ok = np.empty(0, bool)
        self._columns: tuple[int, dict[str, Floats]] | None = None
        self._file = sqlite3.connect(path if path is not None else ":memory:")
        names = [*(axis.name for axis in axes), *responses]
        columns = ", ".join(f'"{name}"' for name in names)
        marks = ", ".join("?" * (len(names) + 3))
        self._insert = f"INSERT INTO rows VALUES ({marks})"
        self._insert_complete = f"INSERT INTO rows VALUES ({marks[:-6]}, '{COMPLETE}', '')"
        try:
            self._begin(columns, identity, path)
        except sqlite3.DatabaseError as error:
            what, todo = f"the rows cannot be read: {error}", "choose another folder with --out"
            raise InputError(Problem(what, "", "", todo, file=str(path or ""))) from None

    def _begin(self, columns: str, identity: str, path: Path | None) -> None:
        with self._file as file:
            # else each of these would be committed by itself
            file.execute("BEGIN")
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
            point = tuple(cells[:width])
            self._known[point] = Row(values, cells[-2], cells[-1])
            self._kept.add(point)
            self._stored.add(number)

    def close(self) -> None:
        """Commit what is known, and close the file.

        Raises
        ------
        OSError
            If the disk is full, for example; rows that were committed before are kept.
        """
        try:
            self._commit(now=True)
        finally:
            self._file.close()

    def solve(self, points: Sequence[Point], progress: Progress = unwatched) -> list[Row]:
        """Rows of further points; equal points are solved once.  `progress`: told the share that is known."""
        first = len(self.points)
        self.points += points
        if self._known.keys().isdisjoint(points) and len(set(points)) == len(points):
            return self._solve_new(points, first, progress)
        numbers: dict[Point, list[int]] = {}
        for i, point in enumerate(points, first):
            numbers.setdefault(point, []).append(i)
        self._store([(i, self._known[p]) for p, own in numbers.items() if p in self._known for i in own])
        missing = [point for point in numbers if point not in self._known]
        left = len(missing)
        for group in self._model.rows(missing):
            for i, row in group:
                self._known[missing[i]] = row
            self._store([(k, row) for i, row in group for k in numbers[missing[i]]])
            self.solved += len(group)
            left -= len(group)
            progress(1.0 - left / len(numbers))
        found = [self._known[point] for point in points]
        self.rows += found
        return found

    def solve_in_groups(self, points: Sequence[Point], size: int, progress: Progress) -> None:
        """`solve` in groups of so many points; `progress`: told the share of all points that is known."""
        for first in range(0, len(points), size):
            part = points[first : first + size]
            self.solve(part, _part_of(progress, first / len(points), len(part) / len(points)))

    def _solve_new(self, points: Sequence[Point], first: int, progress: Progress) -> list[Row]:
        """Rows of points that differ from each other and from all before."""
        found: dict[int, Row] = {}
        for group in self._model.rows(points):
            found.update(group)
            self._store(group, first)
            self.solved += len(group)
            progress(len(found) / len(points))
        rows = [found[i] for i in range(len(points))]
        self._known.update(zip(points, rows, strict=True))
        self.rows += rows
        return rows

    def _store(self, rows: Sequence[tuple[int, Row]], first: int = 0) -> None:
        """Put rows into the file that it does not have; their numbers count from `first`."""
        points = self.points
        if self._by_point:
            new = [(points[first + i], row) for i, row in rows if points[first + i] not in self._kept]
            cells = [(n, *point, *row[0], *row[1:]) for n, (point, row) in enumerate(new, len(self._kept))]
            self._kept.update(point for point, _ in new)
        else:
            have = self._stored
            rows = [one for one in rows if first + one[0] not in have] if have else rows
            if [row[1] for _, row in rows].count(COMPLETE) == len(rows):
                cells = [(first + i, *points[first + i], *row[0]) for i, row in rows]
                self._write(self._insert_complete, cells)
                self._commit()
                return
            cells = [(first + i, *points[first + i], *row[0], *row[1:]) for i, row in rows]
        self._write(self._insert, cells)
        self._commit()

    def _write(self, statement: str, cells: Sequence[tuple[Any, ...]]) -> None:
        with _as_system_errors():
            self._file.executemany(statement, cells)

    def _commit(self, *, now: bool = False) -> None:
        """Commit if the last time is long enough ago that commits take little time, see `COMMITTING`."""
        begun = time.perf_counter()
        if now or begun - self._committed >= min(self._cost / COMMITTING, LATEST):
            with _as_system_errors():
                self._file.commit()
            self._committed = time.perf_counter()
            self._cost = self._committed - begun

    @property
    def known(self) -> dict[Point, Row]:
        """Every point that was solved, also those of the file that were not asked for."""
        return dict(self._known)

    @property
    def ok(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which rows have usable values, (n,)."""
        if self._ok.size != len(self.rows):
            self._ok = np.array([row.status == COMPLETE for row in self.rows], bool)
        return self._ok

    def columns(self) -> dict[str, Floats]:
        """Numeric variables and responses, (n,) each; NaN in failed rows' responses."""
        if self._columns is None or self._columns[0] != len(self.rows):
            self._columns = len(self.rows), self._made_columns()
        return dict(self._columns[1])

    def _made_columns(self) -> dict[str, Floats]:
        found = {
            axis.name: np.array([point[k] for point in self.points], float)
            for k, axis in enumerate(self.axes)
            if axis.numeric
        }
        values = np.array([row.values for row in self.rows]).reshape(len(self.rows), len(self.responses))
        values[~self.ok] = math.nan
        return found | {name: values[:, k] for k, name in enumerate(self.responses)}

    def to_pandas(self) -> pd.DataFrame:
        """All rows as a table in SI units: variables, responses, status and reason, indexed by row.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        pandas = imported_pandas()
        columns: dict[str, Any] = {
            axis.name: [point[k] for point in self.points] for k, axis in enumerate(self.axes)
        }
        columns |= {name: self.columns()[name] for name in self.responses} | self.derived
        columns |= {"status": [row.status for row in self.rows], "reason": [row.reason for row in self.rows]}
        index = pandas.RangeIndex(len(self.rows), name="row")
        found: pd.DataFrame = pandas.DataFrame(columns, index=index)
        return found

    def to_parquet(self, path: Path) -> None:
        """Write all rows as a Parquet file, with the columns of `to_pandas`.

        Raises
        ------
        InputError
            If pandas or pyarrow is not installed.
        """
        refuse_without_parquet()
        self.to_pandas().to_parquet(path, engine="pyarrow")


def refuse_without_parquet() -> None:
    """Refuse to write Parquet files where pandas or pyarrow is not installed.

    Raises
    ------
    InputError
        With the command that installs it.
    """
    imported_pandas()
    try:
        import_module("pyarrow")
    except ImportError:
        todo = "install it: python -m pip install pyarrow; or read study.csv"
        raise InputError(Problem("pyarrow is not installed", todo=todo)) from None


def _part_of(progress: Progress, begun: float, size: float) -> Progress:
    """Progress of a part of something."""
    return lambda share: progress(begun + size * share)


@contextmanager
def _as_system_errors() -> Iterator[None]:
    """What keeps SQLite from writing, as an `OSError`."""
    try:
        yield
    except sqlite3.OperationalError as error:
        full = error.sqlite_errorcode == sqlite3.SQLITE_FULL
        number = errno.ENOSPC if full else errno.EIO
        raise OSError(number, os.strerror(number), str(error)) from error


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
    more = list(zip(*(column.tolist() for column in derived.values()), strict=True)) or [()] * len(table.rows)
    quick = table.ok & all(axis.numeric for axis in table.axes)
    for column in derived.values():
        quick = quick & np.isfinite(column)
    # a quick study takes no longer to solve a row than to write it cell by cell
    plain = "%d" + ",%r" * len(names) + f",{COMPLETE},"
    lines = [",".join(["row", *names, "status", "reason"])]
    each = zip(count(), table.points, table.rows, more, strict=False)
    if quick.all() and not derived:
        lines += [plain % (i, *point, *row[0]) for i, point, row, _ in each]
    else:
        lines += [
            plain % (i, *point, *row[0], *own) if simple else _line(i, point, row, own)
            for simple, (i, point, row, own) in zip(quick.tolist(), each, strict=False)
        ]
    write_text(path, "\n".join(lines) + "\n")


def _line(number: int, point: Point, row: Row, derived: Sequence[float]) -> str:
    """A row of which some cells are no numbers."""
    numbers = ["" if math.isnan(value) else repr(value) for value in (*row.values, *derived)]
    words = [_quoted(value) if isinstance(value, str) else repr(value) for value in point]
    return ",".join([str(number), *words, *numbers, _quoted(row.status), _quoted(row.reason)])


def _quoted(text: str) -> str:
    """A text on one line of a CSV file, in quotes if it needs them."""
    if text.isalnum() or not text:
        return text
    text = text.replace("\n", " ")
    if any(mark in text for mark in ',"\r'):
        return '"' + text.replace('"', '""') + '"'
    return text


def has_rows(folder: Path) -> bool:
    """Whether a file of rows in a folder, or in one below it, has any."""
    for path in sorted(folder.glob("**/*.sqlite")):
        with closing(sqlite3.connect(path)) as file, suppress(sqlite3.DatabaseError):
            if file.execute("SELECT 1 FROM rows LIMIT 1").fetchone():
                return True
    return False
