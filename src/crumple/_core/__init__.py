"""Typed interface of the compiled kernels; used by the solvers only."""
