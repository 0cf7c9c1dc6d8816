"""The function room."""
