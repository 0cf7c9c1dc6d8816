"""The hinge at a T-joint is measured between branch and chord in shapes of either result."""

import numpy as np
import pytest
from tests.unit.structure.hinges.test_t_joints import frame, stored

from crumple.analysis import Analysis, solve
from crumple.comparison.measure.motion import measured
from crumple.comparison.measure.t_joint_motion import with_t_joints
from crumple.structure import placed_hinges


@pytest.mark.parametrize(("across", "planes"), [(False, ("in",)), (True, ("in", "across"))])
def test_shapes_of_a_multibody_result_show_the_rotation_of_its_hinge(across, planes, tmp_path):
    structure = frame(across=across, laws=stored(tmp_path, *planes))
    every = 0.001
    analysis = Analysis(
        title="T",
        structure=structure,
        duration=0.03,
        outputs={"every": every, "pictures": [0.01, 0.02, 0.03]},
    )
    result = solve(analysis, "multibody")
    hinges = placed_hinges(structure)
    seen = with_t_joints(measured(result, structure, hinges), result, structure, hinges)
    (motion,) = (one for one in seen.hinges if one.name == "t-joint-m")
    names = ("rotation.y", "rotation.z") if across else ("rotation",)
    own = np.linalg.norm([result[f"hinge.t-joint-m.{name}"] for name in names], axis=0)
    shown = np.interp(motion.time, result.time, own)
    assert np.abs(motion.rotation).max() > 0.1
    np.testing.assert_allclose(np.abs(motion.rotation), shown, atol=0.02 * shown.max())
    assert not [fold for fold in seen.extra if fold.member == "stem"]
