"""Two results, or a result and a measured curve: metrics, rating, verdict."""

from crumple.comparison.rating import Rating, rating

__all__ = ["Rating", "rating"]
