"""Reports: figures, tables and one self-contained page."""

from crumple.report.comparison_page import write_comparison
from crumple.report.layouts import Layout, layout_table, order_notes, write_layouts
from crumple.report.report import ReportInput, write_report
from crumple.report.wording.curve_wording import curve_notes

__all__ = [
    "Layout",
    "ReportInput",
    "curve_notes",
    "layout_table",
    "order_notes",
    "write_comparison",
    "write_layouts",
    "write_report",
]
