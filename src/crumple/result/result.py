"""The answer of a run, of the same type for both fidelities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cached_property
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.errors import InputError, Problem, Status
from crumple.hinge.law_use import LawUse
from crumple.numeric.arrays import Floats, Integers
from crumple.result.caution import Caution
from crumple.result.crush import BENT, CrumpledEnd, CrushSummary, DentedWall, StretchSummary
from crumple.result.nearby import LawRange, Modes
from crumple.result.scatter import Judged, Scatter
from crumple.result.tables import imported_pandas

if TYPE_CHECKING:
    import pandas as pd

    from crumple.result.filters import ChannelClass, Standard


@dataclass(frozen=True, eq=False)
class Channel:
    """One history: name, SI unit, values at the result's times, shape (n_times,)."""

    name: str
    unit: str
    values: Floats


@dataclass(frozen=True)
class OutputSummary:
    """What one requested output did.

    Attributes
    ----------
    final
        Last value.
    max
        Value of largest magnitude, with its sign.
    time_of_max
        When it was first reached [s].
    unit
        Of `final` and `max`.
    """

    final: float
    max: float
    time_of_max: float
    unit: str


@dataclass(frozen=True, eq=False)
class HingeSummary:
    """What one hinge did.

    Attributes
    ----------
    rotation_max
        Largest absolute rotation [rad], of a hinge about several axes the largest length of the vector.
    rotation_final
        Rotation at the end [rad], signed.
    time_of_rest
        Time after which its plastic rotation no longer changed [s]; None if it was still rotating at the end.
    energy
        Energy absorbed (dissipated) [J].
    moment_max
        Largest absolute moment [N m], of several axes the largest length of the vector.
    rotation_error
        Estimated error of rotation_max [rad]; None where no estimate was made.
    energy_error
        Estimated error of energy [J]; None where no estimate was made.
    law, source, form
        Title, citation with trust, and form of the law.
    validity_rotation, validity_basis
        Range [rad] in which the law is backed, and by what.
    law_rotation
        Largest plastic rotation [rad] by which the law is judged, of a hinge about several axes that about
        the axis of this law; None where it was measured.
    envelope
        Capacity used: dict with "rotation" [rad], "positive" and "negative" [N m] arrays.
    position
        Where it lies at the start [m], shape (3,).
    fracture_time, fracture_moment
        When it broke [s], and the moment that it carried until then [N m]; None if it did not break.
    """

    rotation_max: float
    rotation_final: float
    time_of_rest: float | None
    energy: float
    moment_max: float
    rotation_error: float | None = None
    energy_error: float | None = None
    law: str = ""
    source: str = ""
    form: str = ""
    validity_rotation: float | None = None
    validity_basis: str = ""
    law_rotation: float | None = None
    envelope: Mapping[str, Floats] = field(default_factory=dict)
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fracture_time: float | None = None
    fracture_moment: float | None = None
    law_use: LawUse | None = None
    """Where its law comes from; None where it was measured."""
    crush: CrushSummary | None = None
    """Of a hinge that can shorten along its member; None for all others."""
    stretch: StretchSummary | None = None
    """Of a hinge that lengthened along its member; None for all others."""

    @property
    def bends(self) -> bool:
        """Whether it is reported as a hinge that bends; a crush zone that did not bend is not."""
        return self.crush is None or self.rotation_max > BENT


@dataclass(frozen=True)
class Opening:
    """A hinge that opened, in the collapse log.

    Attributes
    ----------
    hinge
        Its name.
    time
        When its plastic rotation passed the threshold [s], linear between outputs.
    rotation
        Plastic rotation at the end [rad], signed; of a hinge about several axes the length of the vector.
    energy
        Absorbed until the end [J].
    broke
        When it broke [s]; None if it did not.
    """

    hinge: str
    time: float
    rotation: float
    energy: float
    broke: float | None = None


@dataclass(frozen=True)
class StageSummary:
    """One stage of a sequence: name, start and end [s], why it ended, and whether that was its duration."""

    name: str
    start: float
    end: float
    ended_by: str
    by_duration: bool = False


@dataclass(frozen=True, eq=False)
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

    def at_times(self, times: Floats) -> States:
        """The states nearest to given times, (n,) [s]."""
        rows = np.array([int(np.argmin(np.abs(self.times - t))) for t in times], dtype=np.int64)
        return replace(
            self,
            times=self.times[rows],
            displacement=self.displacement[rows],
            point_data={name: values[rows] for name, values in self.point_data.items()},
            cell_data={name: values[rows] for name, values in self.cell_data.items()},
        )


@dataclass(frozen=True)
class Provenance:
    """Provenance of a result: version of Crumple, SHA-256 of the canonical input, ISA and so on."""

    version: str
    input_hash: str
    isa: str = ""
    threads: int = 1
    settings: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Result:
    """One run.  Two results are compared with `equals`.

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
    """Names of the channels requested in the analysis; they appear in `outputs` and summary.json."""
    collapse: tuple[Opening, ...] = ()
    """Hinges that opened, in the order in which they did."""
    collapse_threshold: float = 0.0
    """Plastic rotation from which a hinge counts as open [rad]."""
    stages: tuple[StageSummary, ...] = ()
    """Stages in order, as far as the run reached; empty if the analysis has none."""
    cautions: tuple[Caution, ...] = ()
    """Checks that the result did not pass.  The sentences of violations are the reason, of others the first
    warnings."""
    law_range: LawRange | None = None
    """Range from the bands of the hinge laws, if it was computed."""
    modes: Modes | None = None
    """Modes of collapse that appear beside this one, if they were looked for."""
    crumpled_ends: tuple[CrumpledEnd, ...] = ()
    """Free ends of members that crumpled on planes, in the multibody model."""
    dents: tuple[DentedWall, ...] = ()
    """Dents that obstacles pressed into walls, in the multibody model."""
    criteria: tuple[Judged, ...] = ()
    """Criteria of the input and the values of the run."""
    yielded: Mapping[str, tuple[tuple[float, float], ...]] = field(default_factory=dict)
    """Station [m] of each place at which an elastic member yielded between its hinges, and energy [J]
    dissipated there until the end, by member."""
    displacement_errors: Mapping[str, float] = field(default_factory=dict)
    """Estimated error of the displacement of each node at the end [m], by node; empty without an estimate."""
    scatter: Scatter | None = None
    """How the result scatters with the input, if that has a block `uncertainty`."""

    def __getitem__(self, name: str) -> Floats:
        """Values of one channel, (n_times,); KeyError with similar names if there is none."""
        if name not in self.channels:
            from difflib import get_close_matches  # noqa: PLC0415  (only when something is wrong)

            near = get_close_matches(name, self.channels, n=3, cutoff=0.4)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise KeyError(f"no channel {name!r} among {len(self.channels)}{hint}")
        return self.channels[name].values

    def __iter__(self) -> Iterator[str]:
        """Names of the channels."""
        return iter(self.channels)

    def __contains__(self, name: object) -> bool:
        """Whether there is a channel of this name."""
        return name in self.channels

    @cached_property
    def outputs(self) -> dict[str, OutputSummary]:
        """Final and largest value of every requested output; without the values that are not finite."""
        summaries = {}
        for name in self.output_names:
            values = self[name]
            finite = np.isfinite(values)
            if not finite.any():
                continue
            at = int(np.argmax(np.where(finite, np.abs(values), -1.0)))
            final = float(values[np.flatnonzero(finite)[-1]])
            unit = self.channels[name].unit
            # adding zero turns a negative zero into a plain one
            summaries[name] = OutputSummary(final + 0.0, float(values[at]) + 0.0, float(self.time[at]), unit)
        return summaries

    def filtered(self, name: str, channel_class: ChannelClass, *, standard: Standard = "SAE J211") -> Channel:
        """One channel through a CFC filter.

        Parameters
        ----------
        name
            Of the channel.
        channel_class
            60, 180, 600 or 1000.
        standard
            Whose design frequency to use, see `crumple.result.cfc`.

        Returns
        -------
        Channel
            Named ``<name>.cfc<class>``, same unit and times.

        Raises
        ------
        InputError
            If there is no such channel, or the times are not equally spaced or too far apart for the class.
        """
        from crumple.result.filters import cfc, uniform_step, value_before  # noqa: PLC0415  (it needs nothing of this module)

        try:
            values = self[name]
        except KeyError as error:
            raise InputError(Problem(str(error.args[0]))) from None
        before = value_before(name)
        smooth = cfc(values, uniform_step(self.time), channel_class, standard=standard, before=before)
        return Channel(f"{name}.cfc{channel_class}", self.channels[name].unit, smooth)

    def equals(self, other: Result) -> bool:
        """Whether every number, text and array is the same, bit for bit; NaN equals NaN."""
        return _same(self, other)

    def to_pandas(self) -> pd.DataFrame:
        """Histories as a table indexed by time [s], columns named ``name [unit]``.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        pandas = imported_pandas()
        columns = {f"{c.name} [{c.unit}]": c.values for c in self.channels.values()}
        found: pd.DataFrame = pandas.DataFrame(columns, index=pandas.Index(self.time, name="time [s]"))
        return found


def _same(a: Any, b: Any) -> bool:
    """Deep equality of dataclasses, mappings, sequences, arrays and numbers; NaN equals NaN."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        a, b = np.asarray(a), np.asarray(b)
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, Mapping):
        return isinstance(b, Mapping) and list(a) == list(b) and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, (tuple, list)):
        return isinstance(b, (tuple, list)) and len(a) == len(b) and all(map(_same, a, b))
    if is_dataclass(a):
        return type(a) is type(b) and all(_same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, float) and isinstance(b, float) and isnan(a):
        return isnan(b)
    return bool(a == b)
