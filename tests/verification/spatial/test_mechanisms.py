"""Mechanisms without dissipation: closed loops, redundant joints, singular positions, springs, drives.

Bricard's mechanism, the N four-bar mechanism and the flyball governor are problems A04, A02 and A05 of the
IFToMM library of computational benchmark problems (lim.ii.udc.es/mbsbenchmark).  Their bodies and joints
are taken from its specification of A02 and from models published for OpenSim (RehabEngGroup,
MBSbenchmarksInOpenSim) and MATLAB; their motion from our own integrations in the fewest coordinates, with
the energy or Lagrange's equations.  Slider-crank and four-bar linkage have closed forms of their positions.

Kind: independent calculation; closed form.  Source: read; derived here.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.support.multibody.space_models import GRAVITY, bar, started, with_mass

from crumple._core.spatial.model import (
    GROUND,
    SpatialBody,
    SpatialDrive,
    SpatialModel,
    SpatialSpring,
    prismatic,
    revolute,
)
from crumple._core.spatial.simulation import SpatialSimulation

Z = (0.0, 0.0, 1.0)
DOWN = (0.0, -GRAVITY, 0.0)


def turning(angle, axis):
    """Rotation matrix about a unit axis."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


# corners of Bricard's mechanism: five rods of 1 m, the sixth link is the ground
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], float)
LINKS = np.array([CORNERS[(k + 1) % 6] - CORNERS[k] for k in range(6)])
AXES = np.array([np.cross(LINKS[k - 1], LINKS[k]) for k in range(6)])
ABOUT_ROD = 0.1**2 / 6


def bricard(accuracy):
    bodies = tuple(bar(CORNERS[k], CORNERS[k + 1], 1.0, ABOUT_ROD) for k in range(5))
    joints = tuple(
        revolute(k - 1 if k > 0 else GROUND, k if k < 5 else GROUND, CORNERS[k], AXES[k]) for k in range(6)
    )
    return SpatialSimulation(SpatialModel(bodies, joints, gravity=DOWN), accuracy)


class BricardByHand:
    """Places and speeds of the rods from the six joint angles, the other five found from the first."""

    def __init__(self):
        self.angles = np.zeros(6)

    def chain(self, angles):
        turn, place, frames = np.eye(3), np.zeros(3), []
        for k in range(5):
            turn = turn @ turning(angles[k], AXES[k])
            frames.append((turn, place + turn @ LINKS[k] / 2))
            place = place + turn @ LINKS[k]
        return frames, place, turn @ turning(angles[5], AXES[5])

    def closure(self, angles):
        _, place, turn = self.chain(angles)
        return np.concatenate([place - CORNERS[5], [turn[2, 1], turn[0, 2], turn[1, 0]]])

    def jacobian(self, angles):
        columns = [
            (self.closure(angles + step) - self.closure(angles - step)) / 2e-6 for step in 1e-6 * np.eye(6)
        ]
        return np.array(columns).T

    def solve(self, first):
        angles = self.angles.copy()
        angles[0] = first
        for _ in range(20):
            change = np.linalg.lstsq(self.jacobian(angles)[:, 1:], -self.closure(angles), rcond=1e-7)[0]
            angles[1:] += change
            if abs(change).max() < 1e-13:
                break
        self.angles = angles
        rates = np.linalg.lstsq(self.jacobian(angles)[:, 1:], -self.jacobian(angles)[:, 0], rcond=1e-7)[0]
        return angles, np.concatenate([[1.0], rates])

    def inertia_and_height(self, first):
        """Twice the kinetic energy at unit rate, and the sum of heights of the centres times their masses."""
        angles, rates = self.solve(first)
        frames, _, _ = self.chain(angles)
        omega, speed, turn, total, height = np.zeros(3), np.zeros(3), np.eye(3), 0.0, 0.0
        for k, (frame, centre) in enumerate(frames):
            omega = omega + turn @ AXES[k] * rates[k]
            turn, along = frame, frame @ LINKS[k]
            middle = speed + np.cross(omega, along) / 2
            spin = omega @ along
            total += middle @ middle + (omega @ omega - spin**2) / 12 + ABOUT_ROD * spin**2
            speed = speed + np.cross(omega, along)
            height += centre[1]
        return total, height


def test_bricard(record_figure):
    """Time at which the first rod has come to each angle: from the energy, by quadrature over the angle."""
    simulation = bricard(1e-6)
    assert simulation.freedoms == (1, 1)
    times = np.linspace(0.0, 0.6, 61)[1:]
    record = simulation.run(times)
    hand = BricardByHand()
    place = record.centre[-1, 0]
    angle = math.atan2(np.cross(LINKS[0], place) @ AXES[0], LINKS[0] @ place)
    _, start = hand.inertia_and_height(0.0)
    # angle = s^2 takes the root at the start out of the quadrature
    nodes, weights = np.polynomial.legendre.leggauss(24)
    root = math.sqrt(abs(angle))
    time = 0.0
    for node, weight in sorted(zip(nodes, weights, strict=True)):
        s = root * (node + 1) / 2
        inertia, height = hand.inertia_and_height(math.copysign(s * s, angle))
        rate = math.sqrt(2 * GRAVITY * (start - height) / inertia)
        time += weight * root / 2 * 2 * s / rate
    record_figure("time to reach the angle at 0.6 s", time, 0.6, 1e-5, "s")


def test_bricard_keeps_its_energy(record_figure):
    record = bricard(1e-4).run(np.linspace(0.0, 10.0, 11)[1:])
    assert record.outcome == 0
    record_figure("energy residual over 10 s, accuracy 1e-4", record.residual, 0.0, 1e-3)


def four_bars(windows, accuracy):
    """N four-bar mechanism of rods of 1 m and 1 kg, upright, the top moving at 1 m/s."""
    bodies = [bar((i, 0, 0), (i, 1, 0), 1.0) for i in range(windows + 1)]
    bodies += [bar((i, 1, 0), (i + 1, 1, 0), 1.0) for i in range(windows)]
    joints = [revolute(GROUND, i, (i, 0, 0), Z) for i in range(windows + 1)]
    for i in range(windows):
        top = windows + 1 + i
        joints += [revolute(i, top, (i, 1, 0), Z), revolute(top, i + 1, (i + 1, 1, 0), Z)]
    velocity = [[0, 0, -1, 0.5, 0, 0]] * (windows + 1) + [[0, 0, 0, 1, 0, 0]] * windows
    return started(SpatialModel(tuple(bodies), tuple(joints), gravity=DOWN), velocity, accuracy)


@pytest.mark.parametrize("windows", [2, pytest.param(40, marks=pytest.mark.slow)])
def test_four_bars_pass_singular_positions(windows, record_figure):
    """All cranks stay parallel; lying flat, the mechanism has N + 1 freedoms. Place of B0 over 10 s."""
    cranks, moment = windows + 1, (windows + 1) / 2 + windows
    inertia = cranks / 3 + windows

    def motion(t, y):
        return y[1], moment * GRAVITY * math.sin(y[0]) / inertia

    simulation = four_bars(windows, 1e-5)
    assert simulation.freedoms == (1, 3 * windows)
    times = np.linspace(0.0, 10.0, 201)[1:]
    record = simulation.run(times)
    assert record.outcome == 0
    angle = solve_ivp(motion, (0, 10), (0.0, 1.0), "DOP853", times, rtol=1e-12, atol=1e-12).y[0]
    assert angle[-1] > 4 * math.pi
    by_hand = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    error = np.abs(2 * record.centre[:, 0, :2] - by_hand).max()
    record_figure(f"error of B0 in 10 s, {windows} windows", error, 0.0, 1e-3, "m")
    record_figure(f"energy residual, {windows} windows", record.residual, 0.0, 1e-5)


# flyball governor: shaft and rods of 1 m and 10 mm square, slider a cube of 0.1 m, all of 3000 kg/m^3
ROD_MASS, BALL, SLIDER = 3000.0 * 1e-4, 5.0, 3.0
STIFFNESS, DAMPING, FREE = 8e5, 4e4, 0.5
ALONG_ROD = ROD_MASS * 0.01**2 / 6


def governor(accuracy):
    shaft = bar((0, 0, 0), (0, 0, 1), ROD_MASS, ALONG_ROD)
    slope = np.array([math.cos(math.radians(30.0)), 0.0, -math.sin(math.radians(30.0))])
    rods, tops = [], []
    for side in (1.0, -1.0):
        top = np.array([0.05 * side, 0.0, 1.0])
        end = top + slope * (side, 1.0, 1.0)
        rods.append(with_mass(bar(top, end, ROD_MASS, ALONG_ROD), end, BALL))
        tops.append((top, (top + end) / 2))
    slider = SpatialBody(SLIDER, SLIDER * 0.01 / 6 * np.eye(3), np.array([0.0, 0.0, 0.5]))
    joints = (
        revolute(GROUND, 0, np.zeros(3), Z),
        prismatic(0, 3, slider.centre, Z),
        revolute(0, 1, tops[0][0], (0, 1, 0)),
        revolute(0, 2, tops[1][0], (0, 1, 0)),
    )
    springs = tuple(
        SpatialSpring(
            3, 1 + k, slider.centre + np.array([0.05 * side, 0, 0]), tops[k][1], STIFFNESS, FREE, DAMPING
        )
        for k, side in enumerate((1.0, -1.0))
    )
    model = SpatialModel((shaft, *rods, slider), joints, springs=springs, gravity=(0, 0, -GRAVITY))
    omega = (0.0, 0.0, 2 * math.pi)
    velocity = [np.concatenate([omega, np.cross(omega, b.centre)]) for b in model.bodies]
    return started(model, velocity, accuracy)


def governor_by_hand(times):
    """Place of the slider: Lagrange's equations in the angle of the rods below the horizontal and that place.

    The angular momentum about the shaft is constant.
    """
    # a rod with its ball: mass, first and second moment about its top, along it; second moment across
    mass, first = ROD_MASS + BALL, ROD_MASS / 2 + BALL
    second = ROD_MASS / 3 + BALL
    rest = ALONG_ROD + SLIDER * 0.01 / 6

    def spin_inertia(a):
        c, s = math.cos(a), math.sin(a)
        rod = mass * 0.05**2 + 2 * 0.05 * first * c + second * c * c + ALONG_ROD * s * s
        slope = -2 * 0.05 * first * s - 2 * second * c * s + 2 * ALONG_ROD * s * c
        return rest + 2 * rod, 2 * slope

    momentum = spin_inertia(math.radians(30.0))[0] * 2 * math.pi

    def motion(t, y):
        a, da, z, dz = y
        c, s = math.cos(a), math.sin(a)
        # from the slider's eye to the rod's middle: both lie 0.05 m off the shaft
        x, up = 0.5 * c, 1.0 - 0.5 * s - z
        length = math.hypot(x, up)
        dx, dup = -0.5 * s * da, -0.5 * c * da - dz
        force = STIFFNESS * (length - FREE) + DAMPING * (x * dx + up * dup) / length
        inertia, slope = spin_inertia(a)
        # the spring's force on the rod's middle points to the slider
        moment = first * GRAVITY * c - force * (x * -0.5 * s + up * -0.5 * c) / length
        moment += momentum**2 * slope / (2 * inertia**2) / 2
        return da, moment / second, dz, -GRAVITY + 2 * force * up / length / SLIDER

    start = (math.radians(30.0), 0.0, 0.5, 0.0)
    return solve_ivp(motion, (0, times[-1]), start, "Radau", times, rtol=1e-10, atol=1e-12).y[2]


@pytest.mark.slow
def test_flyball_governor(record_figure):
    """Couplers of 800 kN/m with dampers of 40 kN s/m: stiff, with a time of decay of microseconds."""
    times = np.linspace(0.0, 10.0, 101)[1:]
    record = governor(1e-5).run(times)
    assert record.outcome == 0
    error = np.abs(record.centre[:, 3, 2] - governor_by_hand(times)).max()
    record_figure("error of the slider's place in 10 s", error, 0.0, 1e-3, "m")
    assert record.residual < 1e-3


def slider_crank(rate):
    """Crank of 0.1 m turned at a constant rate from the dead centre, rod of 0.3 m, slider along x."""
    crank, rod = bar((0, 0, 0), (0.1, 0, 0)), bar((0.1, 0, 0), (0.4, 0, 0))
    slider = SpatialBody(2.0, 0.01 * np.eye(3), np.array([0.4, 0.0, 0.0]))
    joints = (
        revolute(GROUND, 0, np.zeros(3), Z),
        revolute(0, 1, (0.1, 0, 0), Z),
        revolute(1, 2, (0.4, 0, 0), Z),
        prismatic(GROUND, 2, (0.4, 0, 0), (1, 0, 0)),
    )
    held = (True, True, True, True, True, True)
    driven = type(joints[0])(GROUND, 0, np.zeros(3), joints[0].axes, held)
    drive = SpatialDrive(0, 3, np.zeros(1), np.array([rate]))
    model = SpatialModel((crank, rod, slider), (driven, *joints[1:]), drives=(drive,), length=0.4)
    velocity = np.zeros((3, 6))
    return started(model, velocity, 1e-5)


def test_slider_crank(record_figure):
    """Place, speed and acceleration of the slider, and the drive's work against its kinetic energy."""
    rate = 20.0
    times = np.linspace(0.0, 2 * math.pi / rate, 41)[1:]
    record = slider_crank(rate).run(times)
    a = rate * times
    below = np.sqrt(0.09 - (0.1 * np.sin(a)) ** 2)
    place = 0.1 * np.cos(a) + below
    speed = rate * (-0.1 * np.sin(a) - 0.01 * np.sin(a) * np.cos(a) / below)
    record_figure("error of the place", np.abs(record.centre[:, 2, 0] - place).max(), 0.0, 1e-10, "m")
    record_figure("error of the speed", np.abs(record.velocity[:, 2, 3] - speed).max(), 0.0, 1e-7, "m/s")
    assert record.residual < 1e-4


def test_four_bar(record_figure):
    """Rocker's angle of a four-bar linkage a, b, c, d from its crank's (Freudenstein's closed form)."""
    a, b, c, d = 0.1, 0.35, 0.25, 0.3
    rate = 10.0

    def rocker(crank):
        k = np.hypot(d - a * np.cos(crank), a * np.sin(crank))
        return (
            math.pi
            - np.arctan2(a * np.sin(crank), d - a * np.cos(crank))
            - np.arccos((c * c + k * k - b * b) / (2 * c * k))
        )

    first = 0.5
    points = [np.zeros(3), a * np.array([math.cos(first), math.sin(first), 0.0])]
    points += [np.array([d, 0, 0]) + c * np.array([math.cos(rocker(first)), math.sin(rocker(first)), 0.0])]
    points += [np.array([d, 0.0, 0.0])]
    assert np.linalg.norm(points[2] - points[1]) == pytest.approx(b)
    bodies = tuple(bar(points[k], points[k + 1]) for k in range(3))
    joints = [revolute(k - 1, k, points[k], Z) for k in range(3)] + [revolute(2, GROUND, points[3], Z)]
    joints[0] = type(joints[0])(GROUND, 0, points[0], joints[0].axes, (True,) * 6)
    model = SpatialModel(
        bodies, tuple(joints), drives=(SpatialDrive(0, 3, np.zeros(1), np.array([rate])),), length=0.3
    )
    simulation = started(model, np.zeros((3, 6)), 1e-5)
    times = np.linspace(0.0, 2 * math.pi / rate, 33)[1:]
    record = simulation.run(times)
    ends = 2 * record.centre[:, 2] - points[3]
    found = np.arctan2(ends[:, 1], ends[:, 0] - d)
    error = np.abs(found - rocker(first + rate * times)).max()
    record_figure("error of the rocker's angle", error, 0.0, 1e-9, "rad")
