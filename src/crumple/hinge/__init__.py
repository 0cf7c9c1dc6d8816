"""The hinge room."""
