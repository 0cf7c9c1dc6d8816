"""Tables of variants in space: every parameter does what changing the input does, and failures are rows."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.structures import STEEL, TUBE, cantilever

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody, solve_variants
from crumple.structure import MultibodySettings, Outputs, Stage, Structure, changed

TURN = {"rotation": 8.0, "about": (0.0, 0.0, 0.0), "axis": (0.0, -1.0, 0.6)}
CLEAR = {
    "moves_with": "far",
    "members": ["near"],
    "points": [(0.9, 0.2, 0.0), (0.9, 0.4, 0.0), (0.9, 0.3, 0.2)],
}
OUTPUTS = Outputs(
    nodes=("tip",), distances={"sag": {"from": "root", "to": "tip"}}, clearances={"room": CLEAR}
)
RUN = Run(0.04, 0.04, MultibodySettings(accuracy=1e-3), OUTPUTS)
QUANTITY = "node.tip.displacement.z"


def angle(**parts):
    """An angle of two tubes whose hinges bend about both axes and twist."""
    tube = {"section": "tube", "material": "steel"}

    def hinge(name, node):
        return {"name": name, "at": node, "law": {"type": "kecman"}, "axes": ("x", "y", "z")}

    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "knee": (0.6, 0.0, 0.0), "tip": (0.8, 0.5, 0.1)},
        members={
            "near": {**tube, "nodes": ("root", "knee"), "hinges": [hinge("root", "root")]},
            "far": {**tube, "nodes": ("knee", "tip"), "hinges": [hinge("knee", "knee")]},
        },
        masses={"payload": {"node": "tip", "mass": 6.0, "offset": (0.05, 0.0, 0.02)}},
        gravity=(0.0, 0.0, -9.81),
        **({"supports": {"clamp": {"node": "root", "fix": "all"}}} | parts),
    )


@pytest.fixture(scope="module")
def bent():
    """Thrown, pushed and struck."""
    return angle(
        initial_velocity=[TURN],
        impulses=[{"node": "tip", "impulse": (0.0, 1.0, 3.0), "angular_impulse": (0.1, 0.0, 0.0)}],
        loads=[{"node": "tip", "force": {"z": {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.01, "h1": 300.0}}}}],
    )


def alone(structure, run=RUN):
    """Table of one row of a structure as it is."""
    return solve_variants(structure, run, {"hinges.root.capacity": 1.0}, threads=1)


# fmt: off
def test_a_row_ends_where_a_run_does(bent):
    """Channels of the same names; a single run solves again at a quarter of the accuracy."""
    table = alone(bent)
    result = solve_multibody(bent, RUN)
    assert result.provenance.settings["kernel"] == "spatial"
    for name in ("hinge.root.rotation", "hinge.knee.rotation.x", "hinge.root.moment.z", "energy.dissipated",
                 "hinge.knee.energy", "node.tip.displacement.y", "node.tip.rotation.z", "sag", "room"):
        scale = np.abs(result[name]).max()
        assert table[name][0] == pytest.approx(result[name][-1], abs=2e-3 * scale), name
    missing = {name for name in result.channels if name.split(".")[0] in ("hinge", "energy", "sag", "room")}
    missing -= {name for name in missing if "rate" in name or name in ("energy.residual", "energy.gravity")}
    assert missing <= set(table.quantities)
# fmt: on


@pytest.mark.parametrize(
    ("name", "value", "path"),
    [
        ("masses.payload.mass", 7.5, None),
        ("materials.steel.yield_stress", 420e6, None),
        ("sections.tube.thickness", 0.0022, None),
        ("nodes.tip.1", 0.6, None),
        ("initial_velocity", 1.125, {"initial_velocity.0.rotation": 9.0}),
        ("impulses", 2.0, {"impulses.0.impulse.1": 2.0, "impulses.0.impulse.2": 6.0,
                           "impulses.0.angular_impulse.0": 0.2}),
        ("gravity", 0.5, {"gravity.2": -4.905}),
    ],
)  # fmt: skip
def test_a_parameter_is_a_change_of_the_input(bent, name, value, path):
    table = solve_variants(bent, RUN, {name: [value]}, threads=1)
    expected = alone(changed(bent, path or {name: value}))
    assert table.status == (Status.COMPLETE,)
    assert set(table.quantities) == set(expected.quantities)
    for quantity in table.quantities:
        if quantity != "energy_residual":
            # other roundings, behind Newton's tolerance of 1e-9 of the moments
            np.testing.assert_allclose(
                table[quantity], expected[quantity], rtol=1e-6, atol=1e-6, err_msg=quantity
            )
    assert abs(table[QUANTITY][0] - alone(bent)[QUANTITY][0]) > 1e-4


def test_masses_momenta_and_factors_multiply(bent):
    """The lump moves with the field, and drags centre and inertia of its body along."""
    parameters = {"masses.payload.mass": [4.0], "initial_velocity": [1.25], "materials.steel.density": [5e3]}
    other = {"masses.payload.mass": 4.0, "initial_velocity.0.rotation": 10.0, "materials.steel.density": 5e3}
    expected = alone(changed(bent, other))
    table = solve_variants(bent, RUN, parameters)
    np.testing.assert_allclose(table[QUANTITY], expected[QUANTITY], rtol=1e-6)


def test_a_capacity_factor_leaves_the_other_hinges(bent):
    table = solve_variants(bent, RUN, {"hinges.root.capacity": [1.0, 3.0]})
    capacity = table["hinge.root.capacity.y"]
    assert capacity[1] > 2.5 * capacity[0]
    assert table["hinge.root.rotation_max"][1] < table["hinge.root.rotation_max"][0]


def test_failed_variants_are_rows(bent):
    table = solve_variants(
        bent,
        RUN,
        {"sections.tube.thickness": [0.002, 0.030, 0.002, 0.002], "masses.payload.mass": [6, 6, -60, 6]},
    )
    assert [status.ok for status in table.status] == [True, False, False, True]
    assert table.status[1] is table.status[2] is Status.REFUSED
    assert "thickness" in table.reason[1]
    assert "positive" in table.reason[2]
    assert np.isnan(table[QUANTITY]).tolist() == [False, True, True, False]
    assert table[QUANTITY][0] == table[QUANTITY][3]


def test_a_variant_that_does_not_converge_has_that_status(bent):
    table = solve_variants(bent, RUN, {"initial_velocity": [1.0, 1e150]})
    assert table.status[0] is Status.COMPLETE
    assert table.status[1] in (Status.STEP_COLLAPSED, Status.NOT_FINITE)
    assert table.reason[1]


def test_both_kernels_give_the_same_table():
    """A planar chain asked of the spatial kernel."""
    tube = cantilever({"type": "kecman"}, bars=3, initial_velocity=[TURN | {"axis": (0.0, -1.0, 0.0)}])
    parameters = {
        "masses.payload.mass": [5.0, 6.0, 7.0],
        "sections.tube.thickness": [0.0025, 0.0026, 0.0027],
        "hinges.root.capacity": [1.1, 1.0, 0.9],
    }
    fine = [
        Run(0.04, 0.04, MultibodySettings(accuracy=1e-5, kernel=kernel), Outputs(nodes=("tip",)))
        for kernel in ("tree", "spatial")
    ]
    plane, space = (solve_variants(tube, run, parameters) for run in fine)
    assert set(plane.quantities) == set(space.quantities)
    for name in (
        "hinge.root.rotation",
        "hinge.root.rotation_max",
        "node.tip.displacement.z",
        "energy.dissipated",
    ):
        np.testing.assert_allclose(plane[name], space[name], rtol=1e-4, err_msg=name)


def test_stages_and_obstacles():
    """A thrown ram runs into the tip until it has moved 0.1 m, then is gone: stronger hinges stop it."""
    ram = {"type": "sphere", "point": (0.8, 0.5, 0.21), "radius": 0.1, "mass": 30.0, "velocity": (0, 0, -6.0)}
    hit = angle(obstacles={"ram": ram})
    stages = (
        Stage(name="blow", duration=0.04, until=[{"displacement": 0.1, "of": "ram"}]),
        Stage(name="rest", duration=0.01, obstacles=()),
    )
    run = Run(0.05, 0.05, outputs=Outputs(nodes=("tip",)), stages=stages)
    parameters = {"hinges.root.capacity": [1.0, 2.0, 1.0], "obstacles.ram.velocity.2": [-6.0, -6.0, -7.0]}
    table = solve_variants(hit, run, parameters)
    assert table.status == (Status.COMPLETE,) * 3
    depth = table["node.tip.displacement.z"]
    result = solve_multibody(hit, run)
    assert depth[0] == pytest.approx(result["node.tip.displacement.z"][-1], rel=2e-2)
    assert depth[2] < depth[0] < depth[1] < -0.05
    assert (table["energy.contact"] + table["energy.friction"] > 0.0).all()


def test_histories_go_through_stages_that_end_early():
    """At the accuracy of `solve_multibody` they are its samples; a row has no values after its end."""
    ram = {"type": "sphere", "point": (0.8, 0.5, 0.21), "radius": 0.1, "mass": 30.0, "velocity": (0, 0, -6.0)}
    hit = angle(obstacles={"ram": ram})
    stages = (
        Stage(name="blow", duration=0.04, until=[{"displacement": 0.1, "of": "ram"}]),
        Stage(name="rest", duration=0.01, obstacles=()),
    )
    run = Run(0.05, 0.0025, outputs=Outputs(nodes=("tip",)), stages=stages)
    result = solve_multibody(hit, run)
    fine = replace(run, settings=run.settings.model_copy(update={"accuracy": run.settings.accuracy / 4.0}))
    times = 0.0025 * np.arange(21)
    table = solve_variants(hit, fine, {"initial_velocity": [1.0]}, times=times)
    reached = times <= result.time[-1]
    assert 3 < reached.sum() < times.size
    for name in ("node.tip.displacement.z", "hinge.root.rotation", "energy.dissipated"):
        history = table.histories[name][0]
        assert np.isnan(history[~reached]).all()
        at = [int(np.argmin(np.abs(result.time - time))) for time in times[reached]]
        assert np.abs(result.time[at] - times[reached]).max() < 1e-12
        np.testing.assert_allclose(history[reached], result[name][at], rtol=1e-9, atol=1e-12, err_msg=name)


def test_quasi_static_stages():
    """Driven down at the tip: the work scales with the strength; beyond the limit load a status."""
    supports = {
        "clamp": {"node": "root", "fix": "all"},
        "jack": {"node": "tip", "motion": {"z": {"table": {"time": (0.0, 1.0), "value": (0.0, -0.1)}}}},
    }
    driven = angle(supports=supports)
    run = Run(
        1.0,
        1.0,
        outputs=Outputs(nodes=("tip",)),
        stages=(Stage(name="a", kind="quasi-static", duration=1.0),),
    )
    table = solve_variants(driven, run, {"materials.steel.yield_stress": [400e6, 480e6], "gravity": 0.0})
    assert table.status == (Status.COMPLETE,) * 2
    np.testing.assert_allclose(table["node.tip.displacement.z"], -0.1, atol=1e-5)
    assert table["energy.dissipated"][1] / table["energy.dissipated"][0] == pytest.approx(1.2, rel=1e-2)
    loose = solve_variants(angle(), run, {"gravity": [1.0, 400.0]})
    assert loose.status[0] is Status.COMPLETE
    assert loose.status[1] is Status.LIMIT_LOAD
    assert "gravity exceed the limit load" in loose.reason[1]


def test_a_mass_beyond_all_numbers_is_a_row_without_result(bent):
    """Its inertia overflows; the other row has its result."""
    table = solve_variants(bent, RUN, {"masses.payload.mass": [6.0, 1e300]}, threads=1)
    assert table.status[0] is Status.COMPLETE
    assert not table.status[1].ok
    assert np.isnan(table[QUANTITY][1])
