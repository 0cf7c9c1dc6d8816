"""Positions of hinges and their laws."""
