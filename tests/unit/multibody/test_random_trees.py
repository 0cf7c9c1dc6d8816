"""Random planar trees: whatever the shape, law and start, a run ends with finite numbers and a status."""

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.support.multibody.frames import structure

from crumple.multibody import Run, lower, solve_multibody
from crumple.structure import MultibodySettings

FORMS = ("set-valued", "elastic-plastic", "regularised")
SOFTENING = ("peak", "rotation", "accumulated")
BOUND = 1e-3


@st.composite
def trees(draw):
    """Members hung on each other in the x-z plane, with hinges anywhere, clamped, pinned or floating."""
    number = draw(st.integers(1, 6))
    nodes, members = {"a": (0.0, 0.0, 0.0)}, {}
    names = ["a"]
    for i in range(number):
        parent = draw(st.sampled_from(names))
        angle = 2 * np.pi * draw(st.integers(0, 23)) / 24 + 0.01 * i
        length = draw(st.floats(0.1, 1.5))
        x, _, z = nodes[parent]
        name = f"n{i}"
        nodes[name] = (x + length * np.cos(angle), 0.0, z + length * np.sin(angle))
        names.append(name)
        members[f"m{i}"] = draw(hinged(f"m{i}", parent, name, length))
    held = draw(st.sampled_from(({}, {"s": {"node": "a", "fix": "all"}}, {"s": {"node": "a", "fix": "pin"}})))
    masses = {
        f"mass-{name}": {"node": name, "mass": draw(st.floats(0.01, 20.0))}
        for name in draw(st.lists(st.sampled_from(names[1:]), unique=True))
    }
    return {
        "nodes": nodes,
        "members": members,
        "supports": held,
        "masses": masses,
        "initial_velocity": [
            {
                "rotation": draw(st.integers(-30, 30)),
                "axis": (0.0, 1.0, 0.0),
                "about": (draw(st.integers(-10, 10)) / 10, 0.0, 0.0),
                "translation": (draw(st.integers(-20, 20)), 0.0, draw(st.integers(-20, 20))),
                "members": tuple(draw(st.lists(st.sampled_from(sorted(members)), unique=True, min_size=1))),
            }
        ],
        "gravity": (0.0, 0.0, draw(st.sampled_from((0.0, -9.81)))),
    }


@st.composite
def hinged(draw, name, first, second, length):
    """Member with hinges that leave bars of at least a tenth of its length."""
    shares = draw(st.lists(st.integers(1, 9), unique=True, max_size=3))
    hinges = [
        {"name": f"{name}-{share}", "at": share / 10 * length, "axis": "y", "law": draw(laws())}
        for share in shares
    ]
    across = {"up": (0.0, 1.0, 0.0), "roll": np.pi / 2}
    return {"nodes": (first, second), "section": "tube", "material": "steel", "hinges": hinges} | across


@st.composite
def laws(draw):
    stops = {"rotation": draw(st.floats(0.05, 1.0)), "stiffness": draw(st.floats(1e3, 1e6))}
    kind = draw(
        st.sampled_from(
            (
                {"type": "kecman"},
                {"type": "constant", "moment": draw(st.floats(1.0, 5000.0))},
                {"type": "table", "rotation": (0.0, 0.1, 0.5), "moment": (900.0, 400.0, 1200.0)},
            )
        )
    )
    return kind | {
        "form": draw(st.sampled_from(FORMS)),
        "softening": draw(st.sampled_from(SOFTENING)),
        "viscous_damping": draw(st.sampled_from((0.0, 2.0))),
        "stops": draw(st.sampled_from(("law", stops))),
    }


@settings(max_examples=60)
@given(trees())
def test_runs_end_finite_and_balanced(parts):
    whole = structure(**parts)
    assume(lower(whole).bodies)
    result = solve_multibody(whole, Run(0.02, 0.005, MultibodySettings(energy_residual_bound=BOUND)))
    for channel in result.channels.values():
        assert np.isfinite(channel.values).all(), channel.name
    if result.status.ok:
        assert result.energy_residual < BOUND
        assert result.time[-1] == 0.02
    else:
        assert result.reason
    dissipated = result["energy.dissipated"]
    assert np.diff(dissipated).min() > -1e-6 * (result["energy.kinetic"][0] + 1.0)
