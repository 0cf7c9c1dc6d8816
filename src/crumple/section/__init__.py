"""The section room."""
