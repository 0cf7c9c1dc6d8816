"""The multibody room."""
