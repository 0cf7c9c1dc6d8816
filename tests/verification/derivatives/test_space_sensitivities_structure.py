"""Derivatives with respect to parameters of a structure equal differences of its variants (spatial kernel).

Laws, surfaces and geometry depend on the parameters, so a structure is converted again for each of them.
There is no closed form: a table of variants with a parameter changed by 0.1 or 0.01 % gives the
differences, from runs that choose their own steps.

Kind: independent calculation.  Source: derived here.
"""

from dataclasses import replace

import pytest
from tests.support.structures import STEEL, TUBE

from crumple.errors import InputError, Status
from crumple.multibody import Run, sensitivities, solve_variants
from crumple.structure import MultibodySettings, Outputs, Stage, Structure, value_at

TURN = {"rotation": 8.0, "about": (0.0, 0.0, 0.0), "axis": (0.0, -1.0, 0.6)}
FINE = Run(0.03, 0.03, MultibodySettings(accuracy=1e-6), Outputs(nodes=("tip",)))
QUANTITIES = (
    "hinge.root.rotation",
    "hinge.root.energy",
    "node.tip.displacement.x",
    "node.tip.displacement.z",
    "energy.dissipated",
)


def angle(coupling="ellipsoid", form="set-valued", **parts):
    """Two tubes at an angle, hinges that bend about both axes and twist."""
    tube = {"section": "tube", "material": "steel"}
    law = {"type": "kecman", "form": form}

    def hinge(name):
        return {"name": name, "at": name, "law": law, "axes": ("x", "y", "z"), "coupling": coupling}

    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "knee": (0.6, 0.0, 0.0), "tip": (0.8, 0.5, 0.1)},
        members={
            "near": {**tube, "nodes": ("root", "knee"), "hinges": [hinge("root")]},
            "far": {**tube, "nodes": ("knee", "tip"), "hinges": [hinge("knee")]},
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"payload": {"node": "tip", "mass": 6.0}},
        gravity=(0.0, 0.0, -9.81),
        initial_velocity=[TURN],
        loads=[{"node": "tip", "force": {"z": {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.01, "h1": 300.0}}}}],
        **parts,
    )


@pytest.mark.parametrize(
    "name",
    [
        "materials.steel.yield_stress",
        "materials.steel.density",
        "sections.tube.thickness",
        "sections.tube.depth",
        "masses.payload.mass",
        "nodes.tip.1",
        "hinges.root.capacity",
        "initial_velocity",
        "loads",
    ],
)
def test_structure_against_variants(name, record_figure):
    bent = angle()
    factor = name.split(".")[0] in ("hinges", "initial_velocity", "loads")
    value = 1.0 if factor else value_at(bent, name)
    e = 1e-3
    table = solve_variants(bent, FINE, {name: [value * (1 + e), value * (1 - e), value]})
    found = sensitivities(bent, FINE, [name])
    assert found.status is Status.COMPLETE
    for quantity in QUANTITIES:
        assert found.quantities[quantity] == pytest.approx(table[quantity][2], rel=1e-9)
        difference = (table[quantity][0] - table[quantity][1]) / (2 * e)
        slope = found[quantity][name] * value
        scale = max(abs(found.quantities[quantity]), abs(difference))
        record_figure(f"{quantity} by {name}", slope, difference, 2e-3 * scale)


@pytest.mark.parametrize(("coupling", "form"), [("section", "set-valued"), ("ellipsoid", "elastic-plastic")])
def test_section_and_elastic_hinges_against_variants(coupling, form, record_figure):
    """Tip of the angle by yield stress and thickness, several parameters in one call."""
    bent = angle(coupling, form)
    names = ["materials.steel.yield_stress", "sections.tube.thickness"]
    found = sensitivities(bent, FINE, names)
    for name in names:
        value, e = value_at(bent, name), 1e-4
        table = solve_variants(bent, FINE, {name: [value * (1 + e), value * (1 - e)]})
        for quantity in ("node.tip.displacement.z", "energy.dissipated"):
            difference = (table[quantity][0] - table[quantity][1]) / (2 * e)
            slope = found[quantity][name] * value
            scale = max(abs(found.quantities[quantity]), abs(difference))
            record_figure(f"{coupling}, {form}: {quantity} by {name}", slope, difference, 1e-2 * scale)


def test_what_moves_with_events_is_refused():
    ground = {"type": "plane", "point": (0.0, 0.0, -1.0), "normal": (0.0, 0.0, 1.0)}
    with pytest.raises(InputError, match="time of an impact"):
        sensitivities(angle(obstacles={"ground": ground}), FINE, ["masses.payload.mass"])
    ends = (Stage(name="a", duration=0.03, until=[{"distance": 0.1, "between": ("root", "tip")}]),)
    with pytest.raises(InputError, match="end on a condition"):
        sensitivities(angle(), replace(FINE, stages=ends), ["masses.payload.mass"])
    slow = (Stage(name="a", kind="quasi-static", duration=0.03),)
    with pytest.raises(InputError, match="quasi-static"):
        sensitivities(angle(), replace(FINE, stages=slow), ["masses.payload.mass"])
    with pytest.raises(InputError, match="does not exist"):
        sensitivities(angle(), FINE, ["masses.payload.weight"])
    with pytest.raises(InputError, match="step of a parameter that is zero"):
        sensitivities(angle(), FINE, ["masses.payload.offset.2"])


def test_a_parameter_of_value_zero_takes_its_step():
    found = sensitivities(angle(), FINE, {"masses.payload.offset.2": 1e-5})
    assert abs(found["node.tip.displacement.y"]["masses.payload.offset.2"]) > 1e-4
