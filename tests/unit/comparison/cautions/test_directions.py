"""A comparison says when nodes move equally far in different directions."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.unit.structure.hinges.test_t_joints import frame

from crumple.analysis import Analysis, solve
from crumple.comparison import compare, with_frames
from crumple.comparison.cautions.directions import direction_sentences
from crumple.result import Channel

TIME = np.linspace(0.0, 0.1, 11)


def run(name, **nodes):
    """A result whose nodes go to the given places in straight lines [m]."""
    channels = {
        f"node.{node}.displacement.{axis}": Channel(
            f"node.{node}.displacement.{axis}", "m", TIME / 0.1 * part
        )
        for node, place in nodes.items()
        for axis, part in zip("xyz", place, strict=True)
    }
    return SimpleNamespace(name=name, result=SimpleNamespace(time=TIME, channels=channels))


def said(ours, theirs, until=0.1):
    comparison = SimpleNamespace(candidate=ours, reference=theirs, until=until)
    return list(direction_sentences(comparison))


def turned(degrees, length=0.08):
    return (0.0, length * math.sin(math.radians(degrees)), -length * math.cos(math.radians(degrees)))


@pytest.mark.parametrize(("degrees", "caution"), [(0.0, False), (19.0, False), (21.0, True), (180.0, True)])
def test_directions_more_than_20_degrees_apart_are_a_caution(degrees, caution):
    found = said(run("multibody", tip=turned(0.0)), run("shell", tip=turned(degrees, 0.086)))
    assert len(found) == caution
    for text, serious in found:
        assert serious
        assert f"Node tip (80 mm in the multibody, 86 mm in the shell result, {degrees:.1f}° apart)" in text


def test_lengths_that_differ_and_small_motions_are_left_out():
    assert not said(run("multibody", tip=turned(0.0)), run("shell", tip=turned(90.0, 0.2)))
    far = {"far": (0.5, 0.0, 0.0)}
    assert not said(
        run("multibody", tip=turned(0.0, 0.01), **far), run("shell", tip=turned(90.0, 0.01), **far)
    )
    # a node that only one of them has, and results of different length
    assert not said(run("multibody", tip=turned(0.0)), run("shell", other=turned(90.0)))
    assert said(run("multibody", tip=turned(0.0)), run("shell", tip=turned(90.0)), until=0.05)


def test_the_statement_of_a_comparison_contains_it():
    outputs = {"every": 0.001, "pictures": [0.01, 0.02], "nodes": ["m"]}
    structure = frame(across=False)
    analysis = Analysis(title="T", structure=structure, duration=0.02, outputs=outputs)
    result = solve(with_frames(analysis), "multibody", checks=False)
    assert not [text for text in compare(result, result, structure).trust.cautions if "equally far" in text]
    # the same motion the other way
    back = {
        name: replace(c, values=-c.values) for name, c in result.channels.items() if ".displacement." in name
    }
    reference = replace(result, channels={**result.channels, **back})
    (text,) = [t for t in compare(result, reference, structure).trust.cautions if "equally far" in t]
    assert "180.0° apart" in text
