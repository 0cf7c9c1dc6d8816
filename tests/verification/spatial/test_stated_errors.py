"""Stated errors against true ones, where contact, friction and locking leave them to chance.

Reference: runs at a fortieth of the accuracy (docs/theory/stated_errors.md has the convergence and all twenty
structures).  Where the difference of two runs alone was stated, 23 % of the rotations of the looked-at and
18 % of those of the held-back structures erred by more.

Kind: invariant.  Source: derived here.
"""

from functools import cache

import numpy as np
import pytest
from tests.support.multibody import error_cases

ACCURACIES = (8e-4, 1e-3, 1.25e-3)
"""Neighbouring ones: what single runs err by is a matter of chance."""
LOOKED_AT = (
    "box_slides",
    "corner_piece_falls",
    "ladder_on_pole",
    "portal_struck",
    "ring_in_corner",
    "chain_on_stops",
)
HELD_BACK = (
    "hexagon_spins",
    "cage_rolls",
    "t_frame_on_pole",
    "ladder_in_corner",
    "springy_chain",
    "gate_struck",
)
"""Those that a run solves within a second."""


def figures(result):
    """Rotations (largest, final) and energies of hinges, largest displacements of nodes, and their errors."""
    nodes = [name for name in result if name.startswith("node.") and ".displacement." in name]
    return {
        **{("rotation", name): (h.rotation_max, h.rotation_error) for name, h in result.hinges.items()},
        **{("final", name): (h.rotation_final, h.rotation_error) for name, h in result.hinges.items()},
        **{("energy", name): (h.energy, h.energy_error) for name, h in result.hinges.items()},
        **{
            ("displacement", name): (
                float(np.abs(result[name]).max()), result.displacement_errors.get(name.split(".")[1])
            )
            for name in nodes
        },
    }  # fmt: skip


@cache
def judged(name):
    """Of a structure: which figures err by at most what is stated, by kind, and stated over true errors."""
    kept, over = {"rotation": [], "final": [], "energy": [], "displacement": []}, []
    truth = figures(error_cases.solved(name, 2.5e-5, checks=False))
    largest = max(value for (kind, _), (value, _) in truth.items() if kind == "rotation")
    for accuracy in ACCURACIES:
        for (kind, place), (value, stated) in figures(error_cases.solved(name, accuracy)).items():
            true = abs(value - truth[kind, place][0])
            kept[kind].append(true <= stated + 1e-9)
            if kind == "rotation" and value > 0.05 * largest:
                over.append(stated / max(true, 1e-15))
    return kept, float(np.median(over))


@pytest.mark.parametrize("names", [LOOKED_AT, HELD_BACK], ids=["looked at", "held back"])
def test_nine_of_ten_errors_are_within_the_stated_ones(names, record_figure):
    for kind in ("rotation", "final", "energy", "displacement"):
        shares = [np.mean(judged(name)[0][kind]) for name in names]
        record_figure(f"{kind}s within their stated errors", float(np.mean(shares)), 1.0, 0.1)


def test_errors_are_stated_without_excess(record_figure):
    """Of all structures: the median of six hangs on one whose true errors vanish by chance."""
    overstated = [judged(name)[1] for name in (*LOOKED_AT, *HELD_BACK)]
    record_figure("stated over true error of rotations, median", float(np.median(overstated)), 1.0, 9.0)
