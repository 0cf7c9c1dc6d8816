"""Straight runs of members, and candidates for folds on them."""
