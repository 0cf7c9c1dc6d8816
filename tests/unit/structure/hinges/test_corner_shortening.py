"""Mitred corners in a plane shorten under compression where obstacles may press elastic members."""

from __future__ import annotations

import pytest

from crumple.analysis import loads
from crumple.hinge import Coupling, Freedom
from crumple.structure import placed_hinges
from crumple.structure.hinges.elastic_members import with_elastic_members

RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: square_tube, side: 50 mm, thickness: 2 mm}
nodes: {front: [0 m, 0 m, 0 m], bend: [0.3 m, 0 m, 0 m], rear: [0.6 m, 0 m, 0.15 m]}
members:
  first: {nodes: [front, bend], section: tube, material: steel}
  second: {nodes: [bend, rear], section: tube, material: steel}
hinges: HINGES
supports: {sled: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {sled: {node: rear, mass: 50 kg}}
obstacles: OBSTACLES
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms, multibody: {members: MEMBERS}}
"""
WALL = "{wall: {type: plane, point: [0 m, 0 m, 0 m], normal: [1, 0, 0]}}"


def corner(hinges="auto", obstacles=WALL, members="elastic"):
    text = RAIL.replace("HINGES", hinges).replace("OBSTACLES", obstacles).replace("MEMBERS", members)
    analysis = loads(text)
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.duration)
    return next(hinge for hinge in placed_hinges(structure) if hinge.name == "corner-bend")


def test_it_slips_by_a_share_of_the_distance_of_the_tension_flange():
    spatial = corner().spatial
    assert spatial.surface.coupling is Coupling.TENSION_FLANGE
    assert spatial.surface.arm == pytest.approx(0.4 * 0.024)
    assert {*spatial.freedoms} == {Freedom.AXIAL, Freedom.Y}


@pytest.mark.parametrize(
    "case",
    [
        {"obstacles": "{}"},
        {"members": "rigid"},
        {"hinges": "{axial: false}"},
        {"hinges": "{law: {type: auto, form: regularised}}"},
    ],
)
def test_it_only_turns_where_nothing_presses_or_the_model_or_the_input_does_not_let_it_slip(case):
    assert corner(**case).spatial is None


def test_a_coupling_of_the_input_is_kept():
    assert corner(hinges="{axial: true, coupling: ellipsoid}").spatial.surface.coupling is Coupling.ELLIPSOID
