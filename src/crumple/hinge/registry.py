"""Every law by its name, one line each; input file, reference, command line and gallery use it.

A law is a class with ``of(section, material, ...)``; its options, the keyword parameters of ``of``, are its
keys in the input file.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar, runtime_checkable

from crumple.errors import InputError, Problem
from crumple.registry.keys import MISSING, Key, keys_of
from crumple.registry.registry import Registry

if TYPE_CHECKING:
    from crumple.hinge.axial.axial_law import AxialLaw
    from crumple.hinge.law import HingeLaw
    from crumple.hinge.torsion.torsion_law import TorsionLaw
    from crumple.material import Material
    from crumple.section import Axis, Section


class LawType(Protocol):
    """A law that can be built for a section; every bending law class offers it."""

    @property
    def of(self) -> Callable[..., HingeLaw]:
        """Build the law of a section about an axis; options differ from law to law."""
        ...


class AxialLawType(Protocol):
    """A law of axial crushing that can be built for a section."""

    @property
    def of(self) -> Callable[..., AxialLaw]:
        """Build the law of a section; options differ from law to law."""
        ...


class TorsionLawType(Protocol):
    """A law of torsional collapse that can be built for a section."""

    @property
    def of(self) -> Callable[..., TorsionLaw]:
        """Build the law of a section twisted over a length; options differ from law to law."""
        ...


@runtime_checkable
class FromFiles(Protocol):
    """A law whose input may name files: their content replaces their names."""

    file_keys: tuple[Key, ...]
    """Keys that name files, or the format of given values."""

    def embedded(self, given: dict[str, Any], folder: Path | None) -> dict[str, Any]:
        """Keys of a description with the content of files in place of their names."""
        ...


BENDING: Registry[LawType] = Registry(
    "hinge law",
    {
        "constant": "crumple.hinge.bending.constant:ConstantLaw",
        "table": "crumple.hinge.measured.tabulated:TabulatedLaw",
        "kecman": "crumple.hinge.bending.kecman:KecmanLaw",
        "wierzbicki": "crumple.hinge.bending.wierzbicki:WierzbickiLaw",
        "oblique": "crumple.hinge.bending.oblique:ObliqueLaw",
        "circular": "crumple.hinge.bending.circular:CircularLaw",
        "folded_profile": "crumple.hinge.bending.profiles.folded_profile:FoldedProfileLaw",
        "folded_plates": "crumple.hinge.bending.profiles.folded_plates:FoldedPlatesLaw",
        "mitred_corner": "crumple.hinge.corner.mitred_corner:MitredCornerLaw",
        "mitred_corner_across": "crumple.hinge.corner.mitred_corner_across:MitredCornerAcrossLaw",
        "measured": "crumple.hinge.measured.measured_law:MeasuredLaw",
        "file": "crumple.hinge.measured.file_law:FileLaw",
        "library": "crumple.hinge.tube_library.law:TubeLibraryLaw",
        "clamped_tube": "crumple.hinge.tube_library.clamped:ClampedTubeLaw",
        "hardening_tube": "crumple.hinge.tube_library.hardening_tube:HardeningTubeLaw",
        "hardening_section": "crumple.hinge.bending.hardening_section:HardeningSectionLaw",
        "estimate": "crumple.hinge.bending.estimate:EstimatedLaw",
        "auto": "crumple.hinge.bending.estimate:AutoLaw",
    },
)
AUTO = "auto"
"""Type of a hinge without a law: its stored law, else of the library, else a formula, else an estimate."""
DEFAULT_BENDING = {
    "rectangular_tube": "kecman",
    "circular_tube": "circular",
    "channel": "folded_profile",
    "hat": "folded_profile",
    "closed_hat": "folded_profile",
}
"""Formula of a hinge without a law, by the kind of its section."""
FLAT_WALLS = "folded_plates"
"""That of any other section of flat walls, and of these about another axis."""
Fold = Literal["free", "clamped"]
"""Whether a fold lies between joints and clamps, or beside one, which keeps the section in shape."""
FOLD_BENDING: dict[Fold, dict[str, str]] = {
    "free": {"circular_tube": "library", "rectangular_tube": "library"},
    "clamped": {"circular_tube": "clamped_tube", "rectangular_tube": "clamped_tube"},
}
"""Law that goes before the formula in such folds: docs/theory/tube_library.md."""
DEEP = 0.9
"""Flange width over depth up to which it does so at rectangular tubes beside a clamp that do not harden."""
HARDENING_BENDING = {"rectangular_tube": "hardening_tube", "circular_tube": "hardening_tube"}
"""Law that goes before the formula if the metal has a hardening curve."""
HARDENING_SECTION = "hardening_section"
"""That of other sections."""
AXIAL: Registry[AxialLawType] = Registry(
    "axial law",
    {
        "square": "crumple.hinge.axial.square:SquareCrushing",
        "superfolding": "crumple.hinge.axial.superfolding:SuperfoldingCrushing",
        "circular": "crumple.hinge.axial.circular:CircularCrushing",
        "top_hat": "crumple.hinge.axial.top_hat:HatCrushing",
    },
)
TORSION: Registry[TorsionLawType] = Registry(
    "torsion law",
    {
        "plastic": "crumple.hinge.torsion.plastic:PlasticTorsion",
        "square_tube": "crumple.hinge.torsion.square_tube:SquareTubeTorsion",
        "warping": "crumple.hinge.torsion.warping:WarpingTorsion",
    },
)
DEFAULT_TORSION = "plastic"
"""Default law of a hinge in torsion, but for open sections."""
OPEN_TORSION = "warping"
"""That of open sections."""
_Law = TypeVar("_Law")


def options_of(law: LawType | AxialLawType | TorsionLawType) -> tuple[Key, ...]:
    """Keyword options of a law."""
    return keys_of(law.of, options=True)


def needs_curve(name: str) -> bool:
    """Whether a law needs more than a section and a material."""
    return any(option.default is MISSING for option in options_of(BENDING[name]))


def fitting_laws(
    section: Section, material: Material, axis: Axis = "y"
) -> tuple[dict[str, HingeLaw], dict[str, InputError]]:
    """Laws that follow from section and material alone, by name, and why others of that kind do not apply."""
    laws, refused = {}, {}
    for name, law in law_types().items():
        # auto is one of the others, and the estimate is for sections that have none
        if needs_curve(name) or name in {AUTO, "estimate"}:
            continue
        try:
            laws[name] = law.of(section, material, axis)
        except InputError as error:
            refused[name] = error
    return laws, refused


def _built(
    name: str, of: Callable[..., _Law], keys: tuple[Key, ...], *arguments: Any, **options: Any
) -> _Law:
    """Build a law; refuses unknown and missing options with `InputError`."""
    allowed = [key.name for key in keys]
    todo = f"give only options of the law {name}"
    problems = [
        Problem("unknown option", option, ", ".join(allowed) or "none", todo, option)
        for option in options
        if option not in allowed
    ]
    what, todo = f"the law {name} needs more than a section and a material", "give it"
    missing = [key.name for key in keys if key.default is MISSING and key.name not in options]
    problems = problems or [Problem(what, "nothing", option, todo, option) for option in missing]
    if problems:
        raise InputError(problems)
    return of(*arguments, **options)


def law_types() -> dict[str, LawType]:
    """Every bending law class by its name, sorted."""
    return dict(sorted(BENDING.items()))


def axial_law_types() -> dict[str, AxialLawType]:
    """Every axial law class by its name, sorted."""
    return dict(sorted(AXIAL.items()))


def torsion_law_types() -> dict[str, TorsionLawType]:
    """Every torsion law class by its name, sorted."""
    return dict(sorted(TORSION.items()))


def law_options(name: str) -> tuple[str, ...]:
    """Names of the options that `build_law` accepts for a law.

    Raises
    ------
    InputError
        If no law has this name.
    """
    return tuple(option.name for option in options_of(BENDING[name]))


def build_law(name: str, section: Section, material: Material, axis: Axis = "y", **options: Any) -> HingeLaw:
    """Build a bending law by its name.

    Parameters
    ----------
    name
        As in the input file: one of `law_types`.
    section, material, axis
        Section and material of the hinge, and its axis.
    options
        Keyword options of the law, see `law_options`.

    Returns
    -------
    HingeLaw
        Frozen law.

    Raises
    ------
    InputError
        If the name or an option is unknown or missing, or the law does not apply to the section.
    """
    law = BENDING[name]
    return _built(name, law.of, options_of(law), section, material, axis, **options)


def build_axial_law(name: str, section: Section, material: Material, **options: Any) -> AxialLaw:
    """Build an axial law by its name, one of `axial_law_types`; refuses like `build_law`."""
    law = AXIAL[name]
    return _built(name, law.of, options_of(law), section, material, **options)


def build_torsion_law(
    name: str, section: Section, material: Material, length: float, **options: Any
) -> TorsionLaw:
    """Build the torsion law of a member of a length [m] by its name; refuses like `build_law`."""
    law = TORSION[name]
    return _built(name, law.of, options_of(law), section, material, length, **options)
