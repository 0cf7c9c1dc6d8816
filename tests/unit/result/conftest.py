"""Fixtures of the result room."""

import pytest
from tests.support.result.synthetic_tube import tube_result


@pytest.fixture(name="tube")
def _tube():
    return tube_result()
