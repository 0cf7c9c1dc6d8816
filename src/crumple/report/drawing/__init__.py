"""Appearance of figures: styles, scales, views, the animation."""
