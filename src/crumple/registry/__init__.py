"""Registries of types that are added by one file and one line, and the input keys that follow from them."""
