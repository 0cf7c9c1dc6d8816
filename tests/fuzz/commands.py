"""Command lines: words that fit a command and words that do not, over a folder of good and bad files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from typer.testing import CliRunner

from crumple.cli.main import app
from crumple.errors import CancelledError, InputError

BASES = Path(__file__).parent / "bases"
SECTIONS = [
    "rectangular_tube 50x25x2.65 mm",
    "square_tube 40x2 mm",
    "circular_tube 50x2 mm",
    "good.yaml:tube",
]
SECTIONS += ["hat 60x50x1.5 mm, flange 20 mm", "good.yaml:no", "bad.yaml:tube", "no.yaml:tube", "square_tube"]
SECTIONS += [
    "square_tube 40x2 mm, flange 3 mm",
    "square_tube 40x2 mm, corner radius 5 mm, corner radius 5 mm",
]
SECTIONS += ["no 4x2 mm", "square_tube 4 x 9 mm", "", "x" * 200, "good.yaml:", "square_tube 0x2 mm"]
MATERIALS = ["S355", "yield 488 MPa, E 210 GPa", "good.yaml:steel", "good.yaml:no", "no", "", "yield 4 MPa"]
MATERIALS += [
    "yield 488 MPa, E 210 GPa, yield 1 MPa",
    "yield 488 MPa, E 210 GPa, hue 3",
    "yield 4 mm, E 1 Pa",
]
FILES = ["good.yaml", "good.yaml", "frame.yaml", "bad.yaml", "no.yaml", "folder", "binary", "law.yaml"]
LAWS = ["store", "bad_store", "no", "law.yaml", "folder", "curve.csv"]
OUT = ["out/a", "out/a", "", "good.yaml", "out/b", "held"]
AXES = ["y", "z", "x"]
OPTIONS: dict[str, tuple[list[str], dict[str, list[str | None]]]] = {
    "check": (FILES, {"--fidelity": ["both", "shell", "multibody", "no"]}),
    "hinge": (
        SECTIONS,
        {
            "--material": [*MATERIALS],
            "--axis": [*AXES],
            "--law": ["kecman", "constant", "file", "table", "measured", "no"],
            "--curve": ["curve.csv", "no.csv", "folder", "long.csv"],
            "--to": ["30 deg", "0 deg", "-3 deg", "9 rad", "9 mm", "1e9 deg"],
            "--figure": ["out/f.svg", "folder", "good.yaml/f.svg"],
            "--save": ["out/l.yaml", "folder"],
        },
    ),
    "section": (
        SECTIONS,
        {
            "--material": [*MATERIALS],
            "--angle": ["30 deg", "x", "1e30 deg"],
            "--axial": ["-20 kN", "9 MN", "1 mm"],
            "--figure": ["out/f.svg", "folder"],
        },
    ),
    "characterise": (
        [*FILES, *SECTIONS],
        {
            "--list": [None],
            "--material": [*MATERIALS],
            "--store": ["made", "good.yaml"],
            "--axis": [*AXES],
            "--sense": ["+", "-", "no"],
            "--angle": ["90 deg", "0 deg", "200 deg", "x"],
            "--load": ["out-of-plane", "no"],
            "--about": ["tangent", "no"],
            "--to": ["30 deg", "0 deg", "900 deg"],
            "--json": [None],
            "--threads": ["1", "0"],
            "--workers": ["1", "0"],
        },
    ),
    "run": (
        FILES,
        {
            "--no-law-range": [None],
            "--fidelity": ["multibody", "no"],
            "--restart": ["no.npz", "good.yaml"],
            "--laws": [*LAWS],
            "--freeze-laws": ["out/frozen.yaml", "folder", "no/no/x.yaml"],
            "--json": [None],
            "--threads": ["1", "0"],
        },
    ),
    "compare": (
        ["frame.yaml", "frame.yaml", "bad.yaml", "no.yaml", "folder"],
        {
            "--curve": ["a=curve.csv", "curve.csv", "shell=curve.csv", "a=no.csv", "a=time.csv"],
            "--pair": [
                "moment=hinge.root.moment",
                "x",
                "moment=no",
                "no=hinge.root.moment",
                "moment=-energy.x",
            ],
            "--second-mesh": ["2", "0", "nan", "1", "1000"],
            "--restart": ["no.npz", "good.yaml"],
            "--laws": [*LAWS],
        },
    ),
    "layouts": (
        FILES,
        {"--title": ["", "x" * 99], "--laws": [*LAWS], "--freeze-laws": ["out/f.yaml", "folder"]},
    ),
    "schema": (["", "x"], {}),
    "no": ([""], {}),
}
"""By command: first words, and values of the options; None for one without."""


@st.composite
def commands(draw: Any) -> list[str]:
    """A command, its argument (sometimes none, or two) and some options."""
    verb = draw(st.sampled_from([*list(OPTIONS)[:-2] * 4, *OPTIONS]))
    firsts, options = OPTIONS[verb]
    first = st.sampled_from([*firsts[:1] * len(firsts), *firsts])
    number = draw(st.sampled_from([1] * 18 + [0, 2]))
    words = [verb, *[draw(first) for _ in range(number)]]
    always = {"--material"} if verb == "hinge" else {"--no-law-range"}
    for name, values in options.items():
        # a section without --list would be solved
        often = 10 if name == "--list" else 9 if name in always else 2
        if draw(st.integers(0, 9)) < often:
            value = draw(st.sampled_from([*values[:1] * len(values), *values]))
            words += [name] if value is None else [name, value]
    if verb in ("run", "compare", "layouts"):
        words += ["--out", draw(st.sampled_from(OUT))]
    return words


def prepared() -> None:
    """Write the files that the words name."""
    from tests.fuzz.attacks import beside

    beside("curve.csv law.yaml store")
    good = (BASES / "shell.yaml").read_text(encoding="utf-8")
    Path("good.yaml").write_text(good, encoding="utf-8")
    # solved only to its first checks: compare must end before its shell run
    frame = re.sub(r"node: root, fix: all", "node: tip, fix: []", good)
    Path("frame.yaml").write_text(frame, encoding="utf-8")
    Path("bad.yaml").write_text("crumple: 1\nnodes: 3\n", encoding="utf-8")
    Path("binary").write_bytes(b"\x00\xff")
    Path("long.csv").write_text("rotation [deg], moment [N*m]\n" + "1" * 5_000_000, encoding="utf-8")
    Path("time.csv").write_text("time [s], x [m]\n0, 1\n1, 2\n", encoding="utf-8")
    for name in ("folder", "held/histories.csv", "held/summary.json"):
        Path(name).mkdir(parents=True, exist_ok=True)


def spoken(words: Sequence[str]) -> str:
    """Run a command line: "" if it ended well, else its first words of refusal."""
    prepared()
    outcome = CliRunner().invoke(app, list(words))
    error = outcome.exception
    if isinstance(error, InputError):
        raise error
    if error is not None and not isinstance(error, SystemExit | CancelledError | OSError):
        raise error
    assert isinstance(error, OSError) or outcome.exit_code in (0, 1, 2, 130), f"exit code {outcome.exit_code}"
    assert "Traceback" not in outcome.output
    if outcome.exit_code == 0:
        return ""
    lines = [line for line in outcome.output.splitlines() if "rror" in line] or ["ended without a result"]
    return str(error) if isinstance(error, OSError) else lines[0]
