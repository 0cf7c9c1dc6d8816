"""Cross-sections as the description gives them: a registered shape with its keys, or walls."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Tag

from crumple.material import Material
from crumple.registry.keys import Key
from crumple.section import Section
from crumple.section.shapes.registry import SHAPES
from crumple.structure.keys.any_section import AnySection, MaterialReference, Metal
from crumple.structure.keys.walls import WallSectionSpec
from crumple.structure.schema.registered import Registered


class ShapeSpec(AnySection, Registered):
    """Section of a registered shape."""

    type: str
    """Kind of section."""

    @classmethod
    def types(cls) -> Iterable[str]:
        """Shapes."""
        return SHAPES

    @classmethod
    def other_types(cls) -> Iterable[str]:
        """Sections given wall by wall."""
        return (WALLS,)

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Keys of a shape; a metal is given by reference."""
        return tuple(
            replace(key, annotation=MaterialReference | None) if _is_metal(key) else key
            for key in SHAPES[kind].keys
        )

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a shape is."""
        return SHAPES[kind].sentence

    def references(self) -> dict[str, MaterialReference | None]:
        """Metals of single walls."""
        return {key.name: self.own[key.name] for key in SHAPES[self.type].keys if _is_metal(key)}

    def shape(self, metal: Metal) -> Section:
        """Build the section."""
        metals = {name: metal(reference) for name, reference in self.references().items()}
        return SHAPES[self.type].make(**{**self.own, **metals})


WALLS = str(WallSectionSpec.model_fields["type"].default)


def _is_metal(key: Key) -> bool:
    return bool(key.annotation == Material | None)


def _from_section(given: Any) -> Any:
    """Take a section of the physics room too, where the structure is built in Python."""
    kind = getattr(given, "kind", None)
    if isinstance(given, type) or not is_dataclass(given) or not isinstance(kind, str):
        return given
    return {"type": kind, **_keys(given)}


def _keys(given: Any) -> dict[str, Any]:
    """Fields of a section, its walls and its welds as keys; metals stay what they are."""
    keys = {field.name: getattr(given, field.name) for field in fields(given)}
    for name in {"walls", "welds"} & set(keys):
        keys[name] = [_keys(part) for part in keys[name]]
    return keys


def _tag(given: Any) -> str:
    kind = given.get("type") if isinstance(given, Mapping) else getattr(given, "type", None)
    return "(walls)" if kind == WALLS else "(shape)"


SectionSpec = Annotated[
    Annotated[ShapeSpec, Tag("(shape)")] | Annotated[WallSectionSpec, Tag("(walls)")],
    Discriminator(_tag),
    BeforeValidator(_from_section),
]
"""Any section, by its ``type``."""
