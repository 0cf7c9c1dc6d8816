"""Structure to model: masses, rigid sets, clamps, motion at the start, loads, metals."""

import numpy as np
import pytest
from tests.support.shell.structures import STEEL, cantilever, tee, thrown

from crumple._core.shell.simulation import Element, ShellState
from crumple.errors import InputError
from crumple.function import parse_time_function
from crumple.material import CowperSymonds, HardeningTable, JohnsonCook, Material, Swift
from crumple.shell import lower
from crumple.shell.model.drives import velocity_of
from crumple.shell.model.metal import in_words, shell_material
from crumple.structure import ShellSettings, Structure

COARSE = ShellSettings(element_size=12e-3)


def test_kinetic_energy_of_example_01():
    # 6 kg at 1 m and 15 rad/s are 675 J; the tube's rho A L^3 w^2 / 6 and its walls' own inertia the rest
    case = lower(thrown(), ShellSettings())
    energy = ShellState(case.model).energies["kinetic"]
    assert energy == pytest.approx(783.7, abs=0.3)
    assert case.start.given_energy == pytest.approx(energy, rel=2e-4)


def test_tip_is_a_rigid_set_with_the_mass_at_its_node():
    case = lower(thrown(), COARSE)
    (rigid,) = case.model.rigid_sets
    assert rigid.mass == 6.0
    assert rigid.at == pytest.approx((1.0, 0.0, 0.0))
    assert set(rigid.nodes) == {*case.mesh.tubes["tube"].nodes[-1], case.mesh.reference["tip"]}


def test_clamp_holds_its_ring_and_nothing_else():
    case = lower(thrown(), COARSE)
    ring = case.mesh.tubes["tube"].nodes[0]
    assert case.model.fixed[ring].all()
    assert case.model.fixed.sum() == 6 * len(ring)


def test_mass_off_its_node_with_inertia():
    given = cantilever(
        masses={
            "m": {"node": "tip", "mass": 2.0, "offset": (0.1, 0.0, 0.0), "rotary_inertia": (1e-3, 2e-3, 2e-3)}
        }
    )
    (rigid,) = lower(given, COARSE).model.rigid_sets
    assert rigid.at == pytest.approx((1.1, 0.0, 0.0))
    assert rigid.inertia == pytest.approx((1e-3, 2e-3, 2e-3, 0.0, 0.0, 0.0))


def test_two_masses_on_a_node_are_one_lump():
    masses = {
        "left": {"node": "tip", "mass": 1.0, "offset": (0.0, -0.1, 0.0)},
        "right": {"node": "tip", "mass": 3.0, "offset": (0.0, 0.1, 0.0)},
    }
    (rigid,) = lower(cantilever(masses=masses), COARSE).model.rigid_sets
    assert rigid.mass == 4.0
    assert rigid.at == pytest.approx((1.0, 0.05, 0.0))
    # reduced mass 0.75 kg at 0.2 m
    assert rigid.inertia == pytest.approx((0.03, 0.0, 0.03, 0.0, 0.0, 0.0))


def test_what_a_joint_cuts_away_keeps_its_mass():
    case = lower(tee(), COARSE)
    section = tee().section_of("one")
    total = case.report.mass + sum(body.lump.mass for body in case.bodies)
    assert total == pytest.approx(section.mass_per_length(7850.0) * 1.5, rel=1e-9)


def test_impulse_moves_the_free_end_with_its_momentum():
    given = cantilever(
        impulses=[{"node": "tip", "impulse": (0.0, 0.0, 5.0)}], masses={"m": {"node": "tip", "mass": 6.0}}
    )
    case = lower(given, COARSE)
    state = ShellState(case.model)
    ring = case.mesh.tubes["tube"].nodes[-1]
    velocity, spin = case.start.velocity[ring], case.start.spin[ring]
    assert np.ptp(velocity, axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert spin == pytest.approx(np.zeros(spin.shape), abs=1e-12)
    # energy J^2 / 2 m of the body that was struck
    mass = 5.0 / velocity[0, 2]
    assert mass == pytest.approx(6.0, rel=0.01)
    assert state.energies["kinetic"] == pytest.approx(25.0 / (2 * mass), rel=1e-6)


def test_initial_velocity_of_one_member_alone():
    given = tee().model_copy(
        update={"initial_velocity": [{"translation": (0.0, 3.0, 0.0), "members": ["three"]}]}
    )
    case = lower(given, COARSE)
    mesh = case.mesh
    assert case.start.velocity[mesh.tubes["three"].nodes[-1], 1] == pytest.approx(3.0)
    assert case.start.velocity[mesh.tubes["one"].nodes[0], 1] == pytest.approx(0.0)
    # the joint takes a share: its momentum over its mass
    assert 0.0 < case.start.velocity[mesh.reference["b"], 1] < 3.0


def test_load_acts_at_the_node_of_the_structure():
    given = cantilever(loads=[{"node": "tip", "force": {"z": 100.0}, "moment": {"x": 5.0}}])
    case = lower(given, COARSE, duration=0.01)
    assert {(load.node, load.dof) for load in case.model.loads} == {
        (case.mesh.reference["tip"], "z"),
        (case.mesh.reference["tip"], "rx"),
    }


def test_driven_support_becomes_a_velocity():
    table = {"table": {"time": [0.0, 1e-3, 2e-3], "value": [0.0, 2e-3, 2e-3]}}
    given = cantilever(
        supports={"clamp": {"node": "root", "fix": "all"}, "ram": {"node": "tip", "motion": {"z": table}}}
    )
    case = lower(given, COARSE, duration=2e-3)
    (motion,) = case.model.motions
    assert motion.rigid_set
    assert motion.dof == "z"
    state = ShellState(case.model)
    state.advance(2e-3)
    moved = state.position[case.mesh.reference["tip"], 2]
    assert moved == pytest.approx(2e-3, abs=2 * 2.0 * state.time_step)


@pytest.mark.parametrize(
    "spec",
    [
        {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.02, "h1": 0.3}},
        {"table": {"time": [0.0, 0.01, 0.012, 0.02], "value": [0.0, 0.1, 0.1, -0.2]}},
    ],
)
def test_integral_of_a_prescribed_velocity_is_the_motion(spec):
    function = parse_time_function(spec, "m", plain_numbers=True)
    times, rates = velocity_of(function, 0.03)
    moved = np.concatenate([[0.0], np.cumsum((rates[1:] + rates[:-1]) / 2 * np.diff(times))])
    assert moved == pytest.approx(function(times), abs=1e-9)


def test_metal_without_a_curve_is_perfectly_plastic_at_its_flow_stress():
    metal = shell_material(Material("steel", 210e9, 0.3, 7850.0, 250e6, given_flow_stress=320e6))
    assert metal.table()[1] == pytest.approx([320e6])


def test_hardening_curve_is_followed():
    curve = Swift(yield_stress=300e6, prestrain=4e-3, exponent=0.15)
    metal = shell_material(Material("steel", 210e9, 0.3, 7850.0, 300e6, hardening=curve))
    strain, stress = metal.table()
    fine = np.linspace(0.0, 1.0, 5000)
    assert np.interp(fine, strain, stress) == pytest.approx(curve.stress(fine), rel=2e-3)


def test_rate_law_is_taken_from_flow_then_yield():
    given = Material("steel", 210e9, 0.3, 7850.0, 300e6, yield_rate=CowperSymonds(40.4, 5.0))
    assert shell_material(given).rate_reference == 40.4
    logarithmic = Material("steel", 210e9, 0.3, 7850.0, 300e6, flow_rate=JohnsonCook(0.014))
    metal = shell_material(logarithmic)
    assert (metal.rate_logarithm, metal.rate_reference) == (0.014, 1.0)


def test_settings_reach_the_stepper():
    given = ShellSettings(
        element_size=12e-3, hourglass="viscous", hourglass_coefficient=0.1, self_contact="off",
        thickness_update="off", thickness_points=3, safety_factor=0.7, mass_scaling=1e-6,
        contact_friction=0.2,
    )  # fmt: skip
    model = lower(thrown(), given).model
    core = model.settings
    assert (core.hourglass.value, core.hourglass_membrane, core.self_contact) == ("viscous", 0.1, False)
    assert (core.thickness_update, core.safety, core.scaled_step, core.contact_friction) == (
        False,
        0.7,
        1e-6,
        0.2,
    )
    assert model.sheets[0].points == 3


def test_element_and_thickness_rule_reach_the_stepper():
    given = ShellSettings(
        element_size=12e-3, element="stabilised", thickness_rule="lobatto", thickness_points=4,
        warping_correction="on", drill_stiffness=0.02,
    )  # fmt: skip
    model = lower(thrown(), given).model
    core = model.settings
    assert (core.element, core.warping_correction, core.drill_stiffness) == (Element.STABILISED, True, 0.02)
    assert (model.sheets[0].points, model.sheets[0].lobatto) == (4, True)
    # nothing bends by the drill without the warping terms, and nothing has to hold it
    assert lower(thrown(), ShellSettings(element_size=12e-3)).model.settings.drill_stiffness == 0.0


def test_lobatto_needs_two_points():
    with pytest.raises(InputError, match="Lobatto's rule has at least two points"):
        ShellSettings(thickness_rule="lobatto", thickness_points=1)


def test_failure_strain_and_a_table_reach_the_elements():
    table = HardeningTable((0.0, 0.02, 0.3), (300e6, 350e6, 500e6))
    given = Material("steel", 210e9, 0.3, 7850.0, 300e6, hardening=table, failure_strain=0.4)
    metal = shell_material(given)
    assert [list(column) for column in metal.table()] == [[0.0, 0.02, 0.3], [300e6, 350e6, 500e6]]
    assert metal.failure_strain == 0.4
    assert "deleted at a plastic strain of 0.4" in in_words(given)


def test_walls_of_other_metals_keep_theirs():
    """A box whose flanges are of aluminium: they have a sheet and a density of their own."""
    b, h, wall = 0.05, 0.03, 2e-3
    corners = [(-b / 2, -h / 2), (b / 2, -h / 2), (b / 2, h / 2), (-b / 2, h / 2)]
    walls = [
        {
            "points": [corners[i], corners[(i + 1) % 4]],
            "thickness": wall,
            "material": "soft" if i % 2 == 0 else None,
        }
        for i in range(4)
    ]
    soft = {"youngs_modulus": 70e9, "poissons_ratio": 0.33, "density": 2700.0, "yield_stress": 200e6}
    box = Structure(
        materials={"steel": STEEL, "soft": soft},
        sections={"box": {"type": "walls", "walls": walls}},
        nodes={"root": (0, 0, 0), "tip": (0.5, 0, 0)},
        members={"beam": {"nodes": ("root", "tip"), "section": "box", "material": "steel"}},
        supports={"clamp": {"node": "root", "fix": "all"}},
    )
    case = lower(box, COARSE)
    model = case.model
    assert {metal.density for metal in model.materials} == {7850.0, 2700.0}
    height = np.abs(model.position[model.elements][:, :, 2]).min(axis=1)
    flange = height > h / 2 - 1e-9
    densities = np.array([model.materials[model.sheets[i].material].density for i in model.sheet])
    assert np.array_equal(densities == 2700.0, flange)
    mass = 0.5 * wall * 2 * (b * 2700.0 + h * 7850.0)
    assert case.report.mass == pytest.approx(mass, rel=1e-9)
    assert ShellState(model).mass == pytest.approx(mass, rel=1e-9)


def test_fine_size_above_the_element_size_is_refused():
    with pytest.raises(InputError, match="fine size is larger"):
        ShellSettings(element_size=5e-3, fine_size=8e-3)
    with pytest.raises(InputError, match="coarse sections lie away from fine ones"):
        ShellSettings(coarse_sections="on")
