"""The result in one small mapping: the content of summary.json, printed by ``--json``."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from crumple.result.format import FORMAT
from crumple.result.result import HingeSummary, Result
from crumple.result.scatter import Scatter

_HINGE_KEYS = (
    "rotation_max", "rotation_final", "time_of_rest", "energy", "moment_max", "rotation_error",
    "energy_error", "law", "source", "form", "validity_rotation", "validity_basis", "law_rotation",
    "position", "fracture_time", "fracture_moment",
)  # fmt: skip


def summary(result: Result) -> dict[str, Any]:
    """Status, energies, hinges and requested outputs in SI, as strict JSON values.

    Parameters
    ----------
    result
        Of either fidelity.

    Returns
    -------
    dict
        As docs/output.md describes it.  A number that is not finite becomes None.
    """
    hinges = {name: _of_hinge(hinge) for name, hinge in result.hinges.items()}
    outputs = {
        name: {"final": o.final, "max": o.max, "time_of_max": o.time_of_max, "unit": o.unit}
        for name, o in result.outputs.items()
    }
    stages = [{"name": s.name, "start": s.start, "end": s.end, "ended_by": s.ended_by} for s in result.stages]
    content = {
        "format": FORMAT,
        "title": result.title,
        "status": result.status.value,
        "ok": result.status.ok,
        "reason": result.reason,
        "fidelity": result.fidelity,
        "end_time": float(result.time[-1]) if result.time.size else None,
        "solve_seconds": result.solve_seconds,
        "energy_residual": result.energy_residual,
        "displacement_errors": dict(result.displacement_errors),
        "stages": stages,
        "hinges": hinges,
        "outputs": outputs,
        "crumpled_ends": [asdict(end) for end in result.crumpled_ends],
        "dents": [asdict(dent) for dent in result.dents],
        "collapse": [asdict(opening) for opening in result.collapse],
        "collapse_threshold": result.collapse_threshold,
        "cautions": [
            {"code": c.code, "value": c.value, "limit": c.limit, "unit": c.unit, "place": c.place}
            for c in result.cautions
        ],
        "law_range": None if result.law_range is None else result.law_range.stored,
        "modes": None if result.modes is None else asdict(result.modes),
        "criteria": [asdict(criterion) for criterion in result.criteria],
        "scatter": _of_scatter(result.scatter),
        "warnings": result.warnings,
        "assumptions": result.assumptions,
        "provenance": {
            "version": result.provenance.version,
            "input_hash": result.provenance.input_hash,
            "isa": result.provenance.isa,
            "threads": result.provenance.threads,
            "settings": result.provenance.settings,
        },
    }
    return {key: _strict(value) for key, value in content.items()}


def _of_hinge(hinge: HingeSummary) -> dict[str, Any]:
    """Figures of one hinge; of one that can shorten or lengthen along its member also those of that."""
    figures = {key: getattr(hinge, key) for key in _HINGE_KEYS}
    figures["law_use"] = None if hinge.law_use is None else asdict(hinge.law_use)
    further = {"crush": hinge.crush, "stretch": hinge.stretch}
    return figures | {name: asdict(figure) for name, figure in further.items() if figure is not None}


def _of_scatter(scatter: Scatter | None) -> dict[str, Any] | None:
    """Scatter without its bands, which bands.csv has."""
    if scatter is None:
        return None
    return {key: value for key, value in asdict(scatter).items() if key not in {"times", "bands"}}


def summary_json(result: Result) -> str:
    """`summary` as indented JSON text with a final line end; no NaN, no Infinity, UTF-8."""
    return json.dumps(summary(result), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _strict(value: Any) -> Any:
    """Value in types that JSON has: arrays become lists, NumPy numbers Python's, what is not finite None."""
    if isinstance(value, Mapping):
        return {str(key): _strict(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_strict(item) for item in value]
    if hasattr(value, "tolist"):
        return _strict(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (str, int)):
        return value
    return str(value)
