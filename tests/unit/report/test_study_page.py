"""The page of a study: what it embeds, and its figures, filters and shapes in a real browser."""

import csv
import json
import math
import re
import sys
import time
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from tests.unit.study.test_study import ROTATION, WALL, written

from crumple.analysis.solve import run_of
from crumple.errors import InputError
from crumple.multibody import solve_multibody, solve_variants
from crumple.numeric.binomial import clopper_pearson
from crumple.report.study_page import write_study_page
from crumple.study import LoadedStudy, Study, run_study, study_of
from crumple.study import page_data as module
from crumple.study.page_data import page_data, rows_alike
from crumple.study.shapes import chosen_for_shapes, solved_for_shapes, structure_of

MORE = "objectives: [{minimise: m}, {minimise: r}]\nconstraints: [{response: r, at_most: 40 deg}]"
MASS = ROTATION + "\n  m: {mass: true}"
SIZES = "{path: sections.tube.thickness, values: [2 mm, 2.2 mm, 2.5 mm, 3 mm, 14 mm]}"
SPEED = "\n  s: {path: initial_velocity, low: 0.6, high: 1.2, steps: 5}"


def scene_rows(page):
    text = page.read_text(encoding="utf-8")
    return sorted(map(int, json.loads(re.search(r'id="study-shapes">(.*)</script>', text)[1])))


@pytest.fixture(scope="module", name="study")
def _study(tmp_path_factory):
    """25 rows of which the five with the thickest wall are refused, and their page with six shapes."""
    folder = tmp_path_factory.mktemp("page")
    file = written(folder, "{type: grid}", SIZES + SPEED, MASS, MORE)
    loaded = LoadedStudy(file)
    table, answer = run_study(loaded, folder)
    data = page_data(loaded, table, answer)
    rows = chosen_for_shapes(loaded, table, answer, 6)
    data["alike"] = rows_alike(table, data["rows"], rows)
    page, shown = write_study_page(data, solved_for_shapes(loaded, table, rows), folder)
    return loaded, table, answer, data, page, shown


def opened(browser, page, width=1400):
    browser.open(page.as_uri(), width, 900)
    for _ in range(200):
        ready = "document.body.dataset.ready && document.getElementById('player').dataset.ready"
        if browser.evaluate(ready + " || ''"):
            return
        time.sleep(0.1)
    raise AssertionError("the page is not ready")


def test_the_data_are_those_of_the_rows_in_readable_units(study):
    _, table, answer, data, _, _ = study
    columns = {column["name"]: column for column in data["columns"]}
    assert [columns[name]["unit"] for name in "vsrm"] == ["mm", "", "deg", "kg"]
    for i, row in enumerate(table.rows):
        assert columns["v"]["values"][i] == pytest.approx(1e3 * table.points[i][0], rel=1e-5)
        if row.ok:
            assert columns["r"]["values"][i] == pytest.approx(math.degrees(row.values[0]), rel=1e-5)
        else:
            assert columns["r"]["values"][i] is None
    assert sum("refused" in text or "thick" in text for text in data["status"]) == 5
    assert data["limits"] == [{"name": "r", "low": None, "high": pytest.approx(40.0)}]
    assert data["front"] == [one["row"] for one in answer.front]


def test_shapes_are_those_of_the_rows(study):
    """Best compromises and a spread, each solved with its wall and its factor on the speed."""
    loaded, table, answer, _, page, shown = study
    assert scene_rows(page) == sorted(shown)
    assert len(shown) == 6
    assert {one["row"] for one in answer.front} & set(shown)
    for row, result, structure in solved_for_shapes(loaded, table, shown):
        assert structure.sections["tube"].thickness == table.points[row][0]
        # a single run at a quarter of the accuracy, within its stated error
        error = result.hinges["root"].rotation_error
        assert abs(result.hinges["root"].rotation_max - table.rows[row].values[0]) <= error
        assert len(result.states.times) == 31


def test_factors_of_single_runs_are_those_of_batches(study):
    """Speed, gravity and the capacity of a hinge."""
    loaded, table, _, _, _, _ = study
    base = loaded.base.analysis
    axes = [axis for axis in table.axes if axis.name == "s"]
    factors = {"initial_velocity": 0.8, "hinges.root.capacity": 1.3, "gravity": 2.0}
    point = tuple(factors.values())
    axes = [type(axes[0])(name, (name,), "1", 0.0, 1.0, (), None, False, None) for name in factors]
    structure, capacities = structure_of(base, axes, point)
    assert capacities == {"root": 1.3}
    run = run_of(base)
    alone = solve_multibody(structure, replace(run, capacities=capacities)).hinges["root"]
    batch = solve_variants(base.structure, run, {name: [value] for name, value in factors.items()})
    assert abs(alone.rotation_max - batch["hinge.root.rotation_max"][0]) <= alone.rotation_error
    plain = solve_multibody(structure, run).hinges["root"]
    assert plain.rotation_max > 1.2 * alone.rotation_max


def test_rows_with_a_factor_on_loads_have_no_shape(tmp_path):
    file = written(tmp_path, "{type: grid}", "{path: loads, low: 1, high: 2, steps: 2}")
    loaded = LoadedStudy(file)
    table, answer = run_study(loaded, tmp_path)
    rows = chosen_for_shapes(loaded, table, answer, 6)
    assert list(solved_for_shapes(loaded, table, rows)) == []
    data = page_data(loaded, table, answer) | {"alike": {}}
    page, shown = write_study_page(data, [], tmp_path)
    assert shown == []
    assert scene_rows(page) == []


def test_a_long_study_shows_some_rows(monkeypatch, tmp_path):
    monkeypatch.setattr(module, "MOST_ROWS", 40)
    file = written(tmp_path, "{type: sobol, rows: 200}", WALL, MASS, "objective: {minimise: r}")
    loaded = LoadedStudy(file)
    table, answer = run_study(loaded, tmp_path)
    data = page_data(loaded, table, answer)
    assert 39 <= len(data["rows"]) <= 40
    assert answer.best["row"] in data["rows"]
    assert data["total"] == 200
    # the best so far ends with the best of all rows, not of those that are shown
    curve = data["convergence"][0]
    assert curve["values"][-1] == pytest.approx(math.degrees(answer.best["responses"]["r"]), rel=1e-5)
    assert curve["values"] == sorted(curve["values"], reverse=True)


def convergent(rows=400):
    return Study(
        variables={"x": {"low": 0.0, "high": 2.0}, "k": {"values": [1.0, 3.0]}},
        responses={"y": {}},
        constraints=[{"response": "y", "at_most": 4.0}],
        method={"type": "monte_carlo", "rows": rows, "seed": 1},
    )


def test_effects_and_convergence_by_hand():
    """y = x + k: the tenths of x lie 1.8 apart, the values of k two."""

    class Loaded:
        study = convergent()

    table, answer = study_of(lambda c: {"y": c["x"] + c["k"]}, Loaded.study)
    data = page_data(Loaded, table, answer)
    bars = {bar["variable"]: bar for bar in data["effects"][0]["bars"]}
    columns = table.columns()
    for end, value in (("low", 1.0), ("high", 3.0)):
        assert bars["k"][end] == pytest.approx(columns["y"][columns["k"] == value].mean())
    assert bars["x"]["high"] - bars["x"]["low"] == pytest.approx(1.8, abs=0.5)
    mean, share = data["convergence"]
    n = mean["rows"][50]
    y = columns["y"][:n]
    assert mean["values"][50] == pytest.approx(y.mean(), rel=1e-4)
    half = 1.96 * y.std() / math.sqrt(n)
    assert mean["band"][1][50] - mean["values"][50] == pytest.approx(half, rel=1e-3)
    beyond = int((y > 4.0).sum())
    assert share["values"][50] == pytest.approx(beyond / n, rel=1e-4)
    assert [end[50] for end in share["band"]] == pytest.approx(clopper_pearson(beyond, n), rel=1e-4)


def test_the_page_in_a_browser(browser, study):
    _, table, _, _, page, _ = study
    opened(browser, page)
    for part in ("parallel", "pair", "matrix"):
        painted = (
            f"(() => {{ const c = document.querySelector('#{part} canvas'), d = c.getContext('2d')"
            ".getImageData(0, 0, c.width, c.height).data; let n = 0;"
            " for (let i = 3; i < d.length; i += 4) if (d[i]) n++; return n; })()"
        )
        assert browser.evaluate(painted) > 500, part
    assert browser.evaluate("document.querySelectorAll('#effects rect').length") == 4
    assert browser.evaluate("document.querySelectorAll('#convergence polyline').length") == 1
    assert browser.evaluate("document.querySelectorAll('#table tbody tr').length") == 25
    count = "document.querySelector('#filters [data-role=count]').textContent"
    assert browser.evaluate(count) == "20 of 25 rows; 5 have no values."
    # a filter
    browser.evaluate(
        "(() => { const i = document.querySelector('[aria-label=\"most v\"]'); i.value = 2.3;"
        " i.dispatchEvent(new Event('input')); return 1; })()"
    )
    thin = sum(point[0] < 2.3e-3 for point in table.points)
    browser.settle()
    assert browser.evaluate(count).startswith(f"{thin} of 25")
    assert browser.evaluate("document.querySelectorAll('#table tbody tr').length") == thin
    complaints = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    assert [event for event in browser.events if event["method"] in complaints] == []
    requests = [
        e["params"]["request"]["url"] for e in browser.events if e["method"] == "Network.requestWillBeSent"
    ]
    assert [url for url in requests if not url.startswith("data:")] == [page.as_uri()]


def test_every_figure_can_be_kept_as_svg_png_and_csv(browser, study):
    """Those on canvases too, with as many points as rows are shown, and the rows as data."""
    _, table, _, _, page, _ = study
    opened(browser, page)
    kept = browser.saved_files(".tools button", 15)
    names = ("parallel", "two_columns", "matrix", "tornado_r", "convergence_best_m_so_far")
    assert set(kept) == {f"{name}.{kind}" for name in names for kind in ("svg", "png", "csv")}
    for name in names:
        svg = ElementTree.fromstring(kept[f"{name}.svg"]["text"])
        assert len(list(svg.iter("{http://www.w3.org/2000/svg}text"))) > 3, name
        assert kept[f"{name}.png"]["size"] > 8_000, name
        assert kept[f"{name}.csv"]["text"].count("\n") > 2, name
    pair = list(csv.reader(kept["two_columns.csv"]["text"].splitlines()))
    assert pair[0] == ["row", "m, kg", "r, deg"]
    good = [i for i, row in enumerate(table.rows) if row.ok]
    assert [int(line[0]) for line in pair[1:]] == good
    assert [float(line[2]) for line in pair[1:]] == pytest.approx(
        [math.degrees(table.rows[i].values[0]) for i in good], rel=1e-5
    )
    # a filled circle is a row
    svg = ElementTree.fromstring(kept["two_columns.svg"]["text"])
    discs = [one for one in svg.iter("{http://www.w3.org/2000/svg}path") if one.get("fill") != "none"]
    assert len(discs) == len(good)
    # what the rules of the page colour keeps its colour
    svg = ElementTree.fromstring(kept["tornado_r.svg"]["text"])
    assert {one.get("fill") for one in svg.iter("{http://www.w3.org/2000/svg}rect")} == {
        "rgb(127, 168, 207)",
        "rgb(201, 138, 75)",
    }


def test_a_click_on_a_point_shows_its_crash(browser, study):
    """The point of a stored row in the figure of two columns, and a row without shape in the table."""
    _, table, _, _, page, shown = study
    opened(browser, page)
    row = shown[-1]
    r, m = (np.array([one.values[k] if one.ok else np.nan for one in table.rows]) for k in (0, 1))
    across = (m[row] - np.nanmin(m)) / np.ptp(m[np.isfinite(m)])
    up = (r[row] - np.nanmin(r)) / np.ptp(r[np.isfinite(r)])
    browser.evaluate("document.querySelector('#pair canvas').scrollIntoView(); 1")
    place = browser.evaluate(
        "(() => { const b = document.querySelector('#pair canvas').getBoundingClientRect();"
        f" return [b.left + 71 + {across} * (b.width - 90), b.top + 27 + {1 - up} * (b.height - 70)]; }})()"
    )
    for kind in ("mousePressed", "mouseReleased"):
        browser.call(
            "Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1
        )
    for _ in range(100):
        if browser.evaluate("document.body.dataset.shown") == str(row):
            break
        time.sleep(0.05)
    assert browser.evaluate("document.querySelector('#chosen [data-role=told]').textContent").startswith(
        f"Row {row}"
    )
    for _ in range(100):
        name = browser.evaluate("crumplePlayer.scene.models[0].name")
        if name == f"row {row}":
            break
        time.sleep(0.05)
    assert name == f"row {row}"
    shown_rotation = browser.evaluate(
        "Math.max(...crumplePlayer.scene.models[0].hinges[0].rotation.map(Math.abs))"
    )
    assert shown_rotation == pytest.approx(table.rows[row].values[0], abs=2e-3)
    other = next(i for i in range(20) if i not in shown and table.rows[i].ok)
    browser.evaluate(f"document.querySelectorAll('#table tbody tr')[{other}].click(); 1")
    told = browser.evaluate("document.getElementById('shape-told').textContent")
    assert told.startswith(f"No shape of row {other} is stored")


def test_the_page_says_that_a_response_is_constant(browser, tmp_path):
    """The mass does not depend on the speed: its tornado has no bars."""
    file = written(tmp_path, "{type: grid}", "{path: initial_velocity, low: 0.6, high: 1.2, steps: 3}", MASS)
    loaded = LoadedStudy(file)
    table, answer = run_study(loaded, tmp_path)
    data = page_data(loaded, table, answer) | {"alike": {}}
    assert [len(effect["bars"]) for effect in data["effects"]] == [1, 0]
    page, _ = write_study_page(data, [], tmp_path)
    browser.open(page.as_uri(), 1400, 900)
    browser.settle()
    told = "document.querySelector('#effects > div').textContent"
    assert browser.evaluate(told).startswith("v0.61.2mean")
    browser.evaluate(
        "(() => { const s = document.querySelector('#effects select'); s.value = '1';"
        " s.dispatchEvent(new Event('change')); return 1; })()"
    )
    said = browser.evaluate(told)
    assert said == "m is constant, 2.9 kg in all rows: no variable has an effect on it."


TEXTS = """(() => {
  const svg = document.querySelector('#effects svg'), all = svg.getBoundingClientRect();
  return JSON.stringify([[all.left, all.right], ...[...svg.querySelectorAll('text')].map((text) => {
    const box = text.getBoundingClientRect(), whole = text.querySelector('title');
    return [box.left, box.right, box.top, box.bottom, text.firstChild.data, whole ? whole.textContent : ''];
  })]);
})()"""
LONG = "outer_diameter_of_the_longest_of_all_tubes_of_the_frame_with_two_storeys_in_the_plane_of_the_impact"
STEEL = "S355_of_the_first_delivery_of_the_year_in_which_it_was_rolled"


def tornado(browser, study, folder, width):
    """Boxes and words of the texts of a tornado with long names, also of ends, and with a bar of one end."""
    ends = {"low": 2.3, "high": 6.16, "at_low": "≥ 2.783 mm", "at_high": "≤ 1.198 mm"}
    bars = [
        ends | {"variable": "wall_of_the_tube_at_its_root"},
        ends | {"variable": "v", "low": 6.1, "high": 2.4},
        ends | {"variable": LONG, "low": 4.5},
        ends | {"variable": "steel", "at_low": STEEL, "at_high": "S700"},
        ends | {"variable": "one_end_only", "low": 3.9, "high": 3.9},
    ]
    effects = [{"response": "r", "unit": "kN*mm*deg^-1*s^-2", "mean": 3.86, "bars": bars}]
    page, _ = write_study_page(study[3] | {"effects": effects, "alike": {}}, [], folder)
    browser.open(page.as_uri(), width, 900)
    browser.settle()
    return bars, *json.loads(browser.evaluate(TEXTS))


@pytest.mark.parametrize("width", [1400, 1100, 420])
def test_texts_of_a_tornado_are_apart_and_of_one_size(browser, study, tmp_path, width):
    bars, (first, last), *texts = tornado(browser, study, tmp_path, width)
    assert len(texts) == 3 * len(bars) + 3
    for i, (left, right, top, bottom, _, _) in enumerate(texts):
        assert first - 1 <= left < right <= last + 1, i
        assert 12 <= bottom - top <= 17, i
        for a, b, c, d, *words in texts[:i]:
            assert right <= a or b <= left or bottom <= c + 2 or d <= top + 2, words
    # a name stands above its bar, and whatever is cut has the whole where the pointer rests on it
    top_of = {whole or shown: top for _, _, top, _, shown, whole in texts}
    assert top_of[LONG] < top_of[STEEL]
    for *_, shown, whole in texts:
        assert bool(whole) == shown.endswith("…")
        assert whole.startswith(shown.rstrip("…")) or not whole
    assert {shown for *_, shown, _ in texts} >= {"wall_of_the_tube_at_its_root", "v", "S700", "≥ 2.783 mm"}


def test_figures_are_drawn_again_where_their_width_changes(browser, study, tmp_path):
    tornado(browser, study, tmp_path, 1400)
    browser.evaluate("document.querySelector('#effects > div').style.width = '310px'; 1")
    browser.settle()
    assert browser.evaluate("document.querySelector('#effects svg').viewBox.baseVal.width") == 310


def test_the_page_fits_a_phone(browser, study):
    opened(browser, study[4], 390)
    assert browser.evaluate("document.documentElement.scrollWidth") <= 390


def test_the_command_writes_page_and_parquet(run_command, tmp_path):
    pandas = pytest.importorskip("pandas")
    file = written(tmp_path, "{type: sobol, rows: 8}", WALL, ROTATION + "\n  f: {formula: 2 * r}")
    out = tmp_path / "out"
    code, said, err = run_command("study", file, "--out", out, "--shapes", 2)
    assert (code, err) == (0, "")
    assert "(8 of 8 rows, the crash of 2)" in said
    assert len(scene_rows(out / "study.html")) == 2
    code, said, _ = run_command("study", file, "--out", out, "--resume", "--no-page")
    assert "study.html" not in said
    assert not (out / "study.html").exists()
    pytest.importorskip("pyarrow")
    assert run_command("study", file, "--out", out, "--resume", "--no-page", "--parquet")[0] == 0
    frame = pandas.read_parquet(out / "study.parquet")
    rows = pandas.read_csv(out / "study.csv", index_col="row")
    for name in ("v", "r", "f"):
        assert frame[name].tolist() == rows[name].tolist()
    assert (frame["f"] == 2 * frame["r"]).all()


def test_parquet_without_pyarrow(study, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InputError, match="pyarrow is not installed"):
        study[1].to_parquet(tmp_path / "study.parquet")


def test_the_command_refuses_parquet_without_pyarrow_before_it_solves(run_command, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    file, out = written(tmp_path, "{type: sobol, rows: 8}"), tmp_path / "out"
    code, _, err = run_command("study", file, "--out", out, "--parquet")
    assert code != 0
    assert "pyarrow is not installed" in err
    assert not (out / "study.sqlite").exists()
