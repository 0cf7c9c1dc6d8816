"""Figures of what is asked: their curves enclose the right energies, show the right time, and are sorted."""

import csv
import html
import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.support.result.synthetic_frame import CUBE, frame_result
from tests.support.result.synthetic_tube import tube_result

from crumple.analysis import loads, solve
from crumple.report.drawing.style import drawing
from crumple.report.drawing.window import happening, window_sentence
from crumple.report.figures.answers.force import over_path
from crumple.report.page_figures import answers, draw
from crumple.report.wording.along import crush_table
from crumple.result import Channel

RAILS = Path(__file__).parents[4] / "examples" / "11_front_rails.yaml"
MASS, SPEED = 294.0 + 6.0, 7.0

DRIVEN = """
crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {t: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [1 m, 0 m, 0 m]}
members: {m: {nodes: [a, b], section: t, material: s, hinges: auto}}
supports:
  clamp: {node: a, fix: all}
  press: {node: b, motion: {z: {table: {time: [0 s, 1 s], value: [0 mm, -100 mm]}}}}
analysis: {duration: 1 s}
"""


def data(svg):
    """Rows of the figure's data, headings first."""
    text = re.search(r"""data-csv=("[^"]*"|'[^']*')""", svg)[1][1:-1]
    return list(csv.reader(io.StringIO(html.unescape(text))))


def curves(svg):
    """Columns by heading, without the cells that are empty; of one that comes twice the last."""
    rows = data(svg)
    return {head: [row[i] for row in rows[1:] if row[i]] for i, head in enumerate(rows[0])}


def panels(text):
    analysis = loads(text)
    result = solve(analysis)
    with drawing():
        return result, dict(answers(result, analysis.structure, analysis.outputs).panels)


def area(svg, x, y):
    """Integral of the first curve."""
    rows = data(svg)
    assert rows[0][:2] == [x, y]
    points = np.array([row[:2] for row in rows[1:]], float)
    return float(np.sum((points[1:, 1] + points[:-1, 1]) / 2 * np.diff(points[:, 0])))


@pytest.fixture(scope="module", name="rails")
def _rails():
    return panels(RAILS.read_text())


def test_the_force_on_a_wall_does_the_work_that_stops_the_car(rails):
    result, found = rails
    energy = float(result["energy.kinetic"][0] - result["energy.kinetic"][-1])
    work = area(found["force_path_1"], "travel of centre, mm", "Force on wall, kN")
    # kN mm are J; the force is the mean since the last output, so the rule of trapezia errs in the peak
    assert work == pytest.approx(energy, rel=0.03)


def test_crush_zones_have_their_mean_and_peak(rails):
    result, found = rails
    for i, name in enumerate(("left", "right"), 1):
        zone = result.hinges[name].crush
        svg = found[f"crush_{i}"]
        assert f">mean {zone.mean_force / 1e3:.3g}<" in svg
        # by trapezia over the outputs, where the summary has the work of the steps
        assert f"peak {zone.peak_force / 1e3:.3g}" in svg
        assert area(svg, "crush, mm", f"Force of {name}, kN") == pytest.approx(zone.energy, rel=0.02)


BOX = """
crumple: 1
materials: {alu: {grade: 6060-T6, flow_stress: 170 MPa}}
sections: {tube: {type: square_tube, side: 70 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [250 mm, 0 m, 0 m]}
members:
  box:
    {nodes: [root, tip], section: tube, material: alu,
     hinges: [{name: crush, at: 125 mm, axial: {law: superfolding}}]}
supports: {base: {node: root, fix: all}}
obstacles:
  sled: {type: plane, point: [0.2501 m, 0 m, 0 m], normal: [-1, 0, 0], mass: 500 kg,
         velocity: [-5 m/s, 0 m/s, 0 m/s]}
analysis: {duration: 80 ms}
outputs: {every: 0.2 ms}
"""


def test_the_figure_and_the_table_of_a_zone_whose_folds_close_name_the_same_forces():
    """A sum over the outputs took the spike of the closed folds for work: 33.5 kN beside 30.8 kN."""
    result, found = panels(BOX)
    assert result.hinges["crush"].crush.bottomed_out
    table = crush_table(result)
    shown = dict(zip(table.heads, table.rows[0], strict=True))
    for line in ("Mean", "Peak"):
        assert f">{line.lower()} {float(shown[f'{line} force, kN']):.3g}<" in found["crush_1"]
    assert "unfiltered" in table.caption
    assert "unfiltered" in found["crush_1"]


def test_each_kind_of_answer_is_there(rails):
    _, found = rails
    assert list(found) == ["force_1", "force_path_1", "crush_1", "crush_2", "distances", "pulse", "zones"]
    assert "Filtered acceleration, g" in found["pulse"]
    peak = max(map(float, curves(found["pulse"])["deceleration_cfc60: Filtered acceleration, g"]))
    assert peak == pytest.approx(np.abs(rails[0]["deceleration_cfc60"]).max() / 9.80665, rel=1e-4)
    bars = curves(found["zones"])
    assert bars[""] == ["left_rail", "right_rail"]
    energies = [float(rails[0][f"member.{name}.energy"][-1]) / 1e3 for name in bars[""]]
    assert list(map(float, bars["Energy absorbed by member, kJ"])) == pytest.approx(energies, rel=1e-4)


def test_without_a_requested_filter_the_heaviest_node_has_one():
    text = RAILS.read_text()
    begin = text.index("  filters:")
    text = text[:begin] + text[text.index("  pictures:") :]
    _, found = panels(text)
    assert "Acceleration, CFC 60, g" in found["pulse"]


def test_a_barrier_shows_its_velocity_and_travel():
    text = RAILS.read_text().replace("initial_velocity:\n  - {translation: [-7 m/s, 0 m/s, 0 m/s]}", "")
    text = text.replace("friction: 0.3}", "friction: 0.3, mass: 900 kg, velocity: [7 m/s, 0 m/s, 0 m/s]}")
    result, found = panels(text)
    assert {"force_1", "velocity_1", "travel_1"} <= set(found)
    speed = np.array(curves(found["velocity_1"])["Velocity of wall, m/s"], float)
    assert speed[0] == pytest.approx(SPEED, abs=0.3)
    assert speed.min() == pytest.approx(result["obstacle.wall.velocity.x"].min(), rel=1e-3)
    lost = 900.0 / 2 * (SPEED**2 - result["obstacle.wall.velocity.x"][-1] ** 2)
    assert area(found["force_1"], "travel, mm", "Force on wall, kN") == pytest.approx(lost, rel=0.03)


def test_a_driven_support_shows_its_force_over_its_travel():
    structure = loads(DRIVEN).structure
    time = np.linspace(0.0, 1.0, 101)
    force = 500.0 * np.minimum(time / 0.2, 1.0)
    names = [("x", 0 * time), ("y", 0 * time), ("z", force)]
    result = tube_result(
        time=time,
        channels={f"support.press.force.{a}": Channel(f"support.press.force.{a}", "N", v) for a, v in names},
        output_names=(),
    )
    with drawing():
        found = dict(answers(result, structure, None).panels)
    # the press goes down and the structure pushes it up: the force resists
    assert area(found["drive_1"], "travel, mm", "Force of press, z, N") == pytest.approx(45_000.0)
    assert "mean 450" in found["drive_1"]
    assert "peak 500" in found["drive_1"]


def test_the_mean_force_is_the_work_over_the_longest_path():
    x = np.array([0.0, 0.1, 0.2, 0.15])
    with drawing():
        svg = over_path("f", ("Force", "N"), x, np.array([0.0, 300.0, 300.0, 0.0]))
        assert over_path("f", ("Force", "N"), -x, x) is None
    assert "mean 225" in svg
    with drawing():
        large = over_path("f", ("Force", "N"), x, 3e4 * np.array([0.0, 300.0, 300.0, 0.0]))
    assert "mean 6750" in large
    assert "peak 9000" in large
    assert "peak 300" in svg


def late(total=1001):
    """Energy is absorbed between 9 s and 9.5 s of 10 s."""
    time = np.linspace(0.0, 10.0, total)
    absorbed = np.interp(time, [9.0, 9.5], [0.0, 100.0])
    return tube_result(
        time=time,
        channels={
            "energy.dissipated": Channel("energy.dissipated", "J", absorbed),
            "energy.kinetic": Channel("energy.kinetic", "J", 100.0 - absorbed),
        },
        output_names=(),
    )


def test_curves_show_the_time_in_which_something_happens():
    result = late()
    shown = result.time[happening(result)]
    assert 8.85 < shown[0] < 9.0
    assert 9.5 < shown[-1] < 9.75
    assert "of 10 s" in window_sentence(result)
    energy = next(figure for figure in draw(result, None) if figure.name == "energy")
    times = np.array(curves(dict(energy.panels)["energy"])["time, s"], float)
    assert (times[0], times[-1]) == pytest.approx((shown[0], shown[-1]))


@pytest.mark.parametrize(
    "result",
    [tube_result(), tube_result(channels={}), tube_result(time=np.zeros(0), channels={}, output_names=())],
)
def test_the_whole_run_is_shown_if_it_cannot_be_cut(result):
    assert happening(result) == slice(0, len(result.time))
    assert window_sentence(result) == ""


def test_energy_by_hinge_where_members_have_none():
    result = frame_result(CUBE, 12)
    result = replace(result, channels={k: c for k, c in result.channels.items() if "member." not in k})
    with drawing():
        svg = dict(answers(result, None, None).panels)["zones"]
    lengths = list(map(float, next(v for k, v in curves(svg).items() if "by hinge" in k)))
    assert lengths == sorted(lengths, reverse=True)
    assert len(lengths) == 10
