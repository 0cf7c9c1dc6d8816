"""Members that obstacles strike: dents of their walls."""
