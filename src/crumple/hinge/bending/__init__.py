"""Collapse laws of bending, one per file, with one line each in `crumple.hinge.registry`."""
