"""Measured curves, tables and law files."""
