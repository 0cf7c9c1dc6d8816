"""JSON Schema of the input file, for editors that complete and check input."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from copy import deepcopy
from functools import lru_cache
from typing import Any, get_args

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from crumple.analysis.input_file import FORMAT, InputFile
from crumple.registry.keys import MISSING
from crumple.structure.schema.registered import Registered

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """Schema of an input file.

    Returns
    -------
    dict
        JSON Schema 2020-12.  Quantities are texts with a unit; ``x-unit`` names their SI unit.
    """
    return schema_of(InputFile, f"Crumple input file, format {FORMAT}")


def schema_of(whole: type[BaseModel], title: str) -> dict[str, Any]:
    """JSON Schema of a file.

    Parameters
    ----------
    whole
        All its keys.
    title
        What the file is.
    """
    schema = whole.model_json_schema(schema_generator=_Generator)
    parts = schema["$defs"]
    for model in models_of(whole):
        _describe(schema if model is whole else parts[model.__name__], model)
        if issubclass(model, Registered):
            types = {_name_of(model, kind): _type_schema(parts, model, kind) for kind in model.types()}
            parts[model.__name__] = {"oneOf": [{"$ref": f"#/$defs/{name}"} for name in types]}
            parts |= types
    return {"$schema": DIALECT, **_tidy(schema), "title": title}


def models_of(model: type[BaseModel]) -> list[type[BaseModel]]:
    """A model and every model inside it, each once, outermost first."""
    found = [model]
    for one in found:
        inside = [field.annotation for field in one.model_fields.values()]
        if issubclass(one, Registered):
            inside += [key.annotation for kind in one.types() for key in one.written_keys(kind)]
        for annotation in inside:
            found += [inner for inner in dict.fromkeys(_models_in(annotation)) if inner not in found]
    return found


@lru_cache(maxsize=256)
def field_descriptions(model: type[BaseModel]) -> dict[str, str]:
    """Docstring below each field of a model, inherited fields included, on one line each."""
    texts: dict[str, str] = {}
    for owner in reversed(model.__mro__):
        if not (isinstance(owner, type) and issubclass(owner, BaseModel)) or owner is BaseModel:
            continue
        body = ast.parse(textwrap.dedent(inspect.getsource(owner))).body[0]
        assert isinstance(body, ast.ClassDef)
        for statement, below in zip(body.body, body.body[1:], strict=False):
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
                text = _text(below)
                if text is not None:
                    texts[statement.target.id] = " ".join(text.split())
    return texts


def first_sentence(model: type[BaseModel]) -> str:
    """What a model is: the first paragraph of its docstring on one line."""
    return " ".join((model.__doc__ or "").strip().split("\n\n")[0].split())


def _name_of(model: type[Registered], kind: str) -> str:
    """Name of the definition of a registered type, such as HatShape."""
    words = "".join(word.capitalize() for word in re.split("[_-]", kind))
    return words + model.__name__.removesuffix("Spec").removesuffix("Keys")


def _type_schema(parts: dict[str, Any], model: type[Registered], kind: str) -> dict[str, Any]:
    """Schema of a registered type: the keys that all have, and its own."""
    common = deepcopy(parts[model.__name__])
    own, required = {}, []
    for key in model.written_keys(kind):
        entry = TypeAdapter(key.annotation).json_schema(
            schema_generator=_Generator, ref_template="#/$defs/{model}"
        )
        parts |= {name: part for name, part in entry.pop("$defs", {}).items() if name not in parts}
        _describe_key(entry, key.text, key.default)
        own[key.name] = entry
        if key.default is MISSING:
            required.append(key.name)
    common["properties"][model.tag].pop("default", None)
    common["properties"][model.tag] |= {"const": kind}
    if kind != model.default_type:
        required.append(model.tag)
    return {
        **common,
        "description": model.sentence_of(kind),
        "properties": {**common["properties"], **own},
        "required": list(dict.fromkeys([*common.get("required", []), *required])),
        "additionalProperties": False,
    }


class _Generator(GenerateJsonSchema):
    """Lets defaults that are parts themselves be left out: an absent part already means the default."""

    def encode_default(self, dft: Any) -> Any:
        return None if isinstance(dft, BaseModel | dict | tuple) else super().encode_default(dft)


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models_in(argument)


def _text(statement: ast.stmt) -> str | None:
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
        return statement.value.value if isinstance(statement.value.value, str) else None
    return None


def _describe(part: dict[str, Any], model: type[BaseModel]) -> None:
    """Put the docstrings of a part and its keys into its schema."""
    part["description"] = first_sentence(model)
    texts = field_descriptions(model)
    for name, field in model.model_fields.items():
        entry = part["properties"][field.alias or name]
        _describe_key(entry, texts.get(name, ""), entry.get("default", MISSING))
        if name == "type" and not field.is_required():
            # it selects the alternative
            part["required"] = ["type", *part.get("required", [])]
            entry.pop("default", None)


def _describe_key(entry: dict[str, Any], text: str, default: Any) -> None:
    """Put its meaning and its default into the schema of a key."""
    quantity = entry.get("description", "")
    entry["description"] = " ".join(part for part in (text, f"({quantity})" if quantity else "") if part)
    if "x-unit" in entry and isinstance(default, float) and default:
        default = f"{default:g} {entry['x-unit']}"
    if default is not MISSING and default not in (None, ()):
        entry["default"] = default


def _tidy(schema: Any) -> Any:
    """Schema without titles that repeat the key, without null defaults, and with nested choices flattened."""
    if isinstance(schema, list):
        return [_tidy(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    tidy = {
        key: _tidy(value) for key, value in schema.items() if not (key == "title" and isinstance(value, str))
    }
    if "default" in tidy and tidy["default"] is None:
        del tidy["default"]
    choices = tidy.get("anyOf")
    if isinstance(choices, list):
        tidy["anyOf"] = [
            inner
            for choice in choices
            for inner in (choice["anyOf"] if set(choice) == {"anyOf"} else [choice])
        ]
    return tidy
