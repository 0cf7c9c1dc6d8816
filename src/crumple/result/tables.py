"""pandas, where it is installed: tables of results need it, nothing else does."""

from __future__ import annotations

from typing import Any

from crumple.errors import InputError, Problem


def imported_pandas() -> Any:
    """The module pandas.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import pandas  # noqa: PLC0415  (optional, and slow to import)
    except ImportError:
        todo = "install it: python -m pip install pandas; or read histories.csv, study.csv or layouts.csv"
        raise InputError(Problem("pandas is not installed", todo=todo)) from None
    return pandas
