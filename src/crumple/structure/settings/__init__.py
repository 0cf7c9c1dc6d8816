"""Settings of the solvers."""
