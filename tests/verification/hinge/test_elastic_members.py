"""Elastic members: stiffness, first frequencies, and yielding that spreads are those of beam theory.

A member of six segments without hinges of its own, in both kernels.  With E I, mass per length m, length L:

    deflection of a cantilever under a force at its tip        F L^3/(3 E I)
    of a guided column                                         F L^3/(12 E I)
    first frequency                                            c^2/(2 pi L^2) sqrt(E I/m)

with c = 1.8751 clamped and free, pi between pins, 4.7300 between clamps, and for a cantilever with the mass
M at its tip the smallest root of 1 + cos c cosh c + c M/(m L) (cos c sinh c - sin c cosh c) = 0 (Euler and
Bernoulli). The kinetic energy after a blow oscillates with twice the frequency: the largest value of its
Fourier transform, with a Hann window. Between clamps six segments are 4 % off; twelve are used there.

Yield: a cantilever under a force at its tip that grows to 0.97 of the plastic moment. With the section's
moment over curvature the tip moves by the double integral of the curvature. Twelve segments give it within
3 %, the error of their quadrature.

Shear: the flow in a thin square tube of the side b is t b s/2 from the middle of its flanges and
t (3 b^2/8 - s^2/2) from that of its webs, so that A_s = 5/3 b t. Members shorter than ten depths deflect by
F L/(G A_s) more (Timoshenko), within 0.5 %.

Folds of a portal with 6 and 8 segments are those with 24 within 4 %, in at most three times the steps of
rigid bars.

An L of thick tubes thrown at its tip, whose folds turn by 1 degree: displacements of the shell model of the
same input (10 mm elements, 5 mm in the folds), solved once by this program, within 15 % (found: 12 and 12 %;
it starts with 7 % less energy than shells, because members do not lengthen and its tip is thrown partly along
one. With laws at the yield stress found: 9 and 11 %, and with dampers three times as strong, which take what
ends in the folds, 16 and 13 %).

Kind: closed form; invariant; independent calculation.  Source: textbook; derived here; run here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.optimize import brentq

from crumple.analysis import loads, solve
from crumple.hinge import Freedom
from crumple.multibody import Run, solve_multibody
from crumple.section import bending_moment
from crumple.structure import (
    MultibodySettings,
    Outputs,
    Structure,
    placed_hinges,
    with_elastic_members,
)
from crumple.structure.hinges.elastic_members import shear_stretch
from crumple.structure.hinges.runs.bars import bar_of
from crumple.structure.hinges.shares import joint_twists

LENGTH = 2.0
STRONG, MILD = 3e9, 300e6
SHEAR_STIFFNESS = 210e9 / 2.6 * 5.0 / 3.0 * 0.038 * 0.002
"""G A_s of a tube of 40x40x2 mm [N]."""
KERNELS = ("tree", "spatial")
CLAMP, PIN, ROLLER = "all", ["x", "y", "z", "rx", "rz"], ["y", "z", "rx", "rz"]
GUIDE, SLEEVE = ["y", "rx", "ry", "rz"], ["y", "z", "rx", "ry", "rz"]


def beam(first, second, yield_stress=STRONG, segments=6, length=LENGTH, **keys):
    """One member along x that bends about y, without hinges: it does not fold."""
    supports = {"first": {"node": "a", "fix": first}}
    if second is not None:
        supports["second"] = {"node": "b", "fix": second}
    metal = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": yield_stress}
    return Structure(
        materials={"metal": metal},
        sections={"tube": {"type": "square_tube", "side": 0.04, "thickness": 0.002}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (length, 0.0, 0.0)},
        members={
            "beam": {
                "nodes": ("a", "b"),
                "section": "tube",
                "material": "metal",
                "elastic": segments,
                "hinges": (),
            }
        },
        supports=supports,
        **keys,
    )


def rigidity(structure):
    return structure.flexural_rigidity("beam", "y")


def mass_per_length(structure):
    return structure.mass_of_members / LENGTH


def solved(structure, duration, every, kernel, accuracy=1e-4):
    settings = MultibodySettings(
        kernel=kernel, accuracy=accuracy, mechanism_check="off", maximum_time_step=every
    )
    result = solve_multibody(structure, Run(duration, every, settings, Outputs(nodes=("b",))))
    assert result.status.ok, result.reason
    assert result.provenance.settings["kernel"] == kernel
    return result


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(("end", "factor"), [(None, 3.0), (GUIDE, 12.0)], ids=["cantilever", "guided"])
def test_stiffness_is_that_of_the_beam(kernel, end, factor, record_figure):
    force = 20.0
    pushed = {"node": "b", "force": {"z": {"step5": {"x0": 0.0, "h0": 0.0, "x1": 1.0, "h1": force}}}}
    structure = beam(CLAMP, end, loads=[pushed])
    result = solved(structure, 1.0, 0.01, kernel)
    stiffness = force / result["node.b.displacement.z"][-1]
    record_figure(
        "stiffness", stiffness, factor * rigidity(structure) / LENGTH**3, 0.005, "N/m", relative=True
    )


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("depths", [4.0, 6.0, 9.0])
@pytest.mark.parametrize(("end", "factor"), [(None, 3.0), (GUIDE, 12.0)], ids=["cantilever", "guided"])
def test_short_members_shear(kernel, depths, end, factor, record_figure):
    length, force = depths * 0.04, 20.0
    pushed = {"node": "b", "force": {"z": {"step5": {"x0": 0.0, "h0": 0.0, "x1": 1.0, "h1": force}}}}
    structure = beam(CLAMP, end, length=length, loads=[pushed])
    result = solved(structure, 1.0, 0.01, kernel)
    flexibility = length**3 / (factor * rigidity(structure)) + length / SHEAR_STIFFNESS
    found = result["node.b.displacement.z"][-1] / force
    record_figure("flexibility", found, flexibility, 0.005, "m/N", relative=True)


def test_rounding_does_not_decide_whether_a_member_of_ten_depths_shears():
    for length in (0.4, 0.4 * (1.0 - 1e-12), 0.4 * (1.0 + 1e-12)):
        whole = beam(CLAMP, None, length=length)
        assert shear_stretch(whole, bar_of(whole, "beam"), "y") == 0.0


def with_tip_mass(ratio):
    """Smallest root of the frequency equation of a cantilever with a mass over its own at the tip."""
    return brentq(
        lambda c: (
            1.0
            + math.cos(c) * math.cosh(c)
            + ratio * c * (math.cos(c) * math.sinh(c) - math.sin(c) * math.cosh(c))
        ),
        0.3,
        1.9,
    )


CASES = {
    "cantilever": (CLAMP, None, 0.0, 1.8751),
    "cantilever with a mass": (CLAMP, None, 1.5, with_tip_mass(1.5)),
    "between pins": (PIN, ROLLER, 0.0, math.pi),
    "between clamps": (CLAMP, SLEEVE, 0.0, 4.7300),
}


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("case", CASES)
def test_the_first_frequency_is_that_of_the_beam(kernel, case, record_figure):
    first, second, ratio, root = CASES[case]
    plain = beam(first, second)
    blow = {"initial_velocity": [{"translation": (0.0, 0.0, 0.5)}]}
    mass = ratio * plain.mass_of_members
    lumps = {"masses": {"tip": {"node": "b", "mass": mass}}} if mass else {}
    number = 12 if case == "between clamps" else 6
    structure = beam(first, second, segments=number, **blow, **lumps)
    expected = root**2 / (2.0 * math.pi * LENGTH**2) * math.sqrt(rigidity(plain) / mass_per_length(plain))
    duration, every = 12.0 / expected, 1.0 / (20.0 * expected)
    result = solved(structure, duration, every, kernel, accuracy=1e-4)
    record_figure("first frequency", main_frequency(result) / 2.0, expected, 0.02, "Hz", relative=True)


def main_frequency(result):
    """Frequency of the largest part of the kinetic energy's vibration [Hz]."""
    energy = result["energy.kinetic"]
    energy = (energy - energy.mean()) * np.hanning(energy.size)
    padded = 16 * energy.size
    power = np.abs(np.fft.rfft(energy, padded))
    frequency = np.fft.rfftfreq(padded, float(result.time[1] - result.time[0]))
    return float(frequency[int(np.argmax(power))])


@pytest.mark.parametrize("kernel", KERNELS)
def test_yield_spreads_as_the_section_does(kernel, record_figure):
    plain = beam(CLAMP, None, MILD, segments=12)
    section, metal = plain.section_of("beam"), plain.material_of("beam")
    plastic = metal.yield_stress * section.plastic_section_modulus("y")
    force = 0.97 * plastic / LENGTH
    pushed = {"node": "b", "force": {"z": {"step5": {"x0": 0.0, "h0": 0.0, "x1": 0.5, "h1": force}}}}
    structure = beam(CLAMP, None, MILD, segments=12, loads=[pushed])
    result = solved(structure, 0.5, 0.005, kernel, accuracy=1e-3)

    def curvature(moment):
        elastic = moment / rigidity(plain)
        if moment < metal.yield_stress * section.elastic_section_modulus("y"):
            return elastic
        return brentq(
            lambda k: float(bending_moment(section, metal, "y", np.array([k]))[0]) - moment,
            0.9 * elastic,
            100.0 * elastic,
        )

    at = np.linspace(0.0, LENGTH, 401)
    expected = float(trapezoid([curvature(force * x) * x for x in at], at))
    elastic = force * LENGTH**3 / (3.0 * rigidity(plain))
    assert expected > 1.02 * elastic
    record_figure("tip deflection", result["node.b.displacement.z"][-1], expected, 0.03, "m", relative=True)


FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes:
  left: [0 m, 0 m, 0 m]
  left_knee: [0 m, 0 m, 1 m]
  right_knee: [1.2 m, 0 m, 1 m]
  right: [1.2 m, 0 m, 0 m]
members:
  left_post: {nodes: [left, left_knee], section: tube, material: steel}
  beam: {nodes: [left_knee, right_knee], section: tube, material: steel}
  right_post: {nodes: [right_knee, right], section: tube, material: steel}
hinges: auto
supports: {left: {node: left, fix: all}, right: {node: right, fix: all}}
masses: {roof: {node: left_knee, mass: 100 kg}}
impulses: [{node: left_knee, impulse: [600 N*s, 0 N*s, 0 N*s]}]
analysis: {duration: 120 ms, multibody: {members: MEMBERS, segments: SEGMENTS, mechanism_check: off}}
"""


def frame(members, segments=6):
    result = solve_of(FRAME.replace("MEMBERS", members).replace("SEGMENTS", str(segments)))
    assert result.status.ok, result.reason
    return result


def solve_of(text):
    from crumple.analysis import solve

    return solve(loads(text))


def test_elastic_members_for_which_no_hinges_are_asked_fold_as_with_automatic_ones(record_figure):
    asked = frame("elastic")
    text = FRAME.replace("hinges: auto\n", "").replace("MEMBERS", "elastic").replace("SEGMENTS", "6")
    unasked = solve_of(text)
    assert set(unasked.hinges) == set(asked.hinges)
    for name, hinge in asked.hinges.items():
        record_figure(name, unasked.hinges[name].rotation_max, hinge.rotation_max, 1e-12, "rad")


def test_folds_do_not_depend_on_the_number_of_segments(record_figure):
    results = {number: frame("elastic", number) for number in (6, 8, 24)}

    def rotations(number):
        own = {name: hinge.rotation_max for name, hinge in results[number].hinges.items()}
        # two folds beside a corner count together
        return own | {"left_knee": own.pop("left_post-left_knee") + own.pop("beam-left_knee")}

    for name, finest in rotations(24).items():
        for number in (6, 8):
            label = f"{name}, {number} segments"
            record_figure(label, rotations(number)[name], finest, 0.04, "rad", relative=True)
    rigid = frame("rigid")
    assert results[6].provenance.settings["steps"] <= 3 * rigid.provenance.settings["steps"]
    assert results[6].energy_residual < 1e-6


CORNERS = """
crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {{tube: {{type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2 mm}}}}
nodes: {{a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 0.6 m], c: [0.5 m, 0 m, 0.6 m]{more}}}
members: {{{members}}}
hinges: auto
supports: {{a: {{node: a, fix: all}}}}
masses: {{tip: {{node: {tip}, mass: 25 kg}}}}
initial_velocity: [{{translation: [0 m/s, -3 m/s, 0 m/s], nodes: [{tip}]}}]
analysis: {{duration: 100 ms, multibody: {{mechanism_check: off}}}}
"""
BAR = "{0}{1}: {{nodes: [{0}, {1}], section: tube, material: steel}}"


def test_the_order_of_members_at_a_corner_makes_no_difference(record_figure):
    """An L thrown across its plane twists its post, which belonged to the corner's hinge if it came first."""
    found = {}
    for order in (("ab", "bc"), ("bc", "ab")):
        members = ", ".join(BAR.format(*bar) for bar in order)
        result = solve(loads(CORNERS.format(members=members, tip="c", more="")))
        assert result.status.ok, result.reason
        found[order] = {name: hinge.rotation_max for name, hinge in result.hinges.items()}
    one, other = found.values()
    assert one.keys() == other.keys() == {"ab-a", "corner-b"}
    assert min(one.values()) > 0.03
    for name, rotation in one.items():
        record_figure(
            f"rotation of {name} with the members in the other order",
            other[name],
            rotation,
            3e-3,
            "rad",
            relative=True,
        )
        assert other[name] == pytest.approx(rotation, rel=3e-3)


@pytest.mark.parametrize("order", [("ab", "bc", "cd"), ("cd", "bc", "ab")])
def test_a_member_between_corners_twists_as_a_whole(order):
    members = ", ".join(BAR.format(*bar) for bar in order)
    analysis = loads(CORNERS.format(members=members, tip="d", more=", d: [0.5 m, 0 m, 0 m]"))
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    twists = [
        component.record.elastic_stiffness
        for joint in placed_hinges(structure)
        if joint.member == "bc" and not joint.plastic and joint.spatial
        for component in joint.spatial.components
        if component.freedom is Freedom.X
    ]
    section, steel = structure.section_of("bc"), structure.material_of("bc")
    assert twists == [pytest.approx(steel.shear_modulus * section.torsion_constant / 0.5)]
    # rounding decided which of two that are equally near to the middle twists
    bar = bar_of(structure, "bc")
    for second in (0.2 - 1e-15, 0.2, 0.2 + 1e-15):
        assert joint_twists(structure, bar, [0.1, second, 0.3, 0.4]) == {second: pytest.approx(0.5)}


PORTAL = """crumple: 1
materials:
  s: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {{t: {{type: square_tube, side: 40 mm, thickness: 2 mm}}}}
nodes: {{a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 0.25 m], c: [0.5 m, 0 m, 0.25 m], d: [0.5 m, 0 m, 0 m]}}
members: {{{members}}}
hinges: auto
supports: {{a: {{node: a, fix: all}}, d: {{node: d, fix: all}}}}
masses: {{m: {{node: b, mass: 40 kg}}}}
initial_velocity: [{{nodes: [b], translation: [4 m/s, 0 m/s, {across}]}}]
analysis: {{duration: 20 ms}}
"""


@pytest.mark.parametrize("across", ["0 m/s", "1 m/s"])
def test_joints_yield_alike_whichever_member_has_the_hinge_of_a_corner(across):
    """The corner is a fold at the end of both members: what lies between it and another hinge yields."""
    bars = {
        name: f"{name}: {{nodes: [{name[0]}, {name[1]}], section: t, material: s}}"
        for name in ("ab", "bc", "cd")
    }
    found = []
    for order in (("ab", "bc", "cd"), ("bc", "ab", "cd"), ("cd", "bc", "ab")):
        analysis = loads(PORTAL.format(members=", ".join(bars[name] for name in order), across=across))
        structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
        joints = [joint for joint in placed_hinges(structure) if not joint.plastic]
        firm = max(joint.law.moment for joint in joints) / 10.0
        found.append({joint.name: joint.law.moment > firm for joint in joints})
    assert found[0] == found[1] == found[2]


THICK = """
crumple: 1
materials:
  steel:
    youngs_modulus: 210 GPa
    poissons_ratio: 0.3
    density: 7850 kg/m^3
    yield_stress: 350 MPa
    hardening: {type: voce, saturation: 120 MPa, strain: 0.08}
sections: {tube: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 3 mm}}
nodes: {o: [0 m, 0 m, 0 m], p: [0.5 m, 0 m, 0 m], q: [0.8214 m, 0 m, 0.383 m]}
members:
  first: {nodes: [o, p], section: tube, material: steel}
  second: {nodes: [p, q], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: o, fix: all}}
masses: {tip: {node: q, mass: 10 kg}}
initial_velocity: [{translation: [-1.176 m/s, 2.115 m/s, 5.238 m/s], nodes: [q]}]
analysis: {duration: 50 ms, multibody: {mechanism_check: off}}
outputs: {every: 0.2 ms, nodes: [p, q]}
"""


def test_vibration_ends_in_the_folds_and_not_in_dampers(record_figure):
    result = solve(loads(THICK))
    assert result.status.ok, result.reason
    for node, shells in (("p", 0.01974), ("q", 0.04955)):
        moved = [result[f"node.{node}.displacement.{axis}"] for axis in "xyz"]
        largest = float(np.linalg.norm(moved, axis=0).max())
        record_figure(f"largest displacement {node}", largest, shells, 0.15, "m", relative=True)
