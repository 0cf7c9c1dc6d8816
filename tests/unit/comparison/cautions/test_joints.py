"""A comparison says when its shells have rigid T-joints and its hinges welded ones, and the other way."""

from dataclasses import replace

import pytest
from tests.unit.structure.hinges.test_t_joints import frame, stored

from crumple.analysis import Analysis, loads, solve
from crumple.comparison import compare, with_frames
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.mesh import mesh_of
from crumple.structure import ShellSettings


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


CORNER = """crumple: 1
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], k: [0 m, 0 m, LENGTH mm], b: [0.6 m, 0 m, LENGTH mm]}
members:
  post: {nodes: [a, k], section: tube, material: steel}
  beam: {nodes: [k, b], section: tube, material: steel}
hinges: auto
supports: {a: {node: a, fix: all}}
masses: {m: {node: b, mass: 5 kg}}
initial_velocity: [{translation: [0 m/s, 0 m/s, -1 m/s], nodes: [b]}]
analysis: {duration: 2 ms}
outputs: {every: 1 ms}
"""


@pytest.mark.parametrize(("length", "said"), [(150, True), (160, True), (180, False)])
def test_corners_that_shells_join_rigidly_are_named(length, said):
    """A mitre of 90 degrees needs 2.5 x 24 mm/0.35 = 171 mm of each member."""
    analysis = loads(CORNER.replace("LENGTH", str(length)))
    result = solve(with_frames(analysis), "multibody", checks=False)
    found = compare(result, replace(result, fidelity="shell"), analysis.structure).trust.cautions
    corners = [text for text in found if "too short for its mitre" in text]
    assert len(corners) == said
    assert all("at the corner k has the law" in text for text in corners)
    joints = mesh_of(analysis.structure, ShellSettings(element_size=10e-3)).joints
    assert (joints["k"].kind is Kind.RIGID) == said
