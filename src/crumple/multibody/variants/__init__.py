"""Many variants of one structure, and derivatives."""
