"""Elastic-plastic hinges make members as stiff as beam theory says, in both multibody kernels.

Bending: 12 E I/L^3 of a column between a clamp and a guide, 3 E I/L^3 of a cantilever, the sway of portals
with clamped and with pinned feet by frame theory, a bent cantilever of two sections.  With
k = (I_b/b)/(I_c/h) of beam and columns, inextensible:

    clamped feet    24 E I_c/h^3 (6 k + 1)/(6 k + 4)
    pinned feet      6 E I_c/h^3 2 k/(2 k + 1)

Along and in twist: E A/L and G J/L.  Hinges lie near the ends of their members, or at uneven places.
The energy that rigid hinges leave out: M^2 L/(6 E I) with the moment M at the ends of a guided column.
The planar kernel has no quasi-static stages: there the load rises over 0.5 s, some hundred periods of the
slowest vibration.

The formulas of frame theory are those of slope and deflection; the lengths of hinges and joints, derived in
docs/theory/member_stiffness.md, are exact for linear moments.  The tolerance of 0.1 % is that of the solution
at finite, small deflection.

Kind: closed form.  Source: derived here.
"""

import re

import pytest
from tests.support.structures import STEEL, constant_law

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Stage, Structure

LAW = constant_law(1e6, form="elastic-plastic")
TUBES = {
    "tube": {"type": "square_tube", "side": 0.1, "thickness": 0.005},
    "stout": {"type": "square_tube", "side": 0.12, "thickness": 0.006},
    "flat": {"type": "rectangular_tube", "width": 0.12, "depth": 0.06, "thickness": 0.004},
}
TOLERANCE = 1e-3
FORCE = 100.0
RISE = 0.5
KERNELS = ("tree", "spatial")
GUIDE = {"node": "top", "fix": ["y", "z", "rx", "ry", "rz"]}
UNEVEN = (0.07, 0.31, 0.44, 0.58, 1.02, 1.37)


def bar(first, second, hinges=None, section="tube", **keys):
    """A member of two nodes; `hinges`: distances from its first node, None: automatic."""
    if hinges is not None:
        about = {"law": LAW, **({} if "axes" in keys else {"axis": "y"})}
        keys = {
            "hinges": [
                {"name": f"{first}{second}{i}", "at": at} | about | keys for i, at in enumerate(hinges)
            ]
        }
    else:
        keys = {"hinges": {"law": LAW} | keys}
    return {"nodes": (first, second), "section": section, "material": "steel"} | keys


def frame(nodes, members, supports, loads=()):
    return Structure(
        materials={"steel": STEEL},
        sections=TUBES,
        nodes=nodes,
        members=members,
        supports={f"s{i}": support for i, support in enumerate(supports)},
        loads=[{"node": node, kind: {axis: load()}} for node, kind, axis in loads],
    )


def load():
    """Rises smoothly to its value and stays."""
    return {"step5": {"x0": 0.0, "h0": 0.0, "x1": RISE, "h1": FORCE}}


def deflection(structure, node, quantity, kernel):
    """Displacement or rotation of a node under the whole load, over the load."""
    settings = MultibodySettings(kernel=kernel, accuracy=1e-4, members="rigid")
    stages = (Stage(name="load", kind="quasi-static", duration=RISE),) if kernel == "spatial" else ()
    result = solve_multibody(structure, Run(RISE, RISE / 20, settings, Outputs(nodes=(node,)), stages=stages))
    assert result.status.ok, result.reason
    assert result.provenance.settings["kernel"] == kernel
    assert result.energy_residual < 1e-3
    return abs(float(result[f"node.{node}.{quantity}"][-1])) / FORCE


def rigidity(section="tube", axis="y"):
    nodes = {"base": (0, 0, 0), "top": (0, 0, 1)}
    return frame(nodes, {"a": bar("base", "top", [0.1], section)}, []).flexural_rigidity("a", axis)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(
    "hinges", [None, (0.0, 1.45), (0.02,), (0.8,), (0.3, 0.9), (0.375, 0.75, 1.125), UNEVEN], ids=str
)
def test_column_between_clamp_and_guide(kernel, hinges, record_figure):
    nodes = {"base": (0, 0, 0), "top": (0, 0, 1.5)}
    structure = frame(
        nodes,
        {"col": bar("base", "top", hinges)},
        [{"node": "base", "fix": "all"}, GUIDE | {"fix": ["y", "rx", "ry", "rz"]}],
        [("top", "force", "x")],
    )
    found = 1.0 / deflection(structure, "top", "displacement.x", kernel)
    name = f"column between clamp and guide, {kernel}, hinges {hinges or 'automatic'}"
    record_figure(name, found, 12.0 * rigidity() / 1.5**3, TOLERANCE, "N/m", relative=True)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("hinges", [None, (0.0,), (0.0, 1.3), (0.1, 0.5, 1.2), (0.9,), UNEVEN], ids=str)
def test_cantilever(kernel, hinges, record_figure):
    nodes = {"base": (0, 0, 0), "top": (0, 0, 1.5)}
    structure = frame(
        nodes,
        {"col": bar("base", "top", hinges)},
        [{"node": "base", "fix": "all"}],
        [("top", "force", "x")],
    )
    found = 1.0 / deflection(structure, "top", "displacement.x", kernel)
    name = f"cantilever, {kernel}, hinges {hinges or 'automatic'}"
    record_figure(name, found, 3.0 * rigidity() / 1.5**3, TOLERANCE, "N/m", relative=True)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("feet", ["all", ["x", "y", "z", "rx", "rz"]], ids=["clamped", "pinned"])
def test_sway_of_a_portal(kernel, feet, record_figure):
    height, span = 1.2, 1.7
    nodes = {"a": (0, 0, 0), "b": (0, 0, height), "c": (span, 0, height), "d": (span, 0, 0)}
    members = {"ab": bar("a", "b"), "bc": bar("b", "c", section="stout"), "cd": bar("c", "d")}
    supports = [{"node": node, "fix": feet} for node in "ad"]
    structure = frame(nodes, members, supports, [("b", "force", "x")])
    found = 1.0 / deflection(structure, "b", "displacement.x", kernel)
    columns, ratio = rigidity(), rigidity("stout") / span / (rigidity() / height)
    if feet == "all":
        expected = 24.0 * columns / height**3 * (6.0 * ratio + 1.0) / (6.0 * ratio + 4.0)
    else:
        expected = 6.0 * columns / height**3 * 2.0 * ratio / (2.0 * ratio + 1.0)
    name = f"sway of a portal, {'clamped' if feet == 'all' else 'pinned'} feet, {kernel}"
    record_figure(name, found, expected, TOLERANCE, "N/m", relative=True)


@pytest.mark.parametrize("kernel", KERNELS)
def test_bent_cantilever_of_two_sections(kernel, record_figure):
    """The arm bends as a cantilever, the column under it uniformly: F a^3/(3 E I_2) + F a^2 h/(E I_1)."""
    height, arm = 1.1, 0.8
    nodes = {"a": (0, 0, 0), "b": (0, 0, height), "c": (arm, 0, height)}
    members = {"ab": bar("a", "b"), "bc": bar("b", "c", section="stout")}
    structure = frame(nodes, members, [{"node": "a", "fix": "all"}], [("c", "force", "z")])
    found = deflection(structure, "c", "displacement.z", kernel)
    expected = arm**3 / (3.0 * rigidity("stout")) + arm**2 * height / rigidity()
    record_figure(f"bent cantilever, {kernel}", found, expected, TOLERANCE, "m/N", relative=True)


@pytest.mark.parametrize(("axis", "about"), [("x", "y"), ("y", "z")])
def test_column_that_bends_both_ways(axis, about, record_figure):
    """Hinges about both axes of an unequal section, each with its own joint."""
    nodes = {"base": (0, 0, 0), "top": (0, 0, 1.5)}
    member = bar("base", "top", (0.05, 1.4), "flat", axes=["y", "z"], coupling="none") | {"up": (1, 0, 0)}
    guide = GUIDE | {"fix": ["rx", "ry", "rz", "y" if axis == "x" else "x"]}
    structure = frame(
        nodes, {"col": member}, [{"node": "base", "fix": "all"}, guide], [("top", "force", axis)]
    )
    found = 1.0 / deflection(structure, "top", f"displacement.{axis}", "spatial")
    expected = 12.0 * rigidity("flat", about) / 1.5**3
    record_figure(f"column about its {about} axis", found, expected, TOLERANCE, "N/m", relative=True)


@pytest.mark.parametrize(
    ("with_part", "without"),
    [((0.1,), ()), ((0.05, 1.4), ()), ((0.2, 0.5), (1.3,)), ((0.1, 0.4, 1.1), (0.7, 1.2))],
    ids=str,
)
@pytest.mark.parametrize("along", [True, False], ids=["along", "twist"])
def test_axial_and_torsional_stiffness(along, with_part, without, record_figure):
    """Hinges that lengthen or twist share all of the member, those that do not take no part."""
    nodes = {"base": (0, 0, 0), "top": (0, 0, 1.5)}
    keys = {"axial": True} if along else {"axes": ["x", "y"]}
    own = bar("base", "top", with_part, "flat", coupling="none", **keys)
    own["hinges"] += [{"name": f"n{i}", "at": at, "law": LAW, "axis": "y"} for i, at in enumerate(without)]
    structure = frame(
        nodes,
        {"col": own},
        [{"node": "base", "fix": "all"}],
        [("top", "force" if along else "moment", "z")],
    )
    found = 1.0 / deflection(structure, "top", "displacement.z" if along else "rotation.z", "spatial")
    section, metal = structure.section_of("col"), structure.material_of("col")
    if along:
        expected, unit = metal.youngs_modulus * section.area / 1.5, "N/m"
    else:
        expected, unit = metal.shear_modulus * section.torsion_constant / 1.5, "N m/rad"
    name = f"{'axial' if along else 'torsional'} stiffness, hinges {with_part}, {len(without)} without"
    record_figure(name, found, expected, TOLERANCE, unit, relative=True)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("hinges", [(0.1, 1.4), (0.1, 0.4, 1.4)], ids=str)
def test_elastic_energy_that_rigid_hinges_leave_out(kernel, hinges, record_figure):
    """A guided column is struck; its outer hinges yield, and the moment is linear between them."""
    moment, length = 2e4, 1.5
    law = constant_law(moment)
    # the inner hinge, at 0.4 m, stays below its capacity
    given = [{"name": f"h{i}", "at": at, "law": law, "axis": "y"} for i, at in enumerate(hinges)]
    structure = Structure(
        materials={"steel": STEEL},
        sections=TUBES,
        nodes={"base": (0, 0, 0), "top": (0, 0, length)},
        members={"col": {"nodes": ("base", "top"), "section": "tube", "material": "steel", "hinges": given}},
        supports={
            "base": {"node": "base", "fix": "all"},
            "guide": {"node": "top", "fix": ["y", "rx", "ry", "rz"]},
        },
        masses={"top": {"node": "top", "mass": 500.0}},
        impulses=[{"node": "top", "impulse": (500.0 * 3.0, 0.0, 0.0)}],
    )
    result = solve_multibody(structure, Run(0.05, 0.001, MultibodySettings(kernel=kernel)))
    (match,) = [found for text in result.warnings if (found := re.search(r"up to (\S+) J elastically", text))]
    at_ends = moment * length / (1.4 - 0.1)
    expected = at_ends**2 * length / (6.0 * rigidity())
    name = f"energy that {len(hinges)} rigid hinges leave out, {kernel}"
    # inertia of the column bends the line of moments a little
    record_figure(name, float(match[1]), expected, 0.01, "J", relative=True)
