"""Parts of a description that are one of several registered types, each with keys of its own.

The keys of a type are the parameters of the class or function that a registry names (crumple.registry.keys);
here they are read and checked like all others, every mistake of a part at once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any, Self

from pydantic import (
    ConfigDict,
    ModelWrapValidatorHandler,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from crumple.registry.keys import MISSING, Key
from crumple.structure.schema.problems import one_of, shown, suggestion
from crumple.structure.schema.spec import Spec


class Registered(Spec):
    """Part whose key ``type`` names an entry of a registry, and adds the keys of that entry.

    A validator of a subclass that looks at all keys must be one that runs after.
    """

    model_config = ConfigDict(extra="allow")

    type: str
    """Which one."""

    @classmethod
    def types(cls) -> Iterable[str]:
        """Names that the key ``type`` may have here."""
        raise NotImplementedError

    @classmethod
    def other_types(cls) -> Iterable[str]:
        """Further names that stand for parts of other classes in the same place."""
        return ()

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Keys of a type's own."""
        raise NotImplementedError

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a type is, in one sentence."""
        raise NotImplementedError

    @classmethod
    def embedded(cls, given: dict[str, Any], info: ValidationInfo) -> dict[str, Any]:
        """What was given, with the content of files in place of their names."""
        return given

    @property
    def own(self) -> dict[str, Any]:
        """Values of the keys of its type's own, defaults included."""
        return dict(self.__pydantic_extra__ or {})

    @model_validator(mode="wrap")
    @classmethod
    def _with_keys_of_its_type(
        cls, given: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo
    ) -> Self:
        if not isinstance(given, Mapping):
            return handler(given)
        kind = given.get("type", "")
        if not isinstance(kind, str) or kind not in cls.types():
            raise _refused(*_unknown_type(cls, kind))
        keys = {key.name: key for key in cls.keys_of_type(kind)}
        given = cls.embedded(dict(given), info)
        errors: list[InitErrorDetails] = []
        own = {}
        for name, key in keys.items():
            if name in given:
                try:
                    own[name] = _adapter(key).validate_python(given[name], context=info.context)
                except ValidationError as error:
                    errors += _below(name, error)
            elif key.default is MISSING:
                errors.append(InitErrorDetails(type="missing", loc=(name,), input=given))
            else:
                own[name] = key.default
        known = [*cls.model_fields, *keys]
        for name in (name for name in given if name not in known):
            todo = suggestion(name, known) or "remove it or correct its spelling"
            unknown = _refused(f"unknown key '{shown(name)}'", one_of(known), todo)
            errors.append(InitErrorDetails(type=unknown, loc=(name,), input=given[name]))
        try:
            made = handler({**{name: given[name] for name in cls.model_fields if name in given}, **own})
        except ValidationError as error:
            errors = [*_below(None, error), *errors]
        if errors:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        return made


@cache
def _adapter(key: Key) -> TypeAdapter[Any]:
    return TypeAdapter(key.annotation)


def _unknown_type(part: type[Registered], kind: object) -> tuple[str, str, str, str]:
    """Problem, what is allowed, what to do, and what came."""
    types = [*part.types(), *part.other_types()]
    what = f"unknown type '{shown(kind)}'" if kind else "the key 'type' is missing"
    return what, one_of(types), suggestion(kind, types), shown(kind)


def _refused(what: str, allowed: str, todo: str, came: str | None = None) -> PydanticCustomError:
    context: dict[str, Any] = {
        "what": what,
        "allowed": allowed,
        "todo": todo,
        "key": "",
        "problems": [],
        "came": came,
    }
    return PydanticCustomError("refused", "{what}", context)


def _below(name: str | None, error: ValidationError) -> list[InitErrorDetails]:
    """Errors of an inner validation as those of a key; of the part itself for None."""
    return [
        InitErrorDetails(
            # an error with a message of its own is built anew, pydantic knows the others by their names
            type=PydanticCustomError("refused", "{what}", one["ctx"])
            if one["type"] == "refused"
            else one["type"],
            loc=(*(() if name is None else (name,)), *one["loc"]),
            input=one["input"],
            ctx=one.get("ctx", {}),
        )
        for one in error.errors(include_url=False)
    ]
