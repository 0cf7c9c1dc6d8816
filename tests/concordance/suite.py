"""The structures of the suite: families, the half that they belong to, and their shell models.

The halves were fixed before anything was tuned; frames at walls, a second batch, were divided by lot before
any of them was solved. Whoever changes a model of Crumple may look at the structures of the tuned-on half;
those of the judged-by half are only counted. Drawn frames are two further parts, see `DRAWN` and
`DRAWN_LATER`.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.concordance.layouts import LAYOUTS, layout_text

from crumple.analysis import Analysis, loads

FOLDER = Path(__file__).parent / "structures"
Half = Literal["tuned-on", "judged-by", "drawn", "drawn later"]
DRAWN = (
    *(f"drawn_{number}_l_in_plane" for number in ("01", "02", "03")),
    *(f"drawn_{number}_l_across" for number in ("04", "05")),
    *(f"drawn_{number}_bent_arm" for number in ("06", "07")),
    *(f"drawn_{number}_portal" for number in ("08", "09", "10")),
    *(f"drawn_{number}_hoop" for number in ("11", "12")),
    *(f"drawn_{number}_gate" for number in ("13", "14")),
    *(f"drawn_{number}_cranked_arm" for number in ("15", "16")),
    *(f"drawn_{number}_two_storeys" for number in ("17", "18")),
    *(f"drawn_{number}_ring" for number in ("19", "20")),
    *(f"drawn_{number}_brace" for number in ("21", "22")),
    *(f"drawn_{number}_s_rail" for number in ("23", "24")),
)
"""Simple frames whose sections, metals, sizes and speeds a program drew; shells solved each with 4.6 elements
or more along half a fold, without and with an imperfection. None was left out. They may be looked at, as the
tuned-on half."""
DRAWN_LATER = (
    *(f"drawn_{number}_l_in_plane" for number in ("25", "26", "27")),
    *(f"drawn_{number}_l_across" for number in ("28", "29")),
    *(f"drawn_{number}_bent_arm" for number in ("30", "31")),
    *(f"drawn_{number}_portal" for number in ("32", "33", "34")),
    "drawn_35_hoop",
    *(f"drawn_{number}_gate" for number in ("36", "37")),
    *(f"drawn_{number}_cranked_arm" for number in ("38", "39")),
    *(f"drawn_{number}_two_storeys" for number in ("40", "41")),
    *(f"drawn_{number}_ring" for number in ("42", "43")),
    *(f"drawn_{number}_brace" for number in ("44", "45")),
    *(f"drawn_{number}_s_rail" for number in ("46", "47")),
)
"""The same program drew these from another seed before the former were looked at. They are only counted."""
FAMILIES: dict[str, tuple[Half, tuple[str, ...]]] = {
    "chain": ("tuned-on", ("chain_tip", "chain_beam")),
    "portal": ("tuned-on", ("portal_sway", "portal_oblique")),
    "two storeys": ("tuned-on", ("storeys_roof", "storeys_both")),
    "L": ("tuned-on", ("l_closing", "l_opening", "l_across", "l_oblique")),
    "box frame": ("tuned-on", ("box_frame",)),
    "crash box": ("tuned-on", ("crash_box",)),
    "T": ("judged-by", ("t_in_plane", "t_across")),
    "S-rail": ("judged-by", ("s_rail_20", "s_rail_30", "s_rail_45")),
    "hat pillar": ("judged-by", ("hat_pillar",)),
    "ROPS": ("judged-by", ("rops_load", "rops_impact")),
    "buggy": ("judged-by", ("buggy",)),
    "bus ring": ("judged-by", ("bus_ring",)),
    "front rails": ("judged-by", ("front_rails",)),
    "cab": ("judged-by", ("cab",)),
    "frames at walls, tuned-on": (
        "tuned-on",
        ("wall_tilted", "wall_longer_rail", "wall_kinked_rails", "wall_roof_posts", "wall_square_rails"),
    ),
    "frames at walls, judged-by": (
        "judged-by",
        ("wall_bulkhead_nose", "wall_underrun_guard", "wall_round_rails", "wall_ladder", "wall_round_nose"),
    ),
    "drawn frames": ("drawn", DRAWN),
    "frames drawn later": ("drawn later", DRAWN_LATER),
}
"""Half and structures of each family; the layouts for ranking belong to the judged-by half."""
FINER = 0.5
"""Element size in the folds of the finest shell mesh, over that of the input."""
NOT_FINER = (
    "portal_sway",
    "storeys_roof",
    "bus_ring",
    *FAMILIES["frames at walls, tuned-on"][1],
    *FAMILIES["frames at walls, judged-by"][1],
)
"""Structures without the finest mesh, which takes ten to seventeen times as long as that of the input."""
COARSER = 1.5
"""Element size of the coarsest shell mesh, over that of the input."""
IMPERFECTION = 0.05
"""Largest shift of wall nodes of the last shell run, on the coarsest mesh, over the thinnest wall."""


@dataclass(frozen=True)
class Case:
    """One structure of the suite.

    Attributes
    ----------
    name
        Of its file, or of the layout.
    family, half
        See `FAMILIES`.
    """

    name: str
    family: str
    half: Half

    @property
    def text(self) -> str:
        """Its input, as a user would write it."""
        if self.name in LAYOUTS:
            return layout_text(self.name)
        return (FOLDER / f"{self.name}.yaml").read_text("utf-8")

    def analysis(self) -> Analysis:
        """Its input, read."""
        return loads(self.text, file=self.name, directory=FOLDER)

    def shell_runs(self) -> dict[str, Analysis]:
        """The shell models: finer in the folds, as in the input, coarser, and that with an imperfection.

        Layouts have no finer one either: ranking tells apart what the other meshes can. Drawn frames have
        that of the input, without and with an imperfection.
        """
        nominal = self.analysis()
        thickness = min(
            float(nominal.structure.section_of(member).thickness) for member in nominal.structure.members
        )
        imperfection = {"imperfection": nominal.shell.imperfection + IMPERFECTION * thickness}
        if self.half in ("drawn", "drawn later"):
            return {"nominal": nominal, "imperfect": _with_shell(nominal, imperfection)}
        coarse = {
            key: COARSER * size
            for key in ("element_size", "fine_size")
            if (size := getattr(nominal.shell, key)) is not None
        }
        folds = "element_size" if nominal.shell.fine_size is None else "fine_size"
        runs = {
            "nominal": nominal,
            "coarse": _with_shell(nominal, coarse),
            "imperfect": _with_shell(nominal, coarse | imperfection),
        }
        if self.name in LAYOUTS or self.name in NOT_FINER:
            return runs
        return {"fine": _with_shell(nominal, {folds: FINER * getattr(nominal.shell, folds)})} | runs


def _with_shell(analysis: Analysis, changes: dict[str, float]) -> Analysis:
    return analysis.model_copy(update={"shell": analysis.shell.model_copy(update=changes)})


STRUCTURES = tuple(Case(name, family, half) for family, (half, names) in FAMILIES.items() for name in names)
RANKED = tuple(Case(name, "layouts", "judged-by") for name in LAYOUTS)
CASES = {case.name: case for case in (*STRUCTURES, *RANKED)}
