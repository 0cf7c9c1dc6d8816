"""Laws of torsional collapse, one per file, with one line each in `crumple.hinge.registry`."""
