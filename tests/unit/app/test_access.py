"""A code works once and not for ever; a token is known only to the server that gave it."""

import pytest

pytest.importorskip("starlette")

from crumple.app.access import CODE_SECONDS, MOST_CODES, Access


def test_a_code_gives_one_token():
    access = Access()
    code = access.code()
    token = access.exchange(code)
    assert access.knows(token)
    assert access.exchange(code) is None
    assert not Access().knows(token)
    assert not access.knows(code)
    assert not access.knows(None)
    assert not access.knows(["x"])


@pytest.mark.parametrize("wrong", ["", "x", "ü", "\ud800"])
def test_another_code_gives_none(wrong):
    access = Access()
    code = access.code()
    assert access.exchange(wrong) is None
    assert access.exchange(code[:-1]) is None
    assert access.exchange(code) is not None


def test_a_code_expires_and_only_a_few_wait():
    now = [0.0]
    access = Access(lambda: now[0])
    late = access.code()
    now[0] = CODE_SECONDS + 1.0
    assert access.exchange(late) is None
    codes = [access.code() for _ in range(MOST_CODES + 1)]
    assert access.exchange(codes[0]) is None
    assert access.exchange(codes[-1]) is not None
