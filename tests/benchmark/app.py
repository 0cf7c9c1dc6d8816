"""Answers a second of the app for a dragged value: text in, shapes and curves out, drawing excluded.

Processor time of the process that solves, for values of one number of each input, as while a slider is
dragged: without the checks that follow when it is let go, and without the way through the socket.  Bounds:
30 a second for the tube, 10 for a planar frame of 20 members; the others have none.
"""

from __future__ import annotations

import re
import statistics
import sys
import time
from pathlib import Path

from crumple.app.answer import Answering, Job

EXAMPLES = Path(__file__).parents[2] / "examples"
VALUES, FEWEST, LONGEST = 25, 5, 5.0
"""Most and fewest values, and the processor time [s] after which the fewest are enough."""
FRAME_HEAD = """crumple: 1
title: Frame of four storeys struck at a corner
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 60 mm, thickness: 3 mm}}
hinges: auto
masses: {roof: {node: n04, mass: 250 kg}}
impulses: [{node: n04, impulse: [2 kN*s, 0 N*s, 0 N*s]}]
analysis: {duration: 100 ms}
outputs: {every: 1 ms, nodes: [n01]}
"""


def frame(storeys: int = 4, bays: int = 2) -> str:
    """Planar frame of 20 members with 38 hinges, all of which turn."""
    nodes, members, supports = [], [], []
    for i in range(bays + 1):
        supports.append(f"  clamp{i}: {{node: n{i}0, fix: all}}")
        for j in range(storeys + 1):
            nodes.append(f"  n{i}{j}: [{2 * i} m, 0 m, {1.2 * j:g} m]")
            ends = ([f"n{i}{j - 1}, n{i}{j}"] if j else []) + ([f"n{i - 1}{j}, n{i}{j}"] if i and j else [])
            for name, pair in zip(("column", "beam"), ends, strict=False):
                members.append(f"  {name}{i}{j}: {{nodes: [{pair}], section: tube, material: steel}}")
    parts = (("nodes:", nodes), ("members:", members), ("supports:", supports))
    return FRAME_HEAD + "".join("\n".join([head, *rows, ""]) for head, rows in parts)


def example(name: str) -> str:
    """Text of an example."""
    return (EXAMPLES / name).read_text(encoding="utf-8")


CASES = (
    ("tube", example("01_tube_bending.yaml"), 30.0),
    ("frame of 20 members, planar", frame(), 10.0),
    ("portal frame, planar", example("04_portal_frame.yaml"), None),
    ("bus ring, planar", example("10_bus_ring.yaml"), None),
    ("box frame, spatial", example("09_box_frame.yaml"), None),
    ("buggy, spatial", example("16_buggy.yaml"), None),
)
"""Name, text and bound [1/s]; the first thickness is dragged."""


def main() -> int:
    """Print a line per case; the number of cases that are slower than their bound."""
    missed = 0
    for name, text, bound in CASES:
        found = re.search(r"thickness: [0-9.]+", text)
        assert found is not None
        start, value = found[0].split(" ")
        answering, spent = Answering(), []
        for i in range(VALUES):
            changed = f"{start} {float(value) * (1.0 + 0.005 * i):.6g}"
            job = Job("solve", (("input.yaml", text.replace(found[0], changed)),), quick=True)
            begin = time.process_time()
            answer = answering(job, lambda share: True, lambda: False)
            spent.append(time.process_time() - begin)
            assert answer.get("scene"), answer["problems"]
            if i >= FEWEST and sum(spent) > LONGEST:
                break
        # the first ones import what they need
        rate = 1.0 / statistics.median(spent[3:])
        late = bound is not None and rate < bound
        missed += late
        wanted = "" if bound is None else f", bound {bound:g}{' MISSED' if late else ''}"
        print(f"{name:28} {rate:8.1f} answers a second{wanted}")
    return missed


if __name__ == "__main__":
    sys.exit(main())
