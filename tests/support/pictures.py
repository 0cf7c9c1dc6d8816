"""Pictures of pages for the documentation: `python -m tests.support.pictures COMPARISON RUN [FOLDER]`.

COMPARISON is the folder of `make demo`, RUN that of `crumple run examples/10_bus_ring.yaml`; FOLDER has the
pictures, by default docs/images.  The picture of the app is of examples/08_s_rail.yaml, solved for it.
Needs Chromium, and Pillow, which matplotlib brings.
"""

from __future__ import annotations

import base64
import io
import shutil
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from tests.support.app import started
from tests.support.browser import Browser, find_browser

WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
RAIL = Path("examples/08_s_rail.yaml")
MARGIN = 15
"""Around a figure [px]."""
DRAGGED = ("thickness: 2 mm", "thickness: 2.47 mm")


def until(browser, condition, seconds=120.0):
    """Wait until a condition of the page holds."""
    end = time.monotonic() + seconds
    while not browser.evaluate(f"!!({condition})"):
        if time.monotonic() > end:
            raise TimeoutError(condition)
        time.sleep(0.2)
    browser.settle()


def picture(browser, file, size, scale=1.0):
    """Keep the upper left of a page, (wide, high) [px], in a palette of 256 colours."""
    clip = {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": scale}
    data = browser.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
    image = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")
    image.quantize(256, dither=Image.Dither.NONE).save(file, optimize=True)
    print(f"{file}: {image.width} x {image.height}, {file.stat().st_size / 1e3:.0f} kB")


def report(browser, page, file, size, scale):
    """The head of a report, with the viewer at the time at which it opens."""
    browser.open(page.resolve().as_uri(), size[0], size[1])
    until(browser, "document.getElementById('player').dataset.ready")
    picture(browser, file, size, scale)


def figure(browser, svg, file, width):
    """A figure of a report, drawn some pixels wide."""
    browser.open(svg.resolve().as_uri(), width, width)
    high = browser.evaluate(
        "(() => { const e = document.documentElement, box = e.viewBox.baseVal;"
        f" const [wide, margin] = [{width - 2 * MARGIN}, {MARGIN}], high = wide * box.height / box.width;"
        " e.setAttribute('width', wide); e.setAttribute('height', high); e.style.margin = `${margin}px`;"
        " return high + 2 * margin; })()"
    )
    picture(browser, file, (width, round(high)))


def app(browser, file, size, scale):
    """The app with an S-rail whose wall was just made thicker."""
    with TemporaryDirectory() as place:
        # a draft stays beside the file, and the page shows the name of its folder
        folder = Path(place) / "frames"
        folder.mkdir()
        _rail(browser, shutil.copy(RAIL, folder / "s_rail.yaml"), file, size, scale)


def _rail(browser, rail, file, size, scale):
    with started(rail) as address:
        browser.open(address, *size)
        until(browser, "window.crumpleApp?.idle && document.getElementById('said').textContent.trim()")
        text = "crumpleApp.editor.text"
        old, new = DRAGGED
        start = browser.evaluate(f"{text}.indexOf('{old}')")
        browser.evaluate(f"crumpleApp.editor.put({start}, {start + len(old)}, '{new}', true); 1")
        until(browser, "crumpleApp.idle && crumplePlayer.scene.before?.models.length")
        until(browser, "document.querySelectorAll('#curves polygon.band').length")
        until(browser, "document.querySelectorAll('#forms img').length > 2")
        # room for the form of the section below the text
        browser.evaluate("document.getElementById('editor').style.height = '280px'; 1")
        browser.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; }); 1")
        until(browser, "crumpleApp.idle")
        picture(browser, file, size, scale)


def main(comparison, run, folder="docs/images"):
    """Make all pictures anew."""
    browser, folder = Browser(find_browser(), WEBGL), Path(folder)
    try:
        report(browser, Path(comparison) / "report.html", folder / "comparison.png", (1000, 1070), 1.0)
        report(browser, Path(run) / "report.html", folder / "page.png", (1000, 1500), 0.64)
        figure(browser, Path(run) / "figures" / "deformation.svg", folder / "bus_ring.png", 940)
        app(browser, folder / "app.png", (1400, 1050), 0.8257)
    finally:
        browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
