"""Laws of axial crushing, one per file, with one line each in `crumple.hinge.registry`."""
