"""One-sided stops of a hinge."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass


@dataclass(frozen=True)
class Stop:
    """One-sided spring and damper on g = rotation beyond the gap.

    Its moment is max(0, stiffness g**exponent + damping STEP(g) rate).

    Attributes
    ----------
    rotation
        Rotation [rad] at which it comes into contact, > 0, measured in its own sense.
    stiffness
        k [N m/rad**exponent].
    exponent
        e of IMPACT, >= 1.
    damping
        Damper at full penetration [N m s/rad]; NaN: the solver uses the critical value at first contact.
    full_damping_penetration
        Penetration d of IMPACT [rad] at which the damper acts fully; 0: at once (linear stop).
    """

    rotation: float
    stiffness: float
    exponent: float = 1.0
    damping: float = math.nan
    full_damping_penetration: float = 0.0

    def __post_init__(self) -> None:
        # one NaN object for all stops: NaN equals and hashes as itself by identity alone
        if math.isnan(self.damping):
            object.__setattr__(self, "damping", math.nan)

    def __reduce__(self) -> tuple[type[Stop], tuple[float, ...]]:
        return (type(self), astuple(self))
