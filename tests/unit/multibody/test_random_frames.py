"""Random frames in space: whatever the loops and supports, a run ends with finite numbers and a status."""

import numpy as np
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st
from tests.support.multibody.frames import structure
from tests.unit.multibody.test_random_trees import laws

from crumple.errors import InputError
from crumple.multibody import Run, link, solve_multibody
from crumple.structure import MultibodySettings

RESIDUAL = 5e-3
AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
JOINTS = (
    {"type": "spherical"},
    *(
        {"type": kind, "axis": axis}
        for kind in ("revolute", "prismatic", "cylindrical", "planar")
        for axis in AXES
    ),
    {"type": "universal", "axis": AXES[0], "second": AXES[1]},
)
FIXES = ("all", "pin", ("x", "y", "z", "rx"), ("y", "z"), ("x", "rz"))


@st.composite
def frames(draw):
    """Members along random ways in space, some closing loops, held or not, with hinges, joints and masses."""
    number = draw(st.integers(2, 6))
    cell = st.tuples(st.integers(0, 3), st.integers(0, 3), st.integers(0, 3))
    cells = draw(st.lists(cell, min_size=number, max_size=number, unique=True))
    # off the lattice, so that loops are not all of one kind
    nodes = {f"n{i}": tuple(0.3 * v + 0.02 * (i + j) for j, v in enumerate(at)) for i, at in enumerate(cells)}
    names = sorted(nodes)
    pairs = [(names[draw(st.integers(0, i - 1))], names[i]) for i in range(1, number)]
    further = [(a, b) for a in names for b in names if a < b and (a, b) not in pairs]
    if further:
        pairs += draw(st.lists(st.sampled_from(further), unique=True, max_size=2))
    members = {f"m{i}": draw(hinged(f"m{i}", pair, nodes)) for i, pair in enumerate(pairs)}
    jointed = draw(st.lists(st.sampled_from(sorted(members)), unique=True, max_size=2))
    joints = {
        f"j-{name}": {"member": name, "node": members[name]["nodes"][1], **draw(st.sampled_from(JOINTS))}
        for name in jointed
    }
    held = draw(st.lists(st.sampled_from(names), unique=True, max_size=2))
    masses = {
        f"mass-{name}": {
            "node": name,
            "mass": draw(st.floats(0.1, 20.0)),
            "rotary_inertia": (0.01, 0.01, 0.01),
        }
        for name in draw(st.lists(st.sampled_from(names), unique=True, max_size=2))
    }
    speed = st.integers(-15, 15)
    return {
        "nodes": nodes,
        "members": members,
        "joints": joints,
        "supports": {f"s-{name}": {"node": name, "fix": draw(st.sampled_from(FIXES))} for name in held},
        "masses": masses,
        "initial_velocity": [
            {
                "translation": (draw(speed), draw(speed), draw(speed)),
                "rotation": draw(speed),
                "axis": draw(st.sampled_from(AXES)),
                "members": tuple(draw(st.lists(st.sampled_from(sorted(members)), unique=True, min_size=1))),
            }
        ],
        "gravity": (0.0, 0.0, draw(st.sampled_from((0.0, -9.81)))),
        "obstacles": draw(obstacles()),
        "member_contact": draw(st.sampled_from((None, {"friction": 0.2}))),
    }


@st.composite
def obstacles(draw):
    """Nothing, ground below, and a ball that flies at the frame."""
    touch = {"friction": draw(st.sampled_from((0.0, 0.3))), "restitution": draw(st.sampled_from((0.0, 0.5)))}
    ground = {"type": "plane", "point": (0.0, 0.0, -0.06), "normal": (0.0, 0.0, 1.0), **touch}
    speed = float(draw(st.integers(1, 20)))
    ball = {
        "type": "sphere",
        "point": (-0.3, 0.5, 0.5),
        "radius": 0.2,
        "mass": 5.0,
        "velocity": (speed, 0.0, 0.0),
    }
    return {name: part for name, part in (("ground", ground), ("ball", ball)) if draw(st.booleans())}


@st.composite
def hinged(draw, name, pair, nodes):
    """Member with up to two hinges that leave bars of at least a fifth of its length."""
    length = float(np.linalg.norm(np.subtract(nodes[pair[1]], nodes[pair[0]])))
    shares = draw(st.lists(st.integers(1, 4), unique=True, max_size=2))
    hinges = [
        {
            "name": f"{name}-{share}",
            "at": share / 5 * length,
            "axis": draw(st.sampled_from("yz")),
            "law": draw(laws()),
        }
        for share in shares
    ]
    return {"nodes": pair, "section": "tube", "material": "steel", "hinges": hinges}


def solved(parts):
    """Result of a frame, None if it is refused with a reason."""
    try:
        whole = structure(**parts)
        if not link(whole).bodies:
            return None
        settings_ = MultibodySettings(energy_residual_bound=RESIDUAL)
        return solve_multibody(whole, Run(0.02, 0.005, settings_))
    except InputError:
        return None


@settings(max_examples=60)
@given(frames())
def test_runs_end_finite_and_balanced(parts):
    result = solved(parts)
    event("refused" if result is None else str(result.status))
    assume(result is not None)
    for channel in result.channels.values():
        assert np.isfinite(channel.values).all(), channel.name
    if result.status.ok:
        assert result.energy_residual < RESIDUAL
        assert result.time[-1] == 0.02
        dissipated = result["energy.dissipated"]
        assert np.diff(dissipated).min() > -1e-6 * (result["energy.kinetic"][0] + 1.0)
    else:
        assert result.reason
