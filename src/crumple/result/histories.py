"""Histories as comma-separated values: one column per channel, units in the header."""

from __future__ import annotations

import csv
import io

import numpy as np
from pydantic_core import to_json

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
    # Python's own text of a number takes ten times as long; row by row, so that Ctrl-C is heard
    for row in table:
        numbers = to_json(row.tolist(), inf_nan_mode="constants").decode()[1:-1]
        if not np.isfinite(row).all():
            numbers = numbers.replace("NaN", "").replace("Infinity", "inf")
        text.write(numbers + "\n")
    return text.getvalue()
