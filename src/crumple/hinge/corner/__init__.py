"""Collapse laws of corners, one per file, with one line each in `crumple.hinge.registry`."""
