"""Typed face of the shell kernel."""
