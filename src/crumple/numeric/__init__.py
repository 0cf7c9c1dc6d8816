"""Plain mathematics that several rooms use."""
