"""A bound of a law without a band is refused at its key, with the hinge, its member, and the law."""

import pytest

from crumple.analysis import loads
from crumple.errors import InputError

TEXT = """crumple: 1
materials: {steel: {grade: S355}}
sections: {post: {type: rectangular_tube, width: 60 mm, depth: 40 mm, thickness: 2 mm}}
nodes: {f: [0 m, 0 m, 0 m], t: [0.6 m, 0 m, 0 m]}
hinge_laws:
  most:
    type: kecman
    bound: upper
members:
  p: {nodes: [f, t], section: post, material: steel}
hinges:
  axes: [y, z]
  LAW
supports: {s1: {node: f, fix: all}, s2: {node: t, fix: all}}
analysis: {duration: 14 ms}
outputs: {every: 0.5 ms}
"""


def refusals(law):
    with pytest.raises(InputError) as caught:
        loads(TEXT.replace("LAW", law))
    return caught.value.problems


@pytest.mark.parametrize(
    ("law", "where", "line"),
    [
        ("law: {type: auto, bound: lower}", "hinges.law.bound", 13),
        ("law: {type: kecman, bound: upper}", "hinges.law.bound", 13),
        ("law: most", "hinge_laws.most.bound", 8),
    ],
)
def test_a_bound_without_a_band_is_refused_once_where_it_is_written(law, where, line):
    (problem,) = refusals(law)
    assert (problem.where, problem.line) == (where, line)
    side = "lower" if "lower" in law else "upper"
    assert problem.what.startswith("hinge 'p-")
    assert problem.what.endswith(f"of member 'p': the law about z has no band, so it has no {side} bound")
    assert problem.came.startswith("Kecman-type mechanism, flange 40 mm, depth 60 mm")
    assert "'laws'" in problem.todo


def test_the_bound_can_be_given_to_the_axis_whose_law_has_a_band():
    keys = "laws: {y: {type: auto, bound: upper}}"
    assert loads(TEXT.replace("LAW", keys)).structure.hinges is not None
