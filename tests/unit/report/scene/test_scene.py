"""The scene holds shapes, hinges, obstacles with their motion, masses, supports and forces of a result."""

import base64
import json
import zlib
from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_tube import rotation, tube_result, tube_states

from crumple.analysis import load, loads, solve_with_frames
from crumple.errors import InputError
from crumple.report.scene.coarse import coarsened
from crumple.report.scene.hinges import hinges_of_result, law_energy
from crumple.report.scene.page import store_scene, stored_scene, write_view
from crumple.report.scene.scene import Shown, write_scene
from crumple.result import HingeSummary, write

INPUT = """
crumple: 1
title: a tube thrown onto a turning plate beside a pole
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 3 mm}}
nodes: {a: [0, 0, 0], b: [1 m, 0, 0]}
members: {ab: {nodes: [a, b], section: tube, material: steel, hinges: [{at: 0.1 m, name: h}]}}
masses: {head: {node: b, mass: 1 kg}}
supports: {clamp: {node: a, fix: all}}
initial_velocity: [{rotation: 25 rad/s, axis: [0, -1, 0], about: [0.1 m, 0, 0], members: [ab]}]
obstacles:
  plate: {type: plane, point: [0, 0, 2 m], normal: [0, 0, -1],
    turning: {about: [0, 0, 2 m], axis: [0, 1, 0],
      angle: {table: {time: [0 s, 50 ms], value: [0 deg, 30 deg]}}}}
  pole: {type: cylinder, point: [2 m, 0, 0], axis: [0, 1, 0], radius: 100 mm, length: 1 m,
    velocity: [-2 m/s, 0, 0]}
  ball: {type: sphere, point: [0, 3 m, 0], radius: 200 mm}
outputs: {every: 1 ms}
analysis: {duration: 50 ms}
"""


def scene_of(result, structure=None, title=""):
    return write_scene([Shown("m", result, lambda s: hinges_of_result(result, s), structure)], title)


@pytest.fixture(scope="module", name="solved")
def _solved():
    analysis = loads(INPUT)
    return analysis, *solve_with_frames(analysis)


def test_obstacles_move_as_described(solved):
    analysis, _, frames = solved
    header = json.loads(scene_of(frames, analysis.structure).header)
    times = np.array(header["times"])
    plate, pole, ball = header["models"][0]["obstacles"]
    assert [one["name"] for one in (plate, pole, ball)] == ["plate", "pole", "ball"]
    assert plate["angle"] == pytest.approx(np.radians(30.0) * times / 0.05, abs=1e-6)
    assert plate["axis"] == [0.0, 1.0, 0.0]
    assert np.allclose(np.array(plate["points"])[:, 2], 2.0)
    assert np.array(pole["shift"])[:, 0] == pytest.approx(-2.0 * times, abs=1e-4)
    side = np.array(pole["points"])[24:72]
    assert np.hypot(side[:, 0] - 2.0, side[:, 2]) == pytest.approx(0.1, abs=1e-4)
    assert (side[:, 1].min(), side[:, 1].max()) == (0.0, 1.0)
    assert np.linalg.norm(np.array(ball["points"]) - [0, 3, 0], axis=1) == pytest.approx(0.2, abs=1e-4)


def test_masses_and_supports_move_with_the_structure(solved):
    analysis, _, frames = solved
    model = json.loads(scene_of(frames, analysis.structure).header)["models"][0]
    (mass,), (support,) = model["masses"], model["supports"]
    assert mass["mass"] == 1.0
    assert np.linalg.norm(np.diff(mass["place"], axis=0), axis=1).max() > 0.005
    assert np.allclose(support["place"], 0.0, atol=1e-6)
    assert {"x", "rz"} <= set(support["held"])
    (arrow,) = [entry for entry in model["forces"] if entry["on"] == "support"]
    expected = np.interp(0.02, frames.time, frames["support.clamp.force.z"])
    at = list(json.loads(scene_of(frames).header)["times"]).index(pytest.approx(0.02))
    assert arrow["force"][at][2] == pytest.approx(expected, rel=1e-3)


def test_without_a_structure_only_walls_and_hinges_are_shown(solved):
    model = json.loads(scene_of(solved[2]).header)["models"][0]
    assert [model[key] for key in ("obstacles", "masses", "supports", "forces")] == [[], [], [], []]
    assert [hinge["name"] for hinge in model["hinges"]] == ["h"]


def test_a_run_with_frames_is_the_run_without_them(solved):
    from crumple.analysis import solve

    analysis, stored, frames = solved
    plain = solve(analysis)
    assert len(plain.states.times) == 6
    assert len(frames.states.times) > 40
    alike = replace(stored, solve_seconds=plain.solve_seconds)
    assert alike.equals(plain)


def test_a_zone_that_folds_along_its_member_is_open_and_says_by_how_much():
    analysis = load("examples/15_crash_box.yaml")
    result, frames = solve_with_frames(analysis)
    hinges = json.loads(scene_of(frames, analysis.structure).header)["models"][0]["hinges"]
    box, rail = (next(one for one in hinges if one["name"] == name) for name in ("box", "rail"))
    assert box["travel"][-1] == pytest.approx(-result.hinges["box"].crush.length, rel=1e-3)
    assert (box["state"][0], max(box["state"]), box["state"][-1]) == (0, 2, 2)
    assert 1 in box["state"]
    assert set(rail["state"]) == {0}


def test_the_shapes_of_the_payload_are_those_of_the_result():
    states = tube_states(np.linspace(0.0, 0.1, 11))
    scene = scene_of(replace(tube_result(), states=states), title="tube")
    header, data = json.loads(scene.header), zlib.decompress(base64.b64decode(scene.payload))
    assert (header["format"], header["version"], header["title"]) == ("crumple-scene", 1, "tube")
    n, frames = 3 * len(states.points), len(states.times)
    at = 16 * len(states.quads)
    low, high = (np.frombuffer(data[at + k * n * frames :][: n * frames], np.uint8) for k in (0, 1))
    grid = np.cumsum((low + 256 * high.astype(np.uint16)).reshape(frames, n), axis=0, dtype=np.uint16)
    moved = grid[7].reshape(-1, 3) * header["step"] + header["origin"]
    assert np.allclose(moved, states.points + states.displacement[7], atol=header["step"])
    assert header["models"][0]["hinges"][0]["rotation"][7] == pytest.approx(-rotation(0.07), rel=1e-4)


def test_the_energy_of_a_law_is_its_integral_up_to_its_validity():
    law = {
        "rotation": np.array([0.0, 1.0, 2.0]),
        "positive": np.array([10.0, 10.0, 0.0]),
        "negative": np.zeros(3),
    }
    plain = {
        "rotation_max": 0.0,
        "rotation_final": 0.0,
        "time_of_rest": None,
        "energy": 0.0,
        "moment_max": 0.0,
    }
    assert law_energy(HingeSummary(**plain, envelope=law)) == pytest.approx(15.0)
    assert law_energy(HingeSummary(**plain, envelope=law, validity_rotation=0.5)) == pytest.approx(5.0)
    assert law_energy(HingeSummary(**plain)) is None


def test_large_shells_are_drawn_with_fewer_walls():
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    points = np.array([[x, np.cos(a), np.sin(a)] for x in np.linspace(0, 10, 200) for a in angle])
    i, j = np.divmod(np.arange(199 * 60), 60)
    quads = np.stack([60 * i + j, 60 * i + (j + 1) % 60, 60 * i + 60 + (j + 1) % 60, 60 * i + 60 + j], axis=1)
    states = replace(
        tube_states([0.0, 0.1]),
        points=points,
        quads=quads,
        member=np.zeros(len(points), dtype=int),
        station=points[:, 0],
        contour=np.zeros(len(points), dtype=int),
        displacement=np.stack([0.0 * points, points]),
        cell_data={"plastic_strain": np.stack([np.zeros(len(quads)), np.arange(len(quads))])},
    )
    few = coarsened(states, 3000)
    assert 500 < len(few.points) <= 3000
    assert few.quads.max() < len(few.points)
    assert few.cell_data["plastic_strain"].shape == (2, len(few.quads))
    # what is kept moves as before, and the shape keeps its size
    assert np.allclose(few.displacement[1], few.points)
    assert np.ptp(few.points, axis=0) == pytest.approx(np.ptp(points, axis=0), rel=0.03)
    assert coarsened(states, 20_000) is states


def test_a_stored_scene_is_read_back_and_shown(solved, tmp_path):
    analysis, _, frames = solved
    scene = scene_of(frames, analysis.structure, "</script>")
    store_scene(scene, tmp_path)
    again, title = stored_scene(tmp_path)
    assert (json.loads(again.header), again.payload) == (json.loads(scene.header), scene.payload)
    assert title == "</script>"
    page = write_view(tmp_path).read_text(encoding="utf-8")
    assert "&lt;/script&gt;" in page
    assert page.count("</script>") == page.count("<script")


def test_a_result_without_a_scene_is_shown_too(tmp_path):
    write(tube_result(), tmp_path)
    assert "crumple-scene" in write_view(tmp_path, tmp_path / "page.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("{", "not a scene, or is damaged"),
        ("[]", "not a scene, or is damaged"),
        ('{"format": "crumple-scene", "version": 1}', "payload"),
        (
            '{"format": "crumple-scene", "version": 9, "payload": "", "strain": 0, "times": [], "title": ""}',
            "version 9",
        ),
    ],
)
def test_a_damaged_or_newer_scene_is_refused(tmp_path, text, named):
    (tmp_path / "scene.json").write_text(text)
    with pytest.raises(InputError) as refused:
        stored_scene(tmp_path)
    problem = refused.value.problems[0]
    assert named in f"{problem.what} {problem.came}"
    assert problem.file == str(tmp_path / "scene.json")
