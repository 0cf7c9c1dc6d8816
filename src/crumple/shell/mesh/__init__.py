"""Members as shell elements."""
