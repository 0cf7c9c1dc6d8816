"""Rigid bodies, joints, loads and initial motion of a structure."""
