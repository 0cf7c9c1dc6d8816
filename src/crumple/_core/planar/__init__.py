"""Typed face of the planar kernel."""
