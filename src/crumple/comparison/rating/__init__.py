"""Curves against curves."""
