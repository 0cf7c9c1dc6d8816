"""Random choices that all draws of `random_frames` are made of, and parts that need nothing of the frame."""

from __future__ import annotations

from typing import Any

import numpy as np

Parts = dict[str, Any]


class Dice:
    """Random choices, and small parts."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.planar = self.chance(0.6)

    def chance(self, share: float) -> bool:
        """True with this probability."""
        return bool(self.rng.random() < share)

    def pick(self, *choices: Any) -> Any:
        """One of the choices."""
        return choices[int(self.rng.integers(len(choices)))]

    def some(self, names: Any, most: int) -> list[str]:
        """Up to `most` of the names, at least one."""
        count = int(self.rng.integers(1, most + 1))
        names = list(names)
        return [names[i] for i in self.rng.permutation(len(names))[:count]]

    def direction(self) -> np.ndarray:
        """Unit vector, in the plane y = 0 for plane frames."""
        way = self.rng.normal(size=3)
        if self.planar:
            way[1] = 0.0
        return way / np.linalg.norm(way)

    def vector(self, least: float, most: float) -> tuple[float, float, float]:
        """Vector of any direction and a length between both."""
        x, y, z = self.rng.uniform(least, most) * self.direction()
        return float(x), float(y), float(z)

    def metal(self) -> Parts:
        steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0}
        return {**steel, "yield_stress": float(self.rng.uniform(200e6, 600e6))}

    def section(self) -> Parts:
        a, b = (float(v) for v in self.rng.uniform(0.025, 0.08, 2))
        t = float(self.rng.uniform(0.001, 0.003))
        return self.pick(
            {"type": "square_tube", "side": a, "thickness": t},
            {"type": "rectangular_tube", "width": a, "depth": b, "thickness": t},
            {"type": "circular_tube", "diameter": a, "thickness": t},
            {"type": "closed_hat", "width": a, "depth": b, "thickness": t, "flange": 0.02},
        )

    def law(self) -> Parts:
        moment = float(10.0 ** self.rng.uniform(2.0, 3.7))
        law: Parts = {
            "form": self.rng.choice(["set-valued", "elastic-plastic", "regularised"], p=[0.7, 0.2, 0.1]),
            "softening": self.pick("peak", "rotation", "accumulated"),
        }
        law["form"] = str(law["form"])
        if self.chance(0.2):
            stop = {"rotation": float(self.rng.uniform(0.2, 1.5)), "stiffness": 50.0 * moment}
            law["stops"] = stop
        if self.chance(0.4):
            return {"type": "constant", "moment": moment, **law}
        ends = self.pick((0.3, 0.2), (0.6, 0.5), (1.2, 1.4))
        moments = [moment, moment * ends[0], moment * ends[1]]
        return {"type": "table", "rotation": [0.0, 0.2, 1.5], "moment": moments, **law}

    def touch(self) -> Parts:
        friction = 0.0 if self.chance(0.4) else float(self.rng.uniform(0.05, 0.6))
        restitution = 0.0 if self.chance(0.6) else float(self.rng.uniform(0.1, 0.8))
        return {"friction": friction, "restitution": restitution}
