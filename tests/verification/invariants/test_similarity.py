"""Similarity: structures that differ in size alone do the same (Cauchy's similarity).

With all lengths, walls too, times f, times and durations times f, masses times f^3 and the same speeds,
stresses and strains are the same at the same share of the time: rotations are equal, displacements f times,
energies f^3 times those of the structure that was scaled.  It holds without gravity and without strain rates,
for everything that a model contains: laws, elastic members, their dampers, contact.  The frequency above
which vibration is not resolved is divided by f here; it is a setting, not a property of the structure.  Where
and when contacts open and close differs by rounding, with it the steps, and rotations after it by 4e-4 rad at
most (found: 2.6e-4; the results state errors of 12e-4 to 50e-4 rad).

With the time constant of the dampers of elastic members 0.01 ms for every size, rotations of the portal
differed by up to 6 % at f = 0.3, and by up to 18 % where it meets the wall.

Kind: invariant.  Source: derived here.
"""

import pytest

from crumple.analysis import Analysis, solve
from crumple.structure import MultibodySettings, Outputs, Structure

STEEL = {
    "youngs_modulus": 210e9,
    "poissons_ratio": 0.3,
    "density": 7850.0,
    "yield_stress": 350e6,
    "hardening": {"type": "swift", "prestrain": 0.005, "exponent": 0.15},
}
WALL = {"type": "plane", "normal": (-1, 0, 0), "friction": 0.2}


def portal(f, across, wall):
    """A portal with a mass thrown along its beam, `f` times as large; `across`: in space."""
    tube = {"type": "rectangular_tube", "width": f * 0.04, "depth": f * 0.06, "thickness": f * 0.002}
    aside, high = 0.1 * f * across, 0.45 * f
    beside = {"section": "tube", "material": "steel"}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": tube},
        nodes={"f1": (0, 0, 0), "k1": (0, 0, high), "k2": (0.6 * f, aside, high), "f2": (0.6 * f, aside, 0)},
        members={
            "left": {"nodes": ("f1", "k1"), **beside},
            "beam": {"nodes": ("k1", "k2"), **beside},
            "right": {"nodes": ("k2", "f2"), **beside},
        },
        hinges="auto",
        supports={"s_f1": {"node": "f1", "fix": "all"}, "s_f2": {"node": "f2", "fix": "all"}},
        masses={"payload": {"node": "k1", "mass": 60.0 * f**3}},
        obstacles={"wall": {**WALL, "point": (0.66 * f, 0, 0)}} if wall else {},
        initial_velocity=[{"nodes": ("k1",), "translation": (9.0, 2.0 * across, 0.0)}],
    )


def solved(f, members, across, wall):
    """Result of the portal `f` times as large."""
    settings = MultibodySettings(mechanism_check="off", members=members, resolved_frequency=500.0 / f)
    outputs = Outputs(every=0.5e-3 * f, nodes=("k1", "k2"))
    structure = portal(f, across, wall)
    return solve(Analysis(structure=structure, duration=0.03 * f, multibody=settings, outputs=outputs))


@pytest.mark.parametrize("across", [False, True], ids=["plane", "space"])
@pytest.mark.parametrize("members", ["elastic", "rigid"])
@pytest.mark.parametrize("wall", [False, True], ids=["free", "wall"])
def test_frames_of_another_size_do_the_same(members, across, wall, record_figure):
    room = {"rel": 2e-3, "abs": 4e-4} if wall else {"rel": 5e-4}
    one = solved(1.0, members, across, wall)
    assert max(abs(hinge.rotation_max) for hinge in one.hinges.values()) > 0.09
    for factor in (0.3, 4.0):
        other = solved(factor, members, across, wall)
        assert other.hinges.keys() == one.hinges.keys()
        for name, hinge in one.hinges.items():
            assert other.hinges[name].rotation_max == pytest.approx(hinge.rotation_max, **room)
        largest = max(one.hinges, key=lambda name: one.hinges[name].rotation_max)
        where = f"{members} members in {'space' if across else 'a plane'}, {'a wall' if wall else 'free'}"
        turned = (result.hinges[largest].rotation_max for result in (other, one))
        record_figure(f"largest rotation, {where}, x{factor:g}", *turned, room["rel"], "rad", relative=True)
    assert sum(hinge.energy for hinge in other.hinges.values()) / factor**3 == pytest.approx(
        sum(hinge.energy for hinge in one.hinges.values()), rel=room["rel"]
    )
