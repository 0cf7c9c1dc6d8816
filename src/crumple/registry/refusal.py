"""Errors from inside a validator; pydantic is imported only where it is in use."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

from crumple.errors import Problem


def refuse(
    what: str, *, allowed: str = "", todo: str = "", key: str = "", problems: Sequence[Problem] = ()
) -> NoReturn:
    """Refuse a value from inside a validator.

    Parameters
    ----------
    what
        The mistake in one sentence.
    allowed, todo
        As in `crumple.errors.Problem`.
    key
        Name of the wrong key, if the validator checks the whole part.
    problems
        Ready problems that replace this one, such as the bad rows of a curve file.
    """
    from pydantic_core import PydanticCustomError  # noqa: PLC0415  (packages below the input need none)

    context = {"what": what, "allowed": allowed, "todo": todo, "key": key, "problems": list(problems)}
    raise PydanticCustomError("refused", "{what}", context)
