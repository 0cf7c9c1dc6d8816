"""Plain texts with the line of every entry."""
