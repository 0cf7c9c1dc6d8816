"""A campaign of random frames: `python tests/benchmark/random_frames.py --number 1000 --out
out/frames.jsonl`.

Every case runs in a process of its own, two at a time unless `--processes` states another number, and adds a
line to the file: its status and reason, energy residual, steps, linear solves, processor time, and whether a
number of the answer is not finite.  Cases that are in the file already are not run again, so a campaign that
was stopped goes on.  A case that takes longer than the limit is stopped and counts as failed ("time limit").
At the end a table of outcomes, and the cases that did not complete.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.support import random_frames

import crumple

Row = dict[str, Any]
Frame = Callable[[int, int], crumple.Analysis]
RESIDUAL = 1e-3
"""Energy residual up to which a complete run counts as solved."""
GRACE = 60.0
"""What a process may take beyond the limit, as it asks for the time only between steps [s]."""


def outcome(frame: Frame, seed: int, index: int, limit: float) -> Row:
    """Solve one case and say how it ended; within this process."""
    begin = time.process_time()
    row: Row = {"seed": seed, "index": index}
    try:
        analysis = frame(seed, index)
        result = crumple.solve(analysis, cancel=lambda: time.process_time() - begin > limit)
    except crumple.InputError as error:
        return {**row, "status": "refused", "reason": str(error)[:300], "cpu": time.process_time() - begin}
    except Exception as error:  # a traceback is an outcome to report
        return {**row, "status": "raised", "reason": repr(error)[:300], "cpu": time.process_time() - begin}
    status = result.status.value
    settings = result.provenance.settings
    return {
        **row,
        "status": "time limit" if status == "cancelled" else status,
        "reason": result.reason,
        "residual": result.energy_residual,
        "finite": all(np.isfinite(channel.values).all() for channel in result.channels.values()),
        "steps": settings["steps"] + settings["rejected_steps"],
        "solves": settings["newton_steps"],
        "kernel": settings["kernel"],
        "end": float(result.time[-1]),
        "error": max((hinge.rotation_error or 0.0 for hinge in result.hinges.values()), default=0.0),
        "cpu": time.process_time() - begin,
    }


def _worker(pipe: Any, frame: Frame, seed: int, index: int, limit: float) -> None:
    pipe.send(outcome(frame, seed, index, limit))


def guarded(frame: Frame, seed: int, index: int, limit: float) -> Row:
    """The same in a process of its own, which may die or hang."""
    here, there = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.get_context("fork").Process(
        target=_worker, args=(there, frame, seed, index, limit)
    )
    begin = time.perf_counter()
    process.start()
    there.close()
    row: Row = {"seed": seed, "index": index, "status": "crashed", "reason": "", "cpu": 0.0}
    # the limit is processor time; others may use the machine
    if here.poll(5.0 * limit + GRACE):
        try:
            row = here.recv()
        except EOFError:
            row["reason"] = "the process ended"
    else:
        row = {**row, "status": "hung", "cpu": time.perf_counter() - begin}
        process.kill()
    process.join()
    return row


def campaign(
    frame: Frame, seed: int, indices: Iterable[int], out: Path, limit: float, processes: int = 2
) -> list[Row]:
    """Run what the file does not hold yet; all rows of the indices."""
    rows = {row["index"]: row for row in _stored(out) if row["seed"] == seed}
    wanted = list(indices)
    todo = [index for index in wanted if index not in rows]
    out.parent.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(processes) as pool, out.open("a", encoding="utf-8") as file:
        for row in pool.map(lambda index: guarded(frame, seed, index, limit), todo):
            rows[row["index"]] = row
            file.write(json.dumps(row) + "\n")
            file.flush()
    return [rows[index] for index in wanted]


def _stored(out: Path) -> Iterator[Row]:
    if out.exists():
        for line in out.read_text(encoding="utf-8").splitlines():
            yield json.loads(line)


def solved(row: Row) -> bool:
    """Whether a run ended complete with a small residual and finite numbers."""
    return row["status"] == "complete" and row["residual"] <= RESIDUAL and row["finite"]


def table(rows: list[Row]) -> str:
    """Outcomes, largest figures, and what did not complete."""
    counts = Counter("solved" if solved(row) else row["status"] for row in rows)
    lines = [f"{len(rows)} frames: " + ", ".join(f"{n} {name}" for name, n in counts.most_common())]
    for key, what in (("steps", "steps"), ("solves", "linear solves"), ("cpu", "processor time [s]")):
        values = np.array([row.get(key) or 0.0 for row in rows])
        parts = ", ".join(
            f"{name} {value:.4g}"
            for name, value in zip(
                ("median", "99 %", "largest", "sum"),
                (*np.percentile(values, (50, 99, 100)), values.sum()),
                strict=True,
            )
        )
        lines.append(f"{what}: {parts}")
    for row in rows:
        if solved(row):
            continue
        cost = f"{row.get('steps')} steps, {row.get('solves')} solves, {row['cpu']:.1f} s"
        what = f"{row['status']}, residual {row.get('residual', 0.0):.1e}, {cost}"
        lines.append(f"  {row['index']}: {what}. {row['reason'][:140]}")
    return "\n".join(lines)


def main() -> None:
    """Run a campaign and print its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--number", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", default="campaign", help="a name in SEEDS, or a number")
    parser.add_argument("--limit", type=float, default=60.0, help="processor time of a case [s]")
    parser.add_argument("--processes", type=int, default=2, help="cases at a time")
    parser.add_argument("--out", type=Path, default=Path("out/random_frames.jsonl"))
    given = parser.parse_args()
    seed = random_frames.SEEDS.get(given.seed) or int(given.seed)
    indices = range(given.first, given.first + given.number)
    rows = campaign(random_frames.frame, seed, indices, given.out, given.limit, given.processes)
    print(table(rows))


if __name__ == "__main__":
    main()
