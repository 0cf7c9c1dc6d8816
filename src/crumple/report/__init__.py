"""The report room: figures, tables and one self-contained page."""

from crumple.report.comparison_page import write_comparison
from crumple.report.report import ReportInput, write_report

__all__ = ["ReportInput", "write_comparison", "write_report"]
