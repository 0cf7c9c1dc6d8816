"""Areas, second moments, torsion and warping."""
