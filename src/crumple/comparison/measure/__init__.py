"""What a result says of folds, sections and energies."""
