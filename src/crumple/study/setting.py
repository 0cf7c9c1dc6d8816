"""A study with all its quantities in SI, checked against its base."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from crumple.analysis import Analysis, input_hash, solve
from crumple.analysis.criteria import Measured, late
from crumple.analysis.distribution import number
from crumple.errors import InputError, Problem
from crumple.structure.schema.problems import one_of, suggestion
from crumple.study.space import Axis, axes_of
from crumple.study.study_file import OPTIMISERS, LoadedStudy, Study, refuse_contradictions


@dataclass(frozen=True)
class Setting:
    """A study with all quantities in SI.

    Attributes
    ----------
    study
        As described.
    axes, measured
        Variables, and responses that are read from results.
    limits
        Of each constraint: response, lower limit and upper limit, less the reserve of `verify`.
    units
        SI unit of each response; "1" if it has none.
    folder
        That file names are relative to.
    identity
        Hash of study and base.
    base
        What is varied; None for a function.
    slow_limits
        Of each constraint without reserve, for the slower model.
    """

    study: Study
    axes: list[Axis]
    measured: list[Measured]
    limits: list[tuple[str, float, float]]
    units: Mapping[str, str]
    folder: Path
    identity: str
    base: Analysis | None = None
    slow_limits: Sequence[tuple[str, float, float]] = ()


def setting_of(study: LoadedStudy) -> Setting:
    """A study file in SI; refusals have its lines."""
    with study.lines():
        others = [one.analysis for one in study.bases.values() if one is not study.base]
        return setting_for(
            study.study, study.folder, study.base.analysis, study.base.document.data, tuple(others)
        )


def setting_for(
    study: Study,
    folder: Path,
    base: Analysis | None,
    document: object | None,
    others: Sequence[Analysis] = (),
) -> Setting:
    """A study in SI.

    Parameters
    ----------
    study
        As described.
    folder
        That file names are relative to.
    base, document
        What is varied, and its file as written; None for a function.
    others
        Further bases.

    Raises
    ------
    InputError
        With mistakes of the study.
    """
    refuse_contradictions(study)
    axes = axes_of(study, document)
    units = dict.fromkeys(study.responses, "1")
    if base is not None:
        units |= _units(study, base)
        for other in others:
            _units(study, other)
    measured = [
        Measured(
            name,
            response.channel if base is not None else name,
            response.take,
            0.0 if response.time is None else number(response.time, "s", f"responses.{name}.time"),
        )
        for name, response in study.responses.items()
        if not response.formula
    ]
    end = min((one.duration for one in (base, *others) if one is not None), default=np.inf)
    problems = [p for one in measured for p in late(one.time, end, f"responses.{one.name}.time")]
    if problems:
        raise InputError(problems)
    limits = []
    for i, limit in enumerate(study.constraints):
        unit, where = units[limit.response], f"constraints.{i}"
        low = -np.inf if limit.at_least is None else number(limit.at_least, unit, f"{where}.at_least")
        high = np.inf if limit.at_most is None else number(limit.at_most, unit, f"{where}.at_most")
        if low > high:
            what, todo = "no value is within both limits", "correct one of them"
            came = f"at_least {limit.at_least}, at_most {limit.at_most}"
            raise InputError(Problem(what, came, "at_least below at_most", todo, where))
        limits.append((limit.response, low, high))
    reserve = 0.0 if study.verify is None else study.verify.reserve
    fast = [(name, _clear(low, reserve), _clear(high, -reserve)) for name, low, high in limits]
    content = study.model_dump_json(exclude={"base", "bases", "title", "verify"})
    # which points an optimiser asks for depends on it
    content += f" reserve {reserve}" if reserve and study.method.type in OPTIMISERS else ""
    content += "".join(input_hash(one) for one in (base, *others) if one is not None)
    identity = hashlib.sha256(content.encode()).hexdigest()
    return Setting(study, axes, measured, fast, units, folder, identity, base, limits)


def _clear(limit: float, share: float) -> float:
    """A limit with a share of its magnitude added; none stays none."""
    return limit + share * abs(limit) if np.isfinite(limit) else limit


def _units(study: Study, base: Analysis) -> dict[str, str]:
    """Units of responses by the channels of the base, solved as a multibody model."""
    found, result = {}, solve(base)
    for name, response in study.responses.items():
        if response.mass:
            found[name] = "kg"
        elif response.channel:
            channel = result.channels.get(response.channel)
            if channel is None:
                known = sorted(result.channels)
                todo = suggestion(response.channel, known) or "name a channel of the result"
                what, where = "the result has no such channel", f"responses.{name}.channel"
                raise InputError(Problem(what, response.channel[:80], one_of(known), todo, where))
            found[name] = channel.unit
    return found
