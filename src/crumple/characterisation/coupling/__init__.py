"""Errors of the ways in which hinges combine loads."""
