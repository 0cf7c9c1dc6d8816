"""Large and bad input: work before a refusal is bounded, and counts have limits by name."""

from __future__ import annotations

import re
import sys
from contextlib import suppress

import pytest

from crumple.analysis import check, loads
from crumple.errors import InputError

HEAD = """crumple: 1
materials: {steel: {grade: S355}}
sections:
  tube: {type: square_tube, side: 40 mm, thickness: 2 mm}
  hat: {type: closed_hat, width: 60 mm, depth: 50 mm, thickness: 1.5 mm, flange: 20 mm}
supports: {clamp: {node: n0, fix: all}}
analysis: {duration: 20 ms}
"""


def chain(number: int, member: str = "hinges: [{name: h%d, at: n%d, offset: 20 mm}]") -> str:
    """So many bars in a row, each with a hinge."""
    lines = ["nodes:", *(f"  n{i}: [{0.3 * i:.6g} m, 0 m, 0 m]" for i in range(number + 1)), "members:"]
    for i in range(number):
        own = member % (i, i) if "%" in member else member
        lines.append(f"  m{i}: {{nodes: [n{i}, n{i + 1}], section: tube, material: steel, {own}}}")
    return HEAD + f"masses: {{p: {{node: n{number}, mass: 10 kg}}}}\n" + "\n".join(lines)


def calls(text: str) -> int:
    """Number of functions called by reading and checking, refused or not."""
    number = 0

    def count(frame: object, event: str, of: object) -> None:
        nonlocal number
        number += event in {"call", "c_call"}

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        with suppress(InputError):
            loads(text)
    finally:
        sys.setprofile(before)
    return number


def refused(text: str) -> list[tuple[str, str]]:
    with pytest.raises(InputError) as refusal:
        loads(text)
    return [(problem.where, problem.what) for problem in refusal.value.problems]


MANY = "".join(f", s{i}: {{node: n{i}, fix: [y]}}" for i in range(1, 100))
UNKNOWN = (r"nodes: \[n(\d+), n(\d+)\]", r"nodes: [q\1, q\2]")


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text,
        lambda text: re.sub(*UNKNOWN, text),
        lambda text: text.replace("section: tube", "section: tubo"),
        lambda text: text.replace("section: tube", "sektion: tube"),
        lambda text: re.sub(r"hinges: \[[^\]]*\]", "hinges: auto", text),
        lambda text: text.replace("fix: all}}", f"fix: all}}{MANY}}}"),
    ],
    ids=["valid", "unknown nodes", "unknown sections", "unknown keys", "automatic", "supports"],
)  # fmt: skip
def test_the_work_of_a_check_is_linear_in_the_size(change) -> None:
    small, large = (chain(number) for number in (100, 500))
    calls(change(small))  # imports and what is remembered
    few, many = calls(change(small)), calls(change(large))
    # five times as much; a part that grows with the square, even one of a tenth, would make seven times
    assert many < 6 * few


def test_a_few_suggestions_are_made_and_the_rest_is_refused_without() -> None:
    problems = refused(re.sub(*UNKNOWN, chain(400)))
    assert problems[0] == ("members.m0.nodes[0]", "there is no node 'q0'")
    assert problems[-1] == ("", "and 1100 more problems")


@pytest.mark.parametrize("factor", [0.8, 1.0, 1.2])
@pytest.mark.parametrize(
    ("number", "keys", "where", "what"),
    [
        (1, "hinges: {{spacing: {0:g} m}}", "members.m0", "the member 'm0' has too many hinges"),
        (3, "hinges: {{spacing: {0:g} m}}", "members.m0", "the member 'm0' has too many hinges"),
    ],
)
def test_hinges_are_counted_before_they_are_placed(
    number: int, keys: str, where: str, what: str, factor: float
) -> None:
    assert (where, what) in refused(chain(number, keys.format(1e-12 * factor)))


@pytest.mark.parametrize("factor", [0.8, 1.0, 1.2])
def test_spots_are_counted_before_they_are_placed(factor: float) -> None:
    text = chain(1, "").replace("section: tube", "section: hat").replace(", }", "}")
    text += f"\nspot_welds: {{own: {{members: [m0], pitch: {1e-9 * factor:g} m}}}}"
    assert ("spot_welds.own.pitch", "the line has too many spot welds") in refused(text)


def test_groups_have_most_entries() -> None:
    planes = ", ".join(
        f"o{i}: {{type: plane, point: [0 m, 0 m, -{i + 1} m], normal: [0, 0, 1]}}" for i in range(101)
    )
    assert refused(f"{chain(1)}\nobstacles: {{{planes}}}") == [("obstacles", "there are too many obstacles")]
    fields = ", ".join("{translation: [1 m/s, 0 m/s, 0 m/s]}" for _ in range(101))
    assert refused(f"{chain(1)}\ninitial_velocity: [{fields}]") == [
        ("initial_velocity", "there are too many velocity fields")
    ]
    asked = ", ".join("n0" for _ in range(1001))
    assert refused(f"{chain(1)}\noutputs: {{nodes: [{asked}]}}") == [
        ("outputs.nodes", "there are too many outputs")
    ]


def test_histories_that_fill_the_memory_are_refused() -> None:
    text = chain(1, "bars: 1000") + "\noutputs: {every: 1 us}"
    [(where, what)] = refused(text)
    assert where == "outputs.every"
    assert "2e+04 samples of 999 hinges" in what


@pytest.mark.parametrize("name", ["²", "1²", "٣", "Ⅷ"])
def test_digits_that_are_not_plain_are_letters_of_a_name(name: str) -> None:
    text = chain(1).replace("masses: {p: {node: n1", f'masses: {{"{name}": {{node: q')
    [(where, what)] = refused(text)
    assert where == f"masses.{name}.node"
    assert what == "there is no node 'q'"


@pytest.mark.parametrize("thickness", [0.010, 0.015, 0.020])
def test_walls_too_thin_for_the_formula_are_refused_with_their_section(tmp_path, thickness: float) -> None:
    text = chain(1, "hinges: [{name: root, at: n0}]").replace("thickness: 2 mm", f"thickness: {thickness} mm")
    (tmp_path / "thin.yaml").write_text(text, encoding="utf-8")
    (problem,) = check(tmp_path / "thin.yaml")
    assert problem.where == "sections.tube.thickness"
    assert problem.what == "the walls are too thin: the moment of their folds falls too steeply"
    assert problem.came.startswith(f"{thickness:g} mm with a largest side of ")
    allowed = re.fullmatch(r"a 1000th of the side or more, here (.* mm)", problem.allowed)[1]
    (tmp_path / "thick.yaml").write_text(text.replace(f"{thickness} mm", allowed), encoding="utf-8")
    assert check(tmp_path / "thick.yaml") == []
    assert "thicker walls" in problem.todo


def test_walls_too_thin_are_refused_once_for_automatic_hinges_in_space(tmp_path) -> None:
    text = chain(2, "").replace(", }", "}").replace("thickness: 2 mm", "thickness: 0.02 mm")
    text = text.replace("n2: [0.6 m, 0 m, 0 m]", "n2: [0.6 m, 0.2 m, 0.3 m]") + "\nhinges: auto\n"
    (tmp_path / "thin.yaml").write_text(text, encoding="utf-8")
    (problem,) = check(tmp_path / "thin.yaml")
    assert problem.where == "sections.tube.thickness"
    assert problem.came == "0.02 mm with a largest side of 40 mm"
