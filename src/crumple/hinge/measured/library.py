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
from crumple.hinge.measured.law_file import AGAIN, read_law
from crumple.hinge.measured.place_hash import CORNER, JOINT, PLACE, REVISION, content_hash
from crumple.hinge.measured.stored import StoredCurve, StoredLaw
from crumple.portable import refusal_of

ENDING = ".law.yaml"
"""End of the name of a law file in a folder."""
BETWEEN = "---"
"""Line between the laws of one file."""
LARGEST = 2_000_000
"""Bytes of one file; more than any law needs."""
FROZEN = "# Hinge laws of one analysis"
"""Begin of a file with several laws; it has none if the analysis used formulas alone."""
MOST_LAWS = 2_000
"""Laws in one store."""


def read_store(path: Path, *, filling: bool = False) -> tuple[str, ...]:
    """Texts of all laws with a place in a folder or in a file, sorted.

    Parameters
    ----------
    path
        Folder or file.
    filling
        Whether laws are to be added, so that none need be there.

    Raises
    ------
    InputError
        If there is no such folder or file, it is too large, it has no law with a place, or one of its laws
        cannot be read.
    """
    if not path.exists():
        todo = "give a folder of law files, or a file of --freeze-laws; crumple characterise writes laws"
        raise InputError(Problem("there is no such store of laws", str(path), "", todo))
    files = sorted(path.glob(f"*{ENDING}")) if path.is_dir() else [path]
    texts: dict[str, None] = {}
    problems: list[Problem] = []
    without_place = 0
    for file in files:
        try:
            found = _laws_in(file)
            own = [one for one in found if place_of(_law(one)) is not None]
            without_place += len(found) - len(own)
            texts |= dict.fromkeys(own)
        except InputError as error:
            problems += error.problems[:1]
    if problems:
        raise InputError(problems)
    if len(texts) > MOST_LAWS:
        raise InputError(Problem("the store has too many laws", f"{len(texts)}", f"at most {MOST_LAWS}"))
    if not (texts or filling):
        _refuse_unused(path, files, without_place)
    return tuple(sorted(texts))


def _refuse_unused(path: Path, files: list[Path], without_place: int) -> None:
    """Refuse a store of which no structure can use anything."""
    if without_place:
        what, todo = "no law of this store says for which place it is", "name the law in the input instead"
        allowed = "laws of `crumple characterise`"
        raise InputError(Problem(what, str(path), allowed, f"{todo}: `law: {{type: file, file: NAME}}`"))
    if not files:
        what, allowed = "there is no law file in this folder", f"files with names that end in {ENDING}"
        todo = "give the folder that `crumple characterise` wrote to, or leave it out"
        raise InputError(Problem(what, str(path), allowed, todo))


def without_checksum(texts: Iterable[str]) -> int:
    """Number of laws that somebody may have changed: their files have no checksum."""
    return sum(not _law(text).has_checksum for text in texts)


def frozen(texts: Iterable[str], notes: Iterable[str] = ()) -> str:
    """Text of one file with several laws.

    Parameters
    ----------
    texts
        Of law files.
    notes
        Lines for people at its beginning.
    """
    head = [f"{FROZEN}; use them with `--laws THIS_FILE`.", *(f"# {one}" for one in notes)]
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
    content = content_of(file)
    found, own = [], []
    for number, line in enumerate([*content.splitlines(), BETWEEN]):
        if line.rstrip() != BETWEEN:
            own.append(line)
            continue
        if any(one.strip() and not one.lstrip().startswith("#") for one in own):
            text = "\n".join(own) + "\n"
            # empty lines in place of the laws before it: errors name the line of the file
            read_law("\n" * (number - len(own)) + text, str(file))
            found.append(text)
        own = []
    if not (found or content.startswith(FROZEN)):
        read_law("", str(file))
    return found


def content_of(file: Path) -> str:
    """Text of a file of laws.

    Raises
    ------
    InputError
        If it cannot be read, is too large, or is no text.
    """
    try:
        with file.open("rb") as opened:
            content = opened.read(LARGEST + 1)
        if len(content) > LARGEST:
            allowed, todo = f"at most {LARGEST / 1e6:g} MB", "give a file that Crumple wrote"
            raise InputError(Problem("the file of laws is too large", "", allowed, todo, file=str(file)))
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        what, allowed = "the law file is not a text in UTF-8", "a law file that Crumple wrote"
        raise InputError(Problem(what, "", allowed, AGAIN, file=str(file))) from None
    except OSError as error:
        what = f"the law file cannot be read: {refusal_of(error)}"
        raise InputError(Problem(what, "", "", AGAIN, file=str(file))) from None
