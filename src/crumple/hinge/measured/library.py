"""Laws of a store, by the place that they were characterised for.

A store is a folder of law files, as `crumple characterise` writes it, or one file with several laws between
lines `---`, as `--freeze-laws` writes it.  Laws without the hash of their place (from `crumple hinge --save`)
are left out: a hinge uses them if it names them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

from crumple.errors import InputError, Problem
from crumple.hinge.measured.law_file import read_law
from crumple.hinge.measured.place_hash import CORNER, JOINT, PLACE, REVISION, content_hash
from crumple.hinge.measured.stored import StoredCurve, StoredLaw

ENDING = ".law.yaml"
"""End of the name of a law file in a folder."""
BETWEEN = "---"
"""Line between the laws of one file."""
LARGEST = 2_000_000
"""Bytes of one file; more than any law needs."""
MOST_LAWS = 2_000
"""Laws in one store."""


def read_store(path: Path) -> tuple[str, ...]:
    """Texts of all laws with a place in a folder or in a file, sorted.

    Raises
    ------
    InputError
        If there is no such folder or file, it is too large, or one of its laws cannot be read.
    """
    if not path.exists():
        todo = "give a folder of law files, or a file of --freeze-laws; crumple characterise writes laws"
        raise InputError(Problem("there is no such store of laws", str(path), "", todo))
    files = sorted(path.glob(f"*{ENDING}")) if path.is_dir() else [path]
    texts: dict[str, None] = {}
    problems: list[Problem] = []
    for file in files:
        try:
            texts |= dict.fromkeys(one for one in _laws_in(file) if place_of(_law(one)) is not None)
        except InputError as error:
            problems += error.problems[:1]
    if problems:
        raise InputError(problems)
    if len(texts) > MOST_LAWS:
        raise InputError(Problem("the store has too many laws", f"{len(texts)}", f"at most {MOST_LAWS}"))
    return tuple(sorted(texts))


def frozen(texts: Iterable[str], notes: Iterable[str] = ()) -> str:
    """Text of one file with several laws.

    Parameters
    ----------
    texts
        Of law files.
    notes
        Lines for people at its beginning.
    """
    head = ["# Hinge laws of one analysis; use them with `--laws THIS_FILE`.", *(f"# {one}" for one in notes)]
    return "\n".join(head) + "\n" + "".join(f"{BETWEEN}\n{text}" for text in sorted(set(texts)))


def by_place(texts: Iterable[str]) -> Mapping[str, str]:
    """Text of the law of each place.

    Of several laws of one place that of the latest method is taken, then the one with a known error, then the
    one with the largest rotation, then the first by its text: the order of files in a folder does not matter.
    """
    best: dict[str, str] = {}
    for text in sorted(texts):
        place = place_of(_law(text))
        if place is not None and (place not in best or _rank(text) > _rank(best[place])):
            best[place] = text
    return best


def place_of(law: StoredLaw) -> str | None:
    """Hash of the place that a law was characterised for, if it has one."""
    return dict(law.origin).get(PLACE)


def is_of_joint(law: object) -> bool:
    """Whether a law is of a corner or a joint; its elastic stiffness adds to that of the members."""
    return isinstance(law, StoredLaw) and not {CORNER, JOINT}.isdisjoint(dict(law.origin))


def hash_of_law(text: str) -> str:
    """Hash of the content of a law file: of the text that a program writes, without comments."""
    return content_hash(text)


def mirrored(law: StoredLaw) -> StoredLaw:
    """The law of a hinge whose axis points the other way: both senses exchanged."""

    def swapped(curve: StoredCurve | None) -> StoredCurve | None:
        return None if curve is None else StoredCurve(curve.negative, curve.positive)

    curve = StoredCurve(law.curve.negative, law.curve.positive)
    return replace(law, curve=curve, lower=swapped(law.lower), upper=swapped(law.upper))


@cache
def _law(text: str) -> StoredLaw:
    return read_law(text)


def _rank(text: str) -> tuple[int, bool, float]:
    law = _law(text)
    revision, validity = dict(law.origin).get(REVISION, ""), law.validity
    return (
        int(revision) if revision.isdecimal() else 0,
        validity.uncertainty is not None,
        validity.rotation_max,
    )


def _laws_in(file: Path) -> list[str]:
    """Texts of the laws of one file, each checked."""
    try:
        if file.stat().st_size > LARGEST:
            raise InputError(Problem("the file of laws is too large", str(file), f"{LARGEST / 1e6:g} MB"))
        content = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(Problem(f"the law file cannot be read: {error}", str(file))) from None
    found, own = [], []
    for line in [*content.splitlines(), BETWEEN]:
        if line.rstrip() != BETWEEN:
            own.append(line)
            continue
        if any(one.strip() and not one.lstrip().startswith("#") for one in own):
            found.append("\n".join(own) + "\n")
        own = []
    for text in found:
        read_law(text, str(file))
    return found
