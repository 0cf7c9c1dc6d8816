"""What the engineer describes, once, for every solver."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Self

from pydantic import ValidationInfo, model_validator

from crumple.structure.checks.checks import problems_in
from crumple.structure.keys.member import Member
from crumple.structure.parts import StructureParts
from crumple.structure.schema.spec import raise_all


class Structure(StructureParts):
    """Consistent parts: every name exists, every member has a length, everything is connected."""

    @classmethod
    def of_sound_parts(cls, parts: StructureParts) -> Structure:
        """Structure of parts that were checked together, with what was worked out of them."""
        structure = cls.model_construct(**{key: getattr(parts, key) for key in cls.model_fields})
        # a cached property: as if the structure itself had been asked
        structure.__dict__["kept"] = parts.kept
        return structure

    def with_elastic(self, members: Mapping[str, Member]) -> Self:
        """See `StructureParts`."""
        changed = super().with_elastic(members)
        raise_all(problems_in(changed))
        return changed

    @model_validator(mode="after")
    def _sound(self, info: ValidationInfo) -> Structure:
        """Refuse what cannot be solved, every problem at once; a file's reader has done so, with lines."""
        if not (info.context and info.context.get("checked")):
            raise_all(problems_in(self))
        return self
