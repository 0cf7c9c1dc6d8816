"""Hinge laws as records for the solver."""
