"""The material room."""
