"""Refused settings of shell runs, and warnings about their results."""
