"""Runs from end to end on coarse meshes: closed forms, names, restart, cancelling, failures, shapes."""

import json
from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.structures import cantilever, knee, structure, tee, thrown

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError, Status
from crumple.shell import LongRun, ShellRun, lower, solve_shell
from crumple.shell.answer.record import Record
from crumple.shell.restart import read_restart, write_restart
from crumple.shell.stepping import with_place
from crumple.structure import Outputs, ShellSettings, Stage

COARSE = ShellSettings(element_size=24e-3)
OUTPUTS = Outputs(
    nodes=("root", "tip"),
    section_rotations={"bend": {"member": "tube", "from": 0.0, "to": 1.0}},
    distances={"apart": {"from": "tip", "to": "root"}},
    pictures=(0.0, 2e-3, 4e-3),
)


def run(duration=4e-3, every=2e-4, **more):
    return ShellRun(duration, every, **{"settings": COARSE, "outputs": OUTPUTS, **more})


@pytest.fixture(scope="module")
def result():
    return solve_shell(thrown(), run())


def test_run_completes_and_balances_its_energy(result):
    assert result.status is Status.COMPLETE
    assert result.energy_residual < 1e-4
    total = sum(
        result[f"energy.{name}"] for name in ("kinetic", "elastic", "dissipated", "hourglass", "contact")
    )
    assert total == pytest.approx(result["energy.kinetic"][0], rel=1e-4)


def test_channels_are_those_of_the_multibody_solver(result):
    from crumple.multibody import Run, solve_multibody

    other = solve_multibody(thrown(), Run(4e-3, 2e-4, outputs=OUTPUTS))
    missing = set(other.channels) - set(result.channels)
    assert missing == {"hinge.root.capacity", "member.tube.energy"}
    for name in set(other.channels) & set(result.channels):
        assert other.channels[name].unit == result.channels[name].unit
    assert result.output_names == other.output_names


def test_both_solvers_turn_the_same_way_at_first(result):
    from crumple.multibody import Run, solve_multibody

    other = solve_multibody(thrown(), Run(4e-3, 2e-4, outputs=OUTPUTS))
    for name in ("node.tip.displacement.z", "node.tip.velocity.z"):
        assert result[name][-1] == pytest.approx(other[name][-1], rel=0.1), name
    # rigid bars have no elastic rotation of the tip
    for name in ("bend", "node.tip.rotation.y"):
        assert 1.0 < result[name][-1] / other[name][-1] < 1.7, name
    assert np.sign(result["hinge.root.rotation"][-1]) == np.sign(other["hinge.root.rotation"][-1])
    assert np.sign(result["hinge.root.moment"][-1]) == np.sign(other["hinge.root.moment"][-1])


def test_distance_is_that_of_its_nodes(result):
    moved = np.stack([result[f"node.tip.displacement.{axis}"] for axis in "xyz"], axis=1)
    apart = np.linalg.norm(np.array([1.0, 0.0, 0.0]) + moved, axis=1)
    # both are interpolated from the steps around an output time
    assert result["apart"] == pytest.approx(apart - 1.0, abs=2e-7)
    assert result["apart"][-1] < -1e-4


def test_distances_need_no_node_outputs():
    alone = solve_shell(thrown(), run(2e-4, outputs=Outputs(distances=OUTPUTS.distances)))
    assert alone.output_names == ("apart",)
    assert not any(name.startswith("node.") for name in alone.channels)


def test_times_are_those_asked_for(result):
    assert result.time == pytest.approx(np.arange(21) * 2e-4)


def test_plastic_work_of_the_hinge_is_part_of_the_whole(result):
    assert 0.0 < result["hinge.root.energy"][-1] <= result["energy.dissipated"][-1] * (1 + 1e-12)


def test_moments_in_the_cut_and_at_the_support_agree(result):
    # the cut of the hinge lies 23 mm inside: less the force times the arm
    arm = lower(thrown(), COARSE, OUTPUTS).mesh.tubes["tube"].stations[1]
    force = result["support.clamp.force.z"]
    at_root = result["support.clamp.moment.y"]
    # the clamp is pulled up and turned against y
    expected = at_root + arm * force
    moment = result["cut.root.moment.y"]
    assert np.abs(moment - expected).max() < 0.1 * np.abs(at_root).max()
    assert result["hinge.root.moment"][-1] == pytest.approx(moment[-1], rel=1e-2)


def test_shapes_carry_the_walls_fields(result):
    states = result.states
    assert states.times == pytest.approx([0.0, 2e-3, 4e-3], abs=1e-5)
    assert set(states.cell_data) == {"plastic_strain", "plastic_work", "thickness", "von_mises"}
    assert all(values.shape == (3, len(states.quads)) for values in states.cell_data.values())
    work = states.cell_data["plastic_work"].sum(axis=1)
    assert work[-1] > 1.0
    assert work == pytest.approx(np.interp(states.times, result.time, result["energy.dissipated"]), rel=1e-3)
    assert states.cell_data["thickness"][0] == pytest.approx(2.65e-3)
    assert states.cell_data["von_mises"].max() <= 488e6 * (1 + 1e-6)
    tip = states.station == states.station.max()
    moved = states.displacement[-1, tip].mean(axis=0)
    assert moved[2] == pytest.approx(result["node.tip.displacement.z"][-1], rel=1e-3)


def test_shapes_of_a_knee_have_all_rings_of_both_members():
    states = solve_shell(knee(), run(1e-5, 1e-5, outputs=Outputs())).states
    for i, name in enumerate(states.member_names):
        rings = lower(knee(), COARSE).mesh.tubes[name].nodes.shape
        assert (states.member == i).sum() == rings[0] * rings[1]


def test_free_fall_is_a_parabola():
    free = structure(
        {"root": (0, 0, 0), "tip": (1, 0, 0)}, {"tube": ("root", "tip")}, gravity=(0.0, 0.0, -9.81)
    )
    fallen = solve_shell(free, run(2e-3, 5e-4, outputs=Outputs(nodes=("tip",))))
    # between output and step the linear interpolation errs by less than g h dt / 2
    assert fallen["node.tip.displacement.z"] == pytest.approx(-9.81 * fallen.time**2 / 2, abs=2e-8)
    assert fallen["energy.external_work"][-1] == pytest.approx(fallen["energy.kinetic"][-1], rel=1e-6)
    assert fallen["energy.elastic"] == pytest.approx(np.zeros(fallen.time.size), abs=1e-9)


def test_free_body_keeps_its_turning():
    free = structure(
        {"root": (0, 0, 0), "tip": (1, 0, 0)},
        {"tube": ("root", "tip")},
        initial_velocity=[{"rotation": 100.0, "about": (0.5, 0, 0), "axis": (0, 0, 1)}],
    )
    turned = solve_shell(free, run(5e-3, 1e-3, outputs=Outputs(nodes=("tip",))))
    # centrifugal stretch and the first pull of it are of the order rho (w L)^2 / E
    assert turned["node.tip.rotation.z"] == pytest.approx(100.0 * turned.time, abs=2e-4)
    assert turned["node.tip.displacement.x"][-1] == pytest.approx(0.5 * (np.cos(0.5) - 1), abs=1e-4)


def test_pin_lets_the_end_turn_about_it():
    pinned = cantilever(
        supports={"pin": {"node": "root", "fix": "pin"}},
        initial_velocity=[{"rotation": 20.0, "axis": (0, -1, 0)}],
    )
    turned = solve_shell(pinned, run(5e-3, 1e-3, outputs=Outputs(nodes=("root", "tip"))))
    assert not turned.warnings
    assert turned["node.root.displacement.z"] == pytest.approx(np.zeros(6), abs=1e-12)
    assert turned["node.root.rotation.y"][-1] == pytest.approx(-0.1, rel=2e-3)
    assert turned["energy.dissipated"][-1] == 0.0


def test_threads_change_no_bit(result):
    again = solve_shell(thrown(), run(threads=2))
    assert all(np.array_equal(again[name], result[name]) for name in result.channels)


def test_run_ends_with_a_picture_where_the_caller_has_enough(result):
    asked = []

    def enough(channels):
        asked.append(len(channels["energy.kinetic"]))
        return channels["bend"][-1] < result["bend"][10]

    stopped = solve_shell(thrown(), run(), long_run=LongRun(enough=enough))
    assert asked == [4, 8, 12]
    assert stopped.status is Status.COMPLETE
    assert all(np.array_equal(stopped[name], result[name][:12]) for name in ("bend", "energy.kinetic"))
    assert stopped.states.times == pytest.approx([0.0, 2e-3, 2.2e-3], rel=3e-3)


def test_stages_that_are_left_do_not_run_if_the_caller_has_enough():
    stages = (Stage(name="first", duration=2e-3), Stage(name="second", duration=2e-3))
    stopped = solve_shell(thrown(), run(stages=stages), long_run=LongRun(enough=lambda channels: True))
    assert stopped.status is Status.COMPLETE
    assert [(stage.name, stage.ended_by) for stage in stopped.stages] == [("first", "all that is needed")]
    assert stopped.time[-1] == pytest.approx(6e-4)


def test_cancelled_run_keeps_what_it_has_and_goes_on_with_the_same_bits(result, tmp_path):
    asked = iter(range(1000))
    file = tmp_path / "restart.npz"
    stopped = solve_shell(thrown(), run(), cancel=lambda: next(asked) > 7, long_run=LongRun(restart_to=file))
    assert stopped.status is Status.CANCELLED
    assert 0 < len(stopped.time) < len(result.time)
    assert file.exists()
    resumed = solve_shell(thrown(), run(threads=2), long_run=LongRun(restart_from=file, restart_to=file))
    assert resumed.status is Status.COMPLETE
    # whoever has put the results on the disk removes it
    assert file.exists()
    assert all(np.array_equal(resumed[name], result[name]) for name in result.channels)
    for name, values in result.states.cell_data.items():
        assert np.array_equal(resumed.states.cell_data[name], values)
    assert np.array_equal(resumed.states.displacement, result.states.displacement)


def test_restart_file_of_another_input_is_refused(tmp_path):
    file = tmp_path / "restart.npz"
    asked = iter(range(1000))
    solve_shell(thrown(), run(), cancel=lambda: next(asked) > 3, long_run=LongRun(restart_to=file))
    with pytest.raises(InputError, match="another input"):
        solve_shell(thrown(), run(every=1e-4), long_run=LongRun(restart_from=file))
    file.write_bytes(b"PK\x03\x04 not whole")
    with pytest.raises(InputError, match="no restart file"):
        solve_shell(thrown(), run(), long_run=LongRun(restart_from=file))


def test_restart_file_whose_histories_or_conditions_are_cut_is_refused(tmp_path):
    file, asked = tmp_path / "restart.npz", iter(range(1000))
    solve_shell(thrown(), run(), cancel=lambda: next(asked) > 7, long_run=LongRun(restart_to=file))
    with np.load(file) as arrays:
        head = json.loads(arrays["head"].tobytes())
    mark, whole = head["mark"], read_restart(file, head["mark"], head["isa"])
    rows, shapes = whole.record.rows, whole.record.shapes
    cut = [
        {"record": Record(rows | {"energy": rows["energy"][:-1]}, shapes)},
        {"record": Record(rows | {"energy": [row[:-1] for row in rows["energy"]]}, shapes)},
        {"record": Record({name: rows[name] for name in rows if name != "zone"}, shapes)},
        {"record": Record(rows, shapes | {"displacement": shapes["displacement"][:-1]})},
        {"state": dict(list(whole.state.items())[1:])},
        {"state": {name: values.astype(complex) for name, values in whole.state.items()}},
        {"watch": whole.watch | {"numbers": whole.watch["numbers"][:-1]}},
        {"watch": whole.watch | {"vectors": np.zeros((3, 3))}},
    ]
    for change in cut:
        write_restart(file, replace(whole, **change), mark)
        with pytest.raises(InputError, match=r"damaged|lacks"):
            solve_shell(thrown(), run(), long_run=LongRun(restart_from=file))
    write_restart(file, whole, mark)
    assert solve_shell(thrown(), run(), long_run=LongRun(restart_from=file)).status is Status.COMPLETE


def test_run_cancelled_at_once_is_a_result():
    stopped = solve_shell(thrown(), run(), cancel=lambda: True)
    assert stopped.status is Status.CANCELLED
    assert np.isfinite(stopped["energy.kinetic"]).all()


def test_hopeless_step_ends_with_a_status_and_keeps_the_results():
    # a least step just below the first one stands for an element that collapses
    graded = ShellSettings(element_size=30e-3, fine_size=8e-3, fine_length=40e-3, growth=1.5)
    first = ShellState(lower(thrown(), graded).model).first_time_step
    settings = graded.model_copy(update={"minimum_time_step": 0.98 * first})
    ended = solve_shell(thrown(), run(30e-3, 2e-4, settings=settings))
    assert ended.status is Status.STEP_COLLAPSED
    assert "member tube" in ended.reason
    assert len(ended.time) > 1
    assert all(np.isfinite(channel.values).all() for channel in ended.channels.values())


def test_reason_names_the_place_of_an_element():
    case = lower(thrown(), COARSE)
    assert "(member tube," in with_place("element 12 is not finite", case)
    assert with_place("nothing", case) == "nothing"


def test_energy_that_contact_gave_is_looked_for(monkeypatch):
    seen = []

    def told(contact, internal):
        seen.append((len(contact), internal))
        return ["told"]

    monkeypatch.setattr("crumple.shell.checks.trust.given_by_contact", told)
    result = solve_shell(thrown(), run(2e-4))
    assert "told" in result.warnings
    assert seen[0][0] == len(result.time)
    assert seen[0][1] > 0.0


def test_added_mass_is_reported():
    settings = ShellSettings(element_size=24e-3, mass_scaling=4e-6)
    scaled = solve_shell(thrown(), run(2e-4, settings=settings))
    assert any("Mass scaling added" in warning for warning in scaled.warnings)
    assert scaled.provenance.settings["first_time_step"] >= 4e-6 * (1 - 1e-9)


def test_outputs_nearer_than_a_time_step_have_finite_channels():
    dense = solve_shell(thrown(), run(1e-5, 5e-7, outputs=Outputs(nodes=("tip",))))
    assert len(dense.time) == 21
    for name, channel in dense.channels.items():
        assert np.isfinite(channel.values).all(), name
    # nothing jumps between outputs
    assert np.abs(dense["node.tip.acceleration.x"]).max() < 1.0


def test_energy_lost_at_a_clamp_is_reported():
    given = cantilever(
        supports={"left": {"node": "root", "fix": "all"}, "right": {"node": "tip", "fix": "all"}},
        masses={"m": {"node": "tip", "mass": 1.0}},
        initial_velocity=[{"translation": (0.0, 0.0, 5.0)}],
    )
    lost = solve_shell(given, run(2e-5, 1e-5, outputs=Outputs()))
    assert any("lost at the start" in warning for warning in lost.warnings)


def test_watcher_hears_where_a_run_is(monkeypatch):
    heard = []
    monkeypatch.setattr("crumple.shell.stepping.WATCH_EVERY", 0.0)
    solve_shell(thrown(), run(), long_run=LongRun(watch=heard.append))
    assert heard
    moment = heard[len(heard) // 2]
    assert 0 < moment.time < moment.duration
    assert moment.seconds_left > 0
    assert moment.energies["kinetic"] > 0


def test_three_members_at_a_node_move_as_one_body():
    given = tee().model_copy(update={"initial_velocity": [{"translation": (0.0, 0.0, 2.0)}]})
    moved = solve_shell(given, run(2e-3, 5e-4, outputs=Outputs(nodes=("b", "d"))))
    assert moved.status is Status.COMPLETE
    assert moved.energy_residual < 1e-3
    assert moved["node.b.displacement.z"][-1] > 1e-3


def test_hinges_of_a_frame_are_measured_each_in_its_stretch():
    nodes = {"a": (0, 0, 0), "b": (0, 0, 0.4), "c": (0.5, 0, 0.4), "d": (0.5, 0, 0)}
    portal = structure(
        nodes,
        {"left": ("a", "b"), "beam": ("b", "c"), "right": ("c", "d")},
        supports={"one": {"node": "a", "fix": "all"}, "two": {"node": "d", "fix": "all"}},
        masses={"m": {"node": "b", "mass": 20.0}},
        initial_velocity=[{"translation": (8.0, 0.0, 0.0), "nodes": ["b"]}],
    )
    hinged = {
        "left": [{"name": "foot", "at": "a", "law": "kecman"}, {"name": "head", "at": "b", "law": "kecman"}],
        "right": [{"name": "other", "at": "d", "law": "kecman"}],
    }
    members = {
        name: member.model_copy(update={"hinges": hinged.get(name, [])})
        for name, member in portal.members.items()
    }
    moved = solve_shell(
        portal.model_copy(update={"members": members}), run(20e-3, 5e-4, outputs=Outputs(nodes=("b", "c")))
    )
    assert moved.status is Status.COMPLETE
    assert set(moved.hinges) == {"foot", "head", "other"}
    # leaning to +x is a turn about +y: section y of the left column is -y, and the right one runs down
    assert moved["node.b.displacement.x"][-1] > 0.02
    assert moved["hinge.foot.rotation"][-1] < -0.02
    assert moved["hinge.other.rotation"][-1] < -0.02
    for name in ("foot", "other"):
        moment, rotation = moved[f"hinge.{name}.moment"], moved[f"hinge.{name}.rotation"]
        work = ((moment[1:] + moment[:-1]) / 2 * np.diff(rotation)).sum()
        assert work > 0.5 * moved[f"hinge.{name}.energy"][-1]
    parts = sum(moved[f"hinge.{name}.energy"][-1] for name in moved.hinges)
    assert parts <= moved["energy.dissipated"][-1]


def test_a_restart_file_that_cannot_be_written_is_a_warning_and_the_run_goes_on(
    result, tmp_path, monkeypatch
):
    warnings = []
    monkeypatch.setattr("crumple.shell.stepping.SAVE_EVERY", 0.0)
    nowhere = LongRun(restart_to=tmp_path / "file" / "restart.npz", warn=warnings.append)
    (tmp_path / "file").write_text("in the way")
    ended = solve_shell(thrown(), run(), long_run=nowhere)
    assert ended.status is Status.COMPLETE
    assert warnings[-1].startswith("The restart file")
    assert warnings[-1] in ended.warnings
    assert all(np.array_equal(ended[name], result[name]) for name in result.channels)


def test_a_run_that_was_saved_at_its_end_gives_the_same_answer_without_a_step(result, tmp_path, monkeypatch):
    file = tmp_path / "restart.npz"
    monkeypatch.setattr("crumple.shell.stepping.SAVE_AT_END", 0.0)
    solve_shell(thrown(), run(), long_run=LongRun(restart_to=file))
    monkeypatch.setattr(ShellState, "advance", None)
    again = solve_shell(thrown(), run(), long_run=LongRun(restart_from=file))
    assert again.status is Status.COMPLETE
    assert all(np.array_equal(again[name], result[name]) for name in result.channels)


@pytest.mark.parametrize("change", [lambda a: a[:0], lambda a: a[:-1], lambda a: a + 1.0])
@pytest.mark.parametrize("name", ["state/contact", "state/elements", "rows/energy", "shapes/position"])
def test_a_restart_file_whose_arrays_were_changed_is_refused(tmp_path, name, change):
    file = tmp_path / "restart.npz"
    asked = iter(range(1000))
    solve_shell(thrown(), run(), cancel=lambda: next(asked) > 3, long_run=LongRun(restart_to=file))
    with np.load(file) as saved:
        arrays = dict(saved)
    name = name if name in arrays else next(key for key in arrays if key.startswith(name.split("/")[0]))
    arrays[name] = change(arrays[name])
    np.savez(file, **arrays)
    with pytest.raises(InputError, match="damaged"):
        solve_shell(thrown(), run(), long_run=LongRun(restart_from=file))
