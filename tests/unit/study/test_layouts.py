"""Several base inputs in one study: each row is that of its own base, mistakes have lines."""

import csv
from pathlib import Path

import pytest
from tests.support.short_layouts import short_layout

from crumple.errors import InputError
from crumple.study import LoadedStudy, run_study

PLAIN, BEAM, POST = (
    Path(f"examples/layouts/{name}.yaml").resolve() for name in ("plain", "strong_beam", "middle_post")
)
WALL = "{path: sections.tube.thickness, low: 2 mm, high: 3 mm}"
LAYOUT = "{path: base}"


def written(folder, bases, variables, method="{type: sobol, rows: 8, seed: 2}", more=""):
    folder.mkdir(exist_ok=True)
    file = folder / "study.yaml"
    lines = [
        "crumple_study: 1",
        *bases,
        "variables:",
        *(f"  {name}: {one}" for name, one in variables.items()),
    ]
    lines += ["responses:", "  intrusion: {channel: intrusion, take: final}", "  mass: {mass: true}"]
    file.write_text("\n".join([*lines, f"method: {method}", more]) + "\n", encoding="utf-8")
    return file


def both(*names):
    return ["bases:", *(f"  - {name}" for name in names)]


def table(folder):
    return list(csv.DictReader((folder / "study.csv").read_text(encoding="utf-8").splitlines()))


@pytest.mark.slow
def test_rows_are_those_of_their_base(tmp_path):
    study = LoadedStudy(written(tmp_path / "all", both(PLAIN, BEAM), {"layout": LAYOUT, "wall": WALL}))
    run_study(study, tmp_path / "all", 2)
    rows = table(tmp_path / "all")
    assert {row["layout"] for row in rows} == {"plain", "strong_beam"}
    for name, base in (("plain", PLAIN), ("strong_beam", BEAM)):
        own = [row for row in rows if row["layout"] == name]
        (tmp_path / "points.csv").write_text("\n".join(["wall", *(row["wall"] for row in own)]) + "\n")
        points = f"{{type: points, file: {tmp_path / 'points.csv'}}}"
        alone = LoadedStudy(written(tmp_path / name, [f"base: {base}"], {"wall": WALL}, points))
        run_study(alone, tmp_path / name)
        keys = "wall", "intrusion", "mass", "status"
        expected = [[row[key] for key in keys] for row in table(tmp_path / name)]
        assert [[row[key] for key in keys] for row in own] == expected


def test_the_best_layout_is_found_and_verified_with_its_own_input(tmp_path):
    more = "objective: {minimise: mass}\nconstraints: [{response: intrusion, at_least: -135 mm}]\n"
    more += "verify: {best: 1, sample: 2, fidelity: multibody}"
    variables = {
        "layout": "{path: base, values: [plain, strong_beam]}",
        "wall": WALL.replace("}", ", steps: 2}"),
    }
    bases = [short_layout(path.stem, tmp_path) for path in (PLAIN, BEAM, POST)]
    file = written(tmp_path, both(*bases), variables, "{type: grid}", more)
    _, answer = run_study(LoadedStudy(file), tmp_path)
    assert answer.rows == answer.complete == 4
    assert answer.best["variables"] == {"layout": "strong_beam", "wall": 0.002}
    checked = answer.verification["best"]
    assert checked["variables"] == answer.best["variables"]
    assert checked["fast"]["intrusion"] == pytest.approx(checked["slow"]["intrusion"], rel=0.01)
    before = (tmp_path / "study.csv").read_bytes()
    run_study(LoadedStudy(file), tmp_path)
    assert (tmp_path / "study.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("bases", "variables", "method", "said"),
    [
        (both(PLAIN, PLAIN), {"layout": LAYOUT}, "", "two bases have the same name"),
        (both(PLAIN, BEAM), {"wall": WALL}, "", "one variable chooses among several bases"),
        ([f"base: {PLAIN}"], {"layout": LAYOUT}, "", "one variable chooses among several bases"),
        (both(PLAIN, BEAM), {"layout": "{path: base, values: [plane]}"}, "", "there is no such base"),
        (both(PLAIN, BEAM), {"layout": LAYOUT, "wall": WALL}, "{type: lightest, rows: 2}", "has one base"),
    ],
)
def test_mistakes_have_lines(tmp_path, bases, variables, method, said):
    file = written(tmp_path, bases, variables, method or "{type: sobol, rows: 2}")
    with pytest.raises(InputError, match=said) as refused:
        run_study(LoadedStudy(file), tmp_path)
    assert all(problem.file == str(file) and problem.line > 1 for problem in refused.value.problems)
