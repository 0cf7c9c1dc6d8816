"""What an engineer must know before believing a multibody result."""
