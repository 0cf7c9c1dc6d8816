"""The page with sliders: exact at solved values, marked between them, empty where nothing was solved."""

import csv
import time

import numpy as np
import pytest
from tests.unit.analysis.test_explore import EXAMPLES, TUBE, named

from crumple.analysis.explore import explore
from crumple.errors import InputError
from crumple.report.exploration import write_exploration

TOLD = "document.querySelector('[data-role=told]').textContent"
HINGE = "crumplePlayer.scene.models[0].hinges[0].rotation"


@pytest.fixture(scope="module", name="grid")
def _grid(tmp_path_factory):
    sliders = named("thickness=2 mm..14 mm,mass")
    points = explore(TUBE.analysis, sliders)
    return points, write_exploration(points, sliders, "a tube", tmp_path_factory.mktemp("explore"))


def opened(browser, page, width=1100):
    browser.open(page.as_uri(), width, 900)
    for _ in range(200):
        if browser.evaluate("document.getElementById('player').dataset.ready || ''"):
            return
        time.sleep(0.1)
    raise AssertionError(browser.evaluate("document.querySelector('p[data-role=note]').textContent"))


def put(browser, *places):
    for k, place in enumerate(places):
        browser.evaluate(
            f"(() => {{ const i = document.querySelectorAll('#explore input')[{k}]; i.value = {place};"
            " i.dispatchEvent(new Event('input')); return 1; })()"
        )
    return browser.evaluate(TOLD)


def test_solved_values_are_exact_and_others_are_between(browser, grid):
    points, page = grid
    opened(browser, page)
    ends = []
    for place, number in (((0, 1), 1), ((0, 2), 2)):
        assert put(browser, *place).startswith("Solved")
        result = points[number].result
        shown = browser.evaluate(HINGE)
        times = browser.evaluate("crumplePlayer.scene.times")
        expected = np.interp(times, result.time, result["hinge.root.rotation"])
        np.testing.assert_allclose(shown, expected, atol=1e-5)
        ends.append(shown[-1])
        assert browser.evaluate("document.querySelectorAll('.between-points').length") == 0
    assert put(browser, 0, 1.25).startswith("Interpolated between 2 solved points")
    assert browser.evaluate("document.querySelectorAll('.between-points').length") == 1
    assert browser.evaluate(HINGE)[-1] == pytest.approx(0.75 * ends[0] + 0.25 * ends[1], abs=2e-5)
    assert put(browser, 0, 1.02).startswith("Solved")


def test_shapes_change_with_the_sliders(browser, grid):
    points, page = grid
    opened(browser, page)
    lowest = []
    for place, number in (((0, 0), 0), ((0, 4), 4)):
        put(browser, *place)
        states = points[number].frames.states
        moved = states.points + states.displacement[-1]
        seen = browser.evaluate(
            "(() => { const s = crumplePlayer.scene, m = s.models[0]; crumplePlayer.seek(s.last);"
            " let z = -1e9; for (let i = 2; i < m.position.length; i += 3)"
            " z = Math.max(z, m.position[i]); return z + s.origin[2] + s.size[2] / 2; })()"
        )
        assert seen == pytest.approx(moved[:, 2].max(), abs=1e-3)
        lowest.append(seen)
    assert abs(lowest[1] - lowest[0]) > 0.05


def test_nothing_is_shown_where_nothing_was_solved(browser, grid):
    _, page = grid
    opened(browser, page)
    assert put(browser, 4, 0).startswith("No result here: ")
    assert browser.evaluate("document.querySelector('.chart .now').getAttribute('points')") == ""
    put(browser, 0, 0)
    assert browser.evaluate("document.querySelector('.chart .now').getAttribute('points').length") > 100


def test_a_figure_can_be_kept_as_svg_png_and_csv(browser, grid):
    points, page = grid
    opened(browser, page)
    put(browser, 0, 1)
    kept = browser.saved_files("[data-role=curves] .panel:first-child button", 3)
    name = next(iter(kept)).rsplit(".", 1)[0]
    assert set(kept) == {f"{name}.svg", f"{name}.png", f"{name}.csv"}
    lines = list(csv.reader(kept[f"{name}.csv"]["text"].splitlines()))
    assert lines[0][0] == "time, ms"
    assert lines[0][2] == f"middle of the grid: {lines[0][1]}"
    result = points[1].result
    unit = lines[0][1].rsplit(", ", 1)[1]
    factor = {"J": 1.0, "kJ": 1e3}[unit]
    times, values = ([float(line[k]) for line in lines[1:]] for k in (0, 1))
    assert factor * np.array(values) == pytest.approx(
        np.interp(1e-3 * np.array(times), result.time, result[name]), rel=1e-3, abs=1e-3
    )
    # lines have the colours that the rules of the page give them
    svg = kept[f"{name}.svg"]["text"]
    assert 'stroke="rgb(31, 95, 158)"' in svg
    assert kept[f"{name}.png"]["size"] > 4_000


def test_keys_go_from_solved_value_to_solved_value(browser, grid):
    _, page = grid
    opened(browser, page)
    put(browser, 0, 1.5)
    browser.evaluate("document.querySelectorAll('#explore input')[1].focus(); 1")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key="ArrowRight", code="ArrowRight")
    assert browser.evaluate(TOLD).startswith("Solved")
    assert browser.evaluate("document.querySelectorAll('#explore output')[1].textContent") == "6 kg"


def test_the_page_is_alone_and_fits_a_phone(browser, grid):
    _, page = grid
    opened(browser, page, 390)
    put(browser, 0.5, 2.5)
    assert browser.evaluate("document.documentElement.scrollWidth") <= 390
    requests = [
        e["params"]["request"]["url"] for e in browser.events if e["method"] == "Network.requestWillBeSent"
    ]
    assert [url for url in requests if not url.startswith("data:")] == [page.as_uri()]
    complaints = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    assert [event for event in browser.events if event["method"] in complaints] == []


def test_a_grid_without_any_result_is_refused(tmp_path):
    sliders = named("thickness=13 mm..20 mm")
    with pytest.raises(InputError, match="no value of the grid has a result"):
        write_exploration(explore(TUBE.analysis, sliders), sliders, "", tmp_path)


def test_the_command_writes_the_page_and_the_next_run_removes_it(run_command, tmp_path):
    example = EXAMPLES / "01_tube_bending.yaml"
    out = tmp_path / "out"
    code, said, _ = run_command("run", example, "--out", out, "--explore", "mass", "--no-law-range")
    assert code == 0
    assert "9 of 9 variants solved" in said
    assert "masses.payload.mass from 4.2 to 7.8 kg" in said
    assert (out / "explore.html").stat().st_size < 2_000_000
    assert run_command("run", example, "--out", out, "--no-law-range")[0] == 0
    assert not (out / "explore.html").exists()
    code, _, said = run_command("run", example, "--out", out, "--explore", "nothing")
    assert code == 2
    assert "no such number" in said
    assert run_command("run", example, "--explore", "mass", "--fidelity", "shell")[0] == 2
