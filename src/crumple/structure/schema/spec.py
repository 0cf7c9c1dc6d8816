"""What every part of a description has in common: frozen, strict about names, clear when it refuses.

A part is a pydantic model whose attribute names are the keys of the input file.  Built in Python it takes
plain SI floats or texts with a unit; read from a file (validation context ``{"file": True}``) a bare number
without a unit is refused.  Either way a refusal is one `InputError` that holds every problem found.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from numbers import Integral
from operator import itemgetter
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar, cast

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ValidationError,
)

from crumple.errors import InputError, Problem
from crumple.registry.refusal import refuse
from crumple.structure.schema.mapping import frozen
from crumple.structure.schema.problems import problems_of

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class _Refusing(ModelMetaclass):
    """Turns pydantic's error into `InputError` where a part is built by hand.

    pydantic validates nested parts without calling the class, so inside a larger part every problem
    still reaches the outermost call.
    """

    def __call__(cls, *args: Any, **kwargs: Any) -> Any:  # noqa: N805  (a metaclass)
        try:
            return super().__call__(*args, **kwargs)
        except ValidationError as error:
            raise InputError(problems_of(error, cast(type[BaseModel], cls))) from None


@lru_cache(None)
def _keys_of(kind: type[BaseModel]) -> Callable[[Mapping[str, Any]], Any]:
    """Values of a part's own keys from its attributes."""
    return itemgetter(*kind.model_fields) if kind.model_fields else lambda _: ()


class Spec(BaseModel, metaclass=_Refusing):
    """Base of every part: frozen, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, validate_default=False)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy with some keys changed; unlike pydantic's it is checked like any other part."""
        if update is None:
            return super().model_copy(deep=deep)
        return type(self)(**{**{name: getattr(self, name) for name in self.key_names}, **update})

    def __hash__(self) -> int:
        """Of all keys: pydantic's own leaves out those of a type, so that all tubes would share one hash."""
        kind, more = type(self), self.__pydantic_extra__
        keys = _keys_of(kind)(self.__dict__)
        return hash((kind, keys, tuple(more.values())) if more else (kind, keys))

    @property
    def key_names(self) -> list[str]:
        """Its keys, those of its own type last."""
        return [*type(self).model_fields, *(self.__pydantic_extra__ or ())]


def type_tag(given: Any) -> str:
    """Label of the alternative that the key ``type`` of a part chooses, as pydantic's path shows it."""
    kind = given.get("type", "") if isinstance(given, Mapping) else getattr(given, "type", "")
    return f"(type={kind})"


def _text_of_number(value: Any) -> Any:
    """Names may be numbers in a file: node 12 is the node named "12"."""
    return str(value) if isinstance(value, Integral) and not isinstance(value, bool) else value


def _name(value: Any) -> Any:
    # nearly all names of a large input
    if type(value) is str and len(value) <= 64 and value.isalnum():
        return value
    value = _text_of_number(value)
    if (
        not isinstance(value, str)
        or not value.replace("-", "_").replace("_", "a").isalnum()
        or len(value) > 64
    ):
        refuse(
            "this is not a name",
            allowed="letters, digits, '_' and '-', at most 64",
            todo="choose another name",
        )
    return value


Name = Annotated[str, BeforeValidator(_name, json_schema_input_type=str | int)]
"""Name of a part: letters, digits, ``_`` and ``-``; a dot separates the parts of a channel name."""

Part = TypeVar("Part")
Named = Annotated[Mapping[Name, Part], AfterValidator(frozen)]
"""Named parts, frozen, in the order of the input."""


def raise_all(problems: list[Problem]) -> None:
    """Raise one `InputError` with every problem; nothing when there is none."""
    if problems:
        raise InputError(problems)
