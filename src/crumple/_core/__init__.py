"""The compiled kernels behind a typed Python face; used by the solvers alone."""
