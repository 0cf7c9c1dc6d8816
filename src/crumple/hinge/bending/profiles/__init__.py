"""Channels and hats in bending: mechanisms of their faces and free edges."""
