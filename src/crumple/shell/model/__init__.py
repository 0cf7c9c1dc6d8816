"""From a structure and its mesh to the model of the stepper."""
