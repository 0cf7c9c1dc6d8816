"""What a section carries: buckling, moment over curvature, plastic interaction."""
