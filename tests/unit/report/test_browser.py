"""The page in a real browser: it renders, fetches nothing, complains of nothing, fits screen and paper."""

import base64
import re
import zlib

import pytest
from tests.support.result.synthetic_frame import CUBE, frame_result
from tests.support.result.synthetic_tube import tube_result

from crumple.report import ReportInput, write_report

INPUT = "crumple: 1\ntitle: a tube\n" + "".join(f"# line {i} of the input\n" for i in range(60))

FIGURES = """[...document.querySelectorAll('figure svg')].map(svg => {
  const box = svg.getBoundingClientRect(), drawn = svg.getBBox();
  const texts = [...svg.querySelectorAll('text')].map(text => text.getBoundingClientRect());
  const outside = texts.filter(t => t.left < box.left - 4 || t.right > box.right + 4 ||
                                    t.top < box.top - 4 || t.bottom > box.bottom + 4).length;
  return {width: box.width, height: box.height, drawn: drawn.width * drawn.height, outside: outside,
          title: svg.querySelector('title').textContent, labelled: svg.getAttribute('aria-labelledby')};
})"""


@pytest.fixture(scope="module", name="pages")
def _pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    source = ReportInput(text=INPUT, name="tube.yaml", residual_bound=1e-3, accuracy=1e-3)
    return {
        "tube": write_report(tube_result(), source, folder / "tube"),
        "frame": write_report(frame_result(CUBE, 12), source, folder / "frame"),
    }


UNFOLD = "document.querySelectorAll('details').forEach(part => { part.open = true; }); 1"


@pytest.mark.parametrize("name", ["tube", "frame"])
def test_every_figure_is_visible_and_nothing_is_fetched(browser, pages, name):
    browser.open(pages[name].as_uri(), 1200, 1600)
    browser.evaluate(UNFOLD)
    shown = browser.evaluate(FIGURES)
    assert len(shown) == len(list((pages[name].parent / "figures").iterdir()))
    for figure in shown:
        assert figure["width"] > 300
        assert figure["height"] > 100
        assert figure["drawn"] > 1e4
        assert figure["outside"] == 0, figure["title"]
        assert figure["labelled"].endswith("-title")
    requests = [
        e["params"]["request"]["url"] for e in browser.events if e["method"] == "Network.requestWillBeSent"
    ]
    assert requests == [pages[name].as_uri()]
    complaints = [
        event
        for event in browser.events
        if event["method"] in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    ]
    assert complaints == []


def test_ids_are_unique_and_every_reference_is_met(browser, pages):
    browser.open(pages["frame"].as_uri(), 1200, 1600)
    assert browser.evaluate(
        "(() => { const ids = [...document.querySelectorAll('[id]')].map(e => e.id);"
        " return ids.length - new Set(ids).size; })()"
    ) == 0  # fmt: skip
    text = pages["frame"].read_text()
    references = set(re.findall(r'(?:url\(#|href="#)([^")]+)', text))
    assert references <= set(re.findall(r' id="([^"]+)"', text))


@pytest.mark.parametrize("width", [390, 768, 1600])
def test_nothing_is_wider_than_the_window(browser, pages, width):
    for page in pages.values():
        browser.open(page.as_uri(), width, 900)
        assert browser.evaluate("document.documentElement.scrollWidth") <= width


def test_labels_of_grids_can_be_read_on_a_phone(browser, pages):
    browser.open(pages["frame"].as_uri(), 400, 900)
    browser.evaluate(UNFOLD)
    sizes = browser.evaluate(
        "[...document.querySelectorAll('.panels svg text')].filter(t => t.textContent).map(t =>"
        " parseFloat(getComputedStyle(t).fontSize) * Math.hypot(t.getScreenCTM().a, t.getScreenCTM().b))"
    )
    assert len(sizes) > 100
    assert min(sizes) > 9.0  # [px]


def test_every_figure_can_be_kept_as_svg_png_and_csv(browser, pages):
    browser.open(pages["tube"].as_uri(), 1200, 1600)
    browser.evaluate(UNFOLD)
    kept = browser.saved_files(":has(> svg[aria-labelledby=rotation-title]) > .tools button", 3)
    assert set(kept) == {"rotation.svg", "rotation.png", "rotation.csv"}
    assert kept["rotation.png"]["type"] == "image/png"
    # the picture has ink: the size of a blank PNG of 985 x 677 pixels is some 4 kB
    assert kept["rotation.png"]["size"] > 8_000
    assert kept["rotation.csv"]["text"].startswith('"time, ms"')
    assert browser.evaluate(
        "createImageBitmap(window.kept['rotation.png'].blob).then(picture => [picture.width, picture.height])"
    ) == [985, 677]


def test_prints_on_a_few_pages_of_a4(browser, pages):
    browser.open(pages["tube"].as_uri(), 1200, 1600)
    paper = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
    assert len(re.findall(rb"/Type\s*/Page\b", paper)) in (4, 5)
    box = re.search(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)\s*\]", paper)
    assert [float(size) for size in box.groups()] == pytest.approx([595.3, 841.9], abs=1.0)


def test_the_table_of_laws_has_room_on_paper(browser, pages):
    """Names of hinges above their row, and four columns of text that share the width of A4 [px]."""
    browser.open(pages["tube"].as_uri(), 673, 900)
    browser.evaluate(UNFOLD)
    browser.call("Emulation.setEmulatedMedia", media="print")
    cells = "document.querySelectorAll('.laws tbody tr:first-child :is(th, td)')"
    widths = browser.evaluate(f"[...{cells}].map(cell => cell.getBoundingClientRect().width)")
    fits = browser.evaluate("document.documentElement.scrollWidth <= 673")
    assert widths[0] > 660
    assert min(widths[1:5]) > 80
    assert sum(widths[1:]) < 673
    assert fits


def words_of_pages(paper):
    """How often text is drawn on each page of a PDF of Chromium's."""
    objects = {int(n): body for n, body in re.findall(rb"\n(\d+) 0 obj\s*(.*?)\s*endobj", paper, re.DOTALL)}
    numbers = []
    for body in objects.values():
        if re.search(rb"/Type\s*/Page\b", body):
            content = objects[int(re.search(rb"/Contents\s+(\d+) 0 R", body)[1])]
            head, _, drawn = content.partition(b"stream")
            if b"FlateDecode" in head:
                drawn = zlib.decompressobj().decompress(drawn.lstrip(b"\r\n"))
            numbers.append(len(re.findall(rb"T[jJ]\b", drawn)))
    return numbers


@pytest.mark.parametrize("name", ["tube", "frame"])
def test_no_printed_page_is_empty(browser, pages, tmp_path, name):
    browser.open(pages[name].as_uri(), 1200, 1600)
    paper = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
    assert min(words_of_pages(paper)) > 100
    gap = tmp_path / "gap.html"
    gap.write_text("<p>one</p><p style='break-before: page'></p><p style='break-before: page'>two</p>")
    browser.open(gap.as_uri(), 400, 300)
    paper = base64.b64decode(browser.call("Page.printToPDF")["data"])
    assert [number > 0 for number in words_of_pages(paper)] == [True, False, True]


def test_a_page_that_breaks_the_rules_is_noticed(browser, tmp_path):
    """The checks above can fail: a script, a picture from outside and a console message are all reported."""
    page = tmp_path / "bad.html"
    page.write_text("<img src='https://example.invalid/x.png'><script>console.error('x')</script>")
    browser.open(page.as_uri(), 400, 300)
    methods = {event["method"] for event in browser.events}
    assert "Runtime.consoleAPICalled" in methods
    requests = [e for e in browser.events if e["method"] == "Network.requestWillBeSent"]
    assert len(requests) == 2
