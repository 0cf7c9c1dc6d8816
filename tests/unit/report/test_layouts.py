"""Several layouts on one page: table, data, figures; refusals are rows."""

import csv
import html
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from tests.support.result.synthetic_frame import PORTAL, frame_result
from tests.support.result.synthetic_tube import tube_result

from crumple.report import Layout, layout_table, write_layouts

HOSTILE = '<script>alert("x")</script>'


@pytest.fixture(name="layouts")
def _layouts():
    tube, portal = tube_result(), frame_result(PORTAL)
    return [
        Layout("tube", tube.title, 2.9, tube),
        Layout("portal", portal.title, 30.0, replace(portal, warnings=(HOSTILE,))),
        Layout("wrong", reason=f"there is no section '{HOSTILE}'"),
    ]


def test_table_has_a_row_for_each_layout_and_a_refusal_has_no_numbers(layouts):
    table = layout_table(layouts)
    assert [row[0] for row in table.rows] == ["tube", "portal", "wrong"]
    assert all(len(row) == len(table.heads) for row in table.rows)
    assert table.rows[2][1] == "refused"
    assert set(table.rows[2][2:]) == {"—"}
    absorbed = layouts[0].result["energy.dissipated"][-1]
    head = next(head for head in table.heads if head.startswith("Energy absorbed"))
    factor = 1e3 if head.endswith("kJ") else 1.0
    assert float(table.rows[0][table.heads.index(head)]) * factor == pytest.approx(absorbed, rel=2e-3)


def test_data_are_in_si_with_the_outputs_that_all_have(layouts, tmp_path):
    layouts[1] = Layout("again", "", 5.8, layouts[0].result)
    write_layouts(layouts, "Layouts", tmp_path)
    with (tmp_path / "layouts.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["mass [kg]"] for row in rows] == ["2.9", "5.8", ""]
    result = layouts[0].result
    name, summary = next(iter(result.outputs.items()))
    column = f"{name} max [{summary.unit}]"
    assert float(rows[0][column]) == float(rows[1][column]) == summary.max
    assert rows[2][column] == ""
    assert rows[2]["reason"] == layouts[2].reason


def test_page_shows_every_layout_escapes_texts_and_links_to_the_pages(layouts, tmp_path):
    page = write_layouts(layouts, HOSTILE, tmp_path).read_text(encoding="utf-8")
    # its own scripts, each allowed by its hash, and the scene, which is text
    assert page.count("<script") == page.count("</script>") == page.count("sha256-") + 2
    assert "<script>alert" not in page
    assert 'href="tube/report.html"' in page
    assert 'href="wrong/report.html"' not in page
    assert page.count("&lt;script&gt;") >= 3
    for figure in ("shapes", "energy"):
        svg = (tmp_path / "figures" / f"{figure}.svg").read_text(encoding="utf-8")
        texts = " ".join(ElementTree.fromstring(svg).itertext())
        assert "tube" in texts
        assert "portal" in texts


def test_page_of_refusals_alone_is_written(layouts, tmp_path):
    page = write_layouts(layouts[2:], "Layouts", tmp_path).read_text(encoding="utf-8")
    assert "refused" in page
    assert not (tmp_path / "figures").exists()


def test_alike_warnings_of_layouts_are_one_line(tmp_path):
    warned = [
        Layout(name, "", 1.0, tube_result(warnings=(f"{share} J are lost.", f"Only {name}.")))
        for name, share in (("one", 4.0), ("two", 5.0))
    ]
    text = html.unescape(write_layouts(warned, "two", tmp_path).read_text(encoding="utf-8"))
    assert "<li>one: 4.0 J are lost. The same of two.</li>" in text
    assert "two: 5.0 J" not in text
