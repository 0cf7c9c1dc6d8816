"""Facts and cautions about a finished comparison, in words."""
