"""The hinge of a mitred corner in space: its laws out of the plane, and its springs."""
