"""The inputs to start from are examples, all of which the build takes along."""

import re
from pathlib import Path

import pytest

pytest.importorskip("starlette")

from crumple.analysis import loads
from crumple.app.answer import Answering, Job
from crumple.app.start_texts import STARTS, start_text, start_texts
from crumple.errors import InputError

ROOT = Path(__file__).parents[3]


def test_each_is_an_input_that_stands_alone(tmp_path):
    for name, file in STARTS.items():
        assert start_text(name) == (ROOT / "examples" / file).read_text(encoding="utf-8")
        loads(start_text(name), directory=tmp_path)
    assert all(one["title"] and ":" not in one["title"] for one in start_texts())


@pytest.mark.parametrize("name", STARTS)
def test_each_is_solved_and_shown(name):
    job = Job("solve", ((f"{name}.yaml", start_text(name)),), quick=True)
    answer = Answering()(job, lambda share: True, lambda: False)
    assert answer["problems"] == []
    assert answer["level"] in ("good", "caution")
    assert answer["scene"] is not None
    assert answer["curves"]["all"]


def test_the_build_takes_them_along():
    rules = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    assert set(re.findall(r"examples/(\w+\.yaml)", rules)) == set(STARTS.values())


def test_another_is_refused():
    with pytest.raises(InputError, match="tube_bending"):
        start_text("../tube_bending")
