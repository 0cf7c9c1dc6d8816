"""Named channels, shapes and summaries from what a kernel has recorded."""
