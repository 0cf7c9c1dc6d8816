"""Problems and titles that the shapes share."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from crumple.errors import Problem
from crumple.registry.quantity import texts_to_si
from crumple.section.section import in_mm


def lengths_of_texts(section: object) -> None:
    """Replace texts with units, such as "50 mm", among the dimensions of a section by lengths [m].

    Raises
    ------
    InputError
        With every text that is no length.
    """
    texts_to_si(section, dict.fromkeys(vars(section), "m"))


def must_not_be_negative(lengths: Mapping[str, float]) -> list[Problem]:
    """Problems of lengths [m] that are negative or not finite."""
    return [
        Problem(
            f"{name.replace('_', ' ')} must not be negative",
            in_mm(length),
            ">= 0 mm",
            "give 0 mm or more",
            name,
        )
        for name, length in lengths.items()
        if not (math.isfinite(length) and length >= 0.0)
    ]


def must_be_below(name: str, length: float, limit: float, meaning: str) -> list[Problem]:
    """Problem of a length [m] that reaches a limit."""
    if length < limit:
        return []
    what = f"the {name.replace('_', ' ')} is not below {meaning}"
    return [Problem(what, in_mm(length), f"< {in_mm(limit)}", "give less, or a larger section", name)]


def in_title(shape: str, sizes: Sequence[float], extras: Mapping[str, float]) -> str:
    """``hat 50 x 40 x 1.5 mm, flanges 20 mm``; extras [m] that are zero are left out."""
    main = f"{shape} {' x '.join(f'{1e3 * size:g}' for size in sizes)} mm"
    return ", ".join([main, *(f"{name} {in_mm(length)}" for name, length in extras.items() if length)])
