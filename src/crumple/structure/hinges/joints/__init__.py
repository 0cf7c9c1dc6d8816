"""Hinges with their places, and the joints at which elastic members bend and twist between them."""
