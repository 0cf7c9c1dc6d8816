"""Tables of variants: every parameter does what changing the input does, and failures are rows."""

import numpy as np
import pytest
from tests.support.structures import STEEL, TUBE, cantilever, constant_law

from crumple.errors import CancelledError, InputError, Status
from crumple.multibody import Run, sensitivities, solve_variants
from crumple.multibody.planar.case import planar_case
from crumple.structure import MultibodySettings, Outputs, Structure, changed

TURN = {"rotation": 8.0, "about": (0.0, 0.0, 0.0), "axis": (0.0, -1.0, 0.0)}
RUN = Run(0.06, 0.01, MultibodySettings(accuracy=1e-3), Outputs(nodes=("tip",)))
QUANTITY = "node.tip.displacement.z"


@pytest.fixture(scope="module")
def tube():
    """Tube of three bars that is thrown, pushed and struck, with Kecman's law."""
    return cantilever(
        {"type": "kecman"},
        bars=3,
        initial_velocity=[TURN],
        impulses=[{"node": "tip", "impulse": (0.0, 0.0, 3.0)}],
        loads=[{"node": "tip", "force": {"z": {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.01, "h1": 300.0}}}}],
        gravity=(0.0, 0.0, -9.81),
    )


def alone(structure):
    """Table of one row of a structure as it is."""
    return solve_variants(structure, RUN, {"hinges.root.capacity": 1.0}, threads=1)


@pytest.mark.parametrize(
    ("name", "value", "path"),
    [
        ("masses.payload.mass", 7.5, None),
        ("materials.steel.yield_stress", 420e6, None),
        ("materials.steel.density", 6000.0, None),
        ("sections.tube.thickness", 0.0022, None),
        ("nodes.tip.0", 1.1, None),
        ("initial_velocity.0.rotation", 9.0, None),
        ("initial_velocity", 1.125, {"initial_velocity.0.rotation": 9.0}),
        ("impulses", 2.0, {"impulses.0.impulse.2": 6.0}),
        ("gravity", 0.5, {"gravity.2": -4.905}),
    ],
)
def test_a_parameter_is_a_change_of_the_input(tube, name, value, path):
    table = solve_variants(tube, RUN, {name: [value]}, threads=1)
    expected = alone(changed(tube, path or {name: value}))
    assert table.status == (Status.COMPLETE,)
    assert set(table.quantities) == set(expected.quantities)
    for quantity in table.quantities:
        if quantity != "energy_residual":
            np.testing.assert_allclose(
                table[quantity], expected[quantity], rtol=1e-9, atol=1e-9, err_msg=quantity
            )
    assert abs(table[QUANTITY][0] - alone(tube)[QUANTITY][0]) > 1e-3


def test_rows_pass_over_the_vibration_that_runs_pass_over(tube):
    run = Run(0.06, 0.01, MultibodySettings(resolved_frequency=321.0))
    assert planar_case(tube, run).model.resolved_frequency == 321.0


def test_a_table_for_pandas_has_all_columns(tube):
    pandas = pytest.importorskip("pandas")
    table = solve_variants(tube, RUN, {"masses.payload.mass": [7.5, 8.0]}, threads=1)
    frame = table.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == [*table.parameters, *table.quantities, "status", "reason"]
    assert frame["masses.payload.mass"].tolist() == [7.5, 8.0]
    np.testing.assert_array_equal(frame[QUANTITY], table[QUANTITY])


def test_masses_momenta_and_factors_multiply(tube):
    """A lump moves with the field, so mass and factor of the velocity meet in the momentum."""
    parameters = {
        "masses.payload.mass": [4.0],
        "initial_velocity": [1.25],
        "materials.steel.density": [5000.0],
    }
    expected = alone(
        changed(
            tube,
            {
                "masses.payload.mass": 4.0,
                "initial_velocity.0.rotation": 10.0,
                "materials.steel.density": 5000.0,
            },
        )
    )
    table = solve_variants(tube, RUN, parameters)
    np.testing.assert_allclose(table[QUANTITY], expected[QUANTITY], rtol=1e-9)


def test_a_capacity_factor_is_another_moment():
    light = cantilever(constant_law(2000.0), initial_velocity=[TURN], hinge_place=0.0)
    strong = cantilever(constant_law(3000.0), initial_velocity=[TURN], hinge_place=0.0)
    table = solve_variants(light, RUN, {"hinges.root.capacity": [1.0, 1.5]}, threads=2)
    np.testing.assert_allclose(
        table["hinge.root.rotation"][1], alone(strong)["hinge.root.rotation"], rtol=1e-12
    )
    # theta = I w^2/(2 M)
    ratio = table["hinge.root.rotation_max"][0] / table["hinge.root.rotation_max"][1]
    assert ratio == pytest.approx(1.5, rel=1e-3)


def test_laws_are_sampled_once_for_each_distinct_combination(tube, monkeypatch):
    made = []

    def counted(structure, run):
        made.append(structure)
        return planar_case(structure, run)

    monkeypatch.setattr("crumple.multibody.variants.batch.planar_case", counted)
    yields = np.array([400e6, 450e6, 400e6, 450e6] * 5)
    solve_variants(
        tube, RUN, {"materials.steel.yield_stress": yields, "initial_velocity": np.linspace(0.5, 1, 20)}
    )
    assert len(made) == 1 + 2


def test_failed_variants_are_rows(tube):
    table = solve_variants(
        tube,
        RUN,
        {
            "sections.tube.thickness": [0.002, 0.030, 0.002, 0.002],
            "masses.payload.mass": [6.0, 6.0, -60.0, 6.0],
        },
    )
    assert len(table) == 4
    assert [status.ok for status in table.status] == [True, False, False, True]
    assert table.status[1] is table.status[2] is Status.REFUSED
    assert "thickness" in table.reason[1]
    assert "positive" in table.reason[2]
    assert np.isnan(table[QUANTITY]).tolist() == [False, True, True, False]
    assert table["masses.payload.mass"][2] == -60.0


def test_residual_is_a_status(tube):
    strict = Run(RUN.duration, RUN.every, MultibodySettings(energy_residual_bound=1e-15))
    assert alone_with(tube, strict).status == (Status.RESIDUAL_EXCEEDED,)


def alone_with(structure, run):
    return solve_variants(structure, run, {"initial_velocity": 1.0})


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({}, "no parameter"),
        ({"masses.payload.mass": []}, "no parameter"),
        ({"materials.steel.yield": [1.0]}, "this path does not exist"),
        ({"materials.steel": [1.0]}, "not the path of a number"),
        ({"members.tube.section": [1.0]}, "not the path of a number"),
        ({"hinges.nose.capacity": [1.0]}, "hinges.root.capacity"),
        ({"gravity": [1.0, 2.0], "loads": [1.0, 2.0, 3.0]}, "differ in length"),
    ],
)
def test_parameters_that_do_not_exist_are_refused(tube, parameters, message):
    with pytest.raises(InputError, match=message):
        solve_variants(tube, RUN, parameters)


def test_a_variant_that_leaves_the_plane_is_refused():
    """The tip moved across the plane of motion turns the axis of the second member's hinge."""
    tube = {"section": "tube", "material": "steel"}
    law = constant_law(500.0)
    bent = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "knee": (0.5, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={
            "near": {
                **tube,
                "nodes": ("root", "knee"),
                "hinges": [{"name": "root", "at": "root", "law": law}],
            },
            "far": {**tube, "nodes": ("knee", "tip"), "hinges": [{"name": "knee", "at": "knee", "law": law}]},
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        initial_velocity=[TURN],
    )
    table = solve_variants(bent, RUN, {"nodes.tip.1": [0.0, 0.2], "nodes.tip.2": 0.1}, threads=1)
    assert table.status == (Status.COMPLETE, Status.REFUSED)
    assert "not parallel" in table.reason[1]


def test_values_that_are_no_numbers_are_refused(tube):
    with pytest.raises(InputError, match="not a number"):
        solve_variants(tube, RUN, {"masses.payload.mass": ["heavy"]})


def test_one_parameter_may_stand_by_itself(tube):
    (name,) = sensitivities(tube, RUN, "masses.payload.mass")[QUANTITY]
    assert name == "masses.payload.mass"


def test_variants_can_be_stopped_and_followed_while_they_are_prepared(tube, monkeypatch):
    made, shares = [], []

    def counted(structure, run):
        made.append(structure)
        return planar_case(structure, run)

    monkeypatch.setattr("crumple.multibody.variants.batch.planar_case", counted)
    walls = {"sections.tube.thickness": np.linspace(0.0019, 0.0021, 10)}
    solve_variants(tube, RUN, walls, progress=shares.append)
    assert shares[:10] == pytest.approx(np.linspace(0.0, 0.45, 10))
    assert shares == sorted(shares)
    made.clear()
    with pytest.raises(CancelledError, match="while the variants were prepared"):
        solve_variants(tube, RUN, walls, cancel=lambda: len(made) >= 4)
    assert len(made) == 4
