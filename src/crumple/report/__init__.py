"""The report room: figures, tables and one self-contained page."""

from crumple.report.report import ReportInput, write_report

__all__ = ["ReportInput", "write_report"]
