"""From a structure to rigid bodies, joints and what moves them."""
