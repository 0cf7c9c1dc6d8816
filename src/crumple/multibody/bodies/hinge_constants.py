"""Constants of hinges in the form that the kernels take."""

from __future__ import annotations

from typing import Any

from crumple.hinge import Form, HingeRecord, SofteningVariable, Stop

FORMS = {Form.SET_VALUED: 0, Form.ELASTIC_PLASTIC: 1, Form.REGULARISED: 2}
SOFTENING = {SofteningVariable.PEAK: 0, SofteningVariable.ROTATION: 1, SofteningVariable.ACCUMULATED: 2}


def hinge_constants(record: HingeRecord, sign: float = 1.0) -> dict[str, Any]:
    """Values of `HingeConstants`; for a joint that counts the other way the senses are exchanged."""
    senses = ((record.positive, record.stop_positive), (record.negative, record.stop_negative))
    (positive, stop_positive), (negative, stop_negative) = senses if sign > 0.0 else senses[::-1]
    return {
        "positive": (positive.rotation, positive.moment),
        "negative": (negative.rotation, negative.moment),
        "elastic_stiffness": record.elastic_stiffness,
        "regularisation_rate": record.regularisation_rate,
        "rate_reference": record.rate_reference,
        "rate_exponent": record.rate_exponent,
        "viscous_damping": record.viscous_damping,
        "stop_positive": _stop(stop_positive),
        "stop_negative": _stop(stop_negative),
    }


def _stop(stop: Stop | None) -> tuple[float, ...]:
    """Rotation, stiffness, exponent, damping, penetration; empty without a stop."""
    if stop is None:
        return ()
    return (stop.rotation, stop.stiffness, stop.exponent, stop.damping, stop.full_damping_penetration)
