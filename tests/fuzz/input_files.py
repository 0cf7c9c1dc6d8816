"""Input files that are nearly right: small random frames and good files, with some changes each."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy
from tests.fuzz.mutation import Edit, Pool, edited
from tests.fuzz.parts import PARTS, changed_frame

from crumple.analysis import InputFile
from crumple.analysis.reading import read_text
from crumple.analysis.schema import models_of
from crumple.hinge.registry import AXIAL, BENDING, TORSION
from crumple.section.shapes.registry import SHAPES

ROOT = Path(__file__).parents[2]
KEYS = sorted(
    {field.alias or name for model in models_of(InputFile) for name, field in model.model_fields.items()}
)
UNITS = [
    "mm",
    "m",
    "kg",
    "N",
    "kN",
    "MPa",
    "deg",
    "rad/s",
    "s",
    "ms",
    "N*m",
    "kg*m^2",
    "1",
    "",
    "%",
    "m^9",
    "mm/m",
]
NUMBERS = [
    0,
    -1,
    1,
    2,
    0.5,
    1e-30,
    1e-12,
    1e-6,
    1e6,
    1e12,
    1e18,
    1e300,
    -1e300,
    float("nan"),
    float("inf"),
    10**25,
]
TEXTS = [
    "", " ", "a", "²", "x²", "٣", "all", "auto", "none", "a.b", "a b", "x" * 65, "\0", "9**9**9 mm",
    "50 mm + 3 m",     "1e999 m", "-0 m", "0x10 mm", "1_0 mm", "12:30", "<script>", "é", "\ud800", "\u2028",
    "../a", "CON", "0", "-",
]  # fmt: skip
FACTORS = [-1.0, 0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.8, 1.2, 2.0, 10.0, 1e3, 1e6, 1e12]
LAW_TYPES = [*BENDING, *AXIAL, *TORSION, "table", "file", "constant"]
GENTLE = [0.8, 0.9, 0.95, 1.05, 1.1, 1.2]
Numbered = SearchStrategy[Edit]


def edits(kinds: Sequence[str], *, values: SearchStrategy[Any]) -> Numbered:
    """Changes of the data, of these kinds."""
    return st.tuples(st.integers(0, 10**9), st.sampled_from(kinds), values)


def anything() -> SearchStrategy[Any]:
    """A value that has no business where it is put, mostly."""
    quantity = st.tuples(st.sampled_from(NUMBERS), st.sampled_from(UNITS)).map(lambda q: f"{q[0]} {q[1]}")
    plain = st.one_of(st.sampled_from(NUMBERS), st.sampled_from(TEXTS), quantity, st.none(), st.booleans())
    return st.one_of(
        plain, plain, st.lists(plain, max_size=4), st.dictionaries(st.sampled_from(KEYS), plain, max_size=3)
    )


def changes() -> Numbered:
    """One change of an input file."""
    number = st.integers(0, 10**4)
    return st.one_of(
        edits(["scale"], values=st.sampled_from(GENTLE)),
        edits(["scale"], values=st.sampled_from(FACTORS)),
        edits(["splice", "add"], values=number),
        edits(["splice", "add"], values=number),
        edits(["set"], values=anything()),
        edits(["drop"], values=st.none()),
        edits(["copy"], values=number),
        edits(["rename"], values=st.one_of(st.sampled_from(KEYS), st.sampled_from(TEXTS))),
        edits(["repeat", "nest"], values=st.sampled_from([1, 1, 2, 3, 20, 40])),
    )


@cache
def bases() -> tuple[dict[str, Any], ...]:
    """Content of the good files of the project, with short durations."""
    folders = (ROOT / "examples", ROOT / "examples" / "layouts", Path(__file__).parent / "bases")
    texts = [path.read_text(encoding="utf-8") for folder in folders for path in sorted(folder.glob("*.yaml"))]
    texts += re.findall(
        r"```yaml\n(crumple: 1.*?)```", (ROOT / "docs" / "input.md").read_text(encoding="utf-8"), re.S
    )
    # those of this folder twice: they use more keys than the examples
    texts += [path.read_text(encoding="utf-8") for path in sorted(folders[-1].glob("*.yaml"))]
    found = [read_text(text).data for text in texts if ".csv" not in text]
    for data in found:
        if "duration" in data.get("analysis", {}):
            data["analysis"]["duration"] = "8 ms"
            data.get("outputs", {}).pop("pictures", None)
            data.get("outputs", {}).pop("every", None)
    return tuple(found)


@cache
def pool() -> Pool:
    """Values of every key: those of the good files, words that the key allows, files and texts of laws."""
    models = list(models_of(InputFile))
    found = defaultdict[str, list[Any]](list, {key: [] for key in KEYS})
    for model in models:
        for name, field in model.model_fields.items():
            words = re.findall(r"Literal\[(.*?)\]", str(field.annotation))
            found[field.alias or name] += [word for one in words for word in re.findall(r"'([^']*)'", one)]
    found["type"] += [*SHAPES, *LAW_TYPES]
    found["law"] += LAW_TYPES
    found["file"] += ["curve.csv", "no.csv", "law.yaml", "..", "/dev/null"]
    found["negative_file"] += ["curve.csv"]
    found["units"] += [{"rotation": "deg"}, {"moment": "kN"}, {"time": "ms", "value": "kN"}, {"x": "m"}]
    found["text"] += ["crumple_law: 1", "", "\n"]

    typed: list[Mapping[str, Any]] = []

    def collect(data: Any) -> None:
        if isinstance(data, Mapping) and "type" in data:
            typed.append(data)
        for key, value in data.items() if isinstance(data, Mapping) else ():
            found[key].append(value)
            collect(value)
        for value in data if isinstance(data, list) else ():
            collect(value)

    for data in bases():
        collect(data)
    groups = {frozenset(field.alias or name for name, field in m.model_fields.items()) for m in models}
    groups |= {frozenset(group) for group in typed}
    values = {
        key: [json.loads(one) for one in sorted({json.dumps(v) for v in values})]
        for key, values in found.items()
    }
    return Pool(values, sorted(groups, key=sorted))


def input_files(good: Sequence[Mapping[str, Any]], *, most: int = 3) -> SearchStrategy[str]:
    """Texts of input files: a frame or a good file with at most so many changes."""
    count = st.sampled_from([0, 0, *range(1, most + 1)])
    some = count.flatmap(lambda n: st.lists(changes(), min_size=n, max_size=n))
    # by their numbers: reports of Hypothesis then stay short
    given = st.sampled_from(range(len(good))).map(lambda one: good[one])
    data = st.one_of(frames(), given, frames_with_parts())
    return st.tuples(data, some).map(lambda both: written(edited(both[0], both[1], pool())))


def written(data: Any) -> str:
    """Data as an input file, one line for every entry of the groups at the top."""
    if not isinstance(data, dict):
        return flow(data)
    lines = []
    for key, value in data.items():
        head = (
            f"{key}:"
            if isinstance(key, str) and re.fullmatch(r"[a-z_]+", key)
            else f"{json.dumps(str(key))}:"
        )
        if isinstance(value, dict) and value:
            lines += [head, *(f"  {json.dumps(str(name))}: {flow(part)}" for name, part in value.items())]
        else:
            lines.append(f"{head} {flow(value)}")
    return "\n".join(lines) + "\n"


def flow(value: Any) -> str:
    """Value as YAML flow text; texts are quoted as JSON does it, so that any of them survives."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(str(key))}: {flow(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, float):
        return repr(value).replace("inf", ".inf").replace("nan", ".nan")
    return json.dumps(value)


@st.composite
def changed_text(draw: Any, texts: SearchStrategy[str], pieces: Sequence[str]) -> str:
    """Texts with some lines lost, doubled or moved, and some pieces replaced."""
    text = draw(texts)
    lines = text.splitlines(keepends=True)
    for number, what in draw(st.lists(st.tuples(st.integers(0, 10**4), st.sampled_from("xdm")), max_size=1)):
        if lines:
            line = lines.pop(number % len(lines))
            lines[number % (len(lines) + 1) : 0] = [] if what == "x" else [line]
            if what == "d":
                lines.insert((number + 1) % (len(lines) + 1), line)
    text = "".join(lines)
    middle = st.one_of(st.sampled_from([*pieces, ""]), st.text(max_size=6))
    for number, length, piece in draw(
        st.lists(st.tuples(st.integers(0, 10**5), st.integers(0, 12), middle), max_size=1)
    ):
        start = number % (len(text) + 1)
        text = text[:start] + piece + text[start + length :]
    return text


SECTIONS = [
    {"type": "square_tube", "side": "40 mm", "thickness": "2 mm"},
    {"type": "rectangular_tube", "width": "60 mm", "depth": "40 mm", "thickness": "2.5 mm"},
    {"type": "circular_tube", "diameter": "50 mm", "thickness": "2 mm"},
    {"type": "closed_hat", "width": "60 mm", "depth": "50 mm", "thickness": "1.5 mm", "flange": "20 mm"},
]
LAWS = ["constant", {"type": "constant", "moment": "800 N*m"}, {"type": "constant", "form": "regularised"}]
LAWS += [
    {
        "type": "table",
        "rotation": ["0 deg", "20 deg"],
        "moment": ["1 kN*m", "0.5 kN*m"],
        "softening": "rotation",
    }
]
STEPS = [(4, 0, 0), (0, 0, 4), (3, 0, 3), (0, 3, 0), (5, 0, -2), (2, 2, 2)]
GRADES = st.sampled_from(["S235", "S355", "DP600"])


@st.composite
def frames_with_parts(draw: Any) -> dict[str, Any]:
    """A frame with one more part."""
    return changed_frame(draw, draw(st.sampled_from(PARTS)), draw(frames()))


@st.composite
def frames(draw: Any) -> dict[str, Any]:
    """A line of members, clamped or pinned at one end or at both, and something that moves it."""
    pick = lambda *choices: draw(st.sampled_from(choices))  # noqa: E731
    steps = draw(st.lists(st.sampled_from(STEPS), min_size=1, max_size=4))
    places = [(0, 0, 0)]
    for step in steps:
        places.append(tuple(a + b for a, b in zip(places[-1], step, strict=True)))
    names = [f"n{i}" for i in range(len(places))]
    members: dict[str, Any] = {}
    for i in range(len(steps)):
        own = pick(None, "auto", "one", "bars")
        member: dict[str, Any] = {"nodes": [names[i], names[i + 1]], "section": "s", "material": "metal"}
        if own == "auto":
            member["hinges"] = pick("auto", {"law": "constant"})
        elif own == "one":
            at = pick(names[i], "120 mm")
            member["hinges"] = [{"name": f"h{i}", "at": at, "offset": "20 mm", "law": pick(*LAWS)}]
        elif own == "bars":
            member["bars"] = {"number": pick(2, 3, 5), "law": pick(*LAWS)}
        members[f"m{i}"] = member
    file = {
        "crumple": 1,
        "materials": {"metal": {"grade": draw(GRADES)}},
        "sections": {"s": pick(*SECTIONS)},
        "nodes": {name: [f"{0.1 * x:g} m" for x in place] for name, place in zip(names, places, strict=True)},
        "members": members,
        "supports": {"a": {"node": "n0", "fix": pick("all", "all", "pin", ["x", "y", "z"])}},
        "masses": {"m": {"node": names[-1], "mass": pick("2 kg", "50 kg")}},
        "analysis": {"duration": pick("2 ms", "8 ms")},
    }
    velocity = [{"translation": [f"{pick(-8, 0, 3)} m/s", "0 m/s", f"{pick(-5, 2)} m/s"], "nodes": names[1:]}]
    force = {pick("x", "z"): pick("2 kN", {"step": {"x0": "0 ms", "h0": "0 N", "x1": "4 ms", "h1": "3 kN"}})}
    wall = {"type": "plane", "point": ["0 m", "0 m", "-0.9 m"], "normal": [0, 0, 1], "friction": pick(0, 0.3)}
    more = {
        "initial_velocity": velocity,
        "loads": [{"node": names[-1], "force": force}],
        "gravity": ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"],
        "obstacles": {"wall": wall},
        "impulses": [{"node": names[-1], "impulse": ["0 N*s", "0 N*s", "9 N*s"]}],
        "hinges": pick(
            "auto", {"law": "constant"}, {"law": "constant", "axes": ["y", "z"], "coupling": "ellipsoid"}
        ),
        "outputs": {"nodes": [names[-1]]},
    }
    return file | {key: more[key] for key in draw(st.sets(st.sampled_from(sorted(more)), min_size=1))}
