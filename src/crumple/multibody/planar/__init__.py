"""What only the planar kernel needs."""
