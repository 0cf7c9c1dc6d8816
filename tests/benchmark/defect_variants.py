"""Inputs that once showed a defect, each as it is and with one of its numbers 20 % lower and higher.

`python tests/benchmark/defect_variants.py FOLDER [NAME ...] [--limit 60]` solves the files of a folder, or
those whose names begin with NAME, and prints what came out beside what is right.  Every variant runs in a
process of its own with a limit of processor time; of a script of the folder the last line is printed.
The table below names the numbers by the text in which they stand.
"""

from __future__ import annotations

import argparse
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FACTORS = (0.8, 1.2)
GRACE = 15
"""Processor time of a process beyond the limit before it is killed [s]: a run asks for the time itself."""
LEFT = 60
"""Number of characters of a reason or a line that are shown."""
ROTATION = "'rotation %.4f rad' % max(h.rotation_max for h in r.hinges.values())"
CRUSH = "'crushed %.1f mm' % (1e3 * max(h.crush.length for h in r.hinges.values() if h.crush))"
STIFFNESS = (
    "'%.4g MN/m' % (2e-6 * r['energy.external_work'][-1] / abs(r['node.top.displacement.x'][-1]) ** 2)"
)


@dataclass(frozen=True)
class Case:
    """A file, the texts that hold its changed numbers, what is right, and what to show of a result."""

    file: str
    numbers: tuple[str, ...]
    right: str
    show: str = ROTATION


CASES = (
    Case("01_thin_tube_traceback.yaml", ("thickness: 0.04 mm", "side: 40 mm"), "refused: wall too thin"),
    Case("02_spacing_memory.yaml", ("spacing: 1e-12 m",), "refused by count"),
    Case("03_pitch_memory.yaml", ("pitch: 1e-9 m",), "refused by count"),
    Case("05_superscript_digit_name.yaml", ("mass: 10 kg",), "refused: not a name"),
    Case("07_stuck_20bars.yaml", ('"mass": "5 kg"', '"20 N*s"'), "progress, or an end with a status"),
    Case("08_slow_4086.yaml", ('"mass": "5 kg"',), "progress, or an end with a status"),
    Case("08_slow_friction_3002.yaml", ('"mass": "300 kg"',), "progress, or an end with a status"),
    Case("08_slow_overlap_2721.yaml", ('"mass": "10 kg"',), "progress, or an end with a status"),
    Case("09_long_member_memory_2092.yaml", ('"1.2e+06 m"',), "refused by count"),
    Case("12_ascii_terminal.yaml", ("mass: 10 kg",), "complete"),
    Case("13_negative_friction_1149.yaml", ('"mass": "300 kg"',), "complete, friction never negative"),
    Case("14_api_misuse.py", ("(4)*.01",), "errors, no crash"),
    Case("buggy_on_a_corner.yaml", ("-5.425 m/s", "diameter: 38 mm"), "seconds; energy lost is told"),
    Case("bus_ring_from_the_docs.yaml", ("mass: 250 kg", "-0.8 m]"), "some 15 s; progress is shown"),
    Case("crash_box.yaml", ("mass: 500 kg", "thickness: 2 mm"), "crush length; bottoming is told", CRUSH),
    Case("guided_column_stiffness.yaml", ("10 mm]", "thickness: 5 mm"), "12 E I/L^3 = 2.140 MN/m", STIFFNESS),
    Case("missed_pulse.yaml", ("mass: 20 kg", "moment: 1 kN*m"), "some 0.2 rad"),
    Case("pulse_silently_missed.yaml", ("mass: 20 kg", "moment: 1 kN*m"), "0.240 rad"),
    Case("overhang.yaml", ("mass: 15 kg", "8 m/s"), "complete"),
    Case("pillar_nonsense_complete.yaml", ("mass: 300 kg", "-8 m/s"), "refused, or physical"),
    Case("reversed_joint.yaml", ("-80 mm",), "no virgin moment again"),
    Case("t_frame_explodes.yaml", ("mass: 15 kg", "side: 60 mm"), "some 30 deg at the stem"),
    Case("driven_motion_missed.py", ('"mass":5.0',), "6.17 rad for the obstacle"),
    Case("pulse_accuracy.py", ("m=2.9",), "errors fall with accuracy"),
    Case("section_force_first_order.py", ("mu=5.0",), "errors of second order"),
    Case("seed353.py", ("12.917190566551607",), "complete at all accuracies"),
    Case("step_collapses.py", ("20.087468886811585",), "complete at all accuracies"),
)
SOLVE = """
import sys, time, crumple
path, limit = sys.argv[1], float(sys.argv[2])
try:
    a = crumple.load(path)
    r = crumple.solve(a, cancel=lambda: time.process_time() > limit)
except crumple.InputError as error:
    print("refused:", error.problems[0].what)
else:
    codes = ", ".join(caution.code for caution in r.cautions)
    at = r.time[-1] / a.duration if len(r.time) else 0.0
    shown = %s if r.hinges else ""
    end = f"at {at:.0%%}; residual {r.energy_residual:.0e}; {codes or r.reason}"
    print(f"{r.status.name.lower()}; {shown}; {end}")
"""
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def variants(case: Case, text: str) -> Iterator[tuple[str, str]]:
    """Name and text of the file as it is and with each number changed.

    Raises
    ------
    ValueError
        If a text of the table is not in the file.
    """
    yield "as it is", text
    for place in case.numbers:
        if place not in text:
            raise ValueError(f"{case.file} does not contain {place!r}")
        number = _NUMBER.findall(place)[-1]
        for factor in FACTORS:
            changed = f"{float(number) * factor:.9g}"
            head, _, tail = place.rpartition(number)
            yield f"{place} x {factor:g}", text.replace(place, head + changed + tail, 1)


def outcome(case: Case, path: Path, limit: float) -> str:
    """What a run of a file gave, in one line."""
    words = [sys.executable, str(path)]
    if path.suffix == ".yaml":
        words = [sys.executable, "-c", SOLVE % case.show, str(path), str(limit)]
    most = int(limit) + GRACE

    def bounded() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (most, most))

    done = subprocess.run(
        words, cwd=path.parent, capture_output=True, text=True, check=False, preexec_fn=bounded
    )
    lines = (done.stdout.strip() or done.stderr.strip() or "nothing").splitlines()
    ended = "" if done.returncode == 0 else f"exit code {done.returncode}; "
    used = len(lines) if path.suffix == ".py" else 1
    return ended + (f"{used} lines, last: {lines[-1][-LEFT:]}" if used > 1 else lines[-1][: 3 * LEFT])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="the files of the table")
    parser.add_argument("names", nargs="*", help="begins of names of files; without: all")
    parser.add_argument("--limit", type=float, default=60.0, help="processor time of a run [s]")
    given = parser.parse_args()
    for case in CASES:
        if given.names and not case.file.startswith(tuple(given.names)):
            continue
        print(f"{case.file}: right is: {case.right}", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            for file in given.folder.iterdir():
                shutil.copyfile(file, Path(folder) / file.name)
            path = Path(folder) / case.file
            for name, text in variants(case, path.read_text(encoding="utf-8")):
                path.write_text(text, encoding="utf-8")
                print(f"  {name:32} {outcome(case, path, given.limit)}", flush=True)


if __name__ == "__main__":
    main()
