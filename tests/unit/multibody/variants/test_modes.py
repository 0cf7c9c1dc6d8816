"""Modes of collapse: the S-rail slides or sticks, runs are grouped by rotations, obstacles are moved."""

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple._core.spatial.batch import solve_many
from crumple.analysis import loads, solve, with_modes
from crumple.analysis.solve import run_of
from crumple.cli.main import app
from crumple.errors import CancelledError, Status
from crumple.multibody import modes
from crumple.multibody.variants.contact_points import contact_points
from crumple.multibody.variants.modes import _alone, _between, grouped, is_impact
from crumple.multibody.variants.variants import solve_variants
from crumple.result import read, summary, write
from crumple.result.nearby import Mode, Modes, modes_of
from crumple.structure import changed, plastic_hinges

RAIL = Path("examples/08_s_rail.yaml").read_text(encoding="utf-8")
PUSHED = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [0 m, 0 m, 0.5 m], arm: [0.1 m, 0 m, 0.5 m]}
members:
  post: {nodes: [root, tip], section: tube, material: steel}
  arm: {nodes: [tip, arm], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: root, fix: all}}
obstacles:
  pole: {type: cylinder, point: [-0.1 m, 0 m, 0.4 m], axis: [0, 1, 0], radius: 5 cm, motion: {x: MOTION}}
  ball: {type: sphere, point: [0.2 m, 0 m, 0.4 m], radius: 5 cm, mass: 5 kg, velocity: [-1 m/s, 0 m/s, 0 m/s]}
  floor: {type: plane, point: [0 m, 0 m, -0.2 m], normal: [0, 0, 2]}
  ditch: {type: plane, point: [0 m, 0 m, -0.3 m], normal: [0, 0, 1], edge: [3, 0, 0]}
analysis: {duration: 10 ms}
""".replace("MOTION", "{table: {time: [0 s, 1 s], value: [0 m, 1 m]}}")


def rail(friction, **settings):
    analysis = loads(RAIL.replace("friction: 0.2", f"friction: {friction}"))
    multibody = analysis.multibody.model_copy(update=settings)
    return analysis.model_copy(update={"multibody": multibody})


def solved(friction):
    analysis = rail(friction, members="rigid")
    return with_modes(solve(analysis), analysis)


@pytest.mark.parametrize(("friction", "number"), [(0.1, 1), (0.24, 2), (0.3, 2), (0.6, 1)])
def test_the_rail_slides_or_sticks_and_near_the_edge_does_both(friction, number):
    result = solved(friction)
    assert result.status.ok
    assert len(result.modes.modes) == number
    assert result.modes.failed == ()
    runs = [name for mode in result.modes.modes for name in mode.runs]
    assert len(runs) == len(set(runs)) == 9
    assert runs[0] == "as given"
    found = [caution for caution in result.cautions if caution.code == "modes"]
    assert len(found) == (number > 1)
    if number > 1:
        other = "more friction" if friction < 0.28 else "less friction"
        assert other in result.modes.modes[1].runs
        assert result.warnings[0] == found[0].text == result.modes.sentence


def test_modes_that_are_stopped_are_not_those_of_runs_that_failed(monkeypatch):
    """Of the runs in one batch, and of one alone, for which the pole meets the tube elsewhere."""

    def stopped(*what, **options):
        table = solve_variants(*what, **options)
        return replace(table, status=(*table.status[1:], Status.CANCELLED))

    analysis = rail(0.1, members="rigid")
    result = solve(analysis)
    monkeypatch.setattr("crumple.multibody.variants.modes.solve_variants", stopped)
    with pytest.raises(CancelledError, match="while the variants were solved: the modes of collapse are not"):
        with_modes(result, analysis)
    pushed = loads(PUSHED)
    with pytest.raises(CancelledError, match="while the variants were solved: the modes of collapse are not"):
        _alone(pushed.structure, run_of(pushed), {"hinges.post-pole.capacity": 1.0}, 1, None)


def test_modes_are_kept_in_all_files(tmp_path):
    result = solved(0.3)
    write(result, tmp_path / "result.vtkhdf")
    assert read(tmp_path / "result.vtkhdf").modes == result.modes
    (first, second) = summary(result)["modes"]["modes"]
    assert first["hinges"][0] == "corner-upper_bend"
    assert second["runs"] == list(result.modes.modes[1].runs)


@pytest.mark.parametrize(("option", "said"), [(["--modes"], "fold alike"), (["--no-modes"], "")])
def test_the_command_says_that_there_is_one(tmp_path, option, said):
    # at the friction of the example, 0.2, another pattern of capacities folds both bends
    given = tmp_path / "rail.yaml"
    given.write_text(RAIL.replace("friction: 0.2", "friction: 0.15"), encoding="utf-8")
    out = CliRunner().invoke(app, ["run", str(given), "--out", str(tmp_path), *option])
    assert out.exit_code == 0
    assert ("fold alike" in out.output) == bool(said)
    stored = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert (stored["modes"] is None) == (not said)
    assert ("fold alike" in (tmp_path / "report.html").read_text(encoding="utf-8")) == bool(said)


def test_runs_are_grouped_by_rotations():
    runs = {
        "as given": np.radians([30.0, 0.0, 0.5]),
        "alike": np.radians([22.0, 8.0, 0.0]),
        "elsewhere": np.radians([0.0, 20.0, 0.0]),
        "more": np.radians([45.0, 0.0, 0.0]),
    }
    first, second, third = grouped(["a", "b", "c"], runs)
    assert (first.hinges, first.runs) == (("a",), ("as given", "alike"))
    assert (second.hinges, second.runs) == (("b",), ("elsewhere",))
    assert third.runs == ("more",)
    assert third.rotations == pytest.approx(np.radians([45.0]))
    # two degrees are no other mode, however small all rotations are
    assert len(grouped(["a"], {"as given": np.radians([0.1]), "other": np.radians([2.0])})) == 1
    assert grouped(["a"], {"as given": np.zeros(1)})[0].hinges == ()


def test_a_mode_in_which_hinges_hardly_turn_says_what_is_crushed():
    turned = {
        "as given": np.radians([170.0, 160.0, 0.0]),
        "crushed": np.radians([0.0, 12.0, 26.0]),
        "still": np.radians([0.0, 0.0, 0.01]),
    }
    slips = {"as given": {"a": -0.012, "b": -0.01}, "crushed": {"a": -0.0489, "b": 0.0253, "c": -0.0009}}
    given, crushed, *_ = grouped(["a", "b", "c"], turned, slips)
    assert given.slips == ()
    assert given.told == "a 1.7e+02°, b 1.6e+02°"
    assert crushed.slips == (("a", -0.0489), ("b", 0.0253))
    # a fifth of its own largest rotation
    assert crushed.told == "c 26°, b 12°, and a shortens by 49 mm, b lengthens by 25 mm"
    only = {"as given": turned["as given"], "crushed": np.radians([0.0, 0.0, 0.01])}
    assert grouped(["a", "b", "c"], only, slips)[1].told == "a shortens by 49 mm, b lengthens by 25 mm"
    assert grouped(["a", "b", "c"], only)[1].told == "no hinge turns"
    # what no hinge took, members did
    took = {"as given": 5.0, "crushed": 310.0}
    said = [mode.told for mode in grouped(["a", "b", "c"], only, None, took)]
    assert said == ["a 1.7e+02°, b 1.6e+02°", "no hinge turns, members yield between hinges (310 J)"]
    # less than a millimetre is not named
    assert grouped(["a", "b", "c"], only, {"crushed": {"c": -0.0009}})[1].told == "no hinge turns"


def test_slips_are_kept_and_files_without_them_are_read():
    found = Modes(
        (
            Mode(("a",), (1.0,), ("as given",)),
            Mode((), (), ("crushed",), (("a", -0.04),)),
            Mode((), (), ("yields",), (), 310.0),
        )
    )
    stored = json.loads(json.dumps(asdict(found)))
    assert modes_of(stored) == found
    for mode in stored["modes"]:
        del mode["slips"], mode["between"]
    assert [(mode.slips, mode.between) for mode in modes_of(stored).modes] == [((), 0.0)] * 3


STRUTS = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {b: {type: circular_tube, diameter: 25.4 mm, thickness: 1.6 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [1.0 m, 0 m, 0 m], k: [0.5 m, 0 m, 1.1 m]}
members:
  p: {nodes: [a, k], section: b, material: steel}
  q: {nodes: [b, k], section: b, material: steel}
hinges: auto
supports: {a: {node: a, fix: all}, b: {node: b, fix: all}}
masses: {k: {node: k, mass: 200 kg}}
initial_velocity: [{translation: [0.3 m/s, 0 m/s, -5 m/s], nodes: [k]}]
analysis: {duration: 40 ms, multibody: {members: rigid}}
outputs: {every: 0.2 ms}
"""


def test_struts_that_are_crushed_are_no_mode_without_hinges():
    """In some runs the apex spins by 170°; in others the struts turn by less than a fifth of it and crush."""
    analysis = loads(STRUTS)
    result = with_modes(solve(analysis), analysis)
    assert "folded_over" in {caution.code for caution in result.cautions}
    (crushed,) = [mode for mode in result.modes.modes if mode.slips]
    assert min(slip for _, slip in crushed.slips) < -0.02
    assert "shortens by" in result.modes.sentence
    assert "no hinge turns" not in result.modes.sentence


def test_energy_that_no_hinge_took_is_of_members_unless_something_is_dented():
    last = {
        "energy.dissipated": 500.0,
        "energy.kinetic": 20.0,
        "hinge.a.energy": 150.0,
        "hinge.b.energy": 40.0,
    }
    assert _between(last, ["a", "b"]) == 310.0
    assert _between(last | {"hinge.b.energy": 350.0}, ["a", "b"]) == 0.0
    assert _between(last | {"obstacle.pole.dent": 2e-3}, ["a", "b"]) == 0.0


def test_capacities_friction_and_stiffness_change_by_their_shares(monkeypatch):
    asked = []

    def solve_and_keep(structure, run, columns, *rest, guided):
        assert guided
        asked.append(columns)
        return solve_variants(structure, run, columns, *rest, guided=guided)

    def solve_guided(*given, guided, **keys):
        assert guided
        return solve_many(*given, guided=guided, **keys)

    monkeypatch.setattr("crumple.multibody.variants.modes.solve_variants", solve_and_keep)
    monkeypatch.setattr("crumple.multibody.variants.batch.spatial_kernel.solve_many", solve_guided)
    analysis = rail(0.2, members="elastic")
    result = solve(analysis)
    modes(analysis.structure, run_of(analysis), result)
    (columns,) = asked
    assert sorted(set(columns["obstacles.wall.friction"])) == pytest.approx([0.15, 0.2, 0.25])
    assert sorted(set(columns["materials.steel.youngs_modulus"])) == pytest.approx([189e9, 210e9, 231e9])
    capacities = {path: values for path, values in columns.items() if path.endswith(".capacity")}
    bands = {
        f"hinges.{h.name}.capacity": h.law.validity.uncertainty for h in plastic_hinges(analysis.structure)
    }
    assert capacities.keys() == bands.keys()
    for path, values in capacities.items():
        band = bands[path] or 0.05
        assert sorted(set(values)) == pytest.approx([1.0 - band, 1.0, 1.0 + band])
        # as given, which leads the others; alternating, at random, and both reversed
        assert values[0] == 1.0
        assert values[1] - 1.0 == pytest.approx(1.0 - values[2])
    assert len({values[1] for values in capacities.values()}) > 1


STRUCK = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {left: [0 m, 0 m, 0 m], right: [0.6 m, 0 m, 0 m]}
members: {beam: {nodes: [left, right], section: tube, material: steel}}
hinges: auto
supports: {left: {node: left, fix: all}, right: {node: right, fix: all}}
obstacles:
  pole: {type: cylinder, point: [0.28 m, 0 m, 0.06 m], axis: [0, 1, 0], radius: 30 mm, mass: 60 kg, VELOCITY}
analysis: {duration: 15 ms}
""".replace("VELOCITY", "velocity: [0 m/s, 0 m/s, -6 m/s], guide: [0, 0, 1]")


def test_an_obstacle_that_strikes_elsewhere_folds_another_place():
    analysis = loads(STRUCK)
    result = with_modes(solve(analysis), analysis)
    runs = [name for mode in result.modes.modes for name in mode.runs]
    assert {"contact point one way", "contact point other way"} < set(runs)
    assert result.modes.failed == ()
    for mode in result.modes.modes:
        assert "beam-pole" in mode.hinges


@pytest.mark.parametrize("setting", ["off", "auto"])
def test_they_are_not_looked_for_unasked(setting):
    analysis = rail(0.2, mechanism_check=setting)
    if setting == "auto":
        # hinges that the input places are where it wants them
        analysis = loads(Path("examples/02_cantilever_chain.yaml").read_text(encoding="utf-8"))
    result = solve(analysis)
    assert modes(analysis.structure, run_of(analysis), result) is None
    assert with_modes(result, analysis).modes is None


def test_slow_loading_is_no_impact():
    stage = "analysis: {stages: [{name: push, kind: quasi-static, duration: 1 s}]}"
    slow = loads(PUSHED.replace("analysis: {duration: 10 ms}", stage).replace("mass: 5 kg, ", ""))
    assert not is_impact(slow.structure, run_of(slow))
    assert modes(slow.structure, run_of(slow), solve(slow)) is None
    fast = loads(PUSHED)
    assert is_impact(fast.structure, run_of(fast))
    still = changed(fast.structure, {"obstacles": {}})
    assert not is_impact(still, run_of(fast))


def test_obstacles_are_shifted_by_half_a_side_or_tilted():
    analysis = loads(PUSHED)
    structure = analysis.structure
    points = contact_points(structure, run_of(analysis))
    assert list(points) == ["contact point one way", "contact point other way"]
    first, second = (changed(structure, values) for values in points.values())
    for name, axis in (("pole", 2), ("ball", 2), ("ditch", 0)):
        places = [np.array(one.obstacles[name].point) for one in (first, second)]
        between = places[0] - places[1]
        assert abs(between[axis]) == pytest.approx(0.05)
        assert np.delete(between, axis) == pytest.approx([0.0, 0.0])
        assert sum(places) / 2.0 == pytest.approx(np.array(structure.obstacles[name].point))
    # the floor touches one edge of the post's end first, and is no nearer than it was
    corners = np.array([[x, y, 0.0] for x in (-0.025, 0.025) for y in (-0.025, 0.025)])
    firsts = []
    for one in (first, second):
        floor = one.obstacles["floor"]
        distances = (corners - np.array(floor.point)) @ np.array(floor.normal)
        assert np.linalg.norm(floor.normal) == pytest.approx(1.0)
        assert distances.min() == pytest.approx(0.2, abs=1e-9)
        firsts.append(corners[np.argmin(distances), 0])
    assert sorted(firsts) == [-0.025, 0.025]
