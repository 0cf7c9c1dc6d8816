"""Obstacles of a structure as bodies of the spatial kernel."""
