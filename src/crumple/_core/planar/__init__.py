"""Typed interface of the planar kernel."""
