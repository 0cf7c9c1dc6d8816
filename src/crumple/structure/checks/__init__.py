"""Checks between several parts."""
