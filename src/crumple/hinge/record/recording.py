"""From a law to its record for the solver."""

from __future__ import annotations

import math
from typing import Literal

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw, SofteningVariable
from crumple.hinge.record.record import Form, HingeRecord
from crumple.hinge.record.sampling import sampled_envelope
from crumple.hinge.stop import Stop

Stops = Literal["law"] | Stop | tuple[Stop | None, Stop | None] | None


def record_of(
    law: HingeLaw,
    *,
    form: Form = Form.SET_VALUED,
    elastic_stiffness: float | None = None,
    flexural_rigidity: float | None = None,
    tributary_length: float | None = None,
    softening: SofteningVariable | None = None,
    stops: Stops = "law",
    regularisation_rate: float = 0.05,
    rate: bool = True,
    viscous_damping: float = 0.0,
    error: float = 1e-4,
) -> HingeRecord:
    """Sample a law in one of the hinge forms.

    Parameters
    ----------
    law
        Any law.
    form
        Set-valued, elastic-plastic or regularised.
    elastic_stiffness
        [N m/rad] for the elastic-plastic form.  If None: the law's own, else that of the part of the member
        that the hinge represents, see `tributary_stiffness`.
    flexural_rigidity, tributary_length
        E I [N m^2] and length [m] of that part.
    softening
        Variable of the collapse curve; None: that of the law.
    stops
        "law": the stop of the law, in both senses; one stop for both senses; a pair (positive,
        negative); None: no stops.
    regularisation_rate
        Half-width of the HAVSIN ramp [rad/s].
    rate
        Whether the law's strain-rate factor is used.
    viscous_damping
        [N m s/rad].
    error
        Bound of the relative sampling error of the envelopes.

    Returns
    -------
    HingeRecord
        Record for the solver.

    Raises
    ------
    InputError
        If the elastic-plastic form has no stiffness, or a rate is not positive.

    References
    ----------
    Verified in tests/unit/hinge/record/test_recording.py.
    """
    if not (math.isfinite(regularisation_rate) and regularisation_rate > 0.0):
        what, todo = "the regularisation rate must be positive", "0.05 rad/s is the usual half-width"
        raise InputError(
            Problem(what, f"{regularisation_rate:g} rad/s", "> 0 rad/s", todo, "regularisation.rate")
        )
    stiffness = math.inf
    if form is Form.ELASTIC_PLASTIC:
        stiffness = _stiffness(law, elastic_stiffness, flexural_rigidity, tributary_length)
    positive_stop, negative_stop = _both_senses(law.stop if stops == "law" else stops)
    rate_law = law.rate if rate else None
    positive = sampled_envelope(law, 1, error)
    return HingeRecord(
        form=form,
        softening_variable=softening or law.softening_variable,
        positive=positive,
        negative=positive if law.symmetric else sampled_envelope(law, -1, error),
        elastic_stiffness=stiffness,
        regularisation_rate=regularisation_rate,
        rate_reference=math.inf if rate_law is None else rate_law.reference,
        rate_exponent=1.0 if rate_law is None else rate_law.exponent,
        viscous_damping=viscous_damping,
        stop_positive=positive_stop,
        stop_negative=negative_stop,
    )


def tributary_stiffness(flexural_rigidity: float, tributary_length: float) -> float:
    """Rotational stiffness E I/l [N m/rad] of the part of a member that a hinge represents.

    Notes
    -----
    Under a uniform moment the part turns by M l/(E I).  A single hinge at the clamp of a cantilever loaded at
    its tip represents a third of the length (3 E I/L); many hinges represent their share each and converge to
    the beam.
    """
    return flexural_rigidity / tributary_length


def _stiffness(
    law: HingeLaw, given: float | None, flexural_rigidity: float | None, tributary_length: float | None
) -> float:
    """Elastic stiffness [N m/rad]: given, the law's own, or the tributary length's."""
    stiffness = given if given is not None else law.elastic_stiffness
    if stiffness is None and flexural_rigidity is not None and tributary_length is not None:
        stiffness = tributary_stiffness(flexural_rigidity, tributary_length)
    if stiffness is None or not stiffness > 0.0:
        came = "" if stiffness is None else f"{stiffness:g} N m/rad"
        what = "the elastic-plastic form needs a positive elastic stiffness"
        todo = "give elastic_stiffness, or flexural rigidity and length of the part that the hinge represents"
        raise InputError(Problem(what, came, "> 0 N m/rad", todo, "elastic_stiffness"))
    return stiffness


def _both_senses(
    stops: Stop | tuple[Stop | None, Stop | None] | str | None,
) -> tuple[Stop | None, Stop | None]:
    if isinstance(stops, tuple):
        return stops
    if stops is None or isinstance(stops, Stop):
        return stops, stops
    what = "unknown value for the stops"
    raise InputError(Problem(what, repr(stops), '"law", a stop, a pair, or None', "", "stops"))
