"""Stepper: determinism, restart, ledger, rigid sets, loads, motion, planes, mass scaling, failing runs."""

import dataclasses

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, bits, grid, model

from crumple._core.shell.simulation import (
    Cut,
    Element,
    NodalLoad,
    PrescribedVelocity,
    RigidObstacle,
    RigidSet,
    Shape,
    Sheet,
    ShellModel,
    ShellState,
)
from crumple.errors import InputError, Status


def cantilever(material=STEEL, **settings):
    """Sheet clamped at x = 0, thrown sideways hard enough to yield, with a rigid free end."""
    x, quads = grid(40, 26, 0.2, 0.13)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = True
    velocity = np.zeros_like(x)
    velocity[:, 2] = 60 * x[:, 0] / 0.2
    tip = np.flatnonzero(x[:, 0] > 0.2 - 1e-9)
    return model(
        x,
        quads,
        2e-3,
        material,
        settings=settings,
        fixed=fixed,
        velocity=velocity,
        rigid_sets=[RigidSet(tip, mass=0.2)],
    )


def two_sheets():
    """The cantilever with every third element of another sheet: neither number is one of whole registers."""
    whole = cantilever()
    sheet_of = (np.arange(len(whole.elements)) % 3 == 0).astype(int)
    return dataclasses.replace(whole, sheets=[Sheet(points=5), Sheet(points=3)], sheet=sheet_of)


def test_any_number_of_threads_gives_the_same_bits():
    states = [ShellState(cantilever(self_contact=True)) for _ in range(3)]
    for state, threads in zip(states, (1, 2, 3), strict=True):
        assert state.advance(1.0, steps=150, threads=threads) is Status.COMPLETE
    assert bits(states[0]) == bits(states[1]) == bits(states[2])
    assert states[0].energies == states[1].energies


def test_restart_gives_the_same_bits():
    through, stopped = (ShellState(cantilever(self_contact=True, damping=5.0)) for _ in range(2))
    through.advance(1.0, steps=200)
    stopped.advance(1.0, steps=83)
    resumed = ShellState(cantilever(self_contact=True, damping=5.0))
    resumed.restore(stopped.checkpoint())
    resumed.advance(1.0, steps=117)
    assert bits(through) == bits(resumed)
    with pytest.raises(InputError, match="another model"):
        ShellState(model(*grid(2, 2))).restore(stopped.checkpoint())


@pytest.mark.parametrize("described", [cantilever, two_sheets])
@pytest.mark.parametrize("isa", ["x86-64-v2", "x86-64-v3", "x86-64-v4"])
def test_instruction_sets_agree(isa, described, monkeypatch):
    """Compiled without contraction to fused operations, all sets give the same bits."""
    best = ShellState(described())
    monkeypatch.setenv("CRUMPLE_ISA", isa)
    try:
        other = ShellState(described())
    except InputError:
        pytest.skip(f"this machine does not run {isa}")
    assert other.isa == isa
    best.advance(1.0, steps=100)
    other.advance(1.0, steps=100)
    assert np.array_equal(best.position, other.position)
    assert best.energies == other.energies


def test_unknown_instruction_set_is_refused():
    with pytest.raises(InputError, match="allowed: "):
        ShellState(cantilever(), isa="mmx")


@pytest.mark.parametrize(
    "settings", [{}, {"damping": 200.0}, {"gravity": (0.0, 3.0, -5e4)}, {"thickness_update": False}]
)
def test_energy_ledger_balances(settings):
    state = ShellState(cantilever(**settings))
    first = state.energies["kinetic"]
    for t in np.linspace(0, 2e-3, 9):
        state.advance(t)
        e = state.energies
        assert abs(e["residual"]) < 2e-4 * first
    assert e["plastic"] > 0.02 * first
    if "damping" in settings:
        assert e["damping"] > 0.05 * first
    if "gravity" in settings:
        assert abs(e["external_work"]) > 0.05 * first


def test_elastic_energy_is_that_of_the_stresses():
    state = ShellState(cantilever(ELASTIC))
    state.advance(3e-4)
    x, y, xy = (state.point_field(n) for n in ("stress_x", "stress_y", "stress_xy"))
    from crumple._core.shell.simulation import thickness_rule

    density = (x**2 + y**2 - 0.6 * x * y + 2.6 * xy**2) / (2 * 210e9) @ thickness_rule(5)[1]
    shear = state.element_field("shear_xz") ** 2 + state.element_field("shear_yz") ** 2
    stored = (density + shear / (2 * 5 / 6 * 210e9 / 2.6)) * 2e-3 * 0.005**2
    assert state.energies["elastic"] == pytest.approx(stored.sum(), rel=0.01)


def spinning(omega):
    """One flat sheet, all of it one rigid set, with a velocity field of rigid rotation."""
    x, quads = grid(4, 2, 0.08, 0.02)
    x = x - x.mean(axis=0)
    return x, model(
        x,
        quads,
        2e-3,
        rigid_sets=[RigidSet(np.arange(len(x)))],
        velocity=np.cross(omega, x),
        spin=np.tile(omega, (len(x), 1)),
    )


def test_free_rigid_set_keeps_energy_and_momentum():
    """Unstable spin about the middle axis: it tumbles, and both invariants stay to round-off."""
    x, m = spinning(np.array([2000.0, 4e4, 500.0]))
    state = ShellState(m)
    first, upright = state.energies["kinetic"], []
    for _ in range(40):
        state.advance(1.0, steps=100)
        upright.append(state.rigid_sets[0, 13])  # world y of the body's y axis
    assert min(upright) < -0.9
    assert state.energies["kinetic"] == pytest.approx(first, rel=1e-11)
    turn = state.rigid_sets[0, 9:].reshape(3, 3)
    assert turn.T @ turn == pytest.approx(np.eye(3), abs=1e-14)
    centre = state.rigid_sets[0, :3]
    assert state.position == pytest.approx(x @ turn.T + centre, abs=1e-15)
    assert abs(state.point_field("stress_x")).max() < 1e-4 * 488e6


def two_halves(rigid):
    """A sheet of two metals, the right half perhaps rigid, spinning."""
    x, quads = grid(8, 2, 0.08, 0.02)
    x = x - x.mean(axis=0)
    right = x[quads].mean(axis=1)[:, 0] > 0
    steel = dataclasses.replace(STEEL, rigid=False)
    return x, dataclasses.replace(
        model(x, quads, 2e-3, velocity=np.cross([0, 0, 300.0], x)),
        materials=[steel, dataclasses.replace(steel, density=2700.0, rigid=rigid)],
        sheets=[Sheet(0), Sheet(1)],
        sheet=right.astype(int),
        spin=np.tile([0, 0, 300.0], (len(x), 1)),
    )


def test_rigid_material_moves_as_one_body():
    """Distances within stay to round-off, nothing in it is stressed, and its elements do not set the step."""
    x, m = two_halves(True)
    state = ShellState(m)
    first = state.energies["kinetic"]
    assert state.advance(2e-4) is Status.COMPLETE
    body = np.flatnonzero(x[:, 0] > -1e-9)
    before, after = (a[body] - a[body[0]] for a in (x, state.position))
    assert np.linalg.norm(after, axis=1) == pytest.approx(np.linalg.norm(before, axis=1), abs=1e-15)
    inside = np.asarray(m.sheet) == 1
    assert not state.point_field("stress_x")[inside].any()
    assert state.point_field("stress_x")[~inside].any()
    assert abs(state.energies["residual"]) < 1e-4 * first
    assert state.rigid_sets.shape[0] == 1


def test_rigid_elements_must_lie_in_one_body():
    _, m = two_halves(True)
    half = [int(n) for n in np.unique(m.elements[np.asarray(m.sheet) == 1])][:3]
    with pytest.raises(InputError, match="it is rigid, but its nodes are not all in one rigid set"):
        ShellState(dataclasses.replace(m, rigid_sets=[RigidSet(half)]))
    with pytest.raises(InputError, match="every element is rigid"):
        ShellState(dataclasses.replace(m, sheet=1))


def test_rigid_sheets_that_touch_are_one_body():
    x, m = two_halves(True)
    both = dataclasses.replace(
        m, materials=[*m.materials, m.materials[1]], sheets=[Sheet(0), Sheet(1), Sheet(2)]
    )
    sheet = np.where(x[m.elements].mean(axis=1)[:, 0] > 0.02, 2, np.asarray(m.sheet))
    assert ShellState(dataclasses.replace(both, sheet=sheet)).rigid_sets.shape[0] == 1


def torn_strip(any_point):
    """Strip pulled at 20 m/s until it tears."""
    x, quads = grid(10, 2, 0.05, 0.01)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = True
    metal = dataclasses.replace(STEEL, failure_strain=0.1, fails_at_any_point=any_point)
    motions = [PrescribedVelocity(n, "x", [0, 1e-5], [0, 20.0]) for n in range(30, 33)]
    return ShellState(model(x, quads, 2e-3, metal, fixed=fixed, motions=motions))


@pytest.mark.parametrize("any_point", [True, False])
def test_a_strip_tears_with_its_energy_accounted(any_point):
    """Elements go, the force on the pulled end dies, and the ledger closes over the loss."""
    state = torn_strip(any_point)
    assert state.advance(1e-3) is Status.COMPLETE
    gone = state.element_field("alive") == 0
    assert 0 < gone.sum() < 10
    e = state.energies
    lost = state.element_field("internal_energy") - state.element_field("plastic_energy")
    assert e["eroded"] == pytest.approx(lost[gone].sum(), rel=1e-12)
    assert e["eroded"] > 0
    assert abs(e["residual"]) < 0.01 * e["external_work"]
    work = e["external_work"]
    state.advance(1.2e-3)
    assert state.energies["external_work"] - work < 0.02 * work


@pytest.mark.parametrize(
    ("tears_at", "rate"), [(0.03, {}), (0.01, {"rate_reference": 40.0, "rate_exponent": 5.0})]
)
def test_what_walls_store_is_never_negative_however_fast_they_tear(tears_at, rate):
    """A sheet torn apart at 100 m/s with waves in it: stored energy of every element, the ledger closes."""
    x, quads = grid(8, 8, 0.08, 0.08)
    metal = dataclasses.replace(STEEL, failure_strain=tears_at, **rate)
    velocity = np.zeros_like(x)
    velocity[:, 0] = 100 * (2 * x[:, 0] / 0.08 - 1)
    velocity[:, 2] = 30 * np.sin(40 * x[:, 1])
    state = ShellState(model(x, quads, 1.5e-3, metal, velocity=velocity))
    first = state.energies["kinetic"]
    for _ in range(10):
        state.advance(state.time + 4e-5)
        stored = state.element_field("internal_energy") - state.element_field("plastic_energy")
        assert stored.min() > 0
    e = state.energies
    assert e["eroded"] > 0
    # half of the last step's work of the torn ones would be 1 % of the start
    assert abs(e["residual"]) < 5e-3 * first


@pytest.mark.parametrize("element", Element)
def test_an_element_that_inverts_ends_the_run_by_name(element):
    """A corner driven across its element: the run stops with a status, the element and finite results."""
    x, quads = grid(4, 4, 0.04, 0.04)
    rim = np.abs(x[:, :2] - 0.02).max(axis=1) > 0.02 - 1e-9
    fixed = np.repeat(rim[:, None], 6, axis=1)
    motions = [PrescribedVelocity(12, dof, [0.0], [40.0]) for dof in ("x", "y")]
    state = ShellState(
        model(x, quads, 2e-3, STEEL, settings={"element": element}, motions=motions, fixed=fixed)
    )
    assert state.advance(1e-3) is Status.INVERTED
    assert "is inverted: a corner has crossed it" in state.reason
    assert np.isfinite(state.position).all()
    # what was computed until then is sound
    e = state.energies
    assert abs(e["residual"]) < 0.05 * e["external_work"]


def test_rigid_set_accelerates_by_its_whole_mass():
    x, quads = grid(2, 2, 0.02, 0.02)
    rigid = RigidSet(np.arange(9), mass=0.5, at=(0.01, 0.01, 0.0))
    load = NodalLoad(4, "z", [0.0], [10.0])
    state = ShellState(model(x, quads, 2e-3, rigid_sets=[rigid], loads=[load]))
    state.advance(1e-4)
    mass = 0.5 + 7850 * 2e-3 * 4e-4
    assert state.rigid_sets[0, 2] == pytest.approx(0.5 * 10 / mass * state.time**2, rel=1e-9)
    e = state.energies
    assert e["external_work"] == pytest.approx(e["kinetic"], rel=2e-4)  # second order in the step


def test_prescribed_velocity_and_reaction_work():
    x, quads = grid(10, 2, 0.1, 0.02)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = True
    pulled = np.flatnonzero(x[:, 0] > 0.1 - 1e-9)
    motions = [PrescribedVelocity(int(n), "x", [0.0, 1e-3], [0.0, 0.2]) for n in pulled]
    cut = Cut(np.arange(2), np.flatnonzero(x[:, 0] == 0))
    state = ShellState(
        model(x, quads, 2e-3, fixed=fixed, motions=motions, cuts=[cut], settings={"damping": 500.0})
    )
    state.advance(1e-3)
    assert state.position[pulled, 0] - 0.1 == pytest.approx(1e-4 + 0.2 * (state.time - 1e-3), rel=1e-4)
    e = state.energies
    assert abs(e["residual"]) < 1e-5 * e["external_work"]
    force, _, _ = state.cut(0)
    # statically: E A e / L, stiffened at the clamp; still swinging a little
    assert force[0] == pytest.approx(210e9 * 0.02 * 2e-3 * 1e-3, rel=0.05)


def test_sheet_bounces_off_a_plane_and_friction_slows_it():
    x, quads = grid(3, 3, 0.03, 0.03)
    x[:, 2] = 0.002
    velocity = np.tile([5.0, 0.0, -10.0], (len(x), 1))
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0), axis=(0, 0, 2.0), friction=0.2)
    state = ShellState(model(x, quads, 2e-3, velocity=velocity, obstacles=[plane]))
    first = state.energies["kinetic"]
    state.advance(5e-4)
    v = state.velocity[0].mean(axis=0)
    assert v[2] == pytest.approx(10.0, rel=0.02)
    # impulse 2 m v, of which friction takes a fifth
    assert v[0] == pytest.approx(5.0 - 0.2 * 20.0, rel=0.1)
    e = state.energies
    assert abs(e["residual"]) < 1e-4 * first
    assert e["contact"] == pytest.approx(first - e["kinetic"], rel=0.02)


def test_mass_scaling_reaches_the_step_and_is_reported():
    x, quads = grid(4, 4, 0.04, 0.04)
    x[:, 0] = 0.04 * (x[:, 0] / 0.04) ** 2
    plain = ShellState(model(x, quads))
    scaled = ShellState(model(x, quads, settings={"scaled_step": 2 * plain.first_time_step}))
    assert plain.added_mass == 0
    assert scaled.first_time_step == pytest.approx(2 * plain.first_time_step, rel=1e-12)
    assert scaled.added_mass > 0
    scaled.advance(1.0, steps=2)
    assert scaled.time_step == pytest.approx(2 * plain.first_time_step, rel=1e-9)


def test_runaway_ends_with_element_and_reason():
    x, quads = grid(4, 4, 0.04, 0.04)
    load = NodalLoad(12, "x", [0.0, 1e-6, 2e-6], [0.0, 1e12, 1e300])
    state = ShellState(model(x, quads, loads=[load]))
    status = state.advance(1e-3)
    assert status in (Status.NOT_FINITE, Status.STEP_COLLAPSED)
    assert "element" in state.reason
    assert state.steps > 0
    assert state.advance(2e-3) is status


def test_step_below_the_least_ends_the_run():
    state = ShellState(model(*grid(4, 4, 0.04, 0.04), settings={"least_step": 1e-3}))
    assert state.advance(1e-3) is Status.STEP_COLLAPSED
    assert "collapsed" in state.reason


def test_cancel_and_progress():
    state, seen = ShellState(cantilever()), []
    assert (
        state.advance(1.0, progress=lambda s: seen.append(s.time), cancel=lambda: len(seen) >= 2)
        is Status.CANCELLED
    )
    assert len(seen) == 2
    assert state.advance(1.0, steps=10) is Status.COMPLETE


def test_free_flight_is_exact():
    """A sheet without stress in gravity: a parabola, and the ledger at round-off."""
    state = ShellState(
        model(
            *grid(3, 3, 0.03, 0.03),
            velocity=np.tile([1.0, 2.0, 3.0], (16, 1)),
            settings={"gravity": (0, 0, -9.81)},
        )
    )
    state.advance(1e-3)
    t = state.time
    assert state.position[0] == pytest.approx([t, 2 * t, 3 * t - 0.5 * 9.81 * t * t], rel=1e-9)
    assert abs(state.energies["residual"]) < 1e-6


def test_a_fixed_node_of_a_rigid_set_is_refused():
    x, quads = grid(2, 2)
    fixed = np.zeros((9, 6), dtype=bool)
    fixed[3, 0] = True
    with pytest.raises(InputError, match="rigid set 0: node 3 is fixed"):
        ShellState(model(x, quads, fixed=fixed, rigid_sets=[RigidSet([3, 4])]))


def test_model_is_copied():
    m = cantilever()
    state = ShellState(m)
    before = state.position
    m.position[:] = np.nan
    state.advance(1.0, steps=3)
    assert np.isfinite(state.position).all()
    assert before.shape == state.position.shape
    assert isinstance(dataclasses.replace(m), ShellModel)
