"""The comparison page in a real browser: both results move, nothing is fetched, nothing is complained of."""

import base64
import hashlib
import re
import time
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.support.result.folded_tube import analysis, angle_over_time, folded_result, folded_states
from tests.unit.comparison.cautions.test_trust import shortened

import crumple.report
from crumple.analysis import solve
from crumple.comparison import CurveFile, Signal, compare, with_frames
from crumple.comparison.variant import with_elastic_hinges
from crumple.report import ReportInput, write_comparison
from crumple.report.comparison_page import scene_of
from crumple.report.scene.hinges import hinge_states
from crumple.report.scene.scene import frame_times

LARGEST_PAGE = 3_000_000
THREE_SHA256 = "89c5b9aa843f5f652a4914e55bdf5d67fa0235d996a25bc511bf713ee6d76061"

# colours that stand out of the background, left and right half of the canvas, after drawing in the same task
DRAWN = """(() => {
  crumplePlayer.seek(%d);
  const canvas = document.querySelector('#player canvas'), copy = document.createElement('canvas');
  copy.width = canvas.width; copy.height = canvas.height;
  const brush = copy.getContext('2d');
  brush.drawImage(canvas, 0, 0);
  const data = brush.getImageData(0, 0, copy.width, copy.height).data, halves = [0, 0];
  let sum = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 128) {
    halves[(i / 4) %% copy.width < copy.width / 2 ? 0 : 1]++;
    sum += data[i] * ((i / 4) %% 997 + 1);
  }
  return [...halves, sum];
})()"""


@pytest.fixture(scope="module", name="found")
def _found():
    case = analysis()
    dense = with_frames(case, 41)
    times = np.linspace(0.0, 0.1, 50)
    curve = CurveFile(
        "test",
        "t.csv",
        {"hinge.root.rotation": Signal("hinge.root.rotation", "rad", times, -6 * times)},
        ("M2",),
    )
    elastic = solve(dense.model_copy(update={"structure": with_elastic_hinges(case.structure)}))
    return compare(
        solve(dense), folded_result(), case.structure, variants={"elastic hinges": elastic}, curves=[curve]
    )


@pytest.fixture(scope="module", name="page")
def _page(found, tmp_path_factory):
    source = ReportInput(text="crumple: 1\n</script><script>alert(1)</script>\n", name="tube.yaml")
    return write_comparison(found, source, tmp_path_factory.mktemp("page"), pictures=(0.0, 0.05, 0.1))


@pytest.fixture(name="browser")
def _browser(either_browser):
    return either_browser


def opened(browser, page):
    browser.open(page.as_uri(), 1200, 1000)
    for _ in range(200):
        mode = browser.evaluate("document.getElementById('player').dataset.ready || ''")
        if mode:
            return mode
        time.sleep(0.1)
    raise AssertionError(browser.evaluate("document.querySelector('[data-role=note]').textContent"))


def test_both_results_are_drawn_and_move_in_step(browser, page, found):
    assert opened(browser, page) == browser.wanted
    first, last = browser.evaluate(DRAWN % 0), browser.evaluate(DRAWN % 40)
    for left, right, _ in (first, last):
        assert left > 500
        assert right > 500
    assert first[2] != last[2]
    assert browser.evaluate("document.querySelector('#player output').textContent") == "40.0 ms"
    for model, source in enumerate((found.candidate, found.reference)):
        states = source.result.states.at_times(np.array([0.04]))
        moved = states.points + states.displacement[0]
        for point in (0, len(moved) // 2, len(moved) - 1):
            assert browser.evaluate(f"crumplePlayer.place({model}, {point})") == pytest.approx(
                moved[point], abs=2e-4
            )
    for choice in ("hinge", "plain"):
        browser.evaluate(
            f"(() => {{ const c = document.querySelector('[data-role=colour]'); c.value = '{choice}';"
            " c.dispatchEvent(new Event('change')); return 1; })()"
        )
    plain = browser.evaluate(DRAWN % 40)
    assert plain[2] != last[2]
    complaints = [
        event
        for event in browser.events
        if event["method"] in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    ]
    assert complaints == []
    requests = [
        event["params"]["request"]["url"]
        for event in browser.events
        if event["method"] == "Network.requestWillBeSent"
    ]
    assert [url for url in requests if not url.startswith("data:")] == [page.as_uri()]


def test_playing_stops_at_the_end_and_tables_can_be_copied(browser, page):
    opened(browser, page)
    browser.evaluate("crumplePlayer.seek(99); document.querySelector('[data-role=play]').click(); 1")
    for _ in range(100):
        if browser.evaluate("document.querySelector('[data-role=play]').textContent") == "Play":
            break
        time.sleep(0.1)
    assert browser.evaluate("document.querySelector('#player output').textContent") == "100.0 ms"
    tables, buttons = (
        browser.evaluate(f"document.querySelectorAll('{name}').length") for name in ("table", "button.copy")
    )
    assert tables == buttons > 3


def test_on_paper_the_figure_stands_for_the_moving_picture(browser, page):
    opened(browser, page)
    browser.call("Emulation.setEmulatedMedia", media="print")
    assert browser.evaluate("getComputedStyle(document.querySelector('.player')).display") == "none"
    assert browser.evaluate("document.querySelectorAll('figure svg').length") >= 5
    paper = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
    assert 3 <= len(re.findall(rb"/Type\s*/Page\b", paper)) <= 12


@pytest.mark.parametrize("width", [390, 1600])
def test_nothing_is_wider_than_the_window(browser, page, width):
    browser.open(page.as_uri(), width, 900)
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    # a table may be wider and scroll, what it is about is read without
    captions = "[...document.querySelectorAll('caption')].map(c => c.getBoundingClientRect().right)"
    assert max(browser.evaluate(captions)) <= width


@pytest.mark.parametrize("shapes", [1, 2])
def test_a_run_that_ended_at_once_has_a_page(tmp_path, shapes):
    case, whole = analysis(), folded_result()
    end = float(whole.states.times[shapes - 1])
    stopped = shortened(whole, end)
    for first, second in ((solve(with_frames(case, 41)), stopped), (stopped, whole)):
        found = compare(first, second, case.structure)
        page = write_comparison(found, ReportInput(), tmp_path).read_text(encoding="utf-8")
        assert f"only the first {1e3 * end:.4g} ms, which both contain, are compared" in page


def test_the_page_contains_the_comparison(page, found):
    text = page.read_text(encoding="utf-8")
    assert len(text) < LARGEST_PAGE
    for expected in (
        "multibody against shell", "ISO/TS 18571:2014", "10 kHz", "elastic hinges", "Stepping only",
        "is shifted by", "ignored because they have no unit: M2", "&lt;script&gt;alert(1)",
    ):  # fmt: skip
        assert expected in text, expected
    assert "<script>alert(1)" not in text
    figures = {path.stem for path in (page.parent / "figures").iterdir()}
    assert {"shapes", "motion_1", "shifted_1", "plastic_1", "variants"} <= figures


def test_the_scene_holds_the_shapes(found):
    import json

    scene = scene_of(found, ReportInput())
    header, data = json.loads(scene.header), zlib.decompress(base64.b64decode(scene.payload))
    states = found.candidate.result.states
    model = header["models"][0]
    n, frames = 3 * model["points"], len(header["times"])
    at = 16 * model["quads"]
    assert np.array_equal(np.frombuffer(data[:at], "<u4").reshape(-1, 4), states.quads)
    low, high = (
        np.frombuffer(data[at + k * n * frames : at + (k + 1) * n * frames], np.uint8) for k in (0, 1)
    )
    grid = np.cumsum((low + 256 * high.astype(np.uint16)).reshape(frames, n), axis=0, dtype=np.uint16)
    last = grid[-1].reshape(-1, 3) * header["step"] + header["origin"]
    assert np.allclose(last, states.points + states.displacement[-1], atol=header["step"])


def test_the_moving_picture_ends_with_the_run(found):
    times = np.linspace(0.0, 0.1, 11)
    states = folded_states(times, [(0.01, 0.04, angle_over_time(times))])
    # a stepper stores each shape at its first step after the requested time
    late = replace(states, times=states.times + 1e-6)
    assert frame_times([states, late])[-1] == late.times[-1]
    short = replace(states, times=0.6 * states.times)
    assert frame_times([short, late])[-1] == pytest.approx(0.06, abs=1e-5)


def test_hinges_are_closed_then_turn_then_rest(found):
    states = hinge_states(found.candidate.hinges[0], np.array([0.0, 0.04, 0.1]))
    assert states == [0, 1, 2]


def test_a_result_without_shapes_has_no_moving_picture(found, tmp_path):
    bare = replace(
        found, reference=replace(found.reference, result=replace(found.reference.result, states=None))
    )
    assert scene_of(bare, ReportInput()) is None
    assert "<canvas" not in write_comparison(bare, ReportInput(), tmp_path).read_text(encoding="utf-8")


def test_the_vendored_build_is_the_one_that_was_vendored():
    vendor = Path(crumple.report.__file__).parent / "vendor"
    assert hashlib.sha256((vendor / "three.min.js").read_bytes()).hexdigest() == THREE_SHA256
    assert "MIT License" in (vendor / "three.LICENSE").read_text()
