"""Model of the reference tube from the deck of another code; used by the comparison test and by hand.

By hand: ``python tests/support/shell/tube_reference.py DECK_0000.rad HISTORY.csv [threads]``.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from crumple._core.shell.simulation import (
    Cut,
    Hourglass,
    RigidSet,
    ShellMaterial,
    ShellModel,
    ShellSettings,
    ShellState,
)

STEEL = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=488e6)
WALL = 2.65e-3


def read_deck(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n, 3) [m] and quadrilaterals (m, 4) from the blocks /NODE and /SHELL."""
    nodes: dict[int, list[float]] = {}
    shells = []
    block = ""
    for line in path.read_text().splitlines():
        if line.startswith("/"):
            block = line.split("/")[1]
            continue
        fields = line.split()
        if block == "NODE":
            nodes[int(fields[0])] = [float(x) for x in fields[1:4]]
        elif block == "SHELL":
            shells.append([int(x) for x in fields[1:5]])
    number = {node: i for i, node in enumerate(nodes)}
    quads = np.array([[number[n] for n in shell] for shell in shells])
    return np.array(list(nodes.values())), quads


def tube(path: Path, **settings: object) -> ShellModel:
    """Tube clamped at x = 0, thrown at 15 rad/s about -y, with 6 kg on a rigid free end."""
    position, quads = read_deck(path)
    used = np.unique(quads)
    assert np.array_equal(used, np.arange(len(used)))
    position = position[: len(used)]
    x = position[:, 0]
    root, tip = np.flatnonzero(x < 1e-9), np.flatnonzero(x > x.max() - 1e-9)
    omega = np.array([0.0, -15.0, 0.0])
    fixed = np.zeros((len(position), 6), dtype=bool)
    fixed[root] = True
    row = np.flatnonzero(np.isin(quads, root).any(axis=1))
    return ShellModel(
        position=position,
        elements=quads,
        thickness=WALL,
        materials=[STEEL],
        fixed=fixed,
        velocity=np.cross(omega, position),
        spin=np.broadcast_to(omega, position.shape),
        rigid_sets=[RigidSet(nodes=tip, mass=6.0)],
        cuts=[Cut(elements=row, nodes=root)],
        settings=ShellSettings(**settings),  # type: ignore[arg-type]
    )


def run(model: ShellModel, threads: int = 1, end: float = 0.1, outputs: int = 200) -> dict[str, np.ndarray]:
    """Histories: time, tip rotation, energies, root moment, chord rotation at 100 mm."""
    state = ShellState(model)
    near = np.flatnonzero(np.abs(model.position[:, 0] - 0.1) < 1e-6)
    rows = []
    for t in np.linspace(0.0, end, outputs + 1):
        status = state.advance(t, threads=threads)
        if not status.ok:
            print(status, state.reason)
            break
        tip, e = state.rigid_sets[0, :3], state.energies
        chord = state.position[near].mean(axis=0)
        row = {name: e[name] for name in ("kinetic", "plastic", "hourglass", "residual", "contact")}
        row["time"] = state.time
        row["internal"] = e["elastic"] + e["plastic"]
        row["tip_rotation"] = np.arctan2(tip[2], tip[0])
        row["chord_rotation"] = np.arctan2(chord[2], chord[0])
        row["root_moment"] = state.cut(0)[1][1]
        rows.append(row)
    history = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    history["steps"] = np.array(state.steps)
    history["elements"] = np.array(len(model.elements))
    history["searches"] = np.array(state.contact_searches)
    return history


def main() -> None:
    deck, csv, *rest = sys.argv[1:]
    options = dict(item.split("=") for item in rest)
    threads = int(options.pop("threads", 1))
    settings: dict[str, object] = {key: float(value) for key, value in options.items() if key != "hourglass"}
    if "hourglass" in options:
        settings["hourglass"] = Hourglass(options["hourglass"])
    for key in ("thickness_update", "warping_correction", "self_contact"):
        if key in settings:
            settings[key] = bool(settings[key])
    start = time.perf_counter()
    h = run(tube(Path(deck), **settings), threads)
    wall = time.perf_counter() - start
    r = np.genfromtxt(csv, delimiter=",", names=True)
    step_cost = wall / h["steps"] / h["elements"] * 1e9
    print(f"{options} steps {h['steps']} wall {wall:.2f} s = {step_cost:.1f} ns, searches {h['searches']}")
    for name, ours, theirs in compared(h, r):
        print(f"  {name:32s} {ours:10.4f} {theirs:10.4f}  {100 * (ours / theirs - 1):+.2f} %")
    scale = h["kinetic"][0]
    print(f"  hourglass {h['hourglass'].max() / scale:.4%}, residual {abs(h['residual']).max() / scale:.4%}")


def compared(h: dict[str, np.ndarray], r: np.ndarray) -> list[tuple[str, float, float]]:
    """Name, our value and the other code's, of what is compared."""
    best, other = int(h["tip_rotation"].argmax()), int(r["tip_rotation_rad"].argmax())
    moment, theirs = abs(h["root_moment"]), abs(r["root_1_root_M2"])
    rows = [
        ("largest tip rotation [rad]", h["tip_rotation"][best], r["tip_rotation_rad"][other]),
        ("at [ms]", 1e3 * h["time"][best], 1e3 * r["time_s"][other]),
        ("largest chord rotation [rad]", h["chord_rotation"].max(), r["chord_rotation_100mm_rad"].max()),
        ("peak root moment [N m]", moment.max(), theirs.max()),
    ]
    for t in (0.02, 0.04, 0.06, 0.08):
        values = np.interp(t, h["time"], moment), np.interp(t, r["time_s"], theirs)
        rows.append((f"root moment at {1e3 * t:.0f} ms", *values))
    for angle in (0.1, 0.2, 0.3, 0.4, 0.5):
        ours = np.interp(angle, h["tip_rotation"][:best], h["internal"][:best])
        others = np.interp(angle, r["tip_rotation_rad"][:other], r["internal_energy_J"][:other])
        rows.append((f"internal energy at {angle} rad [J]", ours, others))
    return rows


if __name__ == "__main__":
    main()
