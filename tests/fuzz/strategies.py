"""What cases are made of: texts and bytes, law files, curves, restart files, calls of the kernels.

Input files have a module of their own, `tests.fuzz.input_files`.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy
from tests.fuzz.commands import commands
from tests.fuzz.input_files import (
    KEYS,
    NUMBERS,
    bases,
    changed_text,
    edits,
    flow,
    frames,
    frames_with_parts,
    input_files,
    written,
)
from tests.fuzz.worker import Case

ROOT = Path(__file__).parents[2]
PIECES = [
    "crumple: 1", "{", "}", "[", "]", ": ", "- ", "? ", "\n", "\n  ", "# ", "|\n", "> ", "'", '"', "&a ",
    "*a ", "!t ", "%", "---", "...", "<<", "~", ".nan", "1e400", "50 mm", "0", "-1", "true", "é", "\t", "\r",
    "\u2028", "@", "`", "\0", "²", "\ufeff", "[" * 500, "{a: " * 500, "- " * 500,
    "a: !<tag:yaml.org,2002:binary> x",
]  # fmt: skip
SCALARS = st.one_of(
    st.sampled_from(
        ["50 mm", "0 m", "1 kg", "488 MPa", "15 rad/s", "90 deg", "root", "all", "kecman", "auto"]
    ),
    st.none(),
    st.booleans(),
    st.integers(-(10**30), 10**30),
    st.floats(),
    st.text(max_size=8),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(st.sampled_from(KEYS), st.text(max_size=4)), inner, max_size=5),
    ),
    max_leaves=20,
)


def texts() -> SearchStrategy[bytes]:
    """Any bytes, any text, heaps of pieces of YAML, any values under known keys, changed good files."""
    known = st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=6)
    heads = known.map(
        lambda groups: "crumple: 1\n" + "".join(f"{key}: {flow(value)}\n" for key, value in groups.items())
    )
    pieces = st.lists(st.sampled_from([*PIECES, *KEYS]), max_size=60).map("".join)
    good = st.sampled_from([path.read_text(encoding="utf-8") for path in base_files()])
    text = st.one_of(
        st.text(max_size=200),
        pieces,
        pieces.map("crumple: 1\n{}".format),
        heads,
        changed_text(good, PIECES),
        good,
    )
    encoded = text.map(lambda one: one.encode("utf-8", "surrogatepass"))
    return st.one_of(st.binary(max_size=100), encoded, encoded, encoded)


def base_files() -> list[Path]:
    """Good input files that need no file beside them."""
    folders = (ROOT / "examples", Path(__file__).parent / "bases")
    every = [path for folder in folders for path in sorted(folder.glob("*.yaml"))]
    return [path for path in every if ".csv" not in path.read_text(encoding="utf-8")]


@cache
def law_texts() -> list[str]:
    """Law files that the package writes."""
    from crumple.hinge import build_law
    from crumple.hinge.measured.law_file import stored_law, write_law
    from crumple.material import Material
    from crumple.section import RectangularTube

    steel = Material("steel", 210e9, 0.3, 7850.0, 488e6)
    tube = RectangularTube(0.05, 0.025, 0.00265)
    laws = [build_law(name, tube, steel) for name in ("kecman", "constant")]
    return [write_law(stored_law(law, {"method": "formula"}, error=1e-2)) for law in laws]


def laws() -> SearchStrategy[str]:
    """Law files with their lines changed; with a checksum every change of what can be read is refused."""
    texts = [re.sub("checksum: .*\n", "", text) for text in law_texts()]
    return changed_text(
        st.sampled_from([*law_texts(), *texts]), [*PIECES, *map(str, NUMBERS), "none", "mirror", "rad"]
    )


CELLS = st.one_of(
    st.floats(-1e3, 1e3).map(repr),
    st.sampled_from(["", "0", "1e400", "nan", "-inf", "x", '"', "1;2", "²", "\0", "1,5", "0x1", "9" * 200]),
)
HEADS = [
    *["time [s], rotation [deg], moment [N*m]"] * 8,
    "time [s], hinge.root.rotation [deg], moment [N*m]",
    "rotation [deg], moment [kN*m]",
    "time_ms,rotation_deg,force_kN",
    "rotation,moment",
    "time [s],time [ms],x [furlong]",
    "time [],a []",
    "",
]


def curves() -> SearchStrategy[bytes]:
    """CSV files: rising numbers under a head, some with other cells, separators, line ends and bytes."""
    return _curve()


@st.composite
def _curve(draw: Any) -> bytes:
    head = draw(st.sampled_from(HEADS))
    rows, columns = draw(st.sampled_from([3, 5, 12, 0, 1])), max(head.count(",") + 1, 2)
    table = [[repr(0.5 * i)] * (columns - 1) + [repr(10.0 + i)] for i in range(rows)]
    rarely = lambda: draw(st.sampled_from([False] * 9 + [True]))  # noqa: E731
    for row, column, cell in draw(st.lists(st.tuples(st.integers(0), st.integers(0), CELLS), max_size=2)):
        if table:
            table[row % rows][column % columns] = cell
    separator = draw(st.sampled_from([";", "\t", " ", "|"])) if rarely() else ","
    lines = [separator.join(head.split(",")), *(separator.join(row) for row in table)]
    if rarely():
        lines.insert(
            draw(st.integers(0, len(lines))), draw(st.one_of(st.text(max_size=20), st.just("# note")))
        )
    if rarely():
        lines.append("1" * draw(st.sampled_from([90_000, 140_000, 2_000_000])))
    content = draw(st.sampled_from(["\n", "\n", "\r\n", "\r"])).join(lines).encode("utf-8", "surrogatepass")
    spoilt = draw(st.sampled_from([b"\xff\xfe" + content, b"\xef\xbb\xbf" + content, content + b"\0"]))
    return spoilt if rarely() else content


def restarts() -> SearchStrategy[dict[str, Any]]:
    """Changes of a restart file."""
    kinds = ["array", "array", "array", "drop", "rename", "scale"]
    arrays = st.lists(edits(kinds, values=st.integers(0, 10**4)), max_size=2)
    return st.fixed_dictionaries(
        {
            "arrays": arrays,
            "fitting": st.sampled_from([True, True, True, False]),
            "cut": st.sampled_from([0, 0, 0, 0, 1, 100, 10_000]),
            "bytes": st.one_of(
                st.just([]),
                st.just([]),
                st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), max_size=3),
            ),
        }
    )


def kernel_calls() -> SearchStrategy[tuple[str, Any]]:
    """Calls of the kernels with changed arguments."""
    strange = st.one_of(
        st.sampled_from([-1, 0, 1, 2, 7, 2**31, -(2**31), 2**63 - 1, 2**64, None, "x", (), [], {}, True]),
        st.sampled_from([float("nan"), float("inf"), -1.0, 0.0, 1e-300, 1e300, 0.5]),
        st.lists(st.floats(allow_nan=True, width=32), max_size=4),
    )
    changes = st.one_of(
        edits(["array"], values=st.integers(0, 10**4)),
        edits(["set"], values=strange),
        edits(["scale"], values=st.sampled_from([-1.0, 0.0, 1e-9, 1e-3, 0.5, 2.0, 1e3, 1e9, 1e200])),
        edits(["drop", "repeat", "nest"], values=st.integers(1, 4)),
    )
    rooms = st.sampled_from(["planar", "spatial", "shell", "checkpoint"])
    return st.tuples(rooms, st.lists(changes, max_size=3))


def calls() -> SearchStrategy[tuple[str, list[int]]]:
    """Calls of public functions, most arguments good."""
    from tests.fuzz.calls import CALLS

    number = st.one_of(st.just(0), st.just(0), st.just(0), st.integers(0, 12))
    return st.tuples(st.sampled_from(sorted(CALLS)), st.lists(number, max_size=8))


PARAMETERS = ["materials.metal.yield_stress", "sections.s.thickness", "masses.m.mass", "nodes.n1.0", "loads"]
PARAMETERS += ["initial_velocity", "gravity", "impulses", "hinges.h0.capacity", "hinges.h1.capacity"]
PARAMETERS += ["materials.no.x", "nodes.n1", "nodes.n1.9", "hinges.no.capacity", "title", "", "a..b"]
PARAMETERS += ["supports.a.fix", "members.m0.roll", "members.m0.bars.number", "sections.s.type"]


def varied() -> SearchStrategy[tuple[str, dict[str, Any]]]:
    """A frame and values of its parameters: lists for variants, single ones for sensitivities."""
    number = st.sampled_from([1.0, 1.1, 0.9, 0.1, 4e8, 0.002, 0.0, -1.0, 1e300, float("nan")])
    several = st.lists(number, min_size=1, max_size=3)
    names = st.sampled_from([*PARAMETERS[:8] * 2, *PARAMETERS])
    parameters = st.one_of(
        st.dictionaries(names, several, min_size=1, max_size=2),
        st.dictionaries(names, st.one_of(st.none(), st.none(), number), min_size=1, max_size=2),
    )
    return st.tuples(st.one_of(frames(), frames(), frames_with_parts()).map(written), parameters)


def results() -> SearchStrategy[Any]:
    """Changes of a result file: bytes, its end, its entries."""
    entry = st.tuples(st.integers(0, 10**6), st.sampled_from(["drop", "set", "short", "attribute"]))
    return st.one_of(
        st.just([]),
        st.none(),
        st.lists(entry, min_size=1, max_size=2),
        st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), min_size=1, max_size=3),
    )


def cases(kind: str) -> SearchStrategy[Case]:
    """Cases of one kind."""
    payload: SearchStrategy[Any] = {
        "bytes": texts,
        "input": lambda: input_files(bases()),
        "solve": lambda: input_files(bases(), most=2),
        # larger ones take seconds to mesh
        "shell": lambda: input_files([one for one in bases() if len(one["members"]) < 7], most=2),
        "law": laws,
        "curve": curves,
        "restart": restarts,
        "kernel": kernel_calls,
        "call": calls,
        "command": commands,
        "variants": varied,
        "result": results,
    }[kind]()
    return payload.map(lambda one: Case(kind, one))
