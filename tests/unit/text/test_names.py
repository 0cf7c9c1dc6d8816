"""Lists of names in sentences: complete if short, else the first names and the number of the others."""

import pytest

from crumple.text.names import MOST_NAMED, listed


@pytest.mark.parametrize(
    ("names", "expected"),
    [("", ""), ("a", "a"), ("ab", "a, b"), ("abc", "a, b and 1 more"), ("abcde", "a, b and 3 more")],
)
def test_names_beyond_the_limit_are_counted(names, expected):
    assert listed(names, 2) == expected


def test_a_list_of_the_usual_length_is_complete():
    names = [f"h{i}" for i in range(MOST_NAMED + 1)]
    assert listed(names[:-1]) == ", ".join(names[:-1])
    assert listed(iter(names)) == f"{', '.join(names[:-1])} and 1 more"


def test_the_number_of_others_is_separated_like_names_that_contain_commas():
    assert listed(["a, left", "b, right", "c"], 2, "; ") == "a, left; b, right; and 1 more"


def test_only_items_that_are_named_are_spelled():
    assert listed([1.0, 2.0, "not a number"], 2, spell="{:g} mm".format) == "1 mm, 2 mm and 1 more"
