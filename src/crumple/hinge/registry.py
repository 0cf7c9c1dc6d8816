"""Laws by name.  Adding a law is adding a file to `crumple.hinge.laws` with a class under `law_type`."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable
from functools import lru_cache
from typing import Any, Protocol, TypeVar

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw
from crumple.material import Material
from crumple.section import Axis, Section


class LawType(Protocol):
    """A law that can be built for a section; every law class offers it."""

    def of(self, section: Section, material: Material, axis: Axis = "y", **options: Any) -> HingeLaw:
        """Build the law of a section about an axis; options differ from law to law."""
        ...


_types: dict[str, Any] = {}
_Class = TypeVar("_Class")


def law_type(name: str) -> Callable[[_Class], _Class]:
    """Register a law class under the name that the input file uses."""

    def register(cls: _Class) -> _Class:
        _types[name] = cls
        return cls

    return register


@lru_cache(maxsize=1)
def _load_all() -> None:
    """Import every file of the laws folder once, so that its classes register themselves."""
    laws = importlib.import_module("crumple.hinge.laws")
    for module in pkgutil.iter_modules(laws.__path__):
        importlib.import_module(f"{laws.__name__}.{module.name}")


def law_types() -> dict[str, LawType]:
    """Every law class by its name, sorted."""
    _load_all()
    return dict(sorted(_types.items()))


def law_options(name: str) -> tuple[str, ...]:
    """Names of the options that `build_law` accepts for a law.

    Raises
    ------
    InputError
        If no law has this name.
    """
    parameters = inspect.signature(_law_type(name).of).parameters.values()
    return tuple(parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY)


def build_law(name: str, section: Section, material: Material, axis: Axis = "y", **options: Any) -> HingeLaw:
    """Build a law by its name.

    Parameters
    ----------
    name
        As in the input file: one of `law_types`.
    section, material, axis
        What folds, and about which axis.
    options
        Keyword options of the law, see `law_options`.

    Returns
    -------
    HingeLaw
        Frozen law.

    Raises
    ------
    InputError
        If the name or an option is unknown, or the law does not fit the section.
    """
    cls = _law_type(name)
    allowed = law_options(name)
    unknown = [option for option in options if option not in allowed]
    if unknown:
        todo = f"give the law {name} only options that it knows"
        raise InputError(
            [
                Problem("unknown option", option, ", ".join(allowed) or "none", todo, option)
                for option in unknown
            ]
        )
    return cls.of(section, material, axis, **options)


def _law_type(name: str) -> LawType:
    types = law_types()
    if name not in types:
        raise InputError(
            Problem("unknown hinge law", repr(name), ", ".join(types), "choose one of these", "type")
        )
    return types[name]
