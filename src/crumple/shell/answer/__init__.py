"""From a shell run to named channels and shapes."""
