"""Settings that are refused, and what to know before believing a shell result."""
