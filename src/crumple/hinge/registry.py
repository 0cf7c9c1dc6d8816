"""Laws by name.  Adding a law is adding a file with a class under its decorator, and its line here."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw
from crumple.material import Material
from crumple.section import Axis, Section

if TYPE_CHECKING:
    from crumple.hinge.axial.axial_law import AxialLaw
    from crumple.hinge.torsion.torsion_law import TorsionLaw

_Class = TypeVar("_Class")


class LawType(Protocol):
    """A law that can be built for a section; every bending law class offers it."""

    def of(self, section: Section, material: Material, axis: Axis = "y", **options: Any) -> HingeLaw:
        """Build the law of a section about an axis; options differ from law to law."""
        ...


class Family:
    """Laws of one kind of collapse, one file each.

    Parameters
    ----------
    modules
        The files; imported on first use.
    what
        What messages call a law of this kind.
    """

    def __init__(self, modules: tuple[str, ...], what: str) -> None:
        self._modules = modules
        self._what = what
        self._types: dict[str, Any] = {}
        self._loaded = False

    def register(self, name: str) -> Callable[[_Class], _Class]:
        """Register a law class under the name that people use."""

        def register(cls: _Class) -> _Class:
            self._types[name] = cls
            return cls

        return register

    def types(self) -> dict[str, Any]:
        """Every law class by its name, sorted."""
        if not self._loaded:
            for module in self._modules:
                importlib.import_module(module)
            self._loaded = True
        return dict(sorted(self._types.items()))

    def type_of(self, name: str) -> Any:
        """Law class of a name; refuses unknown ones with `InputError`."""
        types = self.types()
        if name not in types:
            what, todo = f"unknown {self._what}", "choose one of these"
            raise InputError(Problem(what, repr(name), ", ".join(types), todo, "type"))
        return types[name]

    def options(self, name: str) -> tuple[str, ...]:
        """Names of the keyword options of a law."""
        return _keyword_only(self.type_of(name).of)

    def build(self, name: str, *arguments: Any, **options: Any) -> Any:
        """Build a law by its name; refuses unknown and missing options with `InputError`."""
        cls = self.type_of(name)
        allowed = self.options(name)
        unknown = [option for option in options if option not in allowed]
        if unknown:
            todo = f"give the law {name} only options that it knows"
            raise InputError(
                [
                    Problem("unknown option", option, ", ".join(allowed) or "none", todo, option)
                    for option in unknown
                ]
            )
        missing = [option for option in allowed if option not in options and option in _needed(cls.of)]
        if missing:
            what, todo = f"the law {name} needs more than a section and a material", "give it"
            raise InputError([Problem(what, "nothing", option, todo, option) for option in missing])
        return cls.of(*arguments, **options)


@cache
def _keyword_only(function: Callable[..., Any]) -> tuple[str, ...]:
    parameters = inspect.signature(function).parameters.values()
    return tuple(parameter.name for parameter in parameters if parameter.kind is parameter.KEYWORD_ONLY)


@cache
def _needed(function: Callable[..., Any]) -> tuple[str, ...]:
    """Keyword options without a default."""
    parameters = inspect.signature(function).parameters
    return tuple(
        name for name in _keyword_only(function) if parameters[name].default is inspect.Parameter.empty
    )


_BENDING = Family(
    (
        "crumple.hinge.bending.circular",
        "crumple.hinge.bending.constant",
        "crumple.hinge.bending.folded_profile",
        "crumple.hinge.bending.kecman",
        "crumple.hinge.bending.oblique",
        "crumple.hinge.bending.wierzbicki",
        "crumple.hinge.measured.law_file",
        "crumple.hinge.measured.tabulated",
    ),
    "hinge law",
)
_AXIAL = Family(
    (
        "crumple.hinge.axial.circular",
        "crumple.hinge.axial.square",
        "crumple.hinge.axial.superfolding",
        "crumple.hinge.axial.top_hat",
    ),
    "axial law",
)
_TORSION = Family(("crumple.hinge.torsion.plastic", "crumple.hinge.torsion.square_tube"), "torsion law")

law_type = _BENDING.register
axial_law_type = _AXIAL.register
torsion_law_type = _TORSION.register


def law_types() -> dict[str, LawType]:
    """Every bending law class by its name, sorted."""
    return _BENDING.types()


def axial_law_types() -> dict[str, Any]:
    """Every axial law class by its name, sorted."""
    return _AXIAL.types()


def torsion_law_types() -> dict[str, Any]:
    """Every torsion law class by its name, sorted."""
    return _TORSION.types()


def law_options(name: str) -> tuple[str, ...]:
    """Names of the options that `build_law` accepts for a law.

    Raises
    ------
    InputError
        If no law has this name.
    """
    return _BENDING.options(name)


def build_law(name: str, section: Section, material: Material, axis: Axis = "y", **options: Any) -> HingeLaw:
    """Build a bending law by its name.

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
        If the name or an option is unknown or missing, or the law does not fit the section.
    """
    law: HingeLaw = _BENDING.build(name, section, material, axis, **options)
    return law


def build_axial_law(name: str, section: Section, material: Material, **options: Any) -> AxialLaw:
    """Build an axial law by its name, one of `axial_law_types`; refuses like `build_law`."""
    law: AxialLaw = _AXIAL.build(name, section, material, **options)
    return law


def build_torsion_law(
    name: str, section: Section, material: Material, length: float, **options: Any
) -> TorsionLaw:
    """Build the torsion law of a member of a length [m] by its name; refuses like `build_law`."""
    law: TorsionLaw = _TORSION.build(name, section, material, length, **options)
    return law
