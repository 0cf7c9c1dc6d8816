"""One corner law predicts how a whole L-frame folds under a slow push at its end.

Two tubes of example 01, 0.4 m each, clamped at one end, mitred at the knee, pushed across the arm at its
tip by 200 mm in 100 ms: solved with shells, and as rigid bars with one hinge at the knee with the law of a
sub-model of this corner, and elastic hinges in the members that stay below their capacity. Compared from 5
degrees of plastic rotation on: the plastic rotation of the corner (8 %), the force at the tip, which times
the arm is the moment at the knee (10 %), and the external work at the end (5 %). The tolerances are those
that the definitions of docs/theory/characterisation.md are to meet; meshes are coarse (5 mm; 4 elements
along half a fold), alike in both.

Kind: independent calculation.  Source: derived here.
"""

import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import crumple
from crumple.characterisation import Bending, characterise
from crumple.characterisation.resolution import Resolution
from crumple.hinge import write_law
from crumple.result import Result

STEEL = crumple.Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = crumple.RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
TRAVEL, LEG = 0.2, 0.4
FIRST = 40
"""Time from which courses are compared, every 10 ms: the frames yield at about 30 ms [ms]."""
FRAME = """
crumple: 1
title: L-frame
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 488 MPa}}
sections: {{tube: {{type: rectangular_tube, width: 50 mm, depth: 25 mm, thickness: 2.65 mm}}}}
{hinge_laws}
nodes: {{root: [{x!r} m, 0 m, {z!r} m], knee: [0 m, 0 m, 0 m], tip: [0.4 m, 0 m, 0 m]}}
members:
  post: {{nodes: [root, knee], section: tube, material: steel, up: [{up!r}, 0, {z_up!r}]{post}}}
  arm: {{nodes: [knee, tip], section: tube, material: steel{arm}}}
{hinges}
supports:
  clamp: {{node: root, fix: all}}
  push: {{node: tip, motion: {{z: {{havsin: {{x0: 0 ms, h0: 0 mm, x1: 100 ms, h1: {travel!r} m}}}}}}}}
analysis:
  duration: 100 ms
  shell: {{element_size: 10 mm, fine_size: 5 mm, fine_length: 70 mm}}
  multibody: {{kernel: spatial}}
outputs: {{every: 1 ms, nodes: [tip, knee], section_forces: {{at_knee: {{member: arm, at: 100 mm}}}}}}
"""


class Course(NamedTuple):
    """Course of a push at times from `FIRST` to 100 ms."""

    rotation: np.ndarray
    force: np.ndarray
    work: float


def frame(folder: Path, degrees: float, sense: int, laws: dict[str, str] | None) -> crumple.Analysis:
    """The L-frame with hinges on both sides of its corner, or with law files of its corner and members."""
    turn = math.radians(degrees)
    along = math.cos(turn), math.sin(turn)
    keys = {"x": -LEG * along[0], "z": -LEG * along[1], "up": -along[1], "z_up": along[0]}
    keys["travel"] = -sense * TRAVEL
    if laws is None:
        text = FRAME.format(hinge_laws="", post="", arm="", hinges="hinges: {law: kecman}", **keys)
    else:
        for name, law in laws.items():
            (folder / f"{name}.yaml").write_text(law, encoding="utf-8")
        text = FRAME.format(
            hinge_laws="hinge_laws: {corner: {type: file, file: corner.yaml, form: elastic-plastic}, "
            "tube: {type: file, file: member.yaml, form: elastic-plastic}}",
            post=", hinges: [{name: clamp, at: root, law: tube}, {name: below, at: 327 mm, law: tube}]",
            arm=", hinges: [{name: corner, at: knee, law: corner}, {name: beside, at: 73 mm, law: tube}]",
            hinges="",
            **keys,
        )
    if laws is None:
        text = text.replace("section_forces: {at_knee: {member: arm, at: 100 mm}}", "pictures: []")
    path = folder / "frame.yaml"
    path.write_text(text, encoding="utf-8")
    return crumple.load(path)


@cache
def law_of(angle: float | None) -> str:
    """Text of the law file of a corner, or of a straight member, both senses."""
    return write_law(characterise(Bending(TUBE, STEEL, angle=angle, resolution=Resolution(4.0, 7.0))).law)


def course(result: Result, rotations: tuple[str, ...]) -> Course:
    """Sum of rotations, and force of the push as a mean over 5 ms."""
    time = result.time
    rotation = np.sum([result.channels[f"hinge.{name}"].values for name in rotations], axis=0)
    force = result.channels["support.push.force.z"].values
    at = [int(np.argmin(abs(time - t))) for t in np.arange(FIRST, 101, 10) / 1000.0]
    return Course(
        np.abs(np.array([rotation[i] for i in at])),
        np.abs(np.array([force[max(i - 2, 0) : i + 3].mean() for i in at])),
        float(result.channels["energy.external_work"].values[-1]),
    )


@pytest.mark.slow
@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("degrees", [90.0, 60.0, 30.0])
def test_corner_law_predicts_the_frame(degrees, sense, tmp_path, record_figure):
    laws = {"corner": law_of(math.radians(degrees)), "member": law_of(None)}
    fast = course(crumple.solve(frame(tmp_path, degrees, sense, laws)), ("corner.rotation",))
    shells = course(
        crumple.solve(frame(tmp_path, degrees, sense, None), fidelity="shell"),
        # only the elastic rotation of straight members is taken out of what shells call plastic here
        ("post-knee.plastic_rotation", "arm-knee.plastic_rotation"),
    )
    name = f"{degrees:g} deg, {'closing' if sense > 0 else 'opening'}"
    record_figure(f"work, {name}", fast.work, shells.work, 0.05, "J", relative=True)
    for i, (rotation, force) in enumerate(zip(shells.rotation, shells.force, strict=True)):
        at = f"{name}, {FIRST + 10 * i} ms"
        record_figure(f"force, {at}", fast.force[i], force, 0.10, "N", relative=True)
        if rotation > math.radians(5.0):
            record_figure(f"rotation, {at}", fast.rotation[i], rotation, 0.08, "rad", relative=True)
