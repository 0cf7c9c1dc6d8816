"""Figures that answer what is asked of a kind of analysis: forces, crush, intrusion, zones, pulses."""
