"""Whatever a text holds, reading it gives an analysis or a refusal, and nothing else."""

from pathlib import Path

from hypothesis import example, given, settings
from hypothesis import strategies as st

from crumple.analysis import Analysis, InputFile, canonical, input_hash, loads
from crumple.analysis.schema import models_of
from crumple.errors import InputError

GOOD = Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8")
CHAIN = Path("examples/02_cantilever_chain.yaml").read_text(encoding="utf-8")
KEYS = sorted(
    {field.alias or name for model in models_of(InputFile) for name, field in model.model_fields.items()}
)
PIECES = [
    "crumple: 1",
    "{",
    "}",
    "[",
    "]",
    ": ",
    "- ",
    "? ",
    "\n",
    "\n  ",
    "# ",
    "|\n",
    "> ",
    "'",
    '"',
    "&a ",
    "*a ",
    "!t ",
    "%",
    "---",
    "...",
    "<<",
    "~",
    ".nan",
    "1e400",
    "50 mm",
    "0",
    "-1",
    "true",
    "é",
    "\t",
    "\r",
    "\u2028",
    "@",
    "`",
]
SCALARS = st.one_of(
    st.sampled_from(
        ["50 mm", "0 m", "1 kg", "488 MPa", "15 rad/s", "90 deg", "root", "tip", "all", "kecman", "auto"]
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


def reads(text):
    """Whether a text is accepted; anything but an analysis or a refusal fails the test."""
    refusal = None
    try:
        analysis = loads(text)
    except InputError as error:
        refusal = error
    if refusal is not None:
        assert refusal.problems
        assert all(problem.what for problem in refusal.problems)
        assert len(str(refusal)) < 200_000
        return False
    assert isinstance(analysis, Analysis)
    assert len(input_hash(analysis)) == 64
    return True


def flow(value):
    """Value as YAML flow text; texts are quoted as JSON does it, so that any of them survives."""
    import json

    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)}: {flow(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, float):
        return repr(value).replace("inf", ".inf").replace("nan", ".nan")
    return json.dumps(value)


@given(st.text(max_size=200))
@example("\ufeff")
@example("a: !<tag:yaml.org,2002:binary> x")
def test_any_text(text):
    reads(text)


@given(st.lists(st.sampled_from([*PIECES, *KEYS]), max_size=60).map("".join))
@settings(max_examples=300)
def test_any_heap_of_yaml_pieces(text):
    reads(text)
    reads(f"crumple: 1\n{text}")


@given(st.dictionaries(st.sampled_from(sorted(InputFile.model_fields)), VALUES, max_size=6))
@settings(max_examples=300)
def test_any_values_under_known_keys(groups):
    reads(
        "crumple: 1\n"
        + "".join(f"{key}: {flow(value)}\n" for key, value in groups.items() if key != "crumple")
    )


@given(st.sampled_from([GOOD, CHAIN]), st.data())
@settings(max_examples=400)
def test_any_change_of_a_good_file(text, data):
    start = data.draw(st.integers(0, len(text)))
    end = min(len(text), start + data.draw(st.integers(0, 12)))
    middle = data.draw(st.one_of(st.sampled_from([*PIECES, ""]), st.text(max_size=6), SCALARS.map(flow)))
    reads(text[:start] + middle + text[end:])


@given(st.sampled_from([GOOD, CHAIN]), st.data())
@settings(max_examples=200)
def test_any_lines_lost_doubled_or_moved(text, data):
    lines = text.splitlines(keepends=True)
    picked = data.draw(st.lists(st.integers(0, len(lines) - 1), min_size=1, max_size=3))
    for index in picked:
        line = lines.pop(min(index, len(lines) - 1))
        if data.draw(st.booleans()):
            lines.insert(data.draw(st.integers(0, len(lines))), line)
    reads("".join(lines))


@given(st.binary(max_size=100))
def test_any_bytes(content):
    import tempfile

    from crumple.analysis import check

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.yaml"
        path.write_bytes(content)
        assert check(path)


def test_the_good_files_are_accepted():
    assert reads(GOOD)
    assert reads(CHAIN)
    assert canonical(loads(GOOD))
