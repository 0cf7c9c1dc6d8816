"""How a study chooses its points."""
