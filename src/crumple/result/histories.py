"""Histories as comma-separated values: one column per channel, units in the header."""

from __future__ import annotations

import csv
import io

import numpy as np

from crumple.result.result import Result


def histories_csv(result: Result) -> str:
    """The histories as text that pandas and spreadsheets open.

    Parameters
    ----------
    result
        Of either fidelity.

    Returns
    -------
    str
        First column ``time [s]``, then ``name [unit]`` per channel; shortest numbers that read back to the
        same bits; an empty field for NaN; Unix line ends.
    """
    channels = list(result.channels.values())
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time [s]", *(f"{channel.name} [{channel.unit}]" for channel in channels)])
    if not result.time.size:
        return text.getvalue()
    table = np.column_stack([result.time, *(channel.values for channel in channels)])
    rows: list[list[float | None]] = table.tolist()
    # csv writes floats by repr and None as an empty field
    for row, column in np.argwhere(np.isnan(table)).tolist():
        rows[row][column] = None
    writer.writerows(rows)
    return text.getvalue()
