"""Typed interface of the shell kernel."""
