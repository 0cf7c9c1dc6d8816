"""The page in a real browser: it solves what is typed and dragged, shows mistakes, saves, fits a phone."""

import json
import time
from contextlib import contextmanager

import pytest

for package in ("starlette", "uvicorn", "websockets"):
    pytest.importorskip(package)

from tests.support.app import request, started  # noqa: E402

from crumple.app.start_texts import start_text  # noqa: E402

TUBE = start_text("tube_bending")
TEXT = "crumpleApp.editor.text"
SAID = "document.getElementById('said').textContent"
ABSORBED = "Number(/absorbed ([0-9.]+)/.exec(document.getElementById('said').textContent)?.[1] ?? 0)"
THICKNESS = "document.querySelector('#sliders input[data-path=\"sections.tube.thickness\"]')"


@pytest.fixture(name="place")
def _place(tmp_path):
    (tmp_path / "tube.yaml").write_text(TUBE)
    return tmp_path


@contextmanager
def opened(browser, place):
    with started(place / "tube.yaml") as address:
        browser.open(address, 1400, 1000)
        until(browser, f"window.crumpleApp?.idle && {ABSORBED} > 0")
        yield browser
        browser.open("about:blank", 1400, 1000)


@pytest.fixture(name="own_page")
def _own_page(browser, place):
    with opened(browser, place) as page:
        yield page


@pytest.fixture(scope="module", name="first_page")
def _first_page(browser, tmp_path_factory):
    place = tmp_path_factory.mktemp("shared")
    (place / "tube.yaml").write_text(TUBE)
    with opened(browser, place) as page:
        yield page


@pytest.fixture(name="page")
def _page(first_page):
    """One page for tests that only change its text, which come before those that open another.

    The start of an app takes as long as several of them.
    """
    if first_page.evaluate(TEXT) != TUBE:
        first_page.evaluate(f"crumpleApp.editor.put(0, {TEXT}.length, {json.dumps(TUBE)}, true); 1")
    until(first_page, f"crumpleApp.idle && {ABSORBED} === 783.7")
    return first_page


def until(browser, condition, seconds=240.0):
    """Wait for something to be true in the page."""
    end = time.monotonic() + seconds
    while not browser.evaluate(f"!!({condition})"):
        assert time.monotonic() < end, browser.evaluate("document.body.innerText")
        time.sleep(0.05)


def put(browser, old, new):
    """Replace a piece of the text as an edit."""
    start = browser.evaluate(f"{TEXT}.indexOf({json.dumps(old)})")
    assert start >= 0
    browser.evaluate(f"crumpleApp.editor.put({start}, {start + len(old)}, {json.dumps(new)}, true); 1")


def key(browser, name, code, **more):
    for kind in ("rawKeyDown", "keyUp"):
        browser.call(
            "Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=code, **more
        )


def box(browser, element):
    return browser.evaluate(
        f"(() => {{ const e = {element}; e.scrollIntoView({{block: 'center'}});"
        " const b = e.getBoundingClientRect();"
        " return [b.left, b.top, b.width, b.height]; })()"
    )


def mouse(browser, kind, x, y):
    held = {"buttons": 1} if kind == "mouseMoved" else {}
    browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1, **held)


def test_it_opens_solves_and_says_nothing_wrong(page):
    assert page.evaluate(TEXT) == TUBE
    assert page.evaluate("location.hash") == ""
    assert page.evaluate(ABSORBED) == 783.7
    until(page, "document.querySelectorAll('#figures img').length > 3")
    until(
        page,
        "[...document.querySelectorAll('#figures img')].every((one) => one.complete && one.naturalWidth > 0)",
    )
    assert page.evaluate("document.getElementById('player').dataset.ready") == "webgl"
    assert page.evaluate("document.cookie") == ""
    assert page.evaluate("localStorage.length + sessionStorage.length") == 0
    complaints = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
    assert [event for event in page.events if event["method"] in complaints] == []


def test_a_drag_changes_the_digits_of_one_number_and_the_crash(page):
    before = page.evaluate("crumpleApp.told.length")
    left, top, wide, tall = box(page, THICKNESS)
    mouse(page, "mousePressed", left + wide / 2, top + tall / 2)
    for share in (0.55, 0.6, 0.65, 0.7, 0.75):
        mouse(page, "mouseMoved", left + share * wide, top + tall / 2)
        until(page, "crumpleApp.idle")
    text = page.evaluate(TEXT)
    assert page.evaluate("crumplePlayer.scene.before.models.length") == 1
    mouse(page, "mouseReleased", left + 0.75 * wide, top + tall / 2)
    changed = [(a, b) for a, b in zip(TUBE.splitlines(), text.splitlines(), strict=True) if a != b]
    ((old, new),) = changed
    start, _, end = old.partition("2.65 mm")
    assert new.startswith(start)
    assert new.endswith(f" mm{end}")
    assert 3.0 < float(new[len(start) :].partition(" mm")[0]) < 3.6
    assert page.evaluate("crumpleApp.told.length") >= before + 3
    until(page, f"crumpleApp.idle && {ABSORBED} !== 783.7")
    assert page.evaluate("document.querySelectorAll('#curves .middle').length") > 0
    # one undo takes back the whole drag, as far as it was one gesture
    page.evaluate("crumpleApp.editor.view.focus(); 1")
    for _ in range(8):
        key(page, "z", 90, modifiers=2)
        if page.evaluate(TEXT) == TUBE:
            break
    assert page.evaluate(TEXT) == TUBE
    until(page, f"crumpleApp.idle && {ABSORBED} === 783.7")


FIELD = "document.querySelector('#forms [data-path=\"{}\"]')"
FILLED = "document.querySelectorAll('#forms .values').length"


def test_a_form_changes_one_scalar_and_shows_drawing_capacities_and_law(page):
    until(page, f"{FILLED} > 0")
    page.evaluate(
        "document.getElementById('forms').closest('details').open = true;"
        " document.querySelector('#forms details').open = true; 1"
    )
    until(page, "[...document.querySelectorAll('#forms img')].every((one) => one.naturalWidth > 0)")
    assert page.evaluate("document.querySelectorAll('#forms img').length") == 2
    # the values of the text before may still stand there
    until(page, "document.querySelector('#forms .values').innerText.includes('1.696 kN m')")
    field = FIELD.format("sections.tube.thickness")
    left, top, wide, tall = box(page, field)
    for kind in ("mousePressed", "mouseReleased"):
        at = {"x": left + wide / 2, "y": top + tall / 2}
        page.call("Input.dispatchMouseEvent", type=kind, button="left", clickCount=3, **at)
    page.call("Input.insertText", text="3.")
    page.call("Input.insertText", text="1")
    until(page, f"crumpleApp.idle && {ABSORBED} !== 783.7")
    text = page.evaluate(TEXT)
    assert text == TUBE.replace("thickness: 2.65 mm", "thickness: 3.1 mm")
    # what is no number stays out of the text, and the field takes the text back
    page.call("Input.insertText", text="x")
    assert page.evaluate(f"{field}.getAttribute('aria-invalid')") == "true"
    assert page.evaluate(TEXT) == text
    page.evaluate(f"{field}.blur(); 1")
    assert page.evaluate(f"{field}.value") == "3.1"
    until(page, "!document.querySelector('#forms .values').innerText.includes('1.696 kN m')")


def test_a_choice_of_a_law_changes_one_word(page):
    named = "hinge_laws:\n  own: {type: kecman, start: parabola}   # mine\n\nanalysis:"
    put(page, "\nanalysis:", "\n" + named)
    field = FIELD.format("hinge_laws.own.start")
    until(page, f"!!{field}")
    before = page.evaluate(TEXT)
    page.evaluate(f"{field}.value = 'cap'; {field}.dispatchEvent(new Event('input')); 1")
    assert page.evaluate(TEXT) == before.replace("start: parabola}", "start: cap}")
    until(page, "crumpleApp.idle")


def test_curves_have_the_bands_of_laws(page):
    until(page, "document.querySelectorAll('#curves .band').length > 2")
    assert "1 of the hinge laws" in page.evaluate("document.getElementById('band').textContent")


def test_arrow_keys_move_a_slider(page):
    page.evaluate(f"{THICKNESS}.focus(); 1")
    key(page, "ArrowRight", 39)
    until(page, f"crumpleApp.idle && {ABSORBED} !== 783.7")
    assert "thickness: 2.6" in page.evaluate(TEXT)
    assert page.evaluate(TEXT) != TUBE


def test_sliders_and_fields_of_replaced_numbers_leave_the_new_text_alone(page):
    until(page, f"{FILLED} > 0")
    other = "# another text\n" + TUBE.replace("2.65 mm", "3 mm")
    for control in (THICKNESS, FIELD.format("sections.tube.thickness")):
        # the answer to the new text has not come when the old control moves
        page.evaluate(
            f"{{ const one = {control};"
            f" crumpleApp.editor.put(0, {TEXT}.length, {json.dumps(other)}, true);"
            " one.value = 2.8; for (const k of ['input', 'change']) one.dispatchEvent(new Event(k)); 1 }"
        )
        assert page.evaluate(TEXT) == other
        until(page, "crumpleApp.idle")
        page.evaluate(f"crumpleApp.editor.put(0, {TEXT}.length, {json.dumps(TUBE)}, true); 1")
        until(page, f"crumpleApp.idle && !!{control}")


def test_typing_shows_mistakes_at_their_line_and_keys_that_fit(page):
    put(page, "section: tube\n", "section: tub\n")
    until(page, "document.querySelectorAll('#problems button').length === 1")
    line = TUBE.splitlines().index("    section: tube") + 1
    assert page.evaluate("document.querySelector('#problems button').textContent").startswith(
        f"line {line}: "
    )
    assert page.evaluate("document.querySelectorAll('.cm-lintRange-error').length") == 1
    page.evaluate("document.querySelector('#problems button').click(); 1")
    assert page.evaluate("crumpleApp.editor.view.state.doc.lineAt(crumpleApp.editor.cursor).number") == line
    page.call("Input.dispatchKeyEvent", type="rawKeyDown", key="End", code="End", windowsVirtualKeyCode=35)
    page.call("Input.insertText", text="e")
    until(page, "document.querySelectorAll('#problems button').length === 0")
    page.evaluate("crumpleApp.editor.go(crumpleApp.editor.view.state.doc.lines); 1")
    # one frame scrolls, the next tells CodeMirror so, which then reads text typed before without its cursor
    page.settle()
    page.settle()
    page.call("Input.insertText", text="grav")
    until(page, "document.querySelector('.cm-tooltip-autocomplete')?.textContent.includes('gravity')")


def test_a_slow_drawing_is_not_overtaken_by_the_next(own_page):
    own_page.evaluate(
        "window.order = []; const show = crumplePlayer.show, waits = [1500, 0]; crumplePlayer.show ="
        " async (...all) => { const wait = waits.shift(); await new Promise((on) => setTimeout(on, wait));"
        " order.push(wait); return show(...all); }; 1"
    )
    put(own_page, "2.65 mm", "2.7 mm")
    until(own_page, f"{ABSORBED} !== 783.7")
    first = own_page.evaluate(ABSORBED)
    put(own_page, "2.7 mm", "2.8 mm")
    until(own_page, f"crumpleApp.idle && ![783.7, {first}].includes({ABSORBED})")
    assert own_page.evaluate("order") == [1500, 0]


def test_saving_keeps_the_file_of_another_program(own_page, place):
    put(own_page, "2.65 mm", "2.7 mm")
    own_page.evaluate("document.getElementById('name').focus(); 1")
    key(own_page, "s", 83, modifiers=2)
    until(own_page, "document.getElementById('file-state').textContent === 'saved'")
    assert (place / "tube.yaml").read_text() == TUBE.replace("2.65 mm", "2.7 mm")
    (place / "tube.yaml").write_text("changed: 1\n")
    put(own_page, "2.7 mm", "2.8 mm")
    own_page.evaluate("document.getElementById('save').click(); 1")
    until(own_page, "document.getElementById('refusal').textContent.includes('changed by another program')")
    assert (place / "tube.yaml").read_text() == "changed: 1\n"


def soon(true):
    """Whether it becomes true."""
    for _ in range(200):
        if true():
            return True
        time.sleep(0.05)
    return False


def test_a_text_that_is_as_saved_again_has_no_draft(own_page, place):
    kept = place / ".tube.yaml.draft"
    put(own_page, "2.65 mm", "3 mm")
    assert soon(kept.exists)
    put(own_page, "3 mm", "2.65 mm")
    assert soon(lambda: not kept.exists())


def test_a_draft_is_offered_again(browser, place):
    for again in (False, True):
        with started(place / "tube.yaml") as address:
            browser.open(address, 1400, 1000)
            until(browser, f"window.crumpleApp && {ABSORBED} > 0")
            if not again:
                put(browser, "2.65 mm", "3 mm")
                until(browser, f"crumpleApp.idle && {ABSORBED} !== 783.7")
                assert soon((place / ".tube.yaml.draft").exists)
                assert (place / "tube.yaml").read_text() == TUBE
            else:
                assert not browser.evaluate("document.getElementById('draft').hidden")
                browser.evaluate("document.getElementById('restore').click(); 1")
                until(browser, f"{TEXT}.includes('thickness: 3 mm')")
        browser.open("about:blank", 800, 600)


def test_without_its_code_the_page_shows_nothing(browser, place):
    with started(place / "tube.yaml") as address:
        base, _, code = address.partition("/#")
        browser.open(base, 800, 600)
        until(browser, "document.getElementById('banner').textContent.includes('without its code')")
        assert request(base, "/token", code.encode(), Origin=base)[0] == 200
        browser.open("about:blank", 800, 600)
        browser.open(address, 800, 600)
        until(browser, "document.getElementById('banner').textContent.includes('used already')")
        assert browser.evaluate(f"{TEXT}") == ""


def test_the_page_fits_a_phone_with_forms_and_figures_of_legible_labels(browser, place):
    """Text of figures has 7.5 points at least: 9 pixels or more if a figure has 0.9 pixels to a point."""
    with started(place / "tube.yaml") as address:
        browser.open(address, 390, 800)
        until(
            browser,
            f"window.crumpleApp && {ABSORBED} > 0 && {FILLED} > 0"
            " && document.querySelectorAll('#figures img').length > 3",
        )
        assert browser.evaluate("document.documentElement.scrollWidth") <= 390
        browser.evaluate("document.querySelectorAll('#forms, #forms details').forEach((one) => {"
                         " one.open = true; one.closest('details').open = true; }); 1")  # fmt: skip
        images = "[...document.querySelectorAll('#forms img, #figures img')]"
        until(browser, f"{images}.every((one) => one.complete && one.naturalWidth > 0)")
        scales = browser.evaluate(
            f"{images}.map((one) => one.getBoundingClientRect().width / one.dataset.points)"
        )
        assert len(scales) > 5
        assert min(scales) > 0.9
        assert browser.evaluate("document.documentElement.scrollWidth") <= 390
        browser.open("about:blank", 1400, 1000)
