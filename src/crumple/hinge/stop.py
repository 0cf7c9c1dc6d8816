"""One-sided stops of a hinge."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Stop:
    """One-sided spring and damper on g = rotation beyond the gap.

    Its moment is max(0, stiffness g**exponent + damping STEP(g) rate).

    Attributes
    ----------
    rotation
        Rotation [rad] at which it is touched, > 0, measured in its own sense.
    stiffness
        k [N m/rad**exponent].
    exponent
        e of IMPACT, >= 1.
    damping
        Damper at full penetration [N m s/rad]; NaN asks the solver for the critical value at first touch.
    full_damping_penetration
        Penetration d of IMPACT [rad] at which the damper acts fully; 0: at once (linear stop).
    """

    rotation: float
    stiffness: float
    exponent: float = 1.0
    damping: float = float("nan")
    full_damping_penetration: float = 0.0
