"""Stated errors against true ones, where contact, friction and locking leave them to chance.

Reference: runs at a fortieth of the accuracy (docs/theory/stated_errors.md has the convergence and all twenty
structures).  Where the difference of two runs alone was stated, 23 % of the rotations of the looked-at and
18 % of those of the held-back structures erred by more.

Kind: invariant.  Source: derived here.
"""

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


@pytest.mark.parametrize("names", [LOOKED_AT, HELD_BACK], ids=["looked at", "held back"])
def test_nine_of_ten_errors_are_within_the_stated_ones(names, record_figure):
    shares, overstated = {}, []
    for name in names:
        over = []
        truth = figures(error_cases.solved(name, 2.5e-5, checks=False))
        kept = {"rotation": [], "final": [], "energy": [], "displacement": []}
        for accuracy in ACCURACIES:
            found = figures(error_cases.solved(name, accuracy))
            largest = max(value for (kind, _), (value, _) in truth.items() if kind == "rotation")
            for (kind, place), (value, stated) in found.items():
                true = abs(value - truth[kind, place][0])
                kept[kind].append(true <= stated + 1e-9)
                if kind == "rotation" and value > 0.05 * largest:
                    over.append(stated / max(true, 1e-15))
        overstated.append(np.median(over))
        for kind, all_kept in kept.items():
            shares.setdefault(kind, []).append(np.mean(all_kept))
    for kind, found in shares.items():
        record_figure(f"{kind}s within their stated errors", float(np.mean(found)), 1.0, 0.1)
    record_figure("stated over true error of rotations, median", float(np.median(overstated)), 1.0, 9.0)
