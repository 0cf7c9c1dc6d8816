"""How figures look: styles, scales, views, the moving picture."""
