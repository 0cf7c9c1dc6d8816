"""Portals pushed by rams without inertia: the load of the limit theorems, and an energy balance.

- Sway of a portal by a ram at height z, by virtual work: all four hinges rotate alike, H = 4 M_p/(z - 0.02)
  on the column between its hinges, 4 M_p/0.96 at the level of the beam.
- Elastic members, before anything yields: stiffness of the portal against sway (Kleinlogel's frame with
  clamped feet), H/u = 24 E I (1 + 6 k)/((4 + 6 k) h^3) with k = (I/l)/(I/h), columns h, beam l.
- Rigid-plastic structures absorb what the ram provides, whichever gap closes first.

Kind: closed form; invariant.  Source: derived here; derived here.
"""

from pathlib import Path

import numpy as np
import pytest
from tests.support.structures import STEEL, constant_law

from crumple.analysis import load, loads, solve
from crumple.multibody import Run, solve_multibody
from crumple.structure import Stage, Structure

EXAMPLES = Path(__file__).parents[3] / "examples"
MOMENT, SPEED, RADIUS, HALF = 1000.0, 0.3, 0.1, 0.025
SQUARE = {"type": "square_tube", "side": 2 * HALF, "thickness": 0.003}
UPRIGHT = {"up": (0, 1, 0), "roll": np.pi / 2}
LIMIT = 4.0 * MOMENT / 0.96
RIGIDITY = STEEL["youngs_modulus"] * ((2 * HALF) ** 4 - (2 * HALF - 0.006) ** 4) / 12.0


def tube(first, second, *places, law=None, **keys):
    """Member with hinges of a constant moment, or of another law, at distances from its first node."""
    law = law or constant_law(MOMENT)
    hinges = tuple(
        {"name": f"{first}{second}{i}", "at": at, "law": law, "axis": "y"} for i, at in enumerate(places)
    )
    return {"nodes": (first, second), "section": "tube", "material": "steel", "hinges": hinges, **keys}


def ram(shape, height, gap, **keys):
    """Ram beside the left column, moving to the right; a plane ends 50 mm below the height."""
    keys = {"velocity": (SPEED, 0.0, 0.0), **keys}
    if shape == "plane":
        place = (-HALF - gap, 0, height - 0.05)
        return {"type": "plane", "point": place, "normal": (1, 0, 0), "edge": (0, 0, -1), **keys}
    place = (-HALF - RADIUS - gap, 0, height)
    if shape == "sphere":
        return {"type": "sphere", "point": place, "radius": RADIUS, **keys}
    return {"type": "cylinder", "point": place, "axis": (0, 1, 0), "radius": RADIUS, **keys}


def portal(shape="sphere", *, height=1.0, gap=0.0, beam=(), elastic=None, **keys):
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1.5, 0, 1), "d": (1.5, 0, 0)}
    upright = {**UPRIGHT, "elastic": elastic}
    members = {
        "ab": tube("a", "b", 0.02, 0.98, **upright),
        "bc": tube("b", "c", *beam, law=constant_law(1.5 * MOMENT), elastic=elastic),
        "cd": tube("c", "d", 0.02, 0.98, **upright),
    }
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes=nodes,
        members=members,
        supports={f"s{node}": {"node": node, "fix": "all"} for node in "ad"},
        obstacles={"ram": ram(shape, height, gap, **keys)},
    )


def pushed(structure, *, until=(), duration=0.2, further=(), every=0.01):
    stages = (Stage(name="push", kind="quasi-static", duration=duration, until=until), *further)
    whole = sum(stage.duration for stage in stages)
    return solve_multibody(structure, Run(whole, every, stages=stages))


def force(result):
    return -result["obstacle.ram.force.x"]


@pytest.mark.parametrize("gap", [0.0, 0.012])
@pytest.mark.parametrize(("shape", "arm"), [("sphere", 0.98), ("cylinder", 0.98), ("plane", 0.93)])
def test_rams_find_the_load_of_the_limit_theorems(shape, arm, gap, record_figure):
    result = pushed(portal(shape, height=0.98 if shape == "plane" else 1.0, gap=gap))
    assert result.status.ok, result.reason
    first = int(np.argmax(force(result) > 1.0)) + 1
    # a plane rests on the column at its edge, a ball above the knee on the beam's level
    expected = LIMIT * 0.96 / (arm - 0.02) if shape == "plane" else LIMIT
    name = f"{shape}, gap {gap * 1e3:g} mm"
    record_figure(f"limit load, {name}", force(result)[first] / expected, 1.0, 0.01)
    work, plastic = result["energy.external_work"][-1], result["energy.dissipated"][-1]
    record_figure(f"plastic work over the ram's, {name}", plastic / work, 1.0, 1e-4)
    assert plastic == pytest.approx(work, rel=1e-4)
    record_figure(f"energy residual, {name}", result.energy_residual, 0.0, 1e-4)
    assert result.energy_residual < 1e-4
    assert not result["energy.kinetic"].any()


CONDITIONS = {
    "force": {"force": 0.9 * LIMIT, "of": "ram"},
    "energy": {"energy": 50.0},
    "displacement": {"displacement": 0.03, "of": "ram"},
    "distance": {"distance": -0.02, "between": ("b", "d")},
}


@pytest.mark.parametrize("gap", [0.0, 0.01])
@pytest.mark.parametrize("quantity", CONDITIONS)
def test_push_ends_where_it_is_asked_to(quantity, gap, record_figure):
    """The force of a rigid-plastic frame jumps at the touch: there the push ends."""
    result = pushed(portal(gap=gap), until=(CONDITIONS[quantity],))
    assert result.status.ok, result.reason
    assert quantity in result.stages[0].ended_by
    end, work = result.time[-1], result["energy.external_work"][-1]
    # work = 4 M_p asin(u/0.96) at a sway u
    sway = 0.96 * np.sin(work / (4.0 * MOMENT))
    name = f"until {quantity}, gap {gap * 1e3:g} mm"
    if quantity == "force":
        assert force(result)[-1] > 0.9 * LIMIT
        record_figure(f"sway, {name}", sway, 0.0, 1e-3, "m")
    else:
        wanted = {
            "energy": 0.96 * np.sin(50.0 / (4.0 * MOMENT)),
            "displacement": 0.03 - gap,
            "distance": 0.0239,
        }[quantity]
        record_figure(f"sway, {name}", sway, wanted, 1e-3, "m", relative=True)
        assert SPEED * end - gap == pytest.approx(sway, rel=2e-3)


def test_elastic_members_are_pushed_to_their_limit_load(record_figure):
    result = pushed(portal(beam=(0.02, 1.48), elastic=6), duration=0.08, every=1e-3)
    assert result.status.ok, result.reason
    assert result.provenance.settings["steps"] < 2000
    assert result.energy_residual < 1e-3
    sway, pushing = SPEED * result.time, force(result)
    k = 1.0 / 1.5
    stiffness = 24.0 * RIGIDITY * (1.0 + 6.0 * k) / (4.0 + 6.0 * k)
    straight = (pushing > 0.05 * LIMIT) & (pushing < 0.5 * LIMIT)
    assert straight.sum() >= 3
    found = float(np.polyfit(sway[straight], pushing[straight], 1)[0])
    record_figure("stiffness of an elastic portal under a ram", found / stiffness, 1.0, 0.02)
    assert found == pytest.approx(stiffness, rel=0.02)
    record_figure("limit load of an elastic portal under a ram", pushing[-1] / LIMIT, 1.0, 0.02)
    assert pushing[-1] == pytest.approx(LIMIT, rel=0.02)


ARM = """
crumple: 1
materials:
  mild: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 320 MPa}}
  strong: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 3 GPa}}
sections:
  tube: {{type: square_tube, side: 50 mm, thickness: 2.5 mm}}
  arm: {{type: square_tube, side: 20 mm, thickness: 4 mm}}
nodes:
  {{a: [0 m, 0 m, 0 m], b: [0.15 m, 0 m, 0 m], c: [0.3 m, 0 m, 0 m], top: [0.15 m, 0 m, 0.21 m]}}
members:
  first: {{nodes: [a, b], section: tube, material: mild}}
  second: {{nodes: [b, c], section: tube, material: mild}}
  arm: {{nodes: [b, top], section: arm, material: strong}}
hinges: auto
supports: {{a: {{node: a, fix: all}}, c: {{node: c, fix: all}}}}
obstacles:
  ram: {{type: cylinder, point: [0.15 m, -60.5 mm, 0.15 m], axis: [1, 0, 0], radius: 50 mm,
    motion: {{y: {{havsin: {{x0: 0 ms, h0: 0 mm, x1: {time} ms, h1: 10 mm}}}}}}}}
analysis:
  stages: [{{name: push, kind: quasi-static, duration: {time} ms}}]
  multibody: {{mechanism_check: off, members: elastic}}
"""


def test_a_push_on_an_arm_of_elastic_members_does_not_depend_on_its_duration(record_figure):
    """A step that weights both its ends alike hands errors of moments on for ever: the push stood still."""
    slow, fast = (solve(loads(ARM.format(time=time))) for time in (100, 10))
    for result in (slow, fast):
        assert result.status.ok, result.reason
        assert result.provenance.settings["steps"] < 1000
        assert result.energy_residual < 1e-4
        lost = result["energy.damping"][-1] / result["energy.external_work"][-1]
        assert 0.0 < lost < 0.01
    one, other = (float(np.abs(result["obstacle.ram.force.y"][-1])) for result in (slow, fast))
    assert one > 10e3
    record_figure("force of a push ten times as fast", other / one, 1.0, 2e-3)
    assert other == pytest.approx(one, rel=2e-3)


def test_a_driven_push_of_elastic_members_is_solved_as_accurately_as_asked(record_figure):
    """Drag that sets in at once leaves an error of the moments that steps of any length hand on."""
    given = load(EXAMPLES / "14_rops.yaml")
    found = []
    for accuracy in (1e-3, 1e-4):
        keys = {"members": "elastic", "mechanism_check": "off", "accuracy": accuracy}
        result = solve(given.model_copy(update={"multibody": given.multibody.model_copy(update=keys)}))
        assert result.status.ok, result.reason
        assert result.provenance.settings["steps"] < 3000
        found.append((result.time[-1], result.hinges["left_post-left_foot"].rotation_max))
    for name, (loose, tight) in zip(("time to 8 kJ", "rotation"), zip(*found, strict=True), strict=True):
        record_figure(f"{name} at accuracies 1e-3 and 1e-4", loose / tight, 1.0, 1e-3)
        assert loose == pytest.approx(tight, rel=1e-3)


def test_candidates_at_every_end_find_the_weakest_mechanism(record_figure):
    """Six hinges of which four must turn: the stronger beam keeps its own locked."""
    result = pushed(portal(beam=(0.02, 1.48)))
    assert result.status.ok, result.reason
    record_figure("limit load, beam with hinges that stay locked", force(result)[1] / LIMIT, 1.0, 0.01)
    assert force(result)[1] == pytest.approx(LIMIT, rel=1e-3)
    assert max(result.hinges[f"bc{i}"].rotation_max for i in (0, 1)) < 1e-5


def test_rates_are_those_of_the_rotations():
    result = pushed(portal(), every=2e-3)
    rate, turned = result["hinge.ab0.rotation_rate"], result["hinge.ab0.rotation"]
    np.testing.assert_allclose(rate[10:-1], np.gradient(turned, result.time)[10:-1], rtol=1e-3)
    assert np.abs(rate[10:]).min() > 0.1


def test_push_then_impact_keeps_one_ledger(record_figure):
    """Motion added by a later stage is work at that instant; motion that a push removes is reported."""
    thrown = {"initial_velocity": ({"translation": (3.0, 0.0, 0.0)},)}
    hit = Stage(name="hit", duration=0.02, drive=(), obstacles=(), **thrown)
    again = Stage(name="again", kind="quasi-static", duration=0.05)
    result = pushed(portal(), duration=0.1, further=(hit, again), every=1e-3)
    assert result.status.ok, result.reason
    given = result["energy.kinetic"].max()
    assert given > 10.0
    share = float(np.abs(result["energy.residual"]).max()) / given
    record_figure("residual of a push, an impact and a push, over the impact's energy", share, 0.0, 1e-3)
    assert share < 1e-3
    assert result.energy_residual < 1e-3


@pytest.mark.parametrize("mass", [50.0, 5e6])
def test_residual_counts_what_the_structure_got(mass, record_figure):
    """A ram with a dominating energy: the residual is relative to the energy that it transfers."""
    keys = {"velocity": (4.0, 0.0, 0.0), "mass": mass, "guide": (1.0, 0.0, 0.0)}
    result = solve_multibody(portal(**keys), Run(0.03, 1e-3))
    assert result.status.ok, result.reason
    worst = float(np.abs(result["energy.residual"]).max())
    taken = result["energy.kinetic"][0] - mass * result["obstacle.ram.velocity.x"][-1] ** 2 / 2
    assert result.energy_residual >= 0.9 * worst / taken
    record_figure(f"energy residual, ram of {mass:g} kg", result.energy_residual, 0.0, 1e-3)
    assert result.energy_residual < 1e-3
