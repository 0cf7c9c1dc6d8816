"""Limits on the number of parts of each kind, checked before anything is built.

The limits are stated in docs/input.md.  Each is far above what a design model needs, and low enough that the
model fits into memory and a check takes seconds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from crumple.errors import Problem
from crumple.structure.hinges.asked import automatic_of, folds_at_ends
from crumple.structure.keys.outputs import Outputs
from crumple.structure.keys.spot_welds import MOST_SPOTS
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names

MOST_MEMBERS = 20_000
MOST_HINGES = 20_000
"""Hinges of a structure: between bars, given, and put by `hinges: auto`."""
MOST_OBSTACLES = 100
MOST_FIELDS = 100
"""Velocity fields; each goes over all nodes."""
MOST_WELD_ENTRIES = 1_000
MOST_OUTPUTS = 1_000
"""Entries of each group of outputs."""
MOST_VALUES = 100_000_000
"""Numbers in the histories of a run: 0.8 GB."""
PER_HINGE, PER_NODE = 25, 18
"""Histories of a hinge with the bar beyond it, and of a node."""


def limit_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Groups with too many entries."""
    for key, noun, most in (
        ("members", "members", MOST_MEMBERS),
        ("obstacles", "obstacles", MOST_OBSTACLES),
        ("initial_velocity", "velocity fields", MOST_FIELDS),
        ("spot_welds", "entries of spot welds", MOST_WELD_ENTRIES),
    ):
        yield from _counted(key, noun, len(getattr(structure, key)), most)
    for name, count in hinge_counts(structure).items():
        if count > MOST_HINGES:
            todo = "give fewer bars, or a larger spacing"
            what = f"the member '{name}' has too many hinges"
            yield Problem(what, _number(count), f"at most {MOST_HINGES}", todo, f"members.{name}")
    total = sum(hinge_counts(structure).values())
    if total > MOST_HINGES:
        yield from _counted("members", "hinges", total, MOST_HINGES)


def pitch_limit_problems(structure: StructureParts) -> Iterator[Problem]:
    """Lines with too many spots."""
    for name, welds in structure.spot_welds.items():
        if welds.pitch is None or not (welds.end or structure.has_line(welds.members[0])):
            continue
        end = welds.end or structure.frame_of(welds.members[0]).length
        if end - welds.start > MOST_SPOTS * welds.pitch:
            came, todo = f"{1e3 * welds.pitch:g} mm", "give a larger pitch"
            what, allowed = "the line has too many spot welds", f"at most {MOST_SPOTS}"
            yield Problem(what, came, allowed, todo, f"spot_welds.{name}.pitch")


def output_limit_problems(outputs: Outputs) -> Iterator[Problem]:
    """Groups of outputs with too many entries."""
    for key in ("nodes", "section_rotations", "section_forces", "distances", "clearances", "filters"):
        yield from _counted(f"outputs.{key}", "outputs", len(getattr(outputs, key)), MOST_OUTPUTS)


def history_problems(structure: StructureParts, outputs: Outputs, samples: float) -> Iterator[Problem]:
    """Histories that would not fit the memory."""
    hinges = sum(hinge_counts(structure).values())
    values = samples * (PER_HINGE * hinges + PER_NODE * len(outputs.nodes))
    if values > MOST_VALUES:
        what = f"{samples:.3g} samples of {hinges:.0f} hinges give {values:.3g} numbers"
        todo = "give a longer interval in 'every', or fewer hinges"
        yield Problem(what, "", f"at most {MOST_VALUES:.3g}", todo, "outputs.every")


def hinge_counts(structure: StructureParts) -> dict[str, float]:
    """Hinges of every member, without placing any."""
    return structure.kept.once(
        "hinge counts", "", lambda: {name: _hinges_of(structure, name) for name in structure.members}
    )


def _hinges_of(structure: StructureParts, name: str) -> float:
    spec = structure.members[name]
    asked = automatic_of(structure, name)
    count: float = spec.bars.number - 1 + len(spec.given_hinges)
    if asked is None:
        return count + 2.0 * folds_at_ends(structure, name)
    if asked.spacing is None or not structure.has_line(name):
        return count + 2
    return count + 2 + math.ceil(structure.frame_of(name).length / asked.spacing)


def _counted(where: str, noun: str, count: float, most: int) -> Iterator[Problem]:
    if count > most:
        yield Problem(
            f"there are too many {noun}", _number(count), f"at most {most}", "leave some out", where
        )


def _number(count: float) -> str:
    return f"{count:.0f}" if count < 1e7 else f"{count:.3g}"
