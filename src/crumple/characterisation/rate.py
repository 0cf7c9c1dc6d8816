"""Rate law of a fold: from its sub-model with the rate law of the metal at one speed, checked at another.

A fold that strains its walls at kappa times its rotation rate has the capacity

    M(theta, rate) = M_s(theta) (1 + (kappa rate/D)^(1/q))

with the Cowper-Symonds pair D, q of the material.  kappa follows from the work at one speed,

    W = W_s + (kappa/D)^(1/q) integral of M_s rate^(1/q) over the rotation,

and the same formula is compared with the work at the other speed.  Derived here.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, runtime_checkable

import numpy as np

from crumple.characterisation.curve import LawCurve
from crumple.characterisation.sub_model import Histories, Model, Solvable, SubModel
from crumple.hinge.rate import HingeRate
from crumple.material import CowperSymonds, Material
from crumple.numeric.arrays import Floats
from crumple.result import Result

FASTER = 3.0
"""Speed at which the law is checked over that at which it is found."""
LEAST = 1e-3
"""Effect of the rate on the work, over the work without it, below which it has no law."""


@runtime_checkable
class Turned(Solvable, Protocol):
    """A sub-model that gives its histories; its run ends where its law does, at the `largest` rotation."""

    @property
    def material(self) -> Material: ...
    @property
    def largest(self) -> float: ...

    def histories(self, result: Histories) -> tuple[Floats, Floats]:
        """Plastic rotation [rad] and moment [N m] at the times of the result."""
        ...


def without_rate(material: Material) -> Material:
    """The metal at rest."""
    return replace(material, yield_rate=None, flow_rate=None)


def rate_pair(material: Material) -> CowperSymonds | None:
    """Pair of the law that shells use: at large strain if it is given, else at yield."""
    law = material.flow_rate or material.yield_rate
    return law if law is None or isinstance(law, CowperSymonds) else law.as_cowper_symonds()


def at_rest(model: SubModel) -> SubModel:
    """The sub-model with the metal at rest."""
    return replace(model, material=without_rate(model.material))


def faster(model: Model) -> Model:
    """The sub-model at the speed of the check."""
    return replace(model, resolution=replace(model.resolution, slowness=model.resolution.slowness / FASTER))


def rate_law(
    pair: CowperSymonds, static: LawCurve, runs: tuple[tuple[Turned, Result], tuple[Turned, Result]]
) -> tuple[HingeRate | None, str]:
    """Rate law of a fold, and a sentence on its check.

    Parameters
    ----------
    pair
        Of the material.
    static
        Curve without rate.
    runs
        Sub-model and result at the first speed, and at the one of the check.
    """
    (work, swept, rate), (other, other_swept, other_rate) = (
        _work(model, result, static, pair.q) for model, result in runs
    )
    end = float(static.rotation[-1])
    alone = static.energy_at(end)
    effect = (work - alone) / swept
    if effect * swept < LEAST * alone:
        return None, "no effect at the speed of the sub-model"
    kappa = pair.D * effect**pair.q
    error = (alone + effect * other_swept) / other - 1.0
    sentence = (
        f"strain rate {kappa:.3g} times the rotation rate, from the work at {rate:.3g} rad/s; "
        f"at {other_rate:.3g} rad/s its work differs by {100.0 * error:+z.1f} % from that of the sub-model"
    )
    return HingeRate(pair.D / kappa, pair.q), sentence


def _work(model: Turned, result: Result, static: LawCurve, exponent: float) -> tuple[float, float, float]:
    """Work [J] of a run up to the end of the law, integral of M_s rate^(1/q), and mean rate [rad/s]."""
    rotation, moment = model.histories(result)
    time = result.time
    reached = np.maximum.accumulate(np.maximum(rotation, 0.0))
    end = float(static.rotation[-1])
    inside = reached <= end
    step = np.diff(reached[inside])
    rate = step / np.diff(time[inside])
    middle = 0.5 * (reached[inside][1:] + reached[inside][:-1])
    mean = 0.5 * (moment[inside][1:] + moment[inside][:-1])
    swept = float((np.interp(middle, static.rotation, static.moment) * rate ** (1.0 / exponent) * step).sum())
    lasted = float(time[inside][-1] - time[np.argmax(reached > 0.0)])
    # the last interval before the end of the law
    rest = (end - float(reached[inside][-1])) * float(mean[-1])
    return float((mean * step).sum()) + rest, swept, end / lasted
