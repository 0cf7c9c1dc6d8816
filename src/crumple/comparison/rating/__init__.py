"""Ratings of histories: signals, curve files, pairs, and the metric of ISO/TS 18571."""
