"""The published JSON Schema accepts what the reader accepts."""

import json
import re
from pathlib import Path

import pytest
from ruamel.yaml import YAML

from crumple.analysis import json_schema
from crumple.analysis.input_file import InputFile
from crumple.analysis.schema import field_descriptions, models_of

SCHEMA = json_schema()
PARTS = [SCHEMA, *(part for part in SCHEMA["$defs"].values() if "oneOf" not in part)]
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "null": type(None),
    "boolean": bool,
}


def complaints(value, schema):
    """Reasons why a value does not fit a schema; knows the keywords that the input file's schema uses."""
    if "$ref" in schema:
        return complaints(value, SCHEMA["$defs"][schema["$ref"].rpartition("/")[2]])
    for keyword in ("anyOf", "oneOf"):
        if keyword in schema and all(complaints(value, choice) for choice in schema[keyword]):
            return [f"{value!r} fits no choice"]
    wanted = schema.get("type", [])
    kinds = [TYPES[kind] for kind in ([wanted] if isinstance(wanted, str) else wanted)]
    if kinds and (
        not any(isinstance(value, kind) for kind in kinds) or (isinstance(value, bool) and bool not in kinds)
    ):
        return [f"{value!r} is no {wanted}"]
    if "const" in schema and value != schema["const"]:
        return [f"{value!r} is not {schema['const']!r}"]
    if "enum" in schema and value not in schema["enum"]:
        return [f"{value!r} is not in {schema['enum']}"]
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        return [f"{value!r} does not match"]
    found = []
    if isinstance(value, dict):
        found += [f"{key} is missing" for key in schema.get("required", []) if key not in value]
        other = schema.get("additionalProperties", True)
        for key, part in value.items():
            inner = schema.get("properties", {}).get(key, other)
            found += (
                [f"unknown key {key}"]
                if inner is False
                else complaints(part, inner)
                if isinstance(inner, dict)
                else []
            )
    if isinstance(value, list):
        heads = schema.get("prefixItems", [])
        for i, part in enumerate(value):
            inner = heads[i] if i < len(heads) else schema.get("items", {})
            found += complaints(part, inner)
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", 10**9):
            found.append(f"{len(value)} items")
    return found


@pytest.mark.parametrize("path", sorted(Path("examples").glob("*.yaml")), ids=lambda path: path.stem)
def test_the_examples_fit_the_schema(path):
    data = YAML(typ="safe", pure=True).load(path.read_text(encoding="utf-8"))
    assert complaints(data, SCHEMA) == []


def test_the_schema_sees_mistakes():
    data = YAML(typ="safe", pure=True).load(Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8"))
    data["sections"]["tube"]["width"] = 50
    assert complaints(data, SCHEMA)
    data["sections"]["tube"]["width"] = "50 mm"
    data["members"]["tube"]["rol"] = "90 deg"
    assert complaints(data, SCHEMA)


def test_every_key_is_described_and_every_quantity_names_its_unit():
    for part in PARTS:
        for key, entry in part["properties"].items():
            assert len(entry["description"]) > 5, key
    assert SCHEMA["$defs"]["Stage"]["properties"]["duration"]["x-unit"] == "s"
    json.dumps(SCHEMA, allow_nan=False)


def test_defaults_fit_their_own_schema():
    for part in PARTS:
        for key, entry in part["properties"].items():
            if "default" in entry:
                assert complaints(entry["default"], entry) == [], key


def test_every_model_field_has_a_text():
    for model in models_of(InputFile):
        assert set(field_descriptions(model)) >= set(model.model_fields), model.__name__


@pytest.mark.parametrize("name", ["RectangularTubeShape", "KecmanLaw"])
def test_the_type_of_an_alternative_is_required(name):
    assert "type" in SCHEMA["$defs"][name]["required"]
