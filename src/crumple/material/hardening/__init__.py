"""Hardening curves, one per file, with one line each in `crumple.material.registry`."""
