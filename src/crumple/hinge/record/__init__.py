"""A law as the stepper takes it."""
