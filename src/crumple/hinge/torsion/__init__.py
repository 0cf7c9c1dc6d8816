"""Laws of torsional collapse, one per file; each registers itself with `torsion_law_type`."""
