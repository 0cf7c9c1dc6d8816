"""Bending between hinges: what of it the model contains."""

from types import SimpleNamespace

import numpy as np
import pytest

from crumple.comparison.cautions.trust import bending_sentences

TIMES = np.linspace(0.0, 1.0, 11)


@pytest.mark.parametrize(("elastic", "said"), [(None, "rigid bars of the multibody"), (6, "joints between")])
def test_bending_between_hinges_is_missing_in_rigid_members_alone(elastic, said):
    motion = SimpleNamespace(
        name="root", member="tube", fold=True, sense=1.0, time=TIMES, rotation=0.2 * TIMES, far=0.5 * TIMES
    )
    motion.rotation_max = float(motion.rotation.max())
    comparison = SimpleNamespace(
        candidate=SimpleNamespace(name="multibody"), reference=SimpleNamespace(hinges=(motion,))
    )
    structure = SimpleNamespace(members={"tube": SimpleNamespace(elastic=elastic)})
    ((message, _),) = bending_sentences(comparison, structure)
    assert message.startswith("Member tube bends between the fold of hinge root and its far end")
    assert said in message
