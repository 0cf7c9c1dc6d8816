"""Parts of a description that are one of several registered types, each with keys of its own.

The keys of a type are the parameters of the class or function that a registry names (crumple.registry.keys);
here they are read and checked like all others, every mistake of a part at once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Self

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
from crumple.structure.schema.problems import meant_by_key, meant_type, one_of, shown
from crumple.structure.schema.spec import Spec


class Registered(Spec):
    """Part whose key ``type`` names an entry of a registry, and adds the keys of that entry.

    A validator of a subclass that looks at all keys must be one that runs after.
    """

    model_config = ConfigDict(extra="allow")

    tag: ClassVar[str] = "type"
    """Key with the type."""
    default_type: ClassVar[str | None] = None
    """Type without that key; None: the key is needed."""

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
    def file_keys(cls, kind: str) -> tuple[Key, ...]:
        """Further keys of a type, which `embedded` turns into values of its own keys."""
        return ()

    @classmethod
    def written_keys(cls, kind: str) -> tuple[Key, ...]:
        """Keys of a type as people write them."""
        files, own = cls.file_keys(kind), cls.keys_of_type(kind)
        if files:
            # a file may stand for any key that is needed
            own = tuple(replace(key, default=None) if key.default is MISSING else key for key in own)
        return (*files, *own)

    @classmethod
    def embedded(cls, kind: str, given: dict[str, Any], folder: Path | None) -> dict[str, Any]:
        """Keys that were given, with the content of files in place of their names.

        Parameters
        ----------
        kind
            Type.
        given
            Keys as they stand in the input.
        folder
            Of the input file; None where the part is built in Python.
        """
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
        kind = given.get(cls.tag, cls.default_type)
        if not isinstance(kind, str) or kind not in cls.types():
            raise _refused(*_unknown_type(cls, kind))
        folder = (info.context or {}).get("directory")
        given = cls.embedded(kind, {**given, cls.tag: kind}, None if folder is None else Path(folder))
        keys = {key.name: key for key in cls.keys_of_type(kind)}
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
        known = [*cls.model_fields, *(key.name for key in cls.file_keys(kind)), *keys]
        for name in (name for name in given if name not in known):
            todo = (
                meant_by_key(str(name), known) or _belongs(cls, name) or "remove it or correct its spelling"
            )
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
    what = f"unknown {part.tag} '{shown(kind)}'" if kind else f"the key '{part.tag}' is missing"
    return what, one_of(types), meant_type(kind, types), shown(kind) if kind else ""


def _belongs(part: type[Registered], name: str) -> str:
    """What to do about a key of other types; nothing where it is no key at all."""
    types = [kind for kind in part.types() if name in {key.name for key in part.written_keys(kind)}]
    return f"remove it, or write {part.tag}: {' or '.join(types[:3])}" if types else ""


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
            # an error with its own message is created again, the others are known to pydantic by name
            type=PydanticCustomError("refused", "{what}", one["ctx"])
            if one["type"] == "refused"
            else one["type"],
            loc=(*(() if name is None else (name,)), *one["loc"]),
            input=one["input"],
            ctx=one.get("ctx", {}),
        )
        for one in error.errors(include_url=False)
    ]
