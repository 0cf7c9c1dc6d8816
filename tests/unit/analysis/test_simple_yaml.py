"""The quick reader of simple lines gives what the full parser gives, or leaves the text to it."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.analysis.reading import DEEPEST, Document, _plain_scalar, _Reader, read_text
from crumple.analysis.simple_yaml import SimpleText
from crumple.errors import InputError

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.yaml"))


def quickly(text: str) -> SimpleText:
    reader = SimpleText(text, _plain_scalar, DEEPEST)
    reader.data = reader.read()  # type: ignore[attr-defined]
    return reader


def same(text: str) -> bool:
    """Whether the quick reader took a text; then it must agree with the full parser."""
    quick = quickly(text)
    if quick.data is None:  # type: ignore[attr-defined]
        return False
    full = _Reader(text, "").read()
    assert repr(quick.data) == repr(full.data)  # type: ignore[attr-defined]
    # what is in brackets is in the line of what they belong to
    read = Document(quick.data, quick.lines)  # type: ignore[attr-defined]
    assert {place: read.line_of(place) for place in full.lines} == full.lines
    assert quick.lines.keys() <= full.lines.keys()
    assert not full.problems
    return True


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_is_simple_and_reads_alike(file: Path) -> None:
    assert same(file.read_text(encoding="utf-8"))


SIMPLE = [
    "a: 1\nb:\n  c: [1, 2.5e-3, -3 mm]\n  d: {e: x, 'f g': \"h, i\"}\n",
    "a:\n- 1\n- b: 2\n  c: 3\n-   - x\n    - y\nd: ~\n",
    "a: 1 # note\n# note\n\n'b': \"c: d\"\ne:\nf: true\n",
    "a: {}\nb: []\nc: .inf\nd: .nan\ne: +5\nf: -.5\r\ng: x, y [z] {w}\n",
    "a: [{b: 1, c: x}]\nb: [[1], 2]\nc: {d: {e: 1}}\nd: [ 1 , 2 mm ]\n",
    "e: [{a: 1}, {b: 2}]\nf: {g: ~ , 'h': 1}\n",
    "größe: 20 °\n1: 2\n_x: no\n",
]


@pytest.mark.parametrize("text", SIMPLE)
def test_simple_texts_are_taken(text: str) -> None:
    assert same(text)


LEFT = [
    "a: b\n c: d\n", "a: |\n  text\n", "a: &x 1\n", "a: *x\n", "a: !!int 1\n", "a: 1\na: 2\n",
    "a: {b: 1, b: 2}\n", "- 1\n- 2\n", "a: [1,\n 2]\n", "a: b: c\n", "a:\n  b: 1\n c: 2\n", "a: 'it''s'\n",
    'a: "x\\n"\n', "a:\tb\n", "? a\n: b\n", "---\na: 1\n", "%YAML 1.2\n", "a: {b}\n", "a: [1, ]\n", "a: @b\n",
    "a: 1 2#3\nb: c#d\n", "a: [}\n", "a: [1]]\n", "a: b\n  c\n", "a: - b\n", "a: {b:1}\n", "",
]  # fmt: skip


@pytest.mark.parametrize("text", LEFT)
def test_other_texts_are_left_to_the_full_parser(text: str) -> None:
    assert not same(text)


PIECES = [
    "a",
    "b",
    ":",
    ": ",
    "- ",
    " ",
    "  ",
    "\n",
    "[",
    "]",
    "{",
    "}",
    ",",
    "#",
    " #",
    "'",
    '"',
    "1",
    "-",
    ".",
    "é",
]


@given(st.lists(st.sampled_from(PIECES), max_size=25))
def test_what_is_taken_reads_as_the_full_parser_reads_it(pieces: list[str]) -> None:
    same("".join(pieces))


LEAF = st.sampled_from(["1", "2 mm", "x", "'y z'", '"a: b"', "", "-0.5", "true", "[1, {a: 2}]", "{k: [v]}"])
NESTED = st.recursive(
    LEAF, lambda inner: st.dictionaries(st.sampled_from("abcd"), inner, min_size=1, max_size=3), max_leaves=8
)


def written(value: object, indent: int = 0) -> str:
    if isinstance(value, str):
        return f" {value}\n" if value else "\n"
    lines = (f"{' ' * indent}{key}:{written(inner, indent + 2)}" for key, inner in value.items())  # type: ignore[attr-defined]
    return ("\n" if indent else "") + "".join(lines)


@given(st.dictionaries(st.sampled_from("abcd"), NESTED, min_size=1, max_size=3))
def test_nested_groups_read_alike(value: dict[str, object]) -> None:
    assert same(written(value))


def test_a_large_text_that_is_not_simple_is_refused_with_its_line() -> None:
    text = "a: 1\nb: |\n" + "  x\n" * 300_000
    with pytest.raises(InputError) as refusal:
        read_text(text, "big.yaml")
    [problem] = refusal.value.problems
    assert "simple lines" in problem.what
    assert problem.line == 2
