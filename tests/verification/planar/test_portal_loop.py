"""Portal frame with four hinges struck sideways: a closed loop with one degree of freedom.

Source: energy balance, exact for a mechanism of one coordinate whose hinges rotate in one sense: the frame
stops when the areas under the curves of the hinges equal the kinetic energy.  The angles follow from the
closure of the four-bar linkage, solved here independently; the time of rest is the integral of the
coordinate over its rate.  Frame A(0,0) B(0,.5) C(1,.6) D(1,0) with 20 kg at the middle of BC; BC starts
with 10 m/s along x, and the columns rotate with it.  The tolerance is the requested accuracy, 1e-4.

Kind: independent calculation.  Source: derived here.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, fsolve

from crumple.hinge import absorbed_energy
from crumple.multibody import Run, lower, solve_multibody
from crumple.result import Result
from crumple.structure import MultibodySettings, Outputs, Structure, placed_hinges

SPEED, PAYLOAD = 10.0, 20.0
HEIGHTS, SPAN = (0.5, 0.6), 1.0
TOP = math.hypot(SPAN, HEIGHTS[1] - HEIGHTS[0])


def portal(law: dict[str, object], *, feet: str = "clamped") -> Structure:
    left = [{"name": "A", "at": "a", "offset": 0.0, "law": law}] if feet == "clamped" else []
    right = [{"name": "D", "at": "d", "offset": 0.0, "law": law}] if feet == "clamped" else []
    tube = {"section": "tube", "material": "steel"}
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
    fix = "all" if feet == "clamped" else "pin"
    return Structure(
        materials={"steel": steel},
        sections={"tube": {"type": "rectangular_tube", "width": 0.05, "depth": 0.025, "thickness": 0.00265}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.5), "m": (0.5, 0, 0.55), "c": (1, 0, 0.6), "d": (1, 0, 0)},
        members={
            "left": {"nodes": ("a", "b"), **tube, "hinges": [*left, {"name": "B", "at": "b", "law": law}]},
            "top_left": {"nodes": ("b", "m"), **tube},
            "top_right": {"nodes": ("m", "c"), **tube},
            "right": {"nodes": ("c", "d"), **tube, "hinges": [{"name": "C", "at": "c", "law": law}, *right]},
        },
        supports={"left_foot": {"node": "a", "fix": fix}, "right_foot": {"node": "d", "fix": fix}},
        masses={"payload": {"node": "m", "mass": PAYLOAD}},
        initial_velocity=[
            {"translation": (SPEED, 0, 0), "nodes": ("m",), "members": ("top_left", "top_right")},
            {"rotation": SPEED / HEIGHTS[0], "axis": (0, 1, 0), "members": ("left",)},
            {"rotation": SPEED / HEIGHTS[1], "axis": (0, 1, 0), "about": (1, 0, 0), "members": ("right",)},
        ],
    )


def solved(structure: Structure, accuracy: float = 1e-4, duration: float = 0.06) -> Result:
    settings = MultibodySettings(accuracy=accuracy)
    run = Run(duration=duration, every=1e-3, settings=settings, outputs=Outputs(nodes=("b", "c", "m")))
    return solve_multibody(structure, run)


def linkage(a: float) -> np.ndarray:
    """Turns about +y of right column and top for a turn `a` of the left column, from the closure alone."""
    lean = math.atan2(HEIGHTS[1] - HEIGHTS[0], SPAN)

    def open_end(unknown: np.ndarray) -> list[float]:
        right, top = unknown
        x = HEIGHTS[0] * math.sin(a) + TOP * math.cos(lean - top) - SPAN - HEIGHTS[1] * math.sin(right)
        z = HEIGHTS[0] * math.cos(a) + TOP * math.sin(lean - top) - HEIGHTS[1] * math.cos(right)
        return [x, z]

    return np.asarray(fsolve(open_end, (a * HEIGHTS[0] / HEIGHTS[1], 0.0), xtol=1e-13))


def turns(a: float) -> np.ndarray:
    """Absolute rotations of hinges A, B, C, D."""
    right, top = linkage(a)
    return np.abs([a, top - a, right - top, right])


def start_energy(structure: Structure) -> float:
    section, steel = structure.section_of("left"), structure.material_of("left")
    mu, rho = section.mass_per_length(steel.density), steel.density * section.second_moment("y")
    columns = sum((mu * h**3 / 3 + rho * h) / 2 * (SPEED / h) ** 2 for h in HEIGHTS)
    return columns + (mu * TOP + PAYLOAD) / 2 * SPEED**2


@pytest.mark.parametrize(
    "law", [{"type": "constant", "moment": 1000.0}, {"type": "kecman"}], ids=lambda law: law["type"]
)
def test_the_frame_stops_where_the_hinges_have_taken_the_energy(law, record_figure) -> None:
    structure = portal(law)
    result, energy = solved(structure), start_energy(structure)
    formula = placed_hinges(structure)[0].law

    def left_over(a: float) -> float:
        return energy - sum(float(absorbed_energy(formula, turn)) for turn in turns(a))

    stop = brentq(left_over, 1e-3, 1.0, xtol=1e-12)
    for name, turn in zip("ABCD", turns(stop), strict=True):
        got = result.hinges[name].rotation_max
        record_figure(
            f"{law['type']}, largest rotation of hinge {name}", got, turn, 1e-4, "rad", relative=True
        )
    assert result["energy.kinetic"][0] == pytest.approx(energy, rel=1e-12)
    record_figure(f"{law['type']}, energy residual", result.energy_residual, 0.0, 1e-4)


def test_the_time_of_rest_follows_from_the_energy_on_the_way(record_figure) -> None:
    structure = portal({"type": "constant", "moment": 1000.0})
    result, energy = solved(structure), start_energy(structure)
    section, steel = structure.section_of("left"), structure.material_of("left")
    mu, rho = section.mass_per_length(steel.density), steel.density * section.second_moment("y")

    def rate(a: float) -> float:
        """Turning rate of the left column after a turn a, from what energy is left and the inertia there."""
        step = 1e-5
        (right, top), (right_before, top_before) = linkage(a + step), linkage(a - step)
        right, top = (right - right_before) / (2 * step), (top - top_before) / (2 * step)
        lean = math.atan2(HEIGHTS[1] - HEIGHTS[0], SPAN) - linkage(a)[1]
        # velocity of the top's middle: that of B and the top's own turn about +y
        x = HEIGHTS[0] * math.cos(a) + top * TOP / 2 * math.sin(lean)
        z = -HEIGHTS[0] * math.sin(a) - top * TOP / 2 * math.cos(lean)
        inertia = (mu * TOP + PAYLOAD) * (x * x + z * z) + (mu * TOP**3 / 12 + rho * TOP) * top**2
        inertia += mu * HEIGHTS[0] ** 3 / 3 + rho * HEIGHTS[0]
        inertia += (mu * HEIGHTS[1] ** 3 / 3 + rho * HEIGHTS[1]) * right**2
        return math.sqrt(2 * max(energy - 1000.0 * turns(a).sum(), 0.0) / inertia)

    stop = brentq(lambda a: energy - 1000.0 * turns(a).sum(), 1e-3, 1.0, xtol=1e-13)
    # a = stop (1 - s^2) takes the singularity of 1/rate out of the integral
    time, _ = quad(lambda s: 2 * s * stop / rate(stop * (1 - s * s)), 1e-6, 1.0, epsrel=1e-8)
    for name in "ABCD":
        rest = result.hinges[name].time_of_rest
        assert rest is not None
        record_figure(f"time of rest of hinge {name}", rest * 1e3, time * 1e3, 5e-3, "ms", relative=True)


def test_the_loop_stays_closed() -> None:
    result = solved(portal({"type": "kecman"}))
    bx, bz = result["node.b.displacement.x"], result["node.b.displacement.z"] + 0.5
    cx, cz = result["node.c.displacement.x"], result["node.c.displacement.z"] + 0.6
    np.testing.assert_allclose(np.hypot(bx, bz), 0.5, atol=1e-12)
    np.testing.assert_allclose(np.hypot(cx, cz), 0.6, atol=1e-6)
    np.testing.assert_allclose(np.hypot(cx + SPAN - bx, cz - bz), TOP, atol=1e-6)


def test_second_order() -> None:
    """Halving the step divides the opening of the loop by four."""
    opened = []
    for every in (2e-3, 1e-3, 5e-4):
        settings = MultibodySettings(accuracy=0.1)
        run = Run(duration=0.02, every=every, settings=settings, outputs=Outputs(nodes=("c",)))
        result = solve_multibody(portal({"type": "constant", "moment": 1000.0}), run)
        c = [result["node.c.displacement.x"], result["node.c.displacement.z"] + 0.6]
        opened.append(np.abs(np.hypot(*c) - 0.6).max())
    rates = np.log2(np.array(opened[:-1]) / opened[1:])
    assert (rates > 1.7).all(), (opened, rates)


def test_pinned_feet_close_a_loop_with_the_ground_too() -> None:
    structure = portal({"type": "constant", "moment": 1000.0}, feet="pinned")
    mechanism = lower(structure)
    assert mechanism.pin_joints == {"a"}
    result, energy = solved(structure, duration=0.09), start_energy(structure)

    def left_over(a: float) -> float:
        return energy - 1000.0 * turns(a)[1:3].sum()

    stop = brentq(left_over, 1e-3, 1.2, xtol=1e-12)
    for name, turn in zip("BC", turns(stop)[1:3], strict=True):
        assert result.hinges[name].rotation_max == pytest.approx(turn, rel=1e-4)


def test_an_impulse_on_a_cut_body_gives_what_its_mass_takes() -> None:
    """A blow of 20 kg times 10 m/s on the payload alone: the frame starts with what its inertia leaves."""
    struck = portal({"type": "constant", "moment": 1000.0})
    blow = {"node": "m", "impulse": (PAYLOAD * SPEED, 0.0, 0.0)}
    struck = Structure.model_validate(struck.model_dump() | {"initial_velocity": [], "impulses": [blow]})
    moved, given = solved(struck), solved(portal({"type": "constant", "moment": 1000.0}))
    # one coordinate: J^2/(2 I) where the whole frame at SPEED has I SPEED^2/2, and J = PAYLOAD SPEED
    share = PAYLOAD * SPEED**2 / (2 * start_energy(struck))
    assert moved["energy.kinetic"][0] == pytest.approx(share**2 * given["energy.kinetic"][0], rel=1e-9)
