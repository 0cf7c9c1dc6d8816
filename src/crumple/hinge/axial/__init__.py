"""Laws of axial crushing, one per file; each registers itself with `axial_law_type`."""
