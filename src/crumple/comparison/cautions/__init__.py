"""Sentences about a finished comparison."""
