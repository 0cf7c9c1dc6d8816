"""What the worker does with a case of every kind: "" where it was accepted, else the message of the refusal.

Any exception but a refusal is a finding, and so is what an accepted case must not give.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from tests.fuzz.strategies import law_texts
from tests.support.stored_laws import law_text

from crumple.analysis import Analysis, check, input_hash, loads, solve
from crumple.comparison.rating.curve_file import read_curves
from crumple.errors import InputError, Problem, Status
from crumple.hinge.measured.law_file import read_law

PATIENCE = 5.0
"""Wall time after which a solve is cancelled [s]; it must obey within the time of a case."""
LONGEST = 200_000
"""Characters of all messages of a refusal."""


def first_message(problems: list[Problem]) -> str:
    """The first of the problems, without names and numbers; all must say something."""
    assert problems, "a refusal without a problem"
    assert all(problem.what for problem in problems), "a problem without a sentence"
    assert sum(len(str(problem)) for problem in problems) < LONGEST, "messages that nobody can read"
    return plain(problems[0].what)


def plain(text: str) -> str:
    """A message without what is in quotes, and without numbers."""
    return re.sub(r"\d[\d.e+-]*", "#", re.sub(r"'[^']*'", "'...'", text.split("\n", maxsplit=1)[0]))[:90]


def refused(call: Callable[[], object]) -> str:
    """The message if the call refuses."""
    try:
        call()
    except InputError as error:
        return first_message(error.problems)
    return ""


def attack_bytes(content: bytes) -> str:
    """Any bytes as an input file."""
    Path("case.yaml").write_bytes(content)
    problems = check("case.yaml")
    return first_message(problems) if problems else ""


def beside(text: str) -> None:
    """Write the files that an input file names: good ones, whatever earlier cases wrote there."""
    if "curve.csv" in text:
        Path("curve.csv").write_text("rotation [deg], moment [N*m]\n0, 0\n2, 900\n10, 700\n30, 500\n")
    if "law.yaml" in text or "store" in text:
        for name, content in (("law.yaml", law_texts()[0]), ("store/a.law.yaml", law_text("0" * 16))):
            Path(name).parent.mkdir(exist_ok=True)
            Path(name).write_text(content, encoding="utf-8")
        Path("bad_store").mkdir(exist_ok=True)
        Path("bad_store/a.law.yaml").write_text("crumple_law: 1\n", encoding="utf-8")


def attack_input(text: str) -> str:
    """An input file: read, hash, lower to the multibody model."""
    beside(text)
    return attack_bytes(text.encode("utf-8", "surrogatepass"))


def attack_shell(text: str) -> str:
    """An input file: mesh it and lower it to shells."""
    beside(text)
    Path("case.yaml").write_text(text, encoding="utf-8", errors="surrogatepass")
    problems = check("case.yaml", "shell")
    return first_message(problems) if problems else ""


def attack_solve(text: str) -> str:
    """An input file: solve it with bodies and hinges, for some seconds at most."""
    analysis: list[Analysis] = []
    beside(text)
    message = refused(lambda: analysis.append(loads(text)))
    if message:
        return message
    assert len(input_hash(analysis[0])) == 64
    end = time.monotonic() + PATIENCE
    return refused(lambda: sound(solve(analysis[0], cancel=lambda: time.monotonic() > end)))


def sound(result: Any) -> None:
    """What every result must keep."""
    assert isinstance(result.status, Status)
    if result.status is Status.COMPLETE:
        assert np.isfinite(result.energy_residual), "complete, but no finite energy residual"
        wrong = [c.name for c in result.channels.values() if np.isinf(c.values).any()]
        assert not wrong, "complete, but infinite values"


def attack_law(text: str) -> str:
    """A law file."""
    return refused(lambda: read_law(text, "law.yaml"))


CURVE_USER = Path(__file__).parent / "bases" / "curve_user.yaml"


def attack_curve(content: bytes) -> str:
    """A CSV file: as curves to compare with, and as the table of a hinge law."""
    Path("curve.csv").write_bytes(content)
    compared = refused(lambda: read_curves(Path("curve.csv")))
    law = refused(lambda: loads(CURVE_USER.read_text(encoding="utf-8")))
    return compared and law


def attack_restart(edits: Mapping[str, Any]) -> str:
    """A restart file of a small shell run, changed; the run goes on from it."""
    from tests.fuzz.restart_base import base, changed

    from crumple.shell import LongRun

    analysis, content = base()
    Path("restart.npz").write_bytes(changed(content, edits))
    asked, end = iter(range(10**9)), time.monotonic() + PATIENCE

    def enough() -> bool:
        return next(asked) > 20 or time.monotonic() > end

    run = LongRun(restart_from=Path("restart.npz"))
    # changed numbers may overflow on the way: the status says so
    with np.errstate(all="ignore"):
        return refused(lambda: solve(analysis, "shell", cancel=enough, long_run=run))


def attack_kernel(payload: tuple[str, Any]) -> str:
    """Calls of a private face of the kernels; any exception with words is a refusal there."""
    from tests.fuzz.kernel_base import CALLS

    room, edits = payload
    try:
        CALLS[room](edits)
    except MemoryError:
        raise
    except Exception as error:
        if not str(error):
            raise
        return plain(f"{type(error).__name__}: {error}")
    return ""


def attack_call(case: tuple[str, list[int]]) -> str:
    """A public function."""
    from tests.fuzz.calls import call

    return refused(lambda: call(*case))


def attack_command(words: list[str]) -> str:
    """A command line."""
    from tests.fuzz.commands import spoken

    message: list[str] = []
    return refused(lambda: message.append(spoken(words))) or plain("".join(message))


def attack_variants(case: tuple[str, dict[str, Any]]) -> str:
    """An input file solved with changed parameters, or its sensitivities."""
    from crumple.multibody import Run, sensitivities, solve_variants

    text, parameters = case
    end = time.monotonic() + PATIENCE

    def run() -> None:
        analysis = loads(text)
        given = Run(
            analysis.duration,
            analysis.output_interval,
            analysis.multibody,
            analysis.outputs,
            stages=analysis.stages,
        )
        late = {"cancel": lambda: time.monotonic() > end}
        if all(np.ndim(value) == 0 for value in parameters.values()):
            sensitivities(analysis.structure, given, parameters, **late)
        else:
            table = solve_variants(analysis.structure, given, parameters, threads=1, **late)
            assert all(isinstance(status, Status) for status in table.status)

    return refused(run)


def attack_result(edits: Any) -> str:
    """A result file, changed."""
    from tests.fuzz.result_base import base, changed

    from crumple.result.store import read

    content = base()
    if edits is None:
        return refused(lambda: read("none"))
    Path("result.vtkhdf").write_bytes(changed(content, edits))
    return refused(lambda: read("result.vtkhdf"))


def attack_self(code: str) -> str:
    """Python code that crashes or hangs: whether the worker reports it."""
    from tests.fuzz.child import limit

    exec(code, {"limit": limit})
    return ""


ATTACKS: dict[str, Callable[[Any], str]] = {
    "bytes": attack_bytes,
    "input": attack_input,
    "solve": attack_solve,
    "shell": attack_shell,
    "law": attack_law,
    "curve": attack_curve,
    "restart": attack_restart,
    "kernel": attack_kernel,
    "call": attack_call,
    "command": attack_command,
    "variants": attack_variants,
    "result": attack_result,
    "self-test": attack_self,
}
"""By kind."""
