"""Typed face of the spatial kernel."""
