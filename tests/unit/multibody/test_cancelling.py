"""A structure of many members is lowered with frequent questions whether to go on; calls are counted."""

import sys

import pytest
from tests.support.long_chains import chain_of_members, member_of_bars

from crumple import cancelling
from crumple.analysis import loads
from crumple.multibody import Run, solve_multibody
from crumple.structure.remembered import forget

MOST_CALLS = 35
"""Calls of functions between two questions, for each member or bar: 0.1 s for 10 000 of them."""
NUMBERS = 400, 800


def longest_silence(analysis):
    """Most calls of functions between two questions, from the begin of a solve to its first step."""
    calls, longest = 0, 0
    asks = cancelling.go_on.__code__
    begun = []

    def seen(frame, event, argument):
        nonlocal calls, longest
        if event in ("call", "c_call") and not begun:
            calls += 1
            if frame.f_code is asks:
                longest, calls = max(longest, calls), 0

    run = Run(analysis.duration, analysis.output_interval, analysis.multibody, analysis.outputs)
    before = sys.getprofile()
    sys.setprofile(seen)
    try:
        solve_multibody(analysis.structure, run, begun.append, lambda: bool(begun))
    finally:
        sys.setprofile(before)
    return max(longest, calls)


@pytest.mark.parametrize("chain", [chain_of_members, member_of_bars])
def test_lowering_asks_often(chain):
    forget()
    # laws are sampled at the first; the question does not depend on the size
    longest_silence(loads(chain(2)))
    few, many = (longest_silence(loads(chain(number))) for number in NUMBERS)
    assert many - few < MOST_CALLS * (NUMBERS[1] - NUMBERS[0])
