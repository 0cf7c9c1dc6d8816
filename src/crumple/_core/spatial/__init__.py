"""Typed interface of the spatial kernel."""
