"""From a run of a kernel to named channels, shapes and summaries."""
