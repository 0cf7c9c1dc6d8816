"""Frames with one more part: hinge axes, joints, stages, obstacles, spot welds, walls, laws of files.

Each part is a table: the keys that it can have and the values that they may take there, most of them good
ones.  A case draws some of the keys and one value for each, so that combinations that exclude each other,
keys that are missing and values that do not fit a neighbour come up as often as sound parts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hypothesis import strategies as st
from tests.fuzz.mutation import listed

Table = Mapping[str, Sequence[Any]]
"""Values of every key; a key whose name ends with "!" is always there, one with "?" rarely."""

DIRECTIONS = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, -1], [1, 1, 0], [0, 0, 0]]
POINTS = [["0 m", "0 m", f"{z} m"] for z in (-0.9, -0.2, 0.03, 0.5)] + [["1.3 m", "0 m", "0 m"]]
SPEEDS = [["0 m/s", "0 m/s", "-4 m/s"], ["3 m/s", "0 m/s", "0 m/s"], ["0 m/s", "0 m/s", "0 m/s"]]
STEP = {"step": {"x0": "0 ms", "h0": "0 mm", "x1": "4 ms", "h1": "20 mm"}}
PARTIAL = {"table": {"time": ["0 s", "9 s"], "value": ["0 mm", "45 mm"]}}
ANGLE = {"table": {"time": ["0 s", "9 s"], "value": ["0 deg", "45 deg"]}}
IMPACT = {"impact": {"x": STEP, "x1": "0 mm", "k": 1000, "e": 1.2, "cmax": "10 N*s/m", "d": "1 mm"}}
LAWS: list[Any] = ["constant", "auto", "kecman", "kecman", "wierzbicki", "oblique", "circular"]
LAWS += ["folded_profile", "own", "none", {"type": "constant", "moment": "900 N*m"}]
LAWS += [{"type": "constant", "form": form} for form in ("regularised", "elastic-plastic", "rigid-plastic")]
LAWS += [{"type": "kecman", "start": start} for start in ("cap", "parabola", "linear")]
LAWS += [{"type": "constant", "regularisation": {"rate": "0.1 rad/s"}}, {"type": "table"}]
LAWS += [{"type": "constant", "stops": {"rotation": "20 deg", "stiffness": "50 kN*m/rad"}}]
CURVE = {"rotation": ["0 deg", "20 deg"], "moment": ["1 kN*m", "0.5 kN*m"]}
LAWS += [
    {"type": "table", **CURVE, **more}
    for more in (
        {},
        {"negative_rotation": ["0 deg", "9 deg"], "negative_moment": ["1 kN*m", "0 kN*m"]},
        {"file": "curve.csv"},
        {"negative_moment": ["1 kN*m"]},
        {"units": {"rotation": "deg"}},
        {"moment": ["1 kN*m"]},
        {"rotation": ["5 deg", "2 deg"]},
    )
]
LAWS += [
    {"type": "table", "file": "curve.csv", **more}
    for more in ({}, {"units": {"rotation": "deg", "moment": "N*m"}}, {"units": {"angle": "deg"}})
]
LAWS += [
    {"type": "measured", **more}
    for more in (
        {"file": "curve.csv"},
        {"files": ["curve.csv", "curve.csv"]},
        {"files": []},
        {"files": "curve.csv"},
        {"file": "curve.csv", "files": ["curve.csv"]},
        {"file": "curve.csv", "rotations": [[0, 1]]},
        {"rotations": [["0 deg", "9 deg"]], "moments": [["0 N*m"]]},
        {"rotations": [["0 deg", "9 deg", "30 deg"]], "moments": [["0 N*m", "1 kN*m", "0.5 kN*m"]]},
        {"rotations": [["0 deg", "9 deg"]]},
        {},
    )
]
LAWS += [{"type": "file", "file": name} for name in ("law.yaml", "no.yaml", "../law.yaml", ".", "")]
LAWS += [{"type": "file", "text": text} for text in ("", "crumple_law: 1", "a: &b 1")]
LAWS += [{"type": "file"}, {"type": "file", "file": "law.yaml", "text": "x"}]

AXES: Table = {
    "axis?": ["y", "z"],
    "axes": [["y", "z"], ["x", "y", "z"], ["y"], ["x"], ["x", "z"], ["y", "y"]],
    "law": LAWS,
    "laws?": [{"y": "constant"}, {"z": "constant"}, {"y": "constant", "z": "kecman"}, {}],
    "twist?": [{}, {"law": "plastic", "torque": "1 kN*m"}, {"law": "square_tube"}, {"law": "no"}],
    "axial?": [
        True,
        False,
        {"law": "square"},
        {"law": "superfolding"},
        {"law": "circular"},
        {"law": "top_hat"},
        {"peak": "90 kN", "mean": "40 kN", "stroke": "30 mm"},
        {"peak": "90 kN"},
        {"law": "square", "mean": "40 kN"},
        {"peak": "30 kN", "mean": "40 kN", "stroke": "30 mm", "tension": "1 N"},
    ],
    "coupling": ["section", "ellipsoid", "none", "ball", "tension-flange"],
    "fracture?": ["40 deg", "500 deg"],
}
HINGE: Table = {
    "name!": ["h", "h", "other"],
    "at!": ["n0", "n1", "n2", "120 mm", "9 m", "0 mm", "no"],
    "offset?": ["20 mm", "5 m"],
    **AXES,
}
JOINT: Table = {
    "node!": ["n1", "n1", "n0", "n2", "n9"],
    "member!": ["m0", "m1", "m9"],
    "type!": ["revolute", "universal", "spherical", "prismatic", "cylindrical", "planar"],
    "axis": [[0, 1, 0], [0, 1, 0], *DIRECTIONS],
    "second?": [[1, 0, 0], *DIRECTIONS],
}
MOTION: Table = {"x": [STEP, "3 mm", PARTIAL], "y?": [STEP, IMPACT], "z": [STEP, STEP, PARTIAL, "9 mm"]}
OBSTACLE: Table = {
    "type!": ["plane", "cylinder", "sphere"],
    "point!": POINTS,
    "normal": DIRECTIONS,
    "axis": DIRECTIONS,
    "radius": ["50 mm", "100 mm", "0 mm", "9 m"],
    "length?": ["300 mm"],
    "edge?": DIRECTIONS,
    "members?": [[], ["m0"], ["m9"], ["m1", "m0"]],
    "friction?": [0.2, -1, 9],
    "restitution?": [0.2, 2],
    "mass?": ["40 kg"],
    "guide?": DIRECTIONS,
    "velocity?": SPEEDS,
    "motion?": [MOTION],
    "turning?": [{"about": POINTS[0], "axis": [0, 1, 0], "angle": ANGLE}, {"angle": "3 deg"}],
}
KEYS_OF = {"plane": {"normal", "edge"}, "cylinder": {"axis", "radius", "length"}, "sphere": {"radius"}}
UNTIL: Table = {
    "energy?": ["5 J", "-1 J"],
    "force?": ["60 kN"],
    "displacement?": ["8 mm", "0 mm"],
    "distance?": ["-10 mm", "0 mm"],
    "rotation?": ["3 deg"],
    "of?": ["o0", "o1", "a", "no"],
    "between?": [["n0", "n1"], ["n0", "n0"], ["n0", "n9"]],
}
FIELD: Table = {
    "translation": SPEEDS,
    "rotation?": ["2 rad/s"],
    "axis?": DIRECTIONS,
    "about?": POINTS,
    "nodes?": [["n1"], ["n9"], []],
    "members?": [["m0"], ["m9"]],
}
STAGE: Table = {
    "name!": ["s0", "s1", "s2", "s0"],
    "kind": ["dynamic", "quasi-static"],
    "duration!": ["3 ms", "3 ms", "8 ms", "0 s"],
    "drive?": [[], ["o0"], ["a"], ["no"], ["o0", "o0"]],
    "obstacles": [[], ["o0"], ["o0", "o1"], ["no"]],
}
WELDS: Table = {
    "members!": [["m0", "m1"], ["m0", "m1"], ["m0"], ["m0", "m0"], ["m9", "m1"]],
    "at": [["0 mm", "20 mm"], ["0 mm", "0 mm"], ["0 mm", "-20 mm"], ["9 mm", "21 mm"]],
    "from?": ["50 mm", "9 m"],
    "to?": ["350 mm", "9 m", "20 mm"],
    "pitch": ["60 mm", "60 mm", "1 mm", "9 m"],
    "points?": [[POINTS[2], POINTS[3]], [["0.2 m", "0 m", "20 mm"]], []],
    "diameter?": ["6 mm", "90 mm"],
    "normal_strength?": ["6 kN"],
    "shear_strength?": ["9 kN"],
}
SHELL: Table = {
    "element_size": ["10 mm", "20 mm", "90 mm", "1 mm", "0.1 mm", "1 nm"],
    "fine_size?": ["5 mm", "50 mm"],
    "fine_length?": ["60 mm"],
    "fine_at?": [[{"member": "m0", "at": "50 mm"}], [{"member": "m0", "at": "9 m"}]],
    "growth?": [1.3, 1.0],
    "coarse_sections?": ["on", "off"],
    "t_joints?": ["welded", "rigid"],
    "thickness_points?": [3, 1, 11],
    "thickness_rule?": ["gauss", "lobatto"],
    "element?": ["stabilised", "belytschko-tsay"],
    "hourglass?": ["viscous"],
    "warping_correction?": ["on"],
    "drill_stiffness?": [0.02],
    "self_contact?": [True, "off"],
    "weld_pitch?": ["40 mm", "1 um", "9 m"],
    "mass_scaling?": ["1 us", "1 s"],
    "imperfection?": ["0.1 mm", "9 mm"],
}
MULTIBODY: Table = {
    "kernel": ["auto", "tree", "spatial", "planar"],
    "accuracy?": [1e-3, 1e-5],
    "maximum_time_step?": ["1 ms", "1 us"],
    "minimum_time_step?": ["1 ns", "9 ms"],
    "mechanism_check?": ["off", "on"],
}
OUTPUTS: Table = {
    "every": ["1 ms", "1 us", "0.1 ns", "9 s"],
    "nodes?": [["n1"], ["n9"]],
    "distances?": [{"d": {"from": "n0", "to": "n1"}}, {"d": {"from": "n0", "to": "n0"}}],
    "section_forces?": [{"f": {"member": "m0", "at": at}} for at in ("50 mm", "9 m")],
    "section_rotations?": [{"r": {"member": "m0", "from": "0 mm", "to": to}} for to in ("50 mm", "9 m")],
    "pictures?": [["0 ms", "1 ms"], ["9 s"], []],
    "filters?": [
        {"f": {"channel": channel, "cfc": cfc}}
        for channel in ("node.n1.velocity.x", "node.n1.acceleration.x", "no.x")
        for cfc in (60, 1000)
    ],
    "clearances?": [
        {"c": {"moves_with": "m0", "points": points, "members": ["m1"]}}
        for points in ([POINTS[0], POINTS[1], POINTS[2], POINTS[4]], POINTS[:2], [POINTS[0]] * 4)
    ],
}
SUPPORT: Table = {
    "node!": ["n0", "n1", "n9"],
    "fix": ["all", "pin", ["x", "z"], [], ["x", "x"], ["no"]],
    "motion?": [{"x": STEP}, {"q": STEP}, {"z": IMPACT}, {"ry": ANGLE}, {"ry": STEP}, {}],
}
LOAD: Table = {
    "node!": ["n1", "n9"],
    "force": [{"x": "2 kN"}, {"z": IMPACT}, {"z": STEP}, {"z": {"no": {}}}, {"z": {"sum": []}}],
    "moment?": [{"x": {"constant": "3 N*m"}}],
}
MASS: Table = {
    "node!": ["n1", "n2", "n9"],
    "mass": ["5 kg", "0 kg"],
    "offset?": [["0 mm", "10 mm", "0 mm"]],
    "rotary_inertia?": [["1 kg*m^2"] * 3, ["9 kg*m^2", "1 kg*m^2", "1 kg*m^2"], ["0 kg*m^2"] * 3],
}
IMPULSE: Table = {
    "node!": ["n1", "n0", "n9"],
    "impulse": [["0 N*s", "5 N*s", "0 N*s"], ["0 N*s"] * 3],
    "angular_impulse?": [["0 N*m*s", "1 N*m*s", "0 N*m*s"]],
}
MEMBER: Table = {
    "nodes!": [["n0", "n1"], ["n0", "n1"], ["n1", "n2"], ["n0", "n0"], ["n0", "n9"]],
    "section!": ["s", "s", "w", "no"],
    "material!": ["metal", "metal", "metal", "no"],
    "up?": DIRECTIONS,
    "roll?": ["30 deg"],
    "rigid?": [True, [{"from": "0 mm", "to": "90 mm"}], [{"from": "90 mm", "to": "9 mm"}]],
    "bars?": [{"number": 3, "law": "constant"}, {"number": 2, "axis": "y"}, {"number": 10**6}],
    "hinges?": ["auto", [], {"law": "constant"}, {"law": {"type": "constant"}, "spacing": "1 mm"}],
}
MATERIAL: Table = {
    "grade": ["S235", "S355", "DP600", "no"],
    "youngs_modulus?": ["210 GPa", "1 Pa"],
    "poissons_ratio?": [0.3, 0.7],
    "density?": ["7850 kg/m^3"],
    "yield_stress?": ["400 MPa", "900 GPa"],
    "ultimate_stress?": ["500 MPa", "5 MPa"],
    "flow_stress?": ["450 MPa", "1 MPa"],
    "yield_rate?": [{"D": "40 1/s", "q": 5}, {"D": "0 1/s", "q": 5}],
    "flow_rate?": [{"type": "johnson-cook", "C": 0.02}, {"type": "no"}, {"type": "cowper-symonds"}],
    "hardening?": [
        {"type": "swift", "prestrain": 0.01, "exponent": 0.2},
        {"type": "swift", "exponent": 2},
        {"type": "voce", "rate": 10},
        {"type": "voce", "rate": -1},
        {"type": "table", "plastic_strain": [0, 0.1], "true_stress": ["355 MPa", "450 MPa"]},
        {"type": "table", "plastic_strain": [0.1, 0.1], "true_stress": ["355 MPa", "5 MPa"]},
        {"type": "table", "plastic_strain": [0], "true_stress": ["1 MPa"]},
        {"type": "none"},
    ],
}
SIZES = ["40 mm", "60 mm", "50 mm", "2 mm", "0 mm", "400 mm"]
SECTION: Table = {
    "type!": [
        "square_tube",
        "rectangular_tube",
        "circular_tube",
        "channel",
        "angle",
        "hat",
        "closed_hat",
        "multi_cell_tube",
    ],
    "side": SIZES,
    "diameter": SIZES,
    "width": SIZES,
    "depth": SIZES,
    "thickness!": ["2 mm", "2 mm", "1 mm", "30 mm", "0 mm"],
    "corner_radius?": ["4 mm", "1 mm", "40 mm"],
    "flange": ["20 mm", "1 mm"],
    "lip?": ["10 mm", "1 mm"],
    "plate_material?": ["metal", "no"],
    "cells?": [[2, 2], [1, 1], [9, 90]],
}
SECTION_KEYS = {
    "square_tube": {"side", "corner_radius"},
    "rectangular_tube": {"width", "depth", "corner_radius"},
    "circular_tube": {"diameter"},
    "channel": {"width", "depth", "corner_radius", "lip"},
    "angle": {"width", "depth", "corner_radius"},
    "hat": {"width", "depth", "flange", "corner_radius"},
    "closed_hat": {"width", "depth", "flange", "corner_radius", "plate_material"},
    "multi_cell_tube": {"width", "depth", "cells"},
}


@st.composite
def drawn(draw: Any, table: Table, *, only: Mapping[str, set[str]] | None = None) -> dict[str, Any]:
    """Some keys of a table with a value each; `only`: keys that fit each type, the others come rarely."""
    part: dict[str, Any] = {}
    for key, values in table.items():
        name = key.rstrip("!?")
        own = set().union(*only.values()) if only else set()
        fits = name not in own or (only is not None and name in only.get(part.get("type", ""), ()))
        # of ten
        often = 10 if key.endswith("!") else 2 if key.endswith("?") else 8
        if only and name in own and fits and not key.endswith("?"):
            often = 10
        if draw(st.integers(0, 29 if not fits else 9)) < (1 if not fits else often):
            # the first is good everywhere
            value = draw(st.sampled_from([*values[:1] * len(values), *values]))
            part[name] = draw(drawn(value)) if value is MOTION else listed(value)
    return part


def obstacle() -> st.SearchStrategy[dict[str, Any]]:
    """A plane, a cylinder or a sphere."""
    return drawn(OBSTACLE, only=KEYS_OF)


@st.composite
def stages(draw: Any) -> list[dict[str, Any]]:
    """Stages with conditions, velocities and impulses."""
    found = []
    for _ in range(draw(st.sampled_from([1, 2, 2, 3]))):
        stage = draw(drawn(STAGE))
        for key, table in (("until", UNTIL), ("initial_velocity", FIELD), ("impulses", IMPULSE)):
            if draw(st.integers(0, 2)) == 0:
                stage[key] = [draw(drawn(table))]
        found.append(stage)
    return found


CORNERS = [["0 mm", "0 mm"], ["60 mm", "0 mm"], ["60 mm", "40 mm"], ["0 mm", "40 mm"]]
OTHERS = [["30 mm", "0 mm"], ["30 mm", "40 mm"], ["0 mm", "1.5 mm"], ["60 mm", "-1.6 mm"], ["2 mm", "2 mm"]]
OTHERS += [["0 mm", "0 mm"], ["61 mm", "-20 mm"], ["30 mm", "-9 mm"], ["300 mm", "300 mm"], ["1e9 m", "0 mm"]]


@st.composite
def walls(draw: Any) -> dict[str, Any]:
    """A section by its walls: a box with some points moved, more walls, and lines of welds."""
    points = listed(CORNERS)
    for _ in range(draw(st.sampled_from([0, 0, 1, 2]))):
        at, point = draw(st.integers(0, len(points))), draw(st.sampled_from(OTHERS))
        points[at : at + draw(st.integers(0, 1))] = [listed(point)]
    wall = {"thickness!": ["1.5 mm", "3 mm", "15 mm"], "corner_radius?": ["4 mm", "1 mm", "25 mm"]}
    wall |= {"closed": [True, False], "material?": ["metal", "no"], "name?": ["box", ""]}
    found = [draw(drawn(wall)) | {"points": points}]
    for _ in range(draw(st.sampled_from([0, 0, 1, 2]))):
        ends = draw(st.lists(st.sampled_from([*OTHERS, *CORNERS]), min_size=1, max_size=3))
        found.append(draw(drawn(wall)) | {"points": listed(ends)})
    section: dict[str, Any] = {"type": "walls", "walls": found}
    if draw(st.integers(0, 3)) == 0:
        ends = [listed(draw(st.sampled_from([*OTHERS, *CORNERS]))) for _ in range(2)]
        section["welds"] = [{"first": ends[0], "second": ends[1]}]
    return section


def changed_frame(draw: Any, part: str, frame: dict[str, Any]) -> dict[str, Any]:
    """The frame with one more part, or with one in place of its own."""
    data = listed(frame)
    analysis = data["analysis"]
    if part in ("obstacles", "stages"):
        number = draw(st.integers(1, 2))
        data["obstacles"] = {f"o{i}": draw(obstacle()) for i in range(number)}
    if part == "stages":
        for key in ("initial_velocity", "impulses"):
            data.pop(key, None)
        if draw(st.integers(0, 9)):
            analysis.pop("duration", None)
        analysis["stages"] = draw(stages())
    if part == "axes":
        data["hinges"] = draw(drawn(AXES))
    if part == "hinge":
        data["members"]["m0"] |= {"hinges": [draw(drawn(HINGE)) for _ in range(draw(st.integers(1, 2)))]}
        data["members"]["m0"].pop("bars", None)
    if part == "welds":
        # the second member lies on the first one
        data["nodes"] |= {"n8": ["0 m", "0 m", "40 mm"], "n7": ["0.4 m", "0 m", "40 mm"]}
        data["nodes"] |= {"n1": ["0.4 m", "0 m", "0 m"]}
        data["members"] = {
            "m0": {"nodes": ["n0", "n1"], "section": "s", "material": "metal"},
            "m1": {"nodes": ["n8", "n7"], "section": "s", "material": "metal", "rigid": True},
        }
        data["nodes"] = {name: data["nodes"][name] for name in ("n0", "n1", "n8", "n7")}
        data["spot_welds"] = {f"w{i}": draw(drawn(WELDS)) for i in range(draw(st.integers(1, 2)))}
    for name, key, table, only in GROUPS:
        if part == name:
            data[key] = data.get(key, {}) | {"x": draw(drawn(table, only=only))}
    if part == "walls":
        data["sections"]["s"] = draw(walls())
    if part == "material":
        data["materials"]["metal"] = draw(drawn(MATERIAL))
    if part == "section":
        data["sections"]["s"] = draw(drawn(SECTION, only=SECTION_KEYS))
    if part == "loads":
        data["loads"] = [draw(drawn(LOAD))]
        data["impulses"] = [draw(drawn(IMPULSE))]
        data["initial_velocity"] = [draw(drawn(FIELD))]
    if part == "settings":
        analysis["shell"], analysis["multibody"] = draw(drawn(SHELL)), draw(drawn(MULTIBODY))
        data["outputs"] = draw(drawn(OUTPUTS))
    if part == "laws":
        data["hinge_laws"] = {"own": draw(st.sampled_from(LAWS))}
        data["laws"] = draw(st.sampled_from(["store", "no", "..", "law.yaml", "curve.csv", "bad_store"]))
    return data


GROUPS: list[tuple[str, str, Table, Mapping[str, set[str]] | None]] = [
    ("joints", "joints", JOINT, None),
    ("supports", "supports", SUPPORT, None),
    ("masses", "masses", MASS, None),
    ("member", "members", MEMBER, None),
]
PARTS = ["obstacles", "stages", "axes", "hinge", "welds", "walls", "material", "section", "loads", "settings"]
PARTS += ["laws", *(name for name, *_ in GROUPS)]
