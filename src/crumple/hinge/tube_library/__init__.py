"""Bending laws of tubes that were solved with shells beforehand, and are interpolated."""
