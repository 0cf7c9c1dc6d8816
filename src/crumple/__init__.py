"""Crash analysis at the concept stage: plastic-hinge multibody and explicit shells from one description."""

__version__ = "0.1.0"
