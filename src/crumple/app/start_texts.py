"""Inputs to start from: those of the examples that need no other file."""

from __future__ import annotations

from pathlib import Path

from crumple.errors import InputError, Problem

STARTS = {
    "tube_bending": "01_tube_bending.yaml",
    "portal_frame": "04_portal_frame.yaml",
    "bus_ring": "10_bus_ring.yaml",
    "rops": "14_rops.yaml",
    "s_rail": "08_s_rail.yaml",
    "crash_box": "15_crash_box.yaml",
    "buggy": "16_buggy.yaml",
    "box_frame": "09_box_frame.yaml",
    "front_rails": "11_front_rails.yaml",
    "l_frame": "12_l_frame.yaml",
}
"""Files of the examples; the build puts them beside this module (CMakeLists.txt)."""
_BUILT = Path(__file__).parent / "templates"
TEXTS = _BUILT if _BUILT.is_dir() else Path(__file__).parents[3] / "examples"
"""Where they are: in a checkout that is installed as editable they are the examples themselves."""


def start_texts() -> list[dict[str, str]]:
    """Name and title of each."""
    return [{"name": name, "title": _title(start_text(name), name)} for name in STARTS]


def start_text(name: str) -> str:
    """Text of one.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    if name not in STARTS:
        raise InputError(Problem("there is no such start", allowed=", ".join(STARTS)))
    return (TEXTS / STARTS[name]).read_text(encoding="utf-8")


def _title(text: str, name: str) -> str:
    lines = (line for line in text.splitlines() if line.startswith("title:"))
    return next((line.partition(":")[2].strip() for line in lines), name)
