"""Where the law of a hinge comes from, for people: user, store, library, formula, or an estimate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from crumple.portable import command_line

Origin = Literal["user", "stored", "library", "formula", "estimate"]
INPUT = "INPUT"
"""Stands for the name of the input file in a command: a structure does not know it."""


@dataclass(frozen=True)
class LawUse:
    """Origin of a hinge's law.

    Attributes
    ----------
    origin
        ``user``: the input names it; ``stored``: found in the store of laws; ``library``: of tubes;
        ``formula``: of the section's shape; ``estimate``: nothing backs it.
    content
        Hash of the law, 16 hexadecimal digits: of the law file, or of the sampled curves.
    band
        Relative half-width of the band of the law [-]; None: not known.
    command
        Command that gives a better law, with `INPUT` for the input file; empty: there is none.
    has_checksum
        Whether the file of a stored or given law shows that it is as a program wrote it; true for others.
    """

    origin: Origin
    content: str
    band: float | None = None
    command: str = ""
    has_checksum: bool = True

    def sentence(self, file: str = INPUT) -> str:
        """Origin, band and hash in a few words, with the command for an input file."""
        words = {
            "user": "given in the input",
            "stored": "stored, from shells",
            "library": "library of tubes solved by shells",
            "formula": "formula",
            "estimate": "estimate without evidence",
        }
        band = "band not known" if self.band is None else f"band ±{100.0 * self.band:.2g} %"
        unsure = "" if self.has_checksum else ", without a checksum"
        better = f"; better: {self.command.replace(INPUT, command_line(file))}" if self.command else ""
        return f"{words[self.origin]}{unsure}, {band}, {self.content}{better}"
