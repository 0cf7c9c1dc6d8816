"""What a run says of hinges that shorten or lengthen along their members."""

import pytest
from tests.support.structures import STEEL

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Structure


def column(tube, axial, speed, **parts):
    """A tube of 0.4 m on its clamp, whose end has 50 kg and moves along it."""
    law = {"type": "constant", "moment": 5000.0, "rate": "off"}
    hinge = {"name": "foot", "at": 0.05, "law": law, "axes": ("y", "z"), "axial": axial}
    member = {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": (hinge,)}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", **tube}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.4)},
        members={"ab": member},
        supports={
            "clamp": {"node": "a", "fix": "all"},
            "guide": {"node": "b", "fix": ("x", "y", "rx", "ry")},
        },
        masses={"m": {"node": "b", "mass": 50.0}},
        initial_velocity=[{"nodes": ("b",), "translation": (0.0, 0.0, speed)}],
        **parts,
    )


def run(structure, duration=0.02):
    return solve_multibody(structure, Run(duration, 1e-3, MultibodySettings()))


THIN = {"side": 0.05, "thickness": 0.0015}
THICK = {"side": 0.05, "thickness": 0.008}


@pytest.mark.parametrize(
    ("tube", "law", "said"),
    [
        (THIN | {"corner_radius": 0.003}, {"law": "superfolding"}, "rounded corners are treated as sharp"),
        (THICK, {"law": "square"}, "is above its peak"),
        (THIN, {"law": "square"}, ""),
        (THIN, True, ""),
    ],
)
def test_what_a_law_of_crushing_says_of_its_section_is_a_warning_as_that_of_bending(tube, law, said):
    texts = [text for text in run(column(tube, law, -8.0)).warnings if "crushing along the member" in text]
    assert bool(texts) == bool(said)
    assert not said or any(text.startswith("Hinge foot: ") and said in text for text in texts)
