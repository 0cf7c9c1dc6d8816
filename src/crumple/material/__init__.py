"""What the metal does: elasticity, yield and flow stress, strain-rate law."""

from crumple.material.material import Material
from crumple.material.rate import CowperSymonds

__all__ = ["CowperSymonds", "Material"]
