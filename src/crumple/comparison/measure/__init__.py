"""Folds, rotations of sections, hinge histories and energies measured in a result."""
