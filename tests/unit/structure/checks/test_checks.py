"""Mistakes that no part shows alone: one clear message each, at the place that is to blame."""

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.structure import Outputs, Structure, output_problems, problems_in

RAMP = {"step": {"x0": 0, "h0": 0, "x1": 1, "h1": 1}}

# what is changed, the path in the message, its text
MISTAKES = {
    "missing node": ({"members.arm.nodes": ("root", "tipp")}, "members.arm.nodes[1]", "no node 'tipp'"),
    "missing section": ({"members.arm.section": "tubes"}, "members.arm.section", "no section 'tubes'"),
    "missing material": ({"members.arm.material": "steal"}, "members.arm.material", "no material 'steal'"),
    "missing law": (
        {"members.arm.hinges": [{"name": "a", "at": 0.5, "law": "kekman"}]},
        "members.arm.hinges[0].law",
        "no hinge law",
    ),
    "missing law of bars": (
        {"members.arm.bars": {"number": 2, "law": "x"}},
        "members.arm.bars.law",
        "no hinge law",
    ),
    "foreign node": (
        {"members.arm.hinges": [{"name": "a", "at": "top"}]},
        "members.arm.hinges[0].at",
        "not a node of this member",
    ),
    "no length": ({"nodes.tip": (0, 0, 0)}, "members.arm", "the member has no length"),
    "coincident nodes": (
        {
            "nodes.tip2": (1, 0, 1e-9),
            "members.b": {"nodes": ("root", "tip2"), "section": "tube", "material": "steel"},
        },
        "nodes.tip2",
        "coincide",
    ),
    "up along": ({"members.arm.up": (-3, 0, 0)}, "members.arm.up", "lies along"),
    "hinge outside": (
        {"members.arm.hinges": [{"name": "a", "at": 1.2}]},
        "members.arm.hinges[0].at",
        "outside",
    ),
    "hinge before": (
        {"members.arm.hinges": [{"name": "a", "at": 0.1, "offset": -0.2}]},
        "members.arm.hinges[0].offset",
        "outside",
    ),
    "hinge before a node": (
        {"members.arm.hinges": [{"name": "a", "at": "root", "offset": -0.04}]},
        "members.arm.hinges[0].offset",
        "outside",
    ),
    "hinge outside with an offset": (
        {"members.arm.hinges": [{"name": "a", "at": 1.2, "offset": 0.1}]},
        "members.arm.hinges[0].at",
        "outside",
    ),
    "hinge at a free end": (
        {"members.arm.hinges": [{"name": "a", "at": "tip"}]},
        "members.arm.hinges[0].at",
        "zero inertia",
    ),
    "hinge at a hinge": (
        {"members.arm.hinges": [{"name": "a", "at": 0.5}, {"name": "b", "at": 0.5}]},
        "members.arm.hinges[1]",
        "are at the same position",
    ),
    "hinge name twice": (
        {"members.arm.hinges": [{"name": "a", "at": 0.5}, {"name": "a", "at": 0.6}]},
        "members.arm.hinges[1].name",
        "2 hinges have the name 'a'",
    ),
    "law does not fit": (
        {"members.arm.section": "pipe", "members.arm.hinges": [{"name": "a", "at": 0.5, "law": "kecman"}]},
        "members.arm.hinges[0].law",
        "rectangular tubes",
    ),
    "mass in the air": (
        {"nodes.far": (5, 0, 0), "masses.m": {"node": "far", "mass": 1}},
        "masses.m.node",
        "not connected",
    ),
    "support in the air": (
        {"nodes.far": (5, 0, 0), "supports.s": {"node": "far", "fix": "all"}},
        "supports.s.node",
        "not connected",
    ),
    "load in the air": (
        {"nodes.far": (5, 0, 0), "loads": [{"node": "far"}]},
        "loads[0].node",
        "not connected",
    ),
    "impulse in the air": (
        {"nodes.far": (5, 0, 0), "impulses": [{"node": "far"}]},
        "impulses[0].node",
        "not connected",
    ),
    "loose node": ({"nodes.far": (5, 0, 0)}, "nodes.far", "no member ends"),
    "support of no node": ({"supports.s": {"node": "rot", "fix": "all"}}, "supports.s.node", "no node 'rot'"),
    "velocity of no node": (
        {"initial_velocity": [{"nodes": ["x"]}]},
        "initial_velocity[0].nodes[0]",
        "no node",
    ),
    "velocity of no member": (
        {"initial_velocity": [{"members": ["x"]}]},
        "initial_velocity[0].members[0]",
        "no member",
    ),
    "held twice": ({"supports.s": {"node": "root", "fix": "x"}}, "supports.s", "both hold x of node 'root'"),
    "jump": (
        {"supports.s": {"node": "tip", "motion": {"x": 0.1}}},
        "supports.s.motion.x",
        "starts with a jump",
    ),
    "no members": ({"members": {}}, "members", "no members"),
    "zero mass": ({"masses.m": {"node": "tip", "mass": 0}}, "masses.m.mass", "no inertia"),
    "impossible inertia": (
        {"masses.m": {"node": "tip", "mass": 1, "rotary_inertia": (1, 1, 3)}},
        "masses.m.rotary_inertia",
        "these moments of inertia are impossible",
    ),
    "thick wall": (
        {"sections.tube.thickness": "12.5 mm"},
        "sections.tube.thickness",
        "half the smaller side",
    ),
    "yield above E": (
        {"materials.steel.yield_stress": "300 GPa"},
        "materials.steel.yield_stress",
        "below Young's modulus",
    ),
    "rotation without axis": (
        {"initial_velocity": [{"rotation": 1}]},
        "initial_velocity[0].rotation",
        "needs an axis",
    ),
    "axis zero": (
        {"initial_velocity": [{"rotation": 1, "axis": (0, 0, 0)}]},
        "initial_velocity[0].axis",
        "axis is zero",
    ),
}


def changed(keys, changes):
    for path, value in changes.items():
        *groups, last = path.split(".")
        part = keys
        for group in groups:
            part = part.setdefault(group, {})
        part[last] = value
    return keys


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_named_where_it_is(keys, mistake):
    changes, where, what = MISTAKES[mistake]
    with pytest.raises(InputError) as refusal:
        Structure(**changed(keys, changes))
    assert (where, True) in [(problem.where, what in problem.what) for problem in refusal.value.problems]
    assert all(problem.todo or problem.allowed for problem in refusal.value.problems)


@pytest.mark.parametrize("mistake", [name for name in MISTAKES if name not in {"no length", "no members"}])
def test_one_mistake_gives_one_message(keys, mistake):
    with pytest.raises(InputError) as refusal:
        Structure(**changed(keys, MISTAKES[mistake][0]))
    assert len(refusal.value.problems) == 1, str(refusal.value)


def test_a_sound_structure_has_no_problems(keys):
    changed(
        keys,
        {
            "masses.m": {"node": "tip", "mass": 1, "rotary_inertia": (1, 1, 2)},
            "loads": [{"node": "tip", "force": {"z": RAMP}}],
        },
    )
    assert problems_in(Structure(**keys)) == []


def test_names_of_refused_parts_are_not_missing(keys):
    structure = Structure(**keys)
    fields = {name: getattr(structure, name) for name in Structure.model_fields}
    part = Structure.model_construct(**{**fields, "sections": {}, "nodes": {}})
    missing = problems_in(part, {"sections": ["tube"], "nodes": ["root", "tip"]})
    assert missing == []
    assert problems_in(part)


def test_a_distance_has_two_nodes(keys):
    structure = Structure(**keys)
    (problem,) = output_problems(Outputs(distances={"d": {"from": "tip", "to": "tip"}}), structure)
    assert (problem.where, problem.came) == ("outputs.distances.d.to", "tip twice")
    assert not output_problems(Outputs(distances={"d": {"from": "root", "to": "tip"}}), structure)


def test_outputs_name_nodes_and_places_that_exist(keys):
    structure = Structure(**keys)
    outputs = Outputs(
        nodes=["tip", "top"],
        section_rotations={"a": {"member": "arm", "to": 1.5}, "b": {"member": "leg", "to": 1}},
    )
    where = [problem.where for problem in output_problems(outputs, structure)]
    assert where == [
        "outputs.nodes[1]",
        "outputs.section_rotations.a.to",
        "outputs.section_rotations.b.member",
    ]


def test_a_mass_with_an_offset_may_sit_beyond_a_hinge(keys):
    changed(
        keys,
        {
            "members.arm.hinges": [{"name": "a", "at": "tip"}],
            "masses.m": {"node": "tip", "mass": 1, "offset": (0.1, 0, 0)},
        },
    )
    assert Structure(**keys)


def test_coincident_nodes_are_found_among_many(keys):
    """A net in an inclined plane: every third node has a twin within the tolerance, in a random direction."""
    random = np.random.default_rng(1)
    across = np.array([[0.6, 0.0, 0.8], [0.48, 0.8, -0.36]])
    net = np.array([(i, j) for i in range(20) for j in range(20)]) @ across
    shift = random.normal(size=net.shape)
    twins = net + 0.9e-6 * shift / np.linalg.norm(shift, axis=1, keepdims=True)
    keys["nodes"] |= {f"p{i}": tuple(place) for i, place in enumerate(10.0 + net)}
    keys["nodes"] |= {f"q{i}": tuple(place) for i, place in enumerate(10.0 + twins[::3])}
    keys["nodes"] |= {f"r{i}": tuple(place) for i, place in enumerate(10.0 + 3.0 * (twins - net) + net)}
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    found = {problem.what for problem in refusal.value.problems if "coincide" in problem.what}
    assert found == {f"the nodes 'p{3 * i}' and 'q{i}' coincide" for i in range(len(twins[::3]))}
