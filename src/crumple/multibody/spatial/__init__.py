"""What only the spatial kernel needs."""
