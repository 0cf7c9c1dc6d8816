"""Slip that spreads over a member: it follows its own shares of the capacity and softens nothing."""

import numpy as np
import pytest
from tests.support.multibody.hinge_rig import (
    ABOUT_Y,
    ACCUMULATED,
    AXIAL,
    ELASTIC_PLASTIC,
    ELLIPSOID,
    NONE,
    PEAK,
    REGULARISED,
    SECTION,
    SET_VALUED,
    component,
    hinge,
    rig,
)

from crumple._core import _kernels

FORCE = ([0.0, 0.2, 1.0], [100.0, 40.0, 20.0])
MOMENT = ([0.0, 0.5, 1.0], [50.0, 20.0, 10.0])
SHORTENING = [[0.0, 0.1], [0.6, 1.0]]
LENGTHENING = [[0.0, 0.3], [0.5, 1.0]]
H = 1e-3


def made(form=SET_VALUED, coupling=SECTION, softening=PEAK, spread=None):
    stiff = 4e5 if form == ELASTIC_PLASTIC else np.inf
    own = {"positive_spread": LENGTHENING, "negative_spread": SHORTENING} if spread is None else spread
    parts = [
        component(AXIAL, FORCE, elastic_stiffness=stiff, **own),
        component(ABOUT_Y, MOMENT, elastic_stiffness=stiff),
    ]
    extra = {"rows": [1.0, 0.0, 0.0, 1.0], "power": 6.0} if coupling == SECTION else {}
    return hinge(*parts, form=form, softening=softening, coupling=coupling, **extra)


def led(element, rate, slip):
    """Lead a hinge along or about one axis, and its force or moment then."""
    axis = int(np.flatnonzero(rate)[0])
    for _ in range(round(slip / (H * abs(rate[axis])))):
        element.led(H, np.array(rate, float))
    return element.state["moment"][axis]


@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
@pytest.mark.parametrize("coupling", [ELLIPSOID, SECTION])
@pytest.mark.parametrize(("sense", "end", "first"), [(-1.0, 0.1, 0.6), (1.0, 0.3, 0.5)])
def test_the_force_rises_to_the_capacity_and_then_falls_as_if_nothing_had_been(
    form, coupling, sense, end, first
):
    element = rig(made(form, coupling))
    assert led(element, [sense, 0.0], end / 2.0) == pytest.approx(
        sense * 100.0 * (1.0 + first) / 2.0, rel=1e-2
    )
    assert led(element, [sense, 0.0], end / 2.0) == pytest.approx(sense * 100.0, rel=1e-2)
    assert led(element, [sense, 0.0], 0.1) == pytest.approx(sense * 70.0, rel=1e-2)


@pytest.mark.parametrize("softening", [PEAK, ACCUMULATED])
def test_it_takes_nothing_from_the_moment_and_the_fold_does(softening):
    element = rig(made(softening=softening))
    led(element, [-1.0, 0.0], 0.1)
    assert led(element, [0.0, 1.0], H) == pytest.approx(50.0, rel=1e-2)
    plain = rig(made(softening=softening, spread={}))
    led(plain, [-1.0, 0.0], 0.1)
    # 100 N along 0.1 m are 50 N m about 0.2 rad
    assert led(plain, [0.0, 1.0], H) == pytest.approx(38.0, rel=1e-2)
    beyond = rig(made(softening=softening))
    led(beyond, [-1.0, 0.0], 0.2)
    assert led(beyond, [0.0, 1.0], H) == pytest.approx(38.0, rel=2e-2)


def test_hardening_in_one_sense_counts_in_the_other():
    element = rig(made())
    led(element, [-1.0, 0.0], 0.1)
    # a third of the way to the end of lengthening, 0.1 m of 0.3
    assert led(element, [1.0, 0.0], H) == pytest.approx(100.0 * (0.5 + 0.5 / 3.0), rel=1e-2)


@pytest.mark.parametrize(
    ("form", "late"), [(SET_VALUED, 0.5), (ELASTIC_PLASTIC, 0.5), (ELASTIC_PLASTIC, 0.8)]
)
def test_energy_is_balanced_through_cycles(form, late):
    element = rig(made(form), late=late)
    lost = 0.0
    for i in range(400):
        element.led(5e-3, np.array([0.3 * np.cos(0.015 * i), np.sin(0.01 * i)]))
        now = element.state["dissipated"]
        assert now >= lost - 1e-12
        lost = now
    assert lost > 10.0
    assert element.energy == pytest.approx(0.0, abs=1e-10 * lost)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"spread": {"negative_spread": [[0.0, 0.1]]}}, "places and shares"),
        ({"spread": {"negative_spread": [[0.0, 0.1], [1.0]]}}, "one share per rotation"),
        ({"spread": {"negative_spread": [[0.0, 0.1], [0.8, 0.9]]}}, "ends with all"),
        ({"spread": {"negative_spread": [[0.1, 0.2], [0.8, 1.0]]}}, "begins at 0"),
        ({"spread": {"negative_spread": [[0.0, 0.1, 0.2], [0.8, 0.7, 1.0]]}}, "do not fall"),
        ({"spread": {"positive_spread": [[0.0, 0.1], [0.0, 1.0]]}}, "positive"),
        ({"coupling": NONE}, "one measure of softening"),
        ({"form": REGULARISED}, "not regularised"),
    ],
)
def test_spreads_that_make_no_sense_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        _kernels.spatial.HingeElement(made(**change))


@pytest.mark.parametrize("softening", [PEAK, ACCUMULATED])
def test_a_hinge_breaks_in_the_step_that_reaches_its_angle(softening):
    element = rig(made(softening=softening) | {"fracture": 0.1005})
    led(element, [0.0, 1.0], 0.12)
    assert element.state["fracture_time"] == pytest.approx(0.1005, abs=0.1 * H)
