"""Numbers of a text are found where they stand, in the units in which a browser counts."""

import pytest

pytest.importorskip("starlette")

from crumple.app.numbers import scalars_of
from crumple.app.start_texts import start_text, start_texts


def numbers(text):
    return scalars_of(text)["numbers"]


TEXT = """crumple: 1
title: "12 mm"   # 13 mm
a: {b: 2.5 mm, c: [1, -3e-2 m, {d: .5}]}
list:
  - x: 70x70x2
    y: +4 kg   # mass
  - 7
"""


def test_each_number_has_path_place_value_and_unit():
    found = {one["path"]: one for one in numbers(TEXT)}
    assert {path: (one["value"], one["unit"]) for path, one in found.items()} == {
        "a.b": (2.5, "mm"),
        "a.c[0]": (1.0, ""),
        "a.c[1]": (-0.03, "m"),
        "a.c[2].d": (0.5, ""),
        "list[0].y": (4.0, "kg"),
        "list[1]": (7.0, ""),
    }
    written = {
        "a.b": "2.5",
        "a.c[0]": "1",
        "a.c[1]": "-3e-2",
        "a.c[2].d": ".5",
        "list[0].y": "+4",
        "list[1]": "7",
    }
    assert {path: TEXT[one["start"] : one["end"]] for path, one in found.items()} == written


def test_places_count_as_browsers_do():
    text = "a: '\U0001f697'\nb: 5 mm\n"
    (one,) = numbers(text)
    wide = text.encode("utf-16-le")
    assert wide[2 * one["start"] : 2 * one["end"]].decode("utf-16-le") == "5"


@pytest.mark.parametrize(
    ("text", "paths"),
    [
        ("", []), ("a: [1, 2", ["a[0]", "a[1]"]), ("a: 1\nb: {", ["a"]), ("&x 1", [""]),
        ("a: 1\nb: *x", ["a"]), ("a: 1\n%", ["a"]), ("\t", []), ("- " * 3000, []),
    ],
)  # fmt: skip
def test_what_comes_before_a_mistake_is_found(text, paths):
    assert [one["path"] for one in numbers(text)] == paths


def test_all_numbers_of_the_starts_are_where_they_say():
    for one in start_texts():
        text = start_text(one["name"])
        found = numbers(text)
        assert len(found) > 10
        assert [float(text[n["start"] : n["end"]]) for n in found] == [n["value"] for n in found]


def test_words_of_sections_and_laws_are_found_where_they_stand():
    text = """sections:
  a: {type: square_tube, side: 5 mm}   # kind: none
hinge_laws: {soft: {type: kecman, start: 'cap', after_jamming: hold}}
members: {m: {section: a}}
"""
    words = scalars_of(text)["words"]
    assert {one["path"]: one["text"] for one in words} == {
        "sections.a.type": "square_tube",
        "hinge_laws.soft.type": "kecman",
        "hinge_laws.soft.after_jamming": "hold",
    }
    assert all(text[one["start"] : one["end"]] == one["text"] for one in words)
