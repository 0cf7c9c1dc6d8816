"""pydantic's refusals as `crumple.errors.Problem`: given value, what is allowed, what to do."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, Tag, ValidationError

from crumple.errors import Problem
from crumple.text.names import listed

Place = tuple[str | int, ...]
MOST_ALLOWED = 12
"""Allowed names that a message lists."""
MOST_COMPARED = 50_000
"""Pairs of names that are compared in search of what was meant: half a second's work."""
LONGEST_SHOWN = 60
"""Characters of a refused value that a message repeats; a longer one is cut."""
DECIMAL_POINT = "write numbers with a decimal point, as 2.5 mm: a comma ends a value"
_MEANT = re.compile(r"did you mean '([^']*)'")
_TAG = re.compile(r"\(type=([^)]*)\)")


def problems_of(error: ValidationError, model: type[BaseModel] | None = None) -> list[Problem]:
    """Problems of one pydantic error, without file and line.

    Parameters
    ----------
    error
        As raised by ``model``'s validation.
    model
        The validated model; names the keys that would have been allowed.
    """
    return [problem for _, problem in placed_problems(error, model)]


def placed_problems(
    error: ValidationError, model: type[BaseModel] | None = None
) -> list[tuple[Place, Problem]]:
    """Problems with their place as a path of keys and indices, tags of alternatives left out."""
    placed: list[tuple[Place, Problem]] = []
    short: dict[Place, tuple[Place, Problem]] = {}
    for details in error.errors(include_url=False):
        place = tuple(part for part in details["loc"] if not _is_internal(part))
        context = details.get("ctx", {})
        if context.get("key"):
            place = (*place, context["key"])
        if context.get("problems"):
            inner = [(problem, (*place, *path_of(problem.where))) for problem in context["problems"]]
            placed += [(path, replace(problem, where=spelled(path))) for problem, path in inner]
            continue
        reached = _LISTING.get(details["type"])
        keys = [] if reached is None else _keys(model, details["loc"][: len(details["loc"]) - reached])
        value = details["input"]
        if context.get("key") and isinstance(value, Mapping):
            value = value.get(context["key"])
        problem = _problem(str(details["type"]), details["msg"], value, context, place, keys)
        if keys and reached and (types := _types_with(model, details["loc"])):
            problem = replace(problem, todo=f"remove it, or choose type {' or '.join(types)}, which has it")
        if details["type"] == "tuple_type" and (count := _entries(model, details["loc"])):
            problem = _with_example(problem, value, count)
        if details["type"] == "missing" and place and isinstance(place[-1], int):
            # every missing entry is reported separately; the last one gives the required number
            short[place[:-1]] = (place[:-1], _too_short(value, place))
            continue
        placed.append((place, problem))
    placed += short.values()
    # a misspelt key and the missing one that it stands for are one mistake
    meant = {(*place[:-1], key) for place, problem in placed for key in _MEANT.findall(problem.todo)}
    return [
        (place, problem) for place, problem in placed if place not in meant or "missing" not in problem.what
    ]


def path_of(where: str) -> Place:
    """Keys and indices of a path such as ``sum[0].step.x0``."""
    parts = re.findall(r"[^.\[\]]+", where)
    # digits of other scripts, and superscripts, are letters of a name
    return tuple(int(part) if part.isascii() and part.isdigit() else part for part in parts)


def spelled(place: Iterable[str | int]) -> str:
    """Path as people write it: ``members.tube.hinges[0].law``."""
    text = ""
    for part in place:
        text += f"[{part}]" if isinstance(part, int) else f"{'.' if text else ''}{shown(part)}"
    return text


def shown(value: object) -> str:
    """A refused value, short and on one line."""
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, float | int | str):
        text = str(value)
    elif isinstance(value, Mapping):
        text = "{" + ", ".join(str(key)[:20] for key in list(value)[:8]) + "}"
    elif isinstance(value, Sequence):
        plain = len(value) <= 4 and all(isinstance(item, float | int | str) for item in value)
        text = f"[{', '.join(map(str, value))}]" if plain else f"a list of {len(value)}"
    else:
        text = "nothing" if value is None else type(value).__name__
    text = "".join(character if character.isprintable() else "?" for character in text[: LONGEST_SHOWN + 1])
    return text if len(text) <= LONGEST_SHOWN else text[:LONGEST_SHOWN] + "..."


class Names(frozenset[str]):
    """Defined names with which many others are compared; the list for messages is sorted only once."""

    @cached_property
    def listed(self) -> str:
        """The names as the text of what is allowed."""
        return one_of(sorted(self))

    @cached_property
    def _left(self) -> list[int]:
        """Number of comparisons left for suggestions."""
        return [MOST_COMPARED]

    def suggestion(self, name: str) -> str:
        """Like the function, but empty once the number of comparisons is used up."""
        if self._left[0] < len(self):
            return ""
        self._left[0] -= len(self)
        return suggestion(name, sorted(self))


def suggestion(name: object, known: Iterable[str]) -> str:
    """Closest known name as ``did you mean 'x'?``; empty where none is close, or too many are known."""
    names = list(known)
    if len(names) > MOST_COMPARED:
        return ""
    close = difflib.get_close_matches(str(name)[:64], names, n=1, cutoff=0.6)
    return f"did you mean '{close[0]}'?" if close else ""


def meant_by_key(key: str, known: Iterable[str]) -> str:
    """What an unknown key may stand for: the rest of a number with a decimal comma, or a known key."""
    return DECIMAL_POINT if re.match(r"\d+ [a-zA-Z]", key) else suggestion(key, known)


def unknown(kind: str, name: str, known: Iterable[str], where: str) -> Iterator[Problem]:
    """The refusal of a name that is not among those known; nothing where it is."""
    names = known if isinstance(known, Names) else Names(known)
    if name not in names:
        todo = names.suggestion(name) or f"define the {kind} '{shown(name)}' or correct the name"
        yield Problem(f"there is no {kind} '{shown(name)}'", shown(name), names.listed, todo, where)


def outside(where: str, distance: float, length: float, begin: float = 0.0) -> Problem:
    """A place that is not on a member of a length [m], by its distance [m] from where one begins to count."""
    came = f"{1e3 * distance:.6g} mm"
    allowed = f"{1e3 * (0.0 - begin):.6g} mm to {1e3 * (length - begin):.6g} mm"
    return Problem("this place is outside the member", came, allowed, "choose a place on the member", where)


def one_of(names: Iterable[str]) -> str:
    """``one of a, b, c``, shortened to `MOST_ALLOWED`."""
    known = list(names)
    if not known:
        return "none is defined"
    return ("one of " if len(known) > 1 else "") + listed(known, MOST_ALLOWED)


def _is_internal(part: str | int) -> bool:
    """Whether a part of pydantic's path is a label of an alternative and not a key."""
    return isinstance(part, str) and (part.startswith("(") or part == "[key]")


def _problem(
    kind: str, message: str, value: Any, context: Mapping[str, Any], place: Place, keys: Sequence[str]
) -> Problem:
    where, came = spelled(place), shown(value)
    key = shown(place[-1]) if place else ""
    if kind == "refused":
        came = came if context.get("came") is None else context["came"]
        return Problem(context["what"], came, context["allowed"], context["todo"], where)
    if kind == "extra_forbidden":
        todo = meant_by_key(key, keys) or "remove it or correct its spelling"
        return Problem(f"unknown key '{key}'", came, one_of(keys) if keys else "", todo, where)
    if kind == "missing":
        return Problem(f"the key '{key}' is missing", todo=f"add '{key}'", where=where)
    if kind in {"union_tag_invalid", "union_tag_not_found"}:
        return _unknown_type(value, context, where)
    if keys:
        what, todo = "a group of keys is needed here", f"write keys with values: {{{keys[0]}: ...}}"
        return Problem(what, came, f"keys with values: {listed(keys, MOST_ALLOWED)}", todo, where)
    return _worded((kind, message), value, context, where)


def _not_permitted(value: Any, expected: str, where: str) -> Problem:
    """A word that is none of a list."""
    words = re.findall(r"'([^']*)'", expected)
    allowed, todo = one_of(words) if words else expected, suggestion(value, words)
    return Problem("this is not one of the permitted values", shown(value), allowed, todo, where)


def _worded(error: tuple[str, str], value: Any, context: Mapping[str, Any], where: str) -> Problem:
    """The refusal of a value by `_WORDS`; `error`: its kind and pydantic's message."""
    kind, message = error
    if kind in {"literal_error", "enum"}:
        return _not_permitted(value, str(context.get("expected", "")), where)
    what, allowed = _WORDS.get(kind, (message, ""))
    todo = f"write {allowed}" if what.endswith(_NEEDED) else ""
    if kind == "too_long" and not isinstance(value, Mapping):
        todo = DECIMAL_POINT if _is_cut_by_commas(value) else "remove what is too much"
    return Problem(what, shown(value), allowed.format_map(_Blank(context)), todo, where)


def _is_cut_by_commas(values: Iterable[object]) -> bool:
    """Whether a list has a whole number without a unit, and behind it the rest of a decimal comma."""
    given = list(values)
    return any(
        isinstance(first, int) and re.match(r"\d+ [a-zA-Z]", str(rest)) is not None
        for first, rest in pairwise(given)
    )


def _entries(model: type[BaseModel] | None, place: Place) -> int:
    """Number of entries of the list of fixed length that is wanted at a place; 0: any."""
    lists = [get_args(kind) for kind in _reached(model, place) if get_origin(kind) is tuple]
    return next((len(entries) for entries in lists if Ellipsis not in entries), 0)


def _with_example(problem: Problem, value: Any, count: int) -> Problem:
    """The refusal of a value where a list of a number of entries is wanted, with an example of one."""
    allowed = f"a list of {count} entries in brackets"
    number, _, unit = value.partition(" ") if isinstance(value, str) else ("", "", "")
    written = re.fullmatch(r"[-+.\deE]+", number) is not None and unit
    example = f", as [{', '.join([f'0 {unit}'] * (count - 1) + [shown(value)])}]" if written else ""
    return replace(problem, allowed=allowed, todo=f"write {allowed}{example}")


def _too_short(value: Any, place: Place) -> Problem:
    """A list of fixed length that ends before its entry at a place."""
    allowed = f"{int(place[-1]) + 1} entries"
    return Problem("the list is too short", shown(value), allowed, "add what is missing", spelled(place[:-1]))


def _unknown_type(value: Any, context: Mapping[str, Any], where: str) -> Problem:
    """A part whose key ``type`` names no known one, or is missing."""
    types = _TAG.findall(str(context.get("expected_tags", "")))
    if not isinstance(value, Mapping):
        allowed = (
            f"keys with values, 'type' among them{': ' if types else ''}{one_of(types) if types else ''}"
        )
        todo = "write keys with values: {type: ...}"
        return Problem("a group of keys is needed here", shown(value), allowed, todo, where)
    tag = (_TAG.findall(str(context.get("tag", ""))) or [""])[0]
    what = f"unknown type '{shown(tag)}'" if tag else "the key 'type' is missing"
    todo = meant_type(tag, types) if tag else "add 'type'"
    return Problem(what, shown(tag), one_of(types), todo, where)


def meant_type(tag: object, types: Sequence[str]) -> str:
    """The type that a word of the workshop stands for, or the one that is spelt nearly so."""
    meant = _COMMON.get(str(tag).lower())
    return f"did you mean '{meant}'?" if meant in types else suggestion(tag, types)


_COMMON: dict[str, str] = {
    **dict.fromkeys(("pole", "post", "bar", "rod"), "cylinder"),
    **dict.fromkeys(("wall", "barrier", "ground", "floor"), "plane"),
    **dict.fromkeys(("ball", "headform"), "sphere"),
    **dict.fromkeys(("pipe", "round_tube", "chs"), "circular_tube"),
    **dict.fromkeys(("box", "rhs"), "rectangular_tube"),
    "shs": "square_tube",
}
"""Types by other words for what they are."""
_LISTING: dict[str, int] = {
    "extra_forbidden": 1,
    "model_type": 0,
    "model_attributes_type": 0,
}
"""Refusals that list the keys of a part, and how far the refused place is below it."""
_NEEDED = "is needed here"
_WORDS: dict[str, tuple[str, str]] = {
    "model_type": ("a group of keys is needed here", "keys with values"),
    "model_attributes_type": ("a group of keys is needed here", "keys with values"),
    "dict_type": ("a group of named entries is needed here", "names with values"),
    "mapping_type": ("a group of named entries is needed here", "names with values"),
    "tuple_type": ("a list is needed here", "a list in brackets"),
    "list_type": ("a list is needed here", "a list in brackets"),
    "bool_type": ("true or false is needed here", "true or false"),
    "bool_parsing": ("true or false is needed here", "true or false"),
    "string_type": ("a text is needed here", "a text"),
    "string_too_long": ("the text is too long", "at most {max_length} characters"),
    "string_too_short": ("the text is too short", "at least {min_length} characters"),
    "int_type": ("a whole number is needed here", "a whole number"),
    "int_from_float": ("a whole number is needed here", "a whole number"),
    "int_parsing": ("a whole number is needed here", "a whole number"),
    "greater_than_equal": ("the number is too small", "at least {ge}"),
    "less_than_equal": ("the number is too large", "at most {le}"),
    "too_long": ("the list is too long", "at most {max_length} entries"),
    "too_short": ("the list is too short", "at least {min_length} entries"),
    "recursion_loop": ("the description contains itself", ""),
}


class _Blank(dict[str, Any]):
    """Context of a message in which an unknown key reads "?"."""

    def __missing__(self, key: str) -> str:
        return "?"


def _keys(model: type[BaseModel] | None, place: Place) -> list[str]:
    """Keys that the models reached by pydantic's path would accept."""
    names = [
        field.alias or name
        for kind in _models(_reached(model, place))
        for name, field in kind.model_fields.items()
    ]
    return list(dict.fromkeys(names))


def _reached(model: type[BaseModel] | None, place: Place) -> list[Any]:
    """Annotations that a path leads to."""
    reached: list[Any] = [model]
    for part in place:
        reached = [deeper for kind in reached for deeper in _below(kind, part)]
    return reached


def _below(kind: Any, part: str | int) -> list[Any]:
    """Annotations that one step of a path leads to."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        fields = kind.model_fields.items()
        return [field.annotation for name, field in fields if part in {name, field.alias}]
    if isinstance(part, str) and part.startswith("("):
        models = [model for model in _models([kind]) if _tag_of(model) == part]
        return models or _tagged(kind, part)
    if get_origin(kind) in {Annotated, Union, UnionType}:
        return [deeper for argument in get_args(kind) for deeper in _below(argument, part)]
    return list(get_args(kind))


def _tagged(kind: Any, tag: str) -> list[Any]:
    """Alternatives that a tag names, looked for through Annotated and Union alone."""
    arguments = get_args(kind)
    if get_origin(kind) is Annotated and any(isinstance(one, Tag) and one.tag == tag for one in arguments):
        return [kind]
    if get_origin(kind) in {Annotated, Union, UnionType}:
        return [found for argument in arguments for found in _tagged(argument, tag)]
    return []


def _types_with(model: type[BaseModel] | None, place: Place) -> list[str]:
    """Types of a part, as its key ``type`` names them, that have the key at the end of a path."""
    if len(place) < 2 or not _TAG.match(str(place[-2])):
        return []
    reached: list[Any] = [model]
    for part in place[:-2]:
        reached = [deeper for kind in reached for deeper in _below(kind, part)]
    return [_TAG.findall(_tag_of(kind))[0] for kind in _models(reached) if place[-1] in kind.model_fields]


def _tag_of(model: type[BaseModel]) -> str:
    field = model.model_fields.get("type")
    return f"(type={field.default})" if field is not None else ""


def _models(kinds: Iterable[Any]) -> list[type[BaseModel]]:
    """Models named by annotations, looked for through Annotated and Union alone."""
    found: list[type[BaseModel]] = []
    for kind in kinds:
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            found.append(kind)
        elif get_origin(kind) in {Annotated, Union, UnionType}:
            found += _models(get_args(kind))
    return found
