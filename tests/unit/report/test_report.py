"""The page holds everything, fetches nothing, escapes everything, and comes out for every kind of result."""

import html.parser
import math
import re
import subprocess
import sys
from dataclasses import replace
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest
from tests.support.result.synthetic_frame import CUBE, PORTAL, frame_result, frame_states
from tests.support.result.synthetic_tube import (
    ENERGY,
    MOMENT,
    ROTATION_MAX,
    TIME_OF_REST,
    tube_channels,
    tube_result,
)

from crumple.errors import Status
from crumple.report import ReportInput, write_report
from crumple.result import Channel

HOSTILE = '$\\q$\x1b<script>alert(\'x\')</script>"><img src=x onerror=y>&amp;]\x00 id="p" url(#q) </text>'
"""First what breaks formulas and XML, since figures cut long names; then what breaks HTML."""


class Elements(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.text = [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes

    def handle_data(self, data):
        self.text += data


@pytest.fixture(name="page")
def _page(tmp_path):
    source = ReportInput(
        text="crumple: 1\nnodes: {a: [0 m, 0 m, 0 m]}\n", name="tube.yaml", residual_bound=1e-3, accuracy=1e-3
    )
    return write_report(tube_result(), source, tmp_path).read_text(encoding="utf-8")


def test_the_page_contains_the_results(page):
    text = Elements(page).text
    for expected in (
        "Steel tube thrown at 15 rad/s, bending about its weak axis",
        "Complete.",
        "within its bound of 0.1 %",
        "Requested accuracy: 0.1 %",
        f"{math.degrees(ROTATION_MAX):.2f}°",
        f"{ROTATION_MAX:.4f} rad",
        f"{TIME_OF_REST * 1e3:.2f} ms",
        f"{ENERGY:.1f} J",
        f"{MOMENT / 1e3:.3f}",
        "Members are rigid between hinges.",
        "Constant moment (set-valued)",
        "chosen by the user",
        "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        "nodes: {a: [0 m, 0 m, 0 m]}",
        "Crumple 0.1.0",
    ):
        assert expected in text


def test_the_page_stands_alone(page):
    elements = Elements(page)
    assert not {"link", "img", "iframe", "object", "image"} & set(elements.tags)
    # the viewer's scripts, each allowed by its hash, and the scene, which is text and not run
    assert elements.tags.count("script") == page.count("sha256-") + 2 == 5
    assert "unsafe-inline'; script" not in page.split("script-src")[1]
    for name, value in elements.attributes:
        if name in ("src", "href", "xlink:href"):
            assert value.startswith("#")
        assert not name.startswith("on")
    assert not re.search(r"@import|url\((?!#)", page)
    assert "default-src 'none'" in page
    assert len(page.encode()) < 1_000_000


def test_tables_and_figures_can_be_read_aloud(page):
    elements = Elements(page)
    assert elements.tags.count("th") > 10
    assert all(value in ("col", "row") for name, value in elements.attributes if name == "scope")
    assert ("lang", "en") in elements.attributes
    assert elements.tags.count("title") == 1 + elements.tags.count("svg")
    assert elements.tags.count("figcaption") == elements.tags.count("figure") == 5


def test_each_figure_is_drawn_once_and_stored_beside_the_page(tmp_path):
    page = write_report(tube_result(), ReportInput(), tmp_path).read_text(encoding="utf-8")
    files = sorted((tmp_path / "figures").iterdir())
    assert [file.name for file in files] == [
        "angular_velocity.svg", "deformation.svg", "energy.svg", "energy_rotation.svg", "moment_1.svg",
        "output_1.svg", "output_2.svg", "residual.svg", "rotation.svg",
    ]  # fmt: skip
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert ElementTree.fromstring(text.encode()).tag == "{http://www.w3.org/2000/svg}svg"
        assert text.partition("\n")[2] in page


def test_the_page_says_the_answer_first_and_folds_the_rest(page):
    order = [
        page.index(text)
        for text in (
            "The structure absorbed",
            'id="player"',
            "Rotation and angular velocity",
            "<details class",
        )
    ]
    stills = page.index('<details class="stills">')
    assert order[:3] == sorted(order[:3])
    assert stills == order[3] > order[1]
    assert page.index('<details class="rest"') > order[2]
    body = page[page.index("</header>") :]
    assert body.count("<table") == body[body.index('<details class="rest"') :].count("<table") > 3


def test_at_most_five_cautions_stand_before_the_pictures(tmp_path):
    warnings = tuple(f"Caution {'abcdefgh'[i]}." for i in range(8))
    page = write_report(tube_result(warnings=warnings), ReportInput(), tmp_path).read_text(encoding="utf-8")
    verdict = page[page.index('<section class="verdict') : page.index('id="player"')]
    assert (
        verdict.index("Caution e.") < verdict.index("<summary>3 more</summary>") < verdict.index("Caution f.")
    )


def test_the_same_result_gives_the_same_bytes(tmp_path):
    pages = [write_report(frame_result(), ReportInput(), tmp_path / name).read_bytes() for name in "ab"]
    assert pages[0] == pages[1]


def test_the_users_matplotlib_settings_neither_change_nor_matter(tmp_path):
    plain = write_report(tube_result(), ReportInput(), tmp_path / "a").read_text()
    with mpl.rc_context({"axes.grid": True, "font.size": 30, "text.usetex": True, "svg.fonttype": "path"}):
        before = dict(mpl.rcParams)
        assert write_report(tube_result(), ReportInput(), tmp_path / "b").read_text() == plain
        assert dict(mpl.rcParams) == before


def hostile_result():
    result = frame_result(
        PORTAL, 1, warnings=(HOSTILE,), assumptions=(HOSTILE,), title=HOSTILE, reason=HOSTILE
    )
    (old,) = result.hinges
    channels = {
        name.replace(old, HOSTILE): replace(channel, name=channel.name.replace(old, HOSTILE))
        for name, channel in result.channels.items()
    }
    channels[HOSTILE] = Channel(HOSTILE, HOSTILE, np.arange(len(result.time), dtype=float))
    hinge = replace(result.hinges[old], law=HOSTILE, source=HOSTILE, form=HOSTILE, validity_basis=HOSTILE)
    provenance = replace(
        result.provenance, version=HOSTILE, input_hash=HOSTILE, isa=HOSTILE, settings={HOSTILE: HOSTILE}
    )
    return replace(
        result,
        status=Status.NOT_CONVERGED,
        channels=channels,
        hinges={HOSTILE: hinge},
        output_names=(HOSTILE,),
        provenance=provenance,
        fidelity=HOSTILE,
    )


def test_nothing_that_the_user_wrote_becomes_markup(tmp_path):
    source = ReportInput(title=HOSTILE, text=HOSTILE, name=HOSTILE)
    page = write_report(hostile_result(), source, tmp_path).read_text(encoding="utf-8")
    elements = Elements(page)
    # the scripts of the page itself alone; the scene is text
    assert elements.tags.count("script") == page.count("sha256-") + 2
    assert "<script>alert" not in page
    assert "img" not in elements.tags
    assert not any(name.startswith("on") for name, _ in elements.attributes)
    assert elements.text.count("<script>alert('x')</script>") > 12
    for file in (tmp_path / "figures").iterdir():
        ElementTree.fromstring(file.read_bytes())
        assert file.parent == tmp_path / "figures"


def test_any_script_can_name_a_hinge(tmp_path):
    result = frame_result(PORTAL, 1)
    result = replace(
        result,
        channels={
            name.replace("h0", "ヒンジ ß π שלום"): channel for name, channel in result.channels.items()
        },
        hinges={"ヒンジ ß π שלום": result.hinges["h0"]},
    )
    page = write_report(result, ReportInput(), tmp_path).read_text(encoding="utf-8")
    assert "Moment in ヒンジ ß π שלום, kN m" in page


def test_names_of_figure_files_do_not_come_from_the_user(tmp_path):
    write_report(hostile_result(), ReportInput(), tmp_path / "out")
    assert {path.name for path in tmp_path.iterdir()} == {"out"}
    assert (tmp_path / "out" / "figures" / "moment_1.svg").exists()


def broken_channels():
    result = tube_result()
    half = np.arange(len(result.time)) > 100
    return {
        name: Channel(name, c.unit, np.where(half, math.nan, c.values)) for name, c in result.channels.items()
    }


def short_run(n):
    time = np.linspace(0.0, 0.1, 201)[:n]
    return {"time": time, "channels": tube_channels(time), "states": None}


def one_hinge(**changes):
    return {"root": replace(tube_result().hinges["root"], **changes)}


KINDS = {
    "no states": tube_result(states=None),
    "nothing": tube_result(hinges={}, channels={}, output_names=(), states=None, assumptions=()),
    "output gone": tube_result(output_names=("gone",)),
    "no times": tube_result(**short_run(0), output_names=()),
    "one time": tube_result(**short_run(1)),
    "two times": tube_result(**short_run(2)),
    "not finite": tube_result(channels=broken_channels(), status=Status.NOT_FINITE, energy_residual=math.nan),
    "hinge not finite": tube_result(
        hinges=one_hinge(
            rotation_max=math.nan,
            energy=math.nan,
            time_of_rest=None,
            moment_max=math.nan,
            validity_rotation=None,
        )
    ),
    "no envelope": tube_result(hinges=one_hinge(envelope={}, validity_rotation=math.inf)),
    "hinge at rest": tube_result(hinges=one_hinge(rotation_max=0.0, energy=0.0)),
    "cancelled": tube_result(status=Status.CANCELLED, solve_seconds=0.0, energy_residual=math.inf),
    "lost points": frame_result(states=frame_states(PORTAL, [0.0, 0.05], math.nan)),
    "no motion": frame_result(states=frame_states(PORTAL, [0.0, 0.05], 0.0)),
    "one picture": frame_result(states=frame_states(PORTAL[:1], [0.03], 0.1)),
}


@pytest.mark.parametrize("result", KINDS.values(), ids=KINDS)
def test_every_kind_of_result_has_a_page(tmp_path, result):
    page = write_report(result, ReportInput(residual_bound=1e-3), tmp_path).read_text(encoding="utf-8")
    drawing = "".join(re.findall(r"<svg.*?</svg>", page, flags=re.DOTALL))
    assert not re.search(r"\b(nan|inf)\b", drawing)
    assert "</html>" in page


def test_many_hinges_and_a_fine_mesh_stay_small(tmp_path):
    many = frame_result(CUBE, 60)
    states = many.states
    copies = 60
    quads = np.concatenate([states.quads] * copies)
    many = replace(many, states=replace(states, quads=quads))
    page = write_report(many, ReportInput(text="# long\n" * 50_000), tmp_path)
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < 1_500_000
    assert len(list((tmp_path / "figures").glob("moment_*.svg"))) == 12
    assert "the histories of the other 48 are in histories.csv" in text
    assert "its first 60000 characters" in text
    assert "data:image/png" in text
    assert text.count("# long") < 10_000


def test_long_histories_stay_small(tmp_path):
    time = np.linspace(0.0, 0.1, 100_001)
    write_report(tube_result(time=time, channels=tube_channels(time)), ReportInput(), tmp_path)
    assert (tmp_path / "report.html").stat().st_size < 1_100_000


def test_canonical_input_is_shown_where_there_is_no_text(tmp_path):
    page = write_report(
        tube_result(), ReportInput(canonical={"crumple": 1, "nodes": {"a": [0, 0, 0]}}), tmp_path
    )
    assert '"nodes": {' in Elements(page.read_text()).text


def test_the_room_is_light_until_it_draws():
    code = (
        "import sys, crumple.report; print([m for m in ('matplotlib', 'jinja2', 'h5py') if m in sys.modules])"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"
