"""T-frame whose joint folds: hinges with the laws of its sub-models against the frame in welded shells.

A stem of 36x36x3 mm on a chord of 60x60x2 mm is thrown in the plane of the frame, across it, and obliquely:
the last is a combined load of which neither law knows. Both have coarse meshes of about the same size.

Kind: independent calculation.  Source: derived here.
"""

import math

import numpy as np
import pytest

from crumple.analysis import Analysis, solve
from crumple.characterisation import LawStore, TJoint, characterise
from crumple.characterisation.resolution import Resolution
from crumple.comparison.measure.motion import measured
from crumple.comparison.measure.t_joint_motion import with_t_joints
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.structure import Structure, placed_hinges

pytestmark = pytest.mark.slow

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
CHORD, STEM = RectangularTube(0.060, 0.060, 0.002), RectangularTube(0.036, 0.036, 0.003)
COARSE = {"largest": math.radians(25.0), "resolution": Resolution(3.0, 7.0)}
THROWN = {"in the plane": (3.0, 0.0, 0.0), "across": (0.0, 3.0, 0.0), "obliquely": (2.5, 2.0, 0.0)}
TOLERANCE = {"in the plane": 0.05, "across": 0.12, "obliquely": 0.12}


@pytest.fixture(scope="module")
def laws(tmp_path_factory):
    store = LawStore(tmp_path_factory.mktemp("laws"))
    for plane in ("in", "across"):
        model = TJoint(STEM, CHORD, STEEL, plane, **COARSE)
        store.keep(model, characterise(model).law)
    return str(store.folder)


@pytest.mark.parametrize("how", THROWN)
def test_hinge_of_the_joint_turns_as_the_shells(how, laws, record_figure):
    chord = {"section": "chord", "material": "steel", "up": (0.0, 0.0, 1.0)}
    stem = {"section": "stem", "material": "steel", "up": (0.0, 1.0, 0.0)}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"chord": CHORD, "stem": STEM},
        nodes={"l": (-0.3, 0.0, 0.0), "m": (0.0, 0.0, 0.0), "r": (0.3, 0.0, 0.0), "t": (0.0, 0.0, 0.4)},
        members={
            "left": {"nodes": ("l", "m"), **chord},
            "right": {"nodes": ("m", "r"), **chord},
            "stem": {"nodes": ("m", "t"), **stem},
        },
        supports={"l": {"node": "l", "fix": "all"}, "r": {"node": "r", "fix": "all"}},
        hinges="auto",
        laws=laws,
        initial_velocity=[{"nodes": ["t"], "translation": THROWN[how]}],
        masses={"tip": {"node": "t", "mass": 20.0}},
    )
    analysis = Analysis(
        title="T-frame",
        structure=structure,
        duration=0.06,
        shell={"element_size": 0.007, "t_joints": "welded"},
        outputs={"every": 2.5e-4, "nodes": ["t"], "pictures": np.linspace(0.0, 0.06, 13).tolist()},
    )
    hinges, turned, moved = placed_hinges(structure), {}, {}
    for fidelity in ("multibody", "shell"):
        result = solve(analysis, fidelity)
        seen = with_t_joints(measured(result, structure, hinges), result, structure, hinges)
        motion = next(one for one in seen.hinges if one.name == "t-joint-m")
        turned[fidelity] = math.degrees(np.abs(motion.rotation).max())
        path = [result[f"node.t.displacement.{axis}"] for axis in "xyz"]
        moved[fidelity] = 1e3 * float(np.linalg.norm(path, axis=0).max())
    allowed = TOLERANCE[how]
    record_figure(
        "rotation of the joint", turned["multibody"], turned["shell"], allowed, "deg", relative=True
    )
    record_figure("displacement of the tip", moved["multibody"], moved["shell"], allowed, "mm", relative=True)
