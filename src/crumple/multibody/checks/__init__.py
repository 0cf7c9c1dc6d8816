"""Checks and warnings of multibody results."""
