"""What every section of a description has in common.

Walls may be of other metals than the member: by the name of a material of the structure, or described in
place.  A section is therefore built with the structure's materials; without them only its geometry is
available.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Annotated, Any

from pydantic import Discriminator, Tag, model_validator

from crumple.errors import InputError, Problem
from crumple.material import Material
from crumple.registry.refusal import refuse
from crumple.section import Section
from crumple.structure.keys.material import MaterialSpec
from crumple.structure.remembered import remembered
from crumple.structure.schema.problems import one_of
from crumple.structure.schema.spec import Name, Spec


def _material_tag(given: Any) -> str:
    return "(name)" if isinstance(given, str | int) else "(material)"


MaterialReference = Annotated[
    Annotated[Name, Tag("(name)")] | Annotated[MaterialSpec, Tag("(material)")],
    Discriminator(_material_tag),
]
"""Name of a material of the structure, or a material described in place."""

Metal = Callable[[MaterialReference | None], Material | None]
"""Gives the metal that a reference means; None: the member's."""


class AnySection(Spec):
    """Base of every section."""

    @model_validator(mode="after")
    def _consistent(self) -> AnySection:
        try:
            self.section()
        except InputError as error:
            refuse("the section is not consistent", problems=self.placed(error.problems))
        return self

    def placed(self, problems: list[Problem]) -> list[Problem]:
        """Problems of the section room with the keys of this description as their places, each key once."""
        placed: dict[tuple[str, str], Problem] = {}
        for problem in problems:
            key = problem.where.rpartition(".")[2]
            where = key if key in self.key_names else ""
            placed.setdefault((problem.what, where), replace(problem, where=where))
        return list(placed.values())

    def references(self) -> dict[str, MaterialReference | None]:
        """Metals that the section itself names, by the path of their key."""
        return {}

    def named_materials(self) -> dict[str, str]:
        """Names of materials that must exist, by the path of their key."""
        return {where: given for where, given in self.references().items() if isinstance(given, str)}

    def section(self, materials: Mapping[str, MaterialSpec] | None = None) -> Section:
        """Section of the physics room.

        Parameters
        ----------
        materials
            Those of the structure; None: every wall is taken as of the member's metal.

        Raises
        ------
        InputError
            If the section cannot be, or names a material that is not there.
        """
        if materials is None:
            return _built(self, None)
        named = self.named_materials()
        problems = [
            Problem(f"there is no material '{name}'", name, one_of(materials), "define it", where)
            for where, name in named.items()
            if name not in materials
        ]
        if problems:
            raise InputError(problems)
        return _built(self, tuple((name, materials[name]) for name in sorted(set(named.values()))))

    def shape(self, metal: Metal) -> Section:
        """Build the section, with the metals that references mean."""
        raise NotImplementedError


@remembered(256)
def _built(spec: AnySection, known: tuple[tuple[str, MaterialSpec], ...] | None) -> Section:
    """One object per description, so that its computed properties are reused."""
    materials = dict(known or ())

    def metal(reference: MaterialReference | None) -> Material | None:
        if reference is None or known is None:
            return None
        if isinstance(reference, str):
            return materials[reference].material(reference)
        return reference.material("in place")

    return spec.shape(metal)
