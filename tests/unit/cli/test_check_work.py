"""The work of checking a valid input is linear in its size: calls are counted, not time.

`python -m tests.unit.cli.test_check_work` prints the processor time of chains of 1 000 to 10 000.
"""

import sys
from itertools import pairwise

import pytest
from tests.support.long_chains import chain_of_members, member_of_bars

from crumple.cli.check import check
from crumple.structure.hinges import hinges
from crumple.structure.remembered import forget

SIZES = (100, 200, 400)
MOST_CALLS = {chain_of_members: 950, member_of_bars: 310}
"""Calls, of Python and of C, for a further member or bar; some hundredths above what is needed."""


def calls_of(work):
    """How often work calls a function."""
    count = 0

    def seen(frame, event, argument):
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count


def written(chain, number, folder):
    path = folder / f"{number}.yaml"
    path.write_text(chain(number))
    return path


@pytest.mark.parametrize("chain", [chain_of_members, member_of_bars])
def test_calls_grow_with_the_size_and_no_faster(chain, tmp_path):
    paths = [written(chain, number, tmp_path) for number in SIZES]
    # modules are loaded, and laws sampled, at the first
    check(paths[0])
    counts = []
    for path in paths:
        forget()
        counts.append(calls_of(lambda path=path: check(path)))
    further = [(b - a) / (m - n) for (a, b), (n, m) in zip(pairwise(counts), pairwise(SIZES), strict=True)]
    print(further)
    assert further[1] <= 1.02 * further[0]
    assert max(further) < MOST_CALLS[chain]


def test_hinges_are_placed_once(tmp_path, monkeypatch):
    placed, place = [], hinges._placed
    monkeypatch.setattr(hinges, "_placed", lambda *given: placed.append(given[1].name) or place(*given))
    check(written(chain_of_members, 20, tmp_path))
    assert sorted(placed) == sorted({*placed})
    assert len(placed) == 20


if __name__ == "__main__":
    import gc
    import tempfile
    import time
    from pathlib import Path

    from crumple.cli.main import COLLECTED_EVERY

    gc.set_threshold(COLLECTED_EVERY)
    for chain in (chain_of_members, member_of_bars):
        for number in (1000, 3000, 10_000):
            with tempfile.TemporaryDirectory() as folder:
                path = written(chain, number, Path(folder))
                begin = time.process_time()
                check(path)
                print(f"{chain.__name__} {number}: {time.process_time() - begin:.2f} s of processor time")
