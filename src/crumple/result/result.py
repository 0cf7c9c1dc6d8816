"""The answer of a run, of the same type for both fidelities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from crumple.errors import Status

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Channel:
    """One history: name, SI unit, values at the result's times, shape (n_times,)."""

    name: str
    unit: str
    values: Floats


@dataclass(frozen=True)
class HingeSummary:
    """What one hinge did.

    Attributes
    ----------
    rotation_max
        Largest absolute rotation [rad].
    rotation_final
        Rotation at the end [rad], signed.
    time_of_rest
        Time after which its plastic rotation no longer changed [s]; None if it still turned at the end.
    energy
        Energy absorbed (dissipated) [J].
    moment_max
        Largest absolute moment [N m].
    rotation_error
        Estimated error of rotation_max [rad]; None where no estimate was made.
    law, source, form
        Title, citation with trust, and form of the law.
    validity_rotation, validity_basis
        Range [rad] in which the law is backed, and by what.
    envelope
        Capacity used: dict with "rotation" [rad], "positive" and "negative" [N m] arrays.
    position
        Where it lies at the start [m], shape (3,).
    """

    rotation_max: float
    rotation_final: float
    time_of_rest: float | None
    energy: float
    moment_max: float
    rotation_error: float | None = None
    law: str = ""
    source: str = ""
    form: str = ""
    validity_rotation: float | None = None
    validity_basis: str = ""
    envelope: Mapping[str, Floats] = field(default_factory=dict)
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class States:
    """Deformed shapes at chosen times: a surface mesh of quadrilaterals (member walls).

    Attributes
    ----------
    points
        Reference positions [m], (n_points, 3).
    quads
        Point indices, (n_quads, 4).
    member, station, contour
        Per point: index of the member in `member_names`, distance along it [m], index around its outline;
        each (n_points,), so that a comparison needs no mesher.
    member_names
        Names of the members.
    times
        [s], (n_states,).
    displacement
        [m], (n_states, n_points, 3).
    point_data, cell_data
        Further fields by name, (n_states, n_points[, k]) and (n_states, n_quads[, k]), SI.
    """

    points: Floats
    quads: Integers
    member: Integers
    station: Floats
    contour: Integers
    member_names: tuple[str, ...]
    times: Floats
    displacement: Floats
    point_data: Mapping[str, Floats] = field(default_factory=dict)
    cell_data: Mapping[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True)
class Provenance:
    """Where a result comes from: Crumple's version, input hash (SHA-256 of the canonical input), ISA, threads, settings."""

    version: str
    input_hash: str
    isa: str = ""
    threads: int = 1
    settings: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Result:
    """One run.

    Attributes
    ----------
    status, reason
        How it ended, and why in one sentence (empty when complete).
    fidelity
        ``multibody`` or ``shell``.
    title
        Of the analysis.
    time
        Output times [s], (n_times,).
    channels
        Histories by name; see docs/conventions.md for the names.
    hinges
        Summary per hinge.
    states
        Deformed shapes, or None.
    energy_residual
        Largest abs(residual) over (initial energy + largest external work).
    solve_seconds
        Lowering and stepping [s].
    warnings
        Sentences that an engineer must read before believing the result.
    assumptions
        Sentences stating what the model assumes.
    provenance
        Version, input hash, settings.
    """

    status: Status
    reason: str
    fidelity: str
    title: str
    time: Floats
    channels: Mapping[str, Channel]
    hinges: Mapping[str, HingeSummary]
    states: States | None
    energy_residual: float
    solve_seconds: float
    warnings: tuple[str, ...]
    assumptions: tuple[str, ...]
    provenance: Provenance
    output_names: tuple[str, ...] = ()
    """Names of the channels that the analysis asked for; they appear in `outputs` and summary.json."""

    def __getitem__(self, name: str) -> Floats:
        """Values of one channel, shape (n_times,)."""
        return self.channels[name].values

    def to_pandas(self) -> pd.DataFrame:
        """Histories as a table indexed by time [s]; needs pandas.  Column names carry the unit: ``name [unit]``."""
        import pandas as pd  # noqa: PLC0415  (optional, and slow to import)

        columns = {f"{c.name} [{c.unit}]": c.values for c in self.channels.values()}
        return pd.DataFrame(columns, index=pd.Index(self.time, name="time [s]"))
