"""Description of a section shape besides its geometry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from crumple.registry.keys import Key, keys_of, sentence_on
from crumple.section.section import Axis, Section


@dataclass(frozen=True)
class Example:
    """Section of the gallery.

    Attributes
    ----------
    text
        Sizes and details, as on the command line behind the name of the shape.
    axis, senses
        Bending axis and senses that its hinge laws are drawn for.
    name
        Its own, where the gallery has several of a shape.
    """

    text: str
    axis: Axis = "y"
    senses: tuple[int, ...] = (1,)
    name: str = ""


@dataclass(frozen=True)
class Shape:
    """A shape that descriptions, the command line and the gallery know.

    Attributes
    ----------
    make
        Class or function whose parameters, with their units and ranges, are the keys of the shape.
    examples
        For the gallery, at least one.
    """

    make: Callable[..., Section]
    examples: tuple[Example, ...]

    @property
    def keys(self) -> tuple[Key, ...]:
        """Keys of its description."""
        return keys_of(self.make)

    @property
    def sentence(self) -> str:
        """What it is: the first paragraph of its docstring."""
        return sentence_on(self.make)
