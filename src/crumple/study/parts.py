"""Parts of a study that are solved apart, as the jobs of an array on a cluster, and joined."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from crumple.errors import InputError, Problem
from crumple.study.methods.points import sampled
from crumple.study.rows import Model, Row
from crumple.study.setting import Setting
from crumple.study.space import Point
from crumple.study.table import Table

MOST_PARTS = 10_000
"""Largest number of parts."""
WHOLE = ("points", "grid", "latin_hypercube", "sobol", "monte_carlo")
"""Methods that know all their points beforehand."""


def read_part(text: str) -> tuple[int, int]:
    """Which part of how many a text such as ``3/40`` names.

    Raises
    ------
    InputError
        If it names none.
    """
    found = re.fullmatch(r"([0-9]{1,5})/([0-9]{1,5})", text.strip())
    number, count = (int(found[1]), int(found[2])) if found else (0, 0)
    if not 1 <= number <= count <= MOST_PARTS:
        allowed = f"number/count, as 3/40; at most {MOST_PARTS} parts"
        raise InputError(Problem("this is not a part", text[:40], allowed, "correct it", "--part"))
    return number, count


def part_file(folder: Path, part: tuple[int, int]) -> Path:
    """File of a part, in a folder of its own: parts are solved at the same time."""
    return folder / f"part-{part[0]}-of-{part[1]}" / "part.sqlite"


def part_of(setting: Setting, part: tuple[int, int]) -> list[Point]:
    """Points of a part: every n-th, so that parts take about equally long.

    Raises
    ------
    InputError
        If the method chooses its points by the rows before.
    """
    kind = setting.study.method.type
    if kind not in WHOLE:
        what, todo = f"'{kind}' chooses its points by rows before, so it has no parts", "leave --part out"
        raise InputError(Problem(what, kind, ", ".join(WHOLE), todo, "method.type"))
    return sampled(setting.axes, setting.study.method, setting.folder)[part[0] - 1 :: part[1]]


def part_table(setting: Setting, model: Model, folder: Path, part: tuple[int, int]) -> Table:
    """Rows of a part in its file."""
    names = [one.name for one in setting.measured]
    return Table(setting.axes, names, model, part_file(folder, part), setting.identity, by_point=True)


class MergedModel(Model):
    """Rows that the parts of a folder have.

    Parameters
    ----------
    setting
        Of the study: parts of another one are refused.
    folder
        With the parts.

    Raises
    ------
    InputError
        If there is none, or one belongs to another study.
    """

    def __init__(self, setting: Setting, folder: Path) -> None:
        self._rows: dict[Point, Row] = {}
        self._files = sorted(folder.glob("part-*-of-*/part.sqlite"))
        if not self._files:
            what, todo = "there are no parts in this folder", "solve them with --part 1/N to N/N"
            raise InputError(Problem(what, str(folder), "part-1-of-N, ...", todo, "--merge"))
        names = [one.name for one in setting.measured]
        for file in self._files:
            table = Table(setting.axes, names, self, file, setting.identity, by_point=True)
            self._rows |= table.known
            table.close()

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`; refuses if a row is missing."""
        missing = sum(point not in self._rows for point in points)
        if missing:
            what = f"the parts lack {missing} of {len(points)} rows"
            came = ", ".join(file.parent.name for file in self._files[:8])
            todo = "solve the parts that are missing, or go on with those that were interrupted (--resume)"
            raise InputError(Problem(what, came, "all parts", todo, "--merge"))
        yield [(i, self._rows[point]) for i, point in enumerate(points)]
