"""Version of what a result is stored as, and the names that channels had in earlier ones."""

from __future__ import annotations

import re
from collections.abc import Iterable

from crumple.text.names import listed

FORMAT = 2
"""Version of summary.json, histories.csv and the `/crumple` group of result.vtkhdf, written together;
a reader refuses a newer one.  2: axial components of hinges have names of their own."""

_AXIAL = {
    "rotation": "travel",
    "rotation_rate": "rate",
    "plastic_rotation": "plastic_travel",
    "moment": "force",
}
"""Axial components of hinges had the names of rotational ones in format 1; read in this release only."""
_FORMER = re.compile(rf"(hinge\..+\.slip\.[xyz])\.({'|'.join(_AXIAL)})")


def present_name(name: str) -> str:
    """The name of a channel today; of other names the name itself."""
    found = _FORMER.fullmatch(name)
    return f"{found[1]}.{_AXIAL[found[2]]}" if found else name


def former_names_note(names: Iterable[str]) -> str | None:
    """A sentence about names of format 1 among the given ones, None without any."""
    former = [name for name in names if present_name(name) != name]
    if not former:
        return None
    return (
        "Deprecated channel names of result format 1 are read under their present names "
        f"({listed(former, 1)} as {present_name(former[0])}); the next release does not read them. "
        "Solve the analysis again, or rename the channels."
    )
