"""Which members must change their length for their hinges to open."""
