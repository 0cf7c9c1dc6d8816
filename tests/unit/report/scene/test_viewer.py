"""The viewer in a real browser: it draws, scrubs, picks, shows obstacles, fits a phone."""

import math
import time

import pytest
from tests.unit.report.scene.test_scene import INPUT

from crumple.analysis import loads, solve_with_frames
from crumple.report import Layout, ReportInput, write_layouts, write_report
from crumple.report.scene.page import write_view

# what differs from the background, and a sum that changes with the picture
DRAWN = """(() => {
  const canvas = document.querySelector('#player canvas'), copy = document.createElement('canvas');
  copy.width = canvas.width; copy.height = canvas.height;
  const brush = copy.getContext('2d');
  brush.drawImage(canvas, 0, 0);
  const data = brush.getImageData(0, 0, copy.width, copy.height).data;
  let number = 0, sum = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 24) {
    number++;
    sum += data[i] * ((i / 4) % 997 + 1);
  }
  return [number, sum];
})()"""


@pytest.fixture(scope="module", name="pages")
def _pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    analysis = loads(INPUT)
    result, frames = solve_with_frames(analysis)
    source = ReportInput(title="thrown", structure=analysis.structure)
    run = write_report(result, source, folder / "run", frames=frames)
    one = Layout("one", "thrown", 1.0, result, frames=frames, structure=analysis.structure)
    layouts = write_layouts([one, Layout("two", "again", 1.0, result)], "two", folder / "layouts")
    return {"run": run, "layouts": layouts, "view": write_view(run.parent)}


@pytest.fixture(name="browser")
def _browser(either_browser):
    return either_browser


def opened(browser, page, width=1200):
    browser.open(page.as_uri(), width, 1000)
    for _ in range(200):
        if mode := browser.evaluate("document.getElementById('player').dataset.ready || ''"):
            return mode
        time.sleep(0.1)
    raise AssertionError(browser.evaluate("document.querySelector('[data-role=note]').textContent"))


def change(browser, role, value):
    browser.evaluate(
        f"(() => {{ const c = document.querySelector('[data-role={role}]');"
        f" if (c.type === 'checkbox') c.checked = {str(value is True).lower()}; else c.value = '{value}';"
        " c.dispatchEvent(new Event('change')); return 1; })()"
    )


@pytest.mark.parametrize("name", ["run", "layouts", "view"])
def test_every_page_draws_and_moves_and_fits(browser, pages, name):
    assert opened(browser, pages[name]) == browser.wanted
    last = browser.evaluate(DRAWN)
    assert last[0] > 500
    slider = "document.querySelector('#player input[type=range]')"
    browser.evaluate(f"{slider}.value = 0; {slider}.dispatchEvent(new Event('input')); 1")
    assert browser.evaluate("document.querySelector('#player output').textContent") == "0.0 ms"
    assert browser.evaluate(DRAWN)[1] != last[1]
    complaints = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    assert [event for event in browser.events if event["method"] in complaints] == []
    requests = [
        e["params"]["request"]["url"] for e in browser.events if e["method"] == "Network.requestWillBeSent"
    ]
    assert [url for url in requests if not url.startswith("data:")] == [pages[name].as_uri()]
    opened(browser, pages[name], 390)
    assert browser.evaluate("document.documentElement.scrollWidth") <= 390
    assert browser.evaluate(DRAWN)[0] > 200


def test_it_opens_when_the_deformation_is_next_to_complete(browser, pages):
    opened(browser, pages["run"])
    at = browser.evaluate("Number(document.querySelector('#player input[type=range]').value)")
    hinges = browser.evaluate("crumplePlayer.scene.models[0].hinges")
    energy = [sum(one["energy"][frame] for one in hinges) for frame in (at - 1, at, -1)]
    assert energy[0] < 0.995 * energy[2] <= energy[1]
    assert at < browser.evaluate("crumplePlayer.scene.last")


def test_what_is_chosen_changes_the_picture(browser, pages):
    opened(browser, pages["run"])
    seen = [browser.evaluate(DRAWN)[1]]
    for role, value in (
        ("surroundings", False), ("ghost", True), ("colour", "plain"), ("scale", 5), ("facing", "x"),
        ("facing", "z"),
    ):  # fmt: skip
        change(browser, role, value)
        seen.append(browser.evaluate(DRAWN)[1])
    assert len(set(seen)) == len(seen)


def click(browser, x, y):
    box = browser.evaluate(
        "(() => { const c = document.querySelector('#player canvas'); c.scrollIntoView();"
        " const b = c.getBoundingClientRect(); return [b.left, b.top]; })()"
    )
    for kind in ("mousePressed", "mouseReleased"):
        browser.call(
            "Input.dispatchMouseEvent", type=kind, x=box[0] + x, y=box[1] + y, button="left", clickCount=1
        )
    return browser.evaluate(
        "(i => i.hidden ? '' : i.textContent)(document.querySelector('[data-role=info]'))"
    )


def test_a_click_on_a_hinge_shows_its_values_at_that_time(browser, pages):
    opened(browser, pages["run"])
    place = browser.evaluate("crumplePlayer.seen(0, 'h')")
    shown = click(browser, *place)
    assert shown.startswith("hinge h; ")
    assert " deg; " in shown
    assert " J" in shown
    browser.evaluate("crumplePlayer.seek(0); 1")
    assert "hinge h; closed; 0.00 deg" in browser.evaluate(
        "document.querySelector('[data-role=info]').textContent"
    ).replace("-0.00", "0.00")
    assert browser.evaluate("document.querySelectorAll('[data-role=info] polyline').length") == 2


def test_a_click_on_a_member_shows_how_far_it_moved(browser, pages):
    """The tube turns about its hinge 0.1 m from the clamp; its tip, where the mass is, is 0.9 m away."""
    opened(browser, pages["run"])
    browser.evaluate("crumplePlayer.seek(crumplePlayer.scene.last); 1")
    hinge, mass = (browser.evaluate(f"crumplePlayer.seen(0, '{name}')") for name in ("h", "head"))
    assert "mass head; 1 kg; moved " in click(browser, *mass)
    shown = click(browser, *((a + b) / 2 for a, b in zip(hinge, mass, strict=True)))
    assert shown.startswith("member ab; moved ")
    assert shown.endswith("over time: displacement")
    angle = browser.evaluate("Math.abs(crumplePlayer.scene.models[0].hinges[0].rotation.at(-1))")
    moved = float(shown.split("moved ")[1].split(" mm")[0])
    # the wall that is hit lies within the section beside the middle
    assert moved == pytest.approx(2e3 * 0.45 * math.sin(angle / 2.0), rel=0.2)
    browser.evaluate("crumplePlayer.seek(0); 1")
    assert "moved 0.0 mm" in browser.evaluate("document.querySelector('[data-role=info]').textContent")
    assert browser.evaluate("document.querySelectorAll('[data-role=info] polyline').length") == 2


def test_obstacles_are_drawn_where_they_are_described(browser, pages):
    opened(browser, pages["run"])
    scene = "crumplePlayer.scene"
    # the pole comes 2 m/s towards the tube; the plate has turned by 30 degrees about y through (0, 0, 2 m)
    moved = browser.evaluate(
        f"(() => {{ const s = {scene}, pole = s.models[0].obstacles[1];"
        " return [0, s.last].map(f => Array.from(s.obstaclePoints(pole, f).subarray(0, 3))); })()"
    )
    assert [b - a for a, b in zip(*moved, strict=True)] == pytest.approx([-0.1, 0.0, 0.0], abs=1e-4)
    ends = browser.evaluate(
        f"(() => {{ const s = {scene}, p = s.obstaclePoints(s.models[0].obstacles[0], s.last);"
        " return [0, 1, 2, 3].map(i => [0, 1, 2].map(k => p[3 * i + k] + s.origin[k] + s.size[k] / 2)); })()"
    )
    for x, _, z in ends:
        # turned right-handed about y: a point at +x goes down
        assert (z - 2.0) == pytest.approx(-x * 0.57735, abs=1e-3)


ALPHA = """(() => {
  const canvas = document.querySelector('#player canvas'), copy = document.createElement('canvas');
  copy.width = canvas.width; copy.height = canvas.height;
  const brush = copy.getContext('2d');
  brush.drawImage(canvas, 0, 0);
  const data = brush.getImageData(0, 0, copy.width, copy.height).data;
  let sum = 0;
  for (let i = 3; i < data.length; i += 4) sum += data[i] / 255;
  return sum;
})()"""


def test_a_plane_seen_from_its_solid_side_hides_nothing(browser, pages, tmp_path):
    text = pages["view"].read_text(encoding="utf-8")
    page = tmp_path / "turned.html"
    # the same plane with its quadrilateral turned over: its solid is on the other side
    assert '"quads": [[0, 1, 2, 3]]' in text
    page.write_text(text.replace('"quads": [[0, 1, 2, 3]]', '"quads": [[3, 2, 1, 0]]'), encoding="utf-8")
    covered = []
    for one in (pages["view"], page):
        opened(browser, one)
        change(browser, "facing", "z")
        with_plane = browser.evaluate(ALPHA)
        change(browser, "surroundings", False)
        covered.append(with_plane - browser.evaluate(ALPHA))
    assert 0 < min(covered) < 0.4 * max(covered)


KEEP = """(() => {
  window.kept = [];
  const make = URL.createObjectURL.bind(URL);
  URL.createObjectURL = (blob) => { window.made = blob; return make(blob); };
  HTMLAnchorElement.prototype.click = function () {
    const made = window.made, entry = [this.download, made.type, made.size, ''];
    window.kept.push(entry);
    made.slice(0, 4).arrayBuffer().then((b) => { entry[3] = [...new Uint8Array(b)].join(' '); });
  };
  return 1;
})()"""


def test_a_picture_and_a_film_can_be_kept(browser, pages):
    opened(browser, pages["run"], 500)
    browser.evaluate(KEEP)
    change(browser, "speed", 4)
    for role, first in (("picture", "137 80 78 71"), ("film", "26 69 223 163")):
        browser.evaluate(f"document.querySelector('[data-role={role}]').click(); window.kept = []; 1")
        for _ in range(600):
            kept = browser.evaluate("window.kept")
            if kept and kept[0][3]:
                break
            time.sleep(0.05)
        ((name, kind, size, start),) = kept
        assert name == {"picture": "thrown.png", "film": "thrown.webm"}[role]
        assert kind == {"picture": "image/png", "film": "video/webm"}[role]
        # the signatures of PNG and of the container of WebM
        assert start == first
        assert size > 2_000


def test_a_scene_of_a_newer_format_says_so(browser, pages, tmp_path):
    text = pages["view"].read_text(encoding="utf-8")
    page = tmp_path / "newer.html"
    page.write_text(text.replace('"version": 1', '"version": 2', 1), encoding="utf-8")
    browser.open(page.as_uri(), 800, 600)
    for _ in range(100):
        said = browser.evaluate("document.querySelector('p[data-role=note]').textContent")
        if said:
            break
        time.sleep(0.1)
    assert "up to version 1, not crumple-scene 2" in said
