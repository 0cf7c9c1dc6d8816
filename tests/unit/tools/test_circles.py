"""What `tools/circles.py` refuses; Crumple itself is held against it by `make check`."""

import pytest
from tools.circles import circle, main


@pytest.mark.parametrize(
    "back",
    [
        "from pack.room import first",
        "import pack.room.first",
        "from . import first",
        "from .first import name",
        "from ..room.first import name",
        "def later():\n    from pack.room.first import name",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from pack.room.first import name",
    ],
)
def test_two_modules_that_import_each_other_are_a_circle_wherever_the_import_stands(tmp_path, capsys, back):
    package = written(tmp_path, {"room/first": "from pack.room.second import name", "room/second": back})
    found = circle(package)
    assert found[0] == found[-1]
    assert set(found) == {"pack.room.first", "pack.room.second"}
    assert main(package) == 1
    assert "pack.room.first -> pack.room.second" in capsys.readouterr().out


def test_one_way_is_no_circle_and_the_public_names_may_come_from_everywhere(tmp_path, capsys):
    files = {
        "first": "from pack.second import name\nimport os",
        "second": "",
        "__init__": "from pack.first import name",
    }
    assert main(written(tmp_path, files)) == 0
    assert "no module" in capsys.readouterr().out


def written(folder, files):
    package = folder / "pack"
    for name, text in {"__init__": "", "room/__init__": "", **files}.items():
        path = package / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return package
