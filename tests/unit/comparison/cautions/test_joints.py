"""A comparison says when its shells have rigid T-joints and its hinges welded ones, and the other way."""

from dataclasses import replace

import pytest
from tests.unit.structure.hinges.test_t_joints import frame, stored

from crumple.analysis import Analysis, solve
from crumple.comparison import compare, with_frames


def cautions(structure, fidelity, t_joints):
    outputs = {"every": 0.001, "pictures": [0.01, 0.02]}
    analysis = Analysis(title="T", structure=structure, duration=0.02, outputs=outputs)
    result = solve(with_frames(analysis), "multibody", checks=False)
    settings = {**result.provenance.settings, **({} if t_joints is None else {"t_joints": t_joints})}
    reference = replace(result, fidelity=fidelity, provenance=replace(result.provenance, settings=settings))
    said = compare(result, reference, structure).trust.cautions
    return [text for text in said if "T-joints m " in text]


@pytest.mark.parametrize(
    ("laws", "t_joints", "text"),
    [
        (True, None, "rigid bodies"),
        (True, "welded", ""),
        (False, None, ""),
        (False, "welded", "crumple characterise FILE"),
    ],
)
def test_different_joints_are_named(laws, t_joints, text, tmp_path):
    structure = frame(across=False, laws=stored(tmp_path, "in") if laws else None)
    found = cautions(structure, "shell", t_joints)
    assert len(found) == bool(text)
    assert all(text in one for one in found)
    assert not cautions(structure, "multibody", t_joints)
