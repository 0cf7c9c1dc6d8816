"""Several sub-models at a time, each in a process of its own that writes its law when it has it.

A sub-model that is not finished leaves nothing; laws that are written stay, whatever ends the program.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from crumple.characterisation.solving import characterise
from crumple.characterisation.store import LawStore
from crumple.characterisation.sub_model import SubModel
from crumple.errors import CrumpleError
from crumple.processes import Report, in_processes


@dataclass(frozen=True)
class Done:
    """End of one sub-model.

    Attributes
    ----------
    number
        Of the sub-model.
    path
        Of its law; None if it failed.
    reason
        Why it failed.
    """

    number: int
    path: Path | None
    reason: str = ""


@dataclass(frozen=True)
class _Job:
    model: SubModel
    folder: Path
    converge: bool


def characterise_all(
    models: Sequence[SubModel],
    folder: Path,
    *,
    workers: int,
    converge: bool = False,
    progress: Callable[[int, float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Iterator[Done]:
    """Solve sub-models in parallel processes; laws are in the folder as soon as they are known.

    Parameters
    ----------
    models
        In the order in which they are begun.
    folder
        Store of the laws.
    workers
        Number of processes at a time, at least 1.
    converge
        As in `characterise`.
    progress
        Called with the number of a sub-model and the share of its work that is done.
    cancel
        Called repeatedly; if it returns True, the processes are ended.

    Yields
    ------
    Done
        Each sub-model when it ends; those not finished when cancelled are missing.
    """
    jobs = [_Job(model, folder, converge) for model in models]
    for number, answer in in_processes(_work, jobs, workers, progress, cancel):
        path, reason = answer or (None, "its process ended without a result")
        yield Done(number, path, reason)


def _work(job: _Job, report: Report) -> tuple[Path | None, str]:
    """Solve one sub-model and write its law; path, or reason of a failure."""
    parts, alone = _Parts(), [False]

    def progress(what: str, share: float) -> None:
        alone[0] = not report(parts.share(what, share))

    try:
        found = characterise(job.model, converge=job.converge, progress=progress, cancel=lambda: alone[0])
        return LawStore(job.folder).keep(job.model, found.law), ""
    except CrumpleError as error:
        return None, str(error).strip() or type(error).__name__
    except KeyboardInterrupt:
        return None, "the program that started it ended"


class _Parts:
    """Share of the work done, if the number of parts is not known before: 1 - 2^-n after n parts."""

    def __init__(self) -> None:
        self._names: list[str] = []

    def share(self, name: str, inside: float) -> float:
        """Share done when a part has done a share of its own."""
        if name not in self._names:
            self._names.append(name)
        begun = self._names.index(name)
        return float(1.0 - 0.5**begun * (1.0 - 0.5 * inside))
