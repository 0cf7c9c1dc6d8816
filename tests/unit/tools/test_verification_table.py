"""The pages of the verification: output of their tool for a test run, and every module names its kind."""

import ast
import json
from pathlib import Path

import pytest
from tools.verification_table import anchor, checks_of, main, share_of_tolerance, worst

MODULES = sorted(Path("tests/verification").glob("**/test_*.py"))
FIGURE = {
    "name": "angle",
    "value": 1.02,
    "expected": 1.0,
    "tolerance": 0.04,
    "relative": False,
    "unit": "rad",
}
DOC = (
    "Bars that fall: against\na closed form.\n\nKind: closed form; published.  Source: derived here; quoted."
)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_every_module_names_its_kind_and_source(path):
    doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    assert checks_of(str(path), doc)
    # the table has a line of its own for each
    assert len(doc.partition("\n")[0]) > 20


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("", "lacks a line"),
        ("Kind: guess.  Source: read.", "guess: allowed are closed form"),
        ("Kind: published.  Source: heard.", "heard: allowed are"),
        ("Kind: published; invariant.  Source: read.", "2 kinds of check, 1 sources"),
    ],
)
def test_refuses_modules_that_do_not(line, message):
    with pytest.raises(SystemExit, match=message):
        checks_of("test_x.py", f"Title.\n\n{line}\n")


def test_worst_error_is_over_the_tolerance():
    relative = FIGURE | {"value": 198.0, "expected": 200.0, "tolerance": 0.02, "relative": True}
    assert share_of_tolerance(FIGURE) == pytest.approx(0.5)
    assert share_of_tolerance(relative) == pytest.approx(0.5)
    assert share_of_tolerance(FIGURE | {"value": 1.0, "tolerance": 0.0}) == 0.0
    assert worst([FIGURE, FIGURE | {"value": 1.03}]) == "0.75"
    assert worst([FIGURE | {"value": 1.0}]) == "below 0.01"
    assert worst([]) == "-"


def test_both_pages(tmp_path):
    modules = {
        "tests/verification/planar/test_a.py": {
            "doc": DOC,
            "outcomes": {"test_one": "passed", "test_two": "skipped"},
            "figures": [FIGURE | {"passed": True}, FIGURE | {"value": 1.05, "passed": False}],
        }
    }
    (tmp_path / "figures.json").write_text(json.dumps(modules), encoding="utf-8")
    main(str(tmp_path / "figures.json"), str(tmp_path))
    first = (tmp_path / "verification.md").read_text(encoding="utf-8")
    rest = (tmp_path / "verification_appendix.md").read_text(encoding="utf-8")
    link = f"verification_appendix.md#{anchor('Bars that fall: against')}"
    cells = ("closed form; published", "not needed; no", "1.25", "1 passed, 1 skipped")
    row = f"| [Bars that fall: against]({link}) | {' | '.join(cells)} |"
    assert row in first
    assert "2 figures; 1 of them is outside" in first
    assert "## Bars that fall: against\n" in rest
    assert "Kind:" not in rest
    assert "| angle | 1.05 rad | 1 rad | 0.04 rad | **no** |" in rest
