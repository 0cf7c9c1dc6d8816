"""Attack Crumple with random input: `python -m tests.fuzz 10000 --seed 1`, or `make fuzz N=10000`.

Prints cases by kind, the share that was accepted, refusals by message, refusals of the code that were not
reached, and what was found; findings are saved, shrunk, in out/fuzz.  The exit code is 1 if there are any.
"""

from __future__ import annotations

import argparse
import math
import pickle
import sys
import time
from pathlib import Path

from tests.fuzz.campaign import SHARES, campaign
from tests.fuzz.worker import Worker


def main() -> int:
    """Run a campaign, or one saved case again."""
    words = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    words.add_argument("number", nargs="?", type=int, default=2000, help="cases")
    words.add_argument("--seed", type=int, default=0, help="another one gives other cases")
    words.add_argument("--minutes", type=float, default=math.inf, help="begin nothing new after so long")
    words.add_argument("--kinds", nargs="+", choices=sorted(SHARES), help="only these")
    words.add_argument("--out", type=Path, default=Path("out/fuzz"), help="folder of findings")
    words.add_argument("--again", type=Path, metavar="FILE.case", help="try a saved case once more")
    words.add_argument("--messages", type=int, default=12, help="refusals shown of every kind")
    given = words.parse_args()
    if given.again:
        with Worker() as worker:
            # our own file
            outcome = worker.run(pickle.loads(given.again.read_bytes()))
        print(outcome.finding or outcome.message or "accepted", outcome.detail, sep="\n")
        return int(bool(outcome.finding))
    begin = time.monotonic()
    shares = {kind: share for kind, share in SHARES.items() if not given.kinds or kind in given.kinds}
    tally = campaign(given.number, given.seed, shares, folder=given.out, longest=60 * given.minutes)
    print(tally.table(given.messages))
    print(f"\n{sum(tally.tried.values())} cases in {time.monotonic() - begin:.0f} s")
    return int(bool(tally.findings))


if __name__ == "__main__":
    sys.exit(main())
