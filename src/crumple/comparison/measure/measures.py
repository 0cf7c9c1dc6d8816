"""Figures of a whole result, read in the same way from shells and from multibody models.

Everything but energies and forces is read off the stored shapes.  A node's *zone* reaches along each of its
members by `REACH` of the section's largest side, at most `PART` of the member; what is left of a member is
its *span*.  Beside the place where an obstacle strikes the member between its nodes a zone takes half the way
to it at most, unless a fold at the node needs more: a border in the fold then lies half a fold beside it.

- Extent: largest change of each requested distance, else largest displacement of each requested node.
- Rotation of a joint: that of the ring of wall points at the border of its zone in each further member,
  relative to the ring in the first one, or to the ground where a support holds the node's rotation; of a
  span: between the rings at its two borders.  Rings are fitted with a rigid rotation (Kabsch 1976), so that
  twist is seen too.
- Energy by zone: plastic work of the wall elements in it, or the energy of the hinges in it; what hinges
  stand for along members counts there (energy.py).
- Force of each obstacle: largest magnitude through CFC 60, and impulse over the time until rest.
- Impulse of each obstacle, and energy dissipated at its contacts: see contacts.py.
- Time of rest: when 95 % of the energy that is dissipated in the end has been dissipated.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from crumple.comparison.measure.contacts import dissipated_at, impulse
from crumple.comparison.measure.energy import distortions, hinge_work
from crumple.comparison.measure.rings import rotations
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import rotation_vector
from crumple.result import Result, States
from crumple.result.filters import cfc
from crumple.section import AXES, half_fold_length
from crumple.structure import Structure, plastic_hinges, struck_places

REACH = 2.0
"""Reach of a zone along a member, over the largest side of its section: folds at corners lie within it."""
PART = 0.4
"""Largest part of a member that one zone takes."""
OPENED = np.radians(2.0)
"""Rotation from which a joint or span counts as open [rad]: above elastic bending."""
RESTED = 0.95
"""Share of the final dissipated energy at which a structure counts as being at rest."""
SAMPLES = 26
"""Samples of each stored history of an extent."""


@dataclass(frozen=True)
class Measures:
    """Figures of one result.

    Attributes
    ----------
    status
        How the run ended; only ``complete`` ones are compared.
    extents
        Largest magnitude by output [m].
    rotations
        Rotation vector at the end by joint and span [rad], in the axes of the side that it is relative to.
    zones
        Energy dissipated by zone [J].
    peak_force, mean_force
        By obstacle [N].
    impulse, at_contact
        By obstacle: of its force over the run [N s], and energy dissipated at its contacts [J]; empty in
        stored figures from before these were measured.
    rest
        Time of rest [s].
    opened
        When each joint or span opened [s], in order.
    energy
        Put in and dissipated [J], ``energy.residual`` over the former, and what contact took.
    seconds
        Processor time of the solve [s]; 0: not measured.
    paths
        `SAMPLES` values of each extent at equal intervals [m].
    shortened
        Largest decrease of the distance between the first and the last ring of each member [m]; empty in
        stored figures from before it was measured.
    """

    status: str
    extents: dict[str, float] = field(default_factory=dict)
    rotations: dict[str, list[float]] = field(default_factory=dict)
    zones: dict[str, float] = field(default_factory=dict)
    peak_force: dict[str, float] = field(default_factory=dict)
    mean_force: dict[str, float] = field(default_factory=dict)
    impulse: dict[str, float] = field(default_factory=dict)
    at_contact: dict[str, float] = field(default_factory=dict)
    rest: float = 0.0
    opened: dict[str, float] = field(default_factory=dict)
    energy: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0
    paths: dict[str, list[float]] = field(default_factory=dict)
    shortened: dict[str, float] = field(default_factory=dict)

    @property
    def complete(self) -> bool:
        """Whether there is anything to compare."""
        return self.status == "complete"


def measurable(result: Result) -> bool:
    """Whether a result is whole and contains what is measured."""
    states = result.states
    if not result.status.ok or states is None or not len(states.times):
        return False
    needed = ("energy.dissipated", "energy.kinetic", "energy.external_work")
    return all(name in result.channels for name in needed) and (
        result.fidelity != "shell" or "plastic_work" in states.cell_data
    )


def measure(result: Result, structure: Structure, seconds: float = 0.0) -> Measures:
    """Measure one result, which needs shapes.

    Parameters
    ----------
    result
        Of either fidelity.
    structure
        That was solved.
    seconds
        Processor time of the solve [s].
    """
    if not result.status.ok or result.states is None:
        return Measures(status=result.status.value, seconds=seconds)
    rest = _rest(result)
    extents = _extents(result)
    turned = _rotations(result.states, structure)
    opened = {name: float(t) for name, vectors in turned.items() if (t := _opening(result.states, vectors))}
    forces = {n: force for n in structure.obstacles if (force := _force(result, n)) is not None}
    impulses = {name: impulse(result.time, force) for name, force in forces.items()}
    work = _elements(result) if result.fidelity == "shell" else hinge_work(result, structure)
    return Measures(
        status="complete",
        extents={name: float(np.abs(values).max()) for name, values in extents.items()},
        rotations={name: _rounded(vectors[-1]) for name, vectors in turned.items()},
        zones=_zones(result, structure),
        peak_force={n: float(np.abs(_filtered(result, f)).max()) for n, f in forces.items()},
        mean_force={n: _mean(result.time, f, rest) for n, f in forces.items()},
        impulse=impulses,
        at_contact=dissipated_at(result, structure, impulses, work),
        rest=rest,
        opened=dict(sorted(opened.items(), key=lambda item: item[1])),
        energy=_energy(result),
        seconds=round(seconds, 3),
        paths={name: _path(result.time, values) for name, values in extents.items()},
        shortened={name: _shortened(result.states, name) for name in structure.members},
    )


def _rounded(vector: Floats) -> list[float]:
    return [float(value) for value in vector]


def _extents(result: Result) -> dict[str, Floats]:
    """Histories of the requested distances, else of the displacement of requested nodes [m]."""
    named = {c.name: c.values for c in result.channels.values() if c.unit == "m" and "." not in c.name}
    if named:
        return {name: values for name, values in named.items() if not name.startswith("energy")}
    nodes = {name.split(".")[1] for name in result.channels if name.startswith("node.")}
    return {
        node: np.linalg.norm([result[f"node.{node}.displacement.{axis}"] for axis in "xyz"], axis=0)
        for node in sorted(nodes)
    }


def _path(time: Floats, values: Floats) -> list[float]:
    return _rounded(np.interp(np.linspace(time[0], time[-1], SAMPLES), time, np.abs(values)))


def _rest(result: Result) -> float:
    done = np.maximum.accumulate(result["energy.dissipated"])
    return float(np.interp(RESTED * done[-1], done, result.time)) if done[-1] > 0.0 else 0.0


def _energy(result: Result) -> dict[str, float]:
    put_in = float(result["energy.kinetic"][0] + np.abs(result["energy.external_work"]).max())
    taken = [name for name in ("energy.contact", "energy.friction") if name in result.channels]
    return {
        "put_in": put_in,
        "dissipated": float(result["energy.dissipated"][-1]),
        "residual": result.energy_residual,
        **{name.removeprefix("energy."): float(result[name][-1]) for name in taken},
    }


def _force(result: Result, obstacle: str) -> Floats | None:
    """Vector of an obstacle's contact force [N], (n_times, 3)."""
    names = [f"obstacle.{obstacle}.force.{axis}" for axis in "xyz"]
    return np.stack([result[n] for n in names], axis=1) if all(n in result.channels for n in names) else None


def _filtered(result: Result, force: Floats) -> Floats:
    """Magnitude of a force through CFC 60 [N], at equal intervals.

    Each value is the mean since the output before.  Shapes add outputs between, so that intervals differ:
    what is kept at equal ones is the impulse.
    """
    time = result.time
    step = float(time[1] - time[0])
    even = np.arange(time[0], time[-1] + step / 2, step)
    passed = np.concatenate([np.zeros((1, 3)), np.cumsum(np.diff(time)[:, None] * force[1:], axis=0)])
    parts = []
    for i in range(3):
        means = np.diff(np.interp(even, time, passed[:, i])) / step
        parts.append(cfc(np.concatenate([force[:1, i], means]), step, 60, before=0.0))
    return np.asarray(np.linalg.norm(parts, axis=0))


def _mean(time: Floats, force: Floats, rest: float) -> float:
    """Impulse until rest over that time [N]."""
    until = time <= rest
    if np.count_nonzero(until) < 2:
        return 0.0
    time = time[until]
    return impulse(time, force[until]) / float(time[-1] - time[0])


def _borders(structure: Structure, member: str) -> tuple[float, float]:
    """Stations at which the zones of a member's nodes end [m]."""
    length, section = structure.frame_of(member).length, structure.section_of(member)
    side = float(np.ptp(section.outline(), axis=0).max())
    reach = min(REACH * side, PART * length)
    places = struck_places(structure, member)
    half = max(half_fold_length(section, axis) for axis in AXES) if places else 0.0
    first = last = reach
    for place in places:
        first = _beside(first, place.station, half)
        last = _beside(last, length - place.station, half)
    return first, length - last


def _beside(reach: float, struck: float, half: float) -> float:
    """Reach of a zone [m] that leaves whole the fold at a struck place, and that at the node."""
    if struck / 2 >= 2.0 * half:
        return min(reach, struck / 2)
    apart = reach - struck
    return reach if abs(apart) >= half else struck + float(np.copysign(half, apart))


def _zone(structure: Structure, member: str, station: float) -> str:
    first, last = structure.members[member].nodes
    low, high = _borders(structure, member)
    return first if station <= low else last if station >= high else f"span of {member}"


def _zones(result: Result, structure: Structure) -> dict[str, float]:
    found: dict[str, float] = {}

    def add(zone: str, energy: float) -> None:
        found[zone] = found.get(zone, 0.0) + energy

    if result.fidelity == "shell":
        for member, station, work in _elements(result):
            add(_zone(structure, member, station), work)
        return found
    totals = {member: result.channels.get(f"member.{member}.energy") for member in structure.members}
    rest = {member: 0.0 if one is None else float(one.values[-1]) for member, one in totals.items()}
    for member, station, energy in hinge_work(result, structure):
        add(_zone(structure, member, station), energy)
        rest[member] -= energy
    for node, (member, station, energy) in distortions(result, structure):
        add(node, -energy)
        add(_zone(structure, member, station), energy)
    for end in result.crumpled_ends:
        add(end.node, end.energy)
    for member, energy in rest.items():
        add(f"span of {member}", energy)
    return found


def _elements(result: Result) -> list[tuple[str, float, float]]:
    """Member, station [m] and plastic work [J] of every wall element at the end."""
    states = result.states
    assert states is not None
    work = np.nan_to_num(states.cell_data["plastic_work"].reshape(len(states.times), -1)[-1])
    member = states.member[states.quads[:, 0]]
    station = states.station[states.quads].mean(axis=1)
    return [
        (states.member_names[m], float(s), float(w)) for m, s, w in zip(member, station, work, strict=True)
    ]


def _rotations(states: States, structure: Structure) -> dict[str, Floats]:
    """Rotation vectors by joint and span [rad], (n_states, 3)."""
    folds: dict[str, list[float]] = {}
    for hinge in plastic_hinges(structure):
        folds.setdefault(hinge.member, []).append(hinge.station)
    rings = {
        (member, end): _ring(states, member, border, folds.get(member, []))
        for member in structure.members
        for end, border in enumerate(_borders(structure, member))
    }
    found = {
        f"span of {member}": _between(rings[member, 0], rings[member, 1]) for member in structure.members
    }
    held = {support.node for support in structure.supports.values() if any(f[0] == "r" for f in support.held)}
    for node in structure.nodes:
        ends = [(m, e) for m, spec in structure.members.items() for e in (0, 1) if spec.nodes[e] == node]
        if node in held:
            ground = np.broadcast_to(np.eye(3), rings[ends[0]].shape)
            found |= {f"{node}, {member}": _between(ground, rings[member, e]) for member, e in ends}
            continue
        found |= {f"{node}, {m} to {ends[0][0]}": _between(rings[ends[0]], rings[m, e]) for m, e in ends[1:]}
    return found


def _shortened(states: States, member: str) -> float:
    """Largest decrease of the distance between a member's outer rings over all states [m]."""
    own = np.flatnonzero(states.member == states.member_names.index(member))
    station = states.station[own]
    first, last = (own[np.abs(station - end) < 1e-8] for end in (station.min(), station.max()))
    start = states.points[last].mean(axis=0) - states.points[first].mean(axis=0)
    moved = states.displacement[:, last].mean(axis=1) - states.displacement[:, first].mean(axis=1)
    return float(np.linalg.norm(start) - np.linalg.norm(start + moved, axis=1).min())


def _between(first: Floats, second: Floats) -> Floats:
    """Rotation vectors of the second relative to the first, in the axes of the first, (n, 3)."""
    return rotation_vector(np.swapaxes(first, 1, 2) @ second)


def _ring(states: States, member: str, station: float, folds: list[float]) -> Floats:
    """Rotation of the ring nearest to a station, but at no hinge, in every state, (n_states, 3, 3)."""
    own = states.member == states.member_names.index(member)
    stations = np.unique(np.round(states.station[own], 9))
    # a ring at a hinge turns by the mean of both sides, which matters where it folds
    clear = [s for s in stations if all(abs(s - fold) > 1e-6 for fold in folds)] or list(stations)
    nearest = min(clear, key=lambda s: abs(s - station))
    points = np.flatnonzero(own & (np.abs(states.station - nearest) < 1e-8))
    start = states.points[points]
    now = start + states.displacement[:, points]
    return rotations(start, now)


def _opening(states: States, vectors: Floats) -> float | None:
    open_ = np.flatnonzero(np.linalg.norm(vectors, axis=1) >= OPENED)
    return float(states.times[open_[0]]) if open_.size else None
