"""The law file, format 1: one hinge law as readable YAML that is read back exactly.

Every number carries its unit and is written with the digits that give the same float back; texts stand in
double quotes.  Keys are documented in docs/law_file.md; unknown ones are refused.  A checksum of the lines
shows changes by accident; who changes a law on purpose deletes it, and the law then says so.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from crumple.errors import InputError, Problem
from crumple.hinge.band import Band
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.measured.law_group import Group
from crumple.hinge.measured.place_hash import content_hash
from crumple.hinge.measured.stored import StoredCurve, StoredLaw
from crumple.hinge.rate import HingeRate
from crumple.hinge.record.sampling import sampled_envelope
from crumple.hinge.stop import Stop
from crumple.text.plain_yaml import read_plain_yaml

FORMAT = 1
"""Version of the format; a reader refuses others."""
HEAD = """# A collapse law for Crumple: capacity of one plastic hinge against its rotation.
# Read it with `law: {type: file, file: NAME}`; docs/law_file.md explains every key.
# After a change by hand delete the line `checksum`: the file is refused with one that does not fit.
"""
CHECKSUM = "checksum"
"""Key of the hash of all lines of a file but comments and its own."""
AGAIN = "restore the file, or write it again with `crumple characterise` or `crumple hinge --save`"
"""What to do about a file that cannot be read."""
_KEYS = (
    *("crumple_law", CHECKSUM, "title", "law", "origin", "source", "range", "softening", "elastic_stiffness"),
    *("jamming_angle", "rate", "stop", "curve", "lower", "upper"),
)
_NONE = "none"
UNITS = {False: {"rotation": "rad", "moment": "N*m"}, True: {"slip": "m", "force": "N"}}
"""Units of the points of a curve, by whether it is a law along the member."""


def stored_law(
    law: HingeLaw, origin: Mapping[str, str], *, error: float = 1e-4, band: Band | None = None
) -> StoredLaw:
    """Sample a law for its file.

    Parameters
    ----------
    law
        Any law of bending or torsion.
    origin
        Origin: ``method`` (formula, library, estimate, measured or shell) at least; section, axis, material,
        made_by and any information needed to reproduce it.
    error
        Bound of the relative sampling error.
    band
        Edges that are not the nominal law times a factor.

    Returns
    -------
    StoredLaw
        Equal to what `read_law` gives of its text.

    Raises
    ------
    InputError
        If the method is missing.
    """
    if "method" not in origin:
        allowed = "formula, library, estimate, measured, shell"
        raise InputError(Problem("the origin has no method", "", allowed, "", "origin"))
    if isinstance(law, StoredLaw):
        return law
    edges = (None, None) if band is None else (_sampled(band.lower, error), _sampled(band.upper, error))
    return StoredLaw(
        law.title,
        law.name,
        tuple((str(key), str(value)) for key, value in origin.items()),
        _sampled(law, error),
        law.source,
        law.validity,
        law.softening_variable,
        law.elastic_stiffness,
        law.jamming_angle,
        law.rate,
        law.stop,
        error,
        *edges,
    )


def write_law(law: StoredLaw) -> str:
    """Text of a law file; `read_law` of it is the same law."""
    lines = [
        f"crumple_law: {FORMAT}",
        f"title: {_quoted(law.title)}",
        f"law: {_quoted(law.law)}",
        "origin:",
        *(f"  {_quoted(key)}: {_quoted(value)}" for key, value in law.origin),
        "source:",
        f"  citation: {_quoted(law.source.citation)}",
        f"  trust: {law.source.trust.name.lower()}",
        f"  note: {_quoted(law.source.note)}",
        "range:",
        f"  rotation_max: {_number(law.validity.rotation_max, 'm' if law.slip else 'rad')}",
        f"  basis: {_quoted(law.validity.basis)}",
        f"  uncertainty: {_number(law.validity.uncertainty, '')}",
        "  warnings:" + ("" if law.validity.warnings else " []"),
        *(f"    - {_quoted(sentence)}" for sentence in law.validity.warnings),
        f"softening: {law.softening_variable.value}",
        f"elastic_stiffness: {_number(law.elastic_stiffness, 'N*m/rad')}",
        f"jamming_angle: {_number(law.jamming_angle, 'rad')}",
        *_rate_lines(law.rate),
        *_stop_lines(law.stop),
        *_curve_lines("curve", law.curve, law),
    ]
    for name, edge in (("lower", law.lower), ("upper", law.upper)):
        lines += [] if edge is None else _curve_lines(name, edge, law)
    if law.has_checksum:
        lines.insert(1, f"{CHECKSUM}: {_quoted(checksum_of(lines))}")
    return HEAD + "\n".join(lines) + "\n"


def checksum_of(lines: Iterable[str]) -> str:
    """Hash of the lines of a law file without comments, empty ones, blanks at ends and the checksum's own.

    Line ends and notes, which editors and version control change, do not count.
    """
    kept = (line.rstrip() for line in lines)
    counted = (one for one in kept if one and not one.lstrip().startswith("#"))
    return content_hash("\n".join(one for one in counted if not one.startswith(f"{CHECKSUM}:")))


def read_law(text: str, file: str = "") -> StoredLaw:
    """Law of a law file's text.

    Parameters
    ----------
    text
        The content.
    file
        Name for messages.

    Returns
    -------
    StoredLaw
        Frozen law.

    Raises
    ------
    InputError
        With file and line: not YAML, another format, a key that is missing, unknown or wrong, or a content
        that its checksum does not fit.
    """
    try:
        top = _top(text, file)
        law = _law(top)
        if CHECKSUM in top.entries and top.text(CHECKSUM) != checksum_of(text.splitlines()):
            what = "the content of this law file was changed after it was written: its checksum does not fit"
            todo = f"{AGAIN}; if the change is meant, delete the line `{CHECKSUM}`: results then say so"
            top.refuse(top.take(CHECKSUM), what, "", todo, CHECKSUM)
    except InputError as error:
        told = [replace(one, todo=one.todo or AGAIN) for one in error.problems]
        raise InputError(told) from None
    return law


def _top(text: str, file: str) -> Group:
    """Keys of a law file of the known format."""
    allowed = f"a file with the key crumple_law: {FORMAT}"
    if not text.strip():
        raise InputError(Problem("the law file is empty", "", allowed, AGAIN, file=file))
    top = Group(read_plain_yaml(text, file), file, 1, "")
    if "crumple_law" not in top.entries:
        raise InputError(Problem("this is not a law file", ", ".join(top.entries)[:60], allowed, file=file))
    version = top.take("crumple_law")
    if version.value != str(FORMAT):
        todo = f"use the version of Crumple that wrote it; or {AGAIN}"
        top.refuse(version, "this is not a law file of a known format", f"crumple_law: {FORMAT}", todo)
    top.only(_KEYS)
    return top


def _law(top: Group) -> StoredLaw:
    """Law of the keys of a file."""
    origin, source, limits = top.group("origin"), top.group("source"), top.group("range")
    origin.take("method")
    source.only(("citation", "trust", "note"))
    limits.only(("rotation_max", "basis", "uncertainty", "warnings"))
    slip = "slip" in top.group("curve").group("units").entries
    validity = Validity(
        _needed(limits.number("rotation_max", "m" if slip else "rad")),
        limits.text("basis"),
        limits.texts("warnings"),
        limits.number("uncertainty", "1", none=True),
    )
    curve, error = _curve(top.group("curve"), slip)
    lower, upper = (
        _curve(top.group(name), slip)[0] if name in top.entries else None for name in ("lower", "upper")
    )
    return StoredLaw(
        top.text("title"),
        top.text("law"),
        tuple((key, origin.text(key)) for key in origin.entries),
        curve,
        Source(source.text("citation"), source.choice("trust", _TRUST), source.text("note")),
        validity,
        top.choice("softening", {one.value: one for one in SofteningVariable}),
        top.number("elastic_stiffness", "N*m/rad", none=True),
        top.number("jamming_angle", "rad", none=True),
        _rate(top),
        _stop(top),
        error,
        lower,
        upper,
        slip,
        CHECKSUM in top.entries,
    )


_TRUST = {one.name.lower(): one for one in Trust}


def _sampled(law: HingeLaw, error: float) -> StoredCurve:
    positive, negative = (sampled_envelope(law, sense, error) for sense in (1, -1))
    return StoredCurve(
        *((tuple(e.rotation.tolist()), tuple(e.moment.tolist())) for e in (positive, negative))
    )


def _quoted(text: str) -> str:
    """Text in double quotes; unprintable characters are escaped, since YAML reads some as line ends."""
    return '"' + "".join(_escaped(one) for one in text) + '"'


def _escaped(one: str) -> str:
    if one in {'"', "\\"}:
        return "\\" + one
    return one if one.isprintable() else f"\\U{ord(one):08x}"


def _number(value: float | None, unit: str) -> str:
    if value is None:
        return _NONE
    if math.isinf(value):
        return "unlimited"
    return f"{value!r} {unit}".strip()


def _rate_lines(rate: HingeRate | None) -> list[str]:
    if rate is None:
        return ["rate: none"]
    return ["rate:", f"  reference: {_number(rate.reference, 'rad/s')}", f"  exponent: {rate.exponent!r}"]


def _stop_lines(stop: Stop | None) -> list[str]:
    if stop is None:
        return ["stop: none"]
    damping = "critical" if math.isnan(stop.damping) else _number(stop.damping, "N*m*s/rad")
    return [
        "stop:",
        f"  rotation: {_number(stop.rotation, 'rad')}",
        f"  stiffness: {_number(stop.stiffness, 'N*m/rad')}",
        f"  exponent: {stop.exponent!r}",
        f"  damping: {damping}",
        f"  penetration: {_number(stop.full_damping_penetration, 'rad')}",
    ]


def _curve_lines(name: str, curve: StoredCurve, law: StoredLaw) -> Iterable[str]:
    units = ", ".join(f"{key}: {unit}" for key, unit in UNITS[law.slip].items())
    yield f"{name}:"
    yield f"  units: {{{units}}}"
    yield f"  sampling_error: {law.sampling_error!r}"
    for sense, points in (("positive", curve.positive), ("negative", curve.negative)):
        if sense == "negative" and points == curve.positive:
            yield "  negative: mirror"
            continue
        yield f"  {sense}:"
        yield from (f"    - [{at!r}, {moment!r}]" for at, moment in zip(*points, strict=True))


def _needed(value: float | None) -> float:
    return math.inf if value is None else value


def _rate(top: Group) -> HingeRate | None:
    if top.says_none("rate"):
        return None
    group = top.group("rate")
    group.only(("reference", "exponent"))
    reference, exponent = group.number("reference", "rad/s"), group.number("exponent", "1")
    return group.built(lambda: HingeRate(_needed(reference), _needed(exponent)))


def _stop(top: Group) -> Stop | None:
    if top.says_none("stop"):
        return None
    group = top.group("stop")
    group.only(("rotation", "stiffness", "exponent", "damping", "penetration"))
    rotation, stiffness = group.number("rotation", "rad"), group.number("stiffness", "N*m/rad")
    exponent, penetration = group.number("exponent", "1"), group.number("penetration", "rad")
    critical = group.take("damping").value == "critical"
    damping = math.nan if critical else _needed(group.number("damping", "N*m*s/rad"))
    return Stop(_needed(rotation), _needed(stiffness), _needed(exponent), damping, _needed(penetration))


def _curve(group: Group, slip: bool) -> tuple[StoredCurve, float]:
    group.only(("units", "sampling_error", "positive", "negative"))
    units = group.group("units")
    units.only(tuple(UNITS[slip]))
    for name, unit in UNITS[slip].items():
        if units.text(name) != unit:
            units.refuse(units.take(name), "the points of a law file are in SI units", unit)
    error = _needed(group.number("sampling_error", "1"))
    positive = group.points("positive")
    mirrored = group.take("negative").value == "mirror"
    negative = positive if mirrored else group.points("negative")
    return group.built(lambda: StoredCurve(positive, negative)), error
