"""Rows that are not dominated: no other row is at least equal in every goal and better in one."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats, Integers


def nondominated(goals: Floats, rows: Integers) -> list[int]:
    """Numbers of the rows of the Pareto front, in the order of the first goal; of equal rows the first one.

    Parameters
    ----------
    goals
        Made small, (goals, n).
    rows
        Numbers of the rows that are compared.

    References
    ----------
    K. Deb, Multi-objective optimization using evolutionary algorithms, Wiley 2001, section 2.4.
    """
    # in lexicographic order a row is dominated by earlier rows alone
    order = rows[np.lexsort((rows, *goals[::-1, rows]))]
    front: list[int] = []
    left = order
    while left.size:
        row, left = int(left[0]), left[1:]
        front.append(row)
        left = left[(goals[:, left] < goals[:, [row]]).any(axis=0)]
    return front
