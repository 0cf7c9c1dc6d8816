"""Collapse laws, one per file; each registers itself with `crumple.hinge.registry.law_type`."""
