"""Functions of time and motion: STEP, STEP5, HAVSIN, IMPACT, BISTOP, tables, and sums of them."""

from __future__ import annotations

from crumple.function.contact import bistop, impact
from crumple.function.parse import parse_time_function
from crumple.function.table import table, table_slope
from crumple.function.time_function import (
    MAX_BREAKS,
    Constant,
    Stop,
    Sum,
    Table,
    TimeFunction,
    Transition,
)
from crumple.function.transition import havsin, havsin_slope, step, step5, step5_slope, step_slope

__all__ = [
    "MAX_BREAKS",
    "Constant",
    "Stop",
    "Sum",
    "Table",
    "TimeFunction",
    "Transition",
    "bistop",
    "havsin",
    "havsin_slope",
    "impact",
    "parse_time_function",
    "step",
    "step5",
    "step5_slope",
    "step_slope",
    "table",
    "table_slope",
]
