"""Mistakes that no part shows alone."""
