"""Walls as a graph of flats, bends and plates."""
