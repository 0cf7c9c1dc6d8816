"""`crumple layouts`: a folder and a row for each file, a refusal is a row too."""

import csv
from pathlib import Path

import pytest

EXAMPLE = Path("examples/01_tube_bending.yaml")


@pytest.fixture(name="files")
def _files(tmp_path):
    text = EXAMPLE.read_text(encoding="utf-8").replace("pictures: [0 ms, 20 ms", "pictures: [20 ms")
    files = []
    for name, change in (("thin", "2 mm"), ("thick", "3 mm"), ("wrong", "3 kg")):
        file = tmp_path / f"{name}.yaml"
        file.write_text(text.replace("2.65 mm", change), encoding="utf-8")
        files.append(file)
    return files


def test_layouts_are_solved_and_tabled(run_command, files, tmp_path):
    code, out, err = run_command("layouts", *files[:2], "--out", tmp_path / "out", "--title", "Walls")
    # where it takes long, it says how far it is
    told = [line for line in err.splitlines() if not line.startswith("solving:")]
    assert (code, told) == (0, [])
    assert "thin" in out
    assert "thick" in out
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<h1>Walls</h1>" in page
    for name in ("thin", "thick"):
        assert (tmp_path / "out" / name / "summary.json").exists()
    rows = (tmp_path / "out" / "layouts.csv").read_text(encoding="utf-8").splitlines()
    assert float(rows[1].split("complete,,")[1].split(",")[0]) == pytest.approx(2.24, rel=5e-3)


def test_the_order_within_the_bands_is_stated_unless_it_is_switched_off(run_command, tmp_path):
    text = Path("examples/12_l_frame.yaml").read_text(encoding="utf-8")
    files = [tmp_path / "given.yaml", tmp_path / "again.yaml"]
    for file in files:
        file.write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    code, told, _ = run_command("layouts", *files, "--out", out)
    assert code == 0
    assert "energy.dissipated: ranges overlap, so the order is open, for given and again." in told
    assert "the same with all laws low and with all laws high" in told
    assert "Order of the layouts by size" in (out / "report.html").read_text(encoding="utf-8")
    head, row, _ = (out / "layouts.csv").read_text(encoding="utf-8").splitlines()
    cells = dict(zip(head.split(","), next(csv.reader([row])), strict=True))
    low, high = (float(cells[f"energy.dissipated final {word} [J]"]) for word in ("least", "largest"))
    assert low < high
    assert low <= float(cells["energy absorbed [J]"]) <= high
    code, told, _ = run_command("layouts", *files, "--out", out, "--no-law-range")
    assert code == 0
    assert "energy.dissipated: " not in told
    assert "Order of the layouts" not in (out / "report.html").read_text(encoding="utf-8")


def test_a_refused_layout_is_a_row(run_command, files, tmp_path):
    code, out, _ = run_command("layouts", *files[1:], "--out", tmp_path / "out")
    assert code == 1
    assert "refused" in out
    assert "wrong: " in out
    assert "sections.tube.thickness" in out.replace("\n", " ")


def test_files_of_one_name_get_folders_of_their_own(run_command, files, tmp_path):
    code, _, _ = run_command("layouts", files[0], files[0], "--out", tmp_path / "out")
    assert code == 0
    assert (tmp_path / "out" / "thin-1" / "report.html").exists()
    assert (tmp_path / "out" / "thin-2" / "report.html").exists()
