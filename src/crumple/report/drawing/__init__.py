"""Appearance of figures: styles, scales, views."""
