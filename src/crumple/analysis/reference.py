"""Tables of every key of the input file for docs/input.md, generated from the models.

    python -m crumple.analysis.reference docs/input.md

updates the tables between the two marks of that file; a test compares the file with them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, Tag
from pydantic.fields import FieldInfo

from crumple.analysis.input_file import InputFile
from crumple.analysis.schema import field_descriptions, first_sentence
from crumple.registry.keys import MISSING
from crumple.registry.quantity import Dimension
from crumple.structure import LawKeys, Obstacle
from crumple.structure.keys.member import Place
from crumple.structure.keys.time_function import FunctionOf
from crumple.structure.schema.registered import Registered
from crumple.structure.schema.spec import Name
from crumple.structure.settings.stored_laws import StoredLaws

BEGIN = "<!-- written by `python -m crumple.analysis.reference docs/input.md`: begin -->"
END = "<!-- end -->"
COMMON: dict[type[BaseModel], str] = {LawKeys: "`hinge_laws.NAME`", Obstacle: "`obstacles.NAME`"}
"""Models whose keys every type of a part has, and the paths of such parts."""
Row = tuple[str, ...]
HEAD: Row = ("Key", "Value", "Unit", "Default", "Meaning")


def input_reference() -> str:
    """Markdown: one table per part of the input file, in order of first use."""
    return "\n\n".join(_tables())


def main(path: Path) -> None:
    """Update the tables between the marks of a file."""
    before, _, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    path.write_text(f"{before}{BEGIN}\n\n{input_reference()}\n\n{END}{after}", encoding="utf-8")


def _tables(
    path: str = "The file", model: type[BaseModel] = InputFile, seen: set[type[BaseModel]] | None = None
) -> Iterator[str]:
    """Table of a part, followed by those of the parts inside it, each at its first use."""
    seen = {model} if seen is None else seen
    common = _common(model)
    if common is not None and common not in seen:
        seen.add(common)
        yield from _tables(f"{COMMON[common]}, any type", common, seen)
    if issubclass(model, Registered):
        yield from _registered_tables(path, model, seen)
        return
    own = {name: field for name, field in model.model_fields.items() if not _shared(model, name)}
    yield _table(path, model, own)
    yield from _inner_tables(path, own, seen)


def _registered_tables(path: str, model: type[Registered], seen: set[type[BaseModel]]) -> Iterator[str]:
    """Table of the keys that every type has besides the type, and tables of the keys of each type."""
    path = COMMON.get(model, path)
    common = {name: field for name, field in model.model_fields.items() if name != model.tag}
    if common:
        yield _table(f"{path}, any type", model, common)
        yield from _inner_tables(path, common, seen)
    texts = field_descriptions(model)
    for kind in model.types():
        keys = {
            key.name: FieldInfo.from_annotated_attribute(
                key.annotation, ... if key.default is MISSING else key.default
            )
            for key in model.written_keys(kind)
        }
        rows: list[Row] = [
            (
                f"`{model.tag}`",
                f"`{kind}`",
                "",
                "" if kind == model.default_type else "required",
                texts[model.tag],
            )
        ]
        rows += [_row(key.name, keys[key.name], key.text) for key in model.written_keys(kind)]
        yield _lines(f"{path}, {model.tag} {kind}", model.sentence_of(kind), rows)
        yield from _inner_tables(path, keys, seen)


def _inner_tables(path: str, fields: Mapping[str, FieldInfo], seen: set[type[BaseModel]]) -> Iterator[str]:
    """Tables of the parts inside some keys, each at its first use."""
    for name, field in fields.items():
        inner = _path(path, field.alias or name, field)
        for found in dict.fromkeys(_models(field.annotation)):
            if found not in seen:
                seen.add(found)
                kind = found.model_fields.get("type")
                # a law in place has the keys of a named one
                base = _common(found)
                inner = inner if base is None else COMMON[base]
                several = kind is not None and not kind.is_required() and not issubclass(found, Registered)
                yield from _tables(
                    f"{inner}, type {kind.default}" if kind and several else inner, found, seen
                )


def _common(model: type[BaseModel]) -> type[BaseModel] | None:
    """Model whose keys every type of this part has; None for parts of one type."""
    return next((base for base in COMMON if issubclass(model, base)), None)


def _shared(model: type[BaseModel], name: str) -> bool:
    """Whether a key stands in the common table of its part's types."""
    common = _common(model)
    return common is not None and model is not common and name in common.model_fields


def _table(path: str, model: type[BaseModel], fields: dict[str, FieldInfo]) -> str:
    texts = field_descriptions(model)
    rows = [_row(name, field, texts[name]) for name, field in fields.items()]
    return _lines(path, first_sentence(model), rows)


def _row(name: str, field: FieldInfo, text: str) -> Row:
    kind = _annotated(field)
    return f"`{field.alias or name}`", _value(kind), _unit(kind), _default(name, field, kind), text


def _lines(path: str, sentence: str, rows: list[Row]) -> str:
    table = [HEAD, ("---",) * len(HEAD), *rows]
    lines = [f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in table]
    return "\n".join([f"### {path}", "", sentence, "", *lines])


def _path(path: str, key: str, field: FieldInfo) -> str:
    start = "" if path == "The file" else path.partition(",")[0].strip("`") + "."
    origin = get_origin(_plain(field.annotation))
    tail = ".NAME" if _is_mapping(origin) else "[]" if origin is tuple else ""
    return f"`{start}{key}{tail}`"


def _annotated(field: FieldInfo) -> Any:
    """Annotation with the outermost metadata, which pydantic stores separately."""
    kind = field.annotation
    return Annotated[(kind, *field.metadata)] if field.metadata else kind


def _plain(kind: Any) -> Any:
    """Annotation without Annotated and without None."""
    if get_origin(kind) is Annotated:
        return _plain(get_args(kind)[0])
    if get_origin(kind) in {Union, UnionType}:
        choices = [choice for choice in get_args(kind) if choice is not type(None)]
        return _plain(choices[0]) if len(choices) == 1 else kind
    return kind


def _measure(kind: Any) -> Dimension | FunctionOf | None:
    """Physical quantity of a value, from the metadata, through None."""
    if get_origin(kind) is Annotated:
        inner, *metadata = get_args(kind)
        found = [item for item in metadata if isinstance(item, Dimension | FunctionOf)]
        return found[0] if found else _measure(inner)
    if get_origin(kind) in {Union, UnionType}:
        return next((found for found in map(_measure, get_args(kind)) if found is not None), None)
    if get_origin(kind) is tuple or _is_mapping(get_origin(kind)):
        return _measure(get_args(kind)[-1 if _is_mapping(get_origin(kind)) else 0])
    return None


def _value(kind: Any) -> str:
    """Kind of value in words."""
    if kind in (Name, Place):
        return "name" if kind == Name else "node or length"
    measure, plain = _measure(kind), _plain(kind)
    origin, arguments = get_origin(plain), get_args(plain)
    if _is_mapping(origin):
        return f"named {_several(_value(arguments[1]))}"
    if origin is tuple:
        number = "list of" if arguments[-1] is Ellipsis else f"{len(arguments)}"
        return f"{number} {_several(_value(arguments[0]))}"
    if measure is not None:
        words = "".join(f", or `{word}`" for word in getattr(measure, "words", ()))
        bounds = f" {measure.bounds()}" if isinstance(measure, Dimension) and measure.bounds() else ""
        suffix = " as a function of time" if isinstance(measure, FunctionOf) else ""
        return f"{measure.noun.split(' ', 1)[1]}{bounds}{suffix}{words}"
    return _value_without_unit(plain)


def _several(value: str) -> str:
    """Plural of the result of `_value`: "group" and "length at least 0" in their lists."""
    noun, space, rest = value.partition(" ")
    plural = {"group": "groups", "name": "names", "length": "lengths", "time": "times", "angle": "angles"}
    if rest.startswith("lengths"):
        return f"lists of {value}"
    return f"{plural.get(noun, noun)}{space}{rest}"


def _value_without_unit(plain: Any) -> str:
    origin, arguments = get_origin(plain), get_args(plain)
    if origin is Literal:
        return ", ".join(f"`{choice}`" for choice in arguments)
    if isinstance(plain, type) and issubclass(plain, BaseModel):
        return "group"
    if origin in {Union, UnionType}:
        choices = [choice for choice in arguments if choice is not type(None)]
        return " or ".join(dict.fromkeys(_value(_untagged(choice)) for choice in choices))
    return {str: "text", float: "number", bool: "`true` or `false`", int: "whole number", StoredLaws: "text"}[
        plain
    ]


def _untagged(kind: Any) -> Any:
    """Alternative without its label."""
    if get_origin(kind) is Annotated:
        inner, *metadata = get_args(kind)
        rest = [item for item in metadata if not isinstance(item, Tag)]
        return Annotated[(inner, *rest)] if rest else _untagged(inner)
    return kind


def _unit(kind: Any) -> str:
    measure = _measure(kind)
    return "" if measure is None or measure.unit == "1" else f"`{measure.unit}`, as `{measure.example}`"


def _default(name: str, field: FieldInfo, kind: Any) -> str:
    if field.is_required() or name == "type":
        return "required"
    default = field.default
    if isinstance(default, BaseModel) or default in (None, (), {}, ""):
        return ""
    measure = _measure(kind)
    unit = f" {measure.unit}" if measure is not None and measure.unit != "1" else ""
    if isinstance(default, tuple):
        return f"`[{', '.join(f'{value:g}' for value in default)}]`"
    if isinstance(default, float):
        return f"`{default:g}{unit if default else ''}`"
    return f"`{str(default).lower() if isinstance(default, bool) else default}`"


def _models(kind: Any) -> Iterator[type[BaseModel]]:
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind
    for argument in get_args(kind):
        yield from _models(argument)


def _is_mapping(origin: Any) -> bool:
    return isinstance(origin, type) and issubclass(origin, Mapping)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
