"""Section shapes, one file each."""
