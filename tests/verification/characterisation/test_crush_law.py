"""Mean forces and folds of crushed tubes are those of kinematic models, and of longer sub-models.

Sub-models of 488 MPa on coarse meshes (4 elements where bending has half a fold). The mean force over the
effective stroke of square and circular tubes is that of the kinematic models in docs/theory/axial_crushing.md
(Abramowicz and Jones; Alexander), which do not harden either, within 10 %. The peak is the
squash force within 2 %. The number of folds is the length over their wave length 2 H = 1.97 c^(2/3) t^(1/3)
(Wierzbicki and Abramowicz), within 1. A sub-model a third longer has the same mean force within 10 %: the
order in which walls fold differs. A column in the multibody model takes the work of its sub-model up to the
end of the stroke, within 5 %.

Kind: published; invariant.  Source: quoted; derived here.
"""

import pytest

import crumple
from crumple.analysis import load_input, loads
from crumple.characterisation import Crush, LawStore, characterise
from crumple.characterisation.crush import fold_count
from crumple.characterisation.resolution import Resolution
from crumple.hinge import build_axial_law
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
SQUARE = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)
ROUND = CircularTube(diameter=0.050, thickness=0.0015)
COARSE = Resolution(4.0, 7.0)
COLUMN = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 488 MPa}
sections: {tube: {type: rectangular_tube, width: 50 mm, depth: 50 mm, thickness: 1.5 mm}}
nodes: {foot: [0 m, 0 m, 0 m], head: [0.15 m, 0 m, 0 m]}
members:
  column:
    nodes: [foot, head]
    section: tube
    material: steel
    hinges: [{name: fold, at: 75 mm, axes: [y, z], axial: true}]
supports:
  clamp: {node: foot, fix: all}
  push:
    node: head
    fix: [y, z, rx, ry, rz]
    motion: {x: {havsin: {x0: 0 ms, h0: 0 mm, x1: 200 ms, h1: -SHORTENING mm}}}
analysis: {duration: 200 ms}
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "law"), [(SQUARE, "square"), (ROUND, "circular")], ids=["square", "round"]
)
def test_mean_force_and_folds_are_those_of_kinematic_models(section, law, record_figure):
    model = Crush(section, STEEL, resolution=COARSE)
    done = characterise(model)
    mean = float(done.curve.energy[-1] / done.curve.rotation[-1])
    expected = build_axial_law(law, section, STEEL).mean_crushing_force
    record_figure("mean force", mean, expected, 0.10, "N", relative=True)
    peak = float(dict(done.law.origin)["peak_force"].split()[0]) * 1e3
    record_figure("peak force", peak, model.squash_force, 0.02, "N", relative=True)
    record_figure("folds", fold_count(done.result, section.thickness), model.length / model.wave, 1.0)
    longer = characterise(Crush(section, STEEL, length_factor=4.0 / 3.0, resolution=COARSE)).curve
    other = float(longer.energy[-1] / longer.rotation[-1])
    record_figure("mean force, a third longer", other, mean, 0.10, "N", relative=True)


@pytest.mark.slow
def test_a_column_takes_the_work_of_its_sub_model(tmp_path, record_figure):
    section, material = SQUARE, loads(COLUMN.replace("SHORTENING", "1")).structure.material_of("column")
    model = Crush(section, material, resolution=COARSE)
    done = characterise(model)
    LawStore(tmp_path / "laws").keep(model, done.law)
    path, end = tmp_path / "column.yaml", float(done.curve.rotation[-1])
    path.write_text(COLUMN.replace("SHORTENING", f"{1e3 * end:.6g}"))
    source = load_input(path)
    found, plain = (crumple.solve(one.analysis) for one in (source.with_laws(tmp_path / "laws"), source))
    assert found.status.ok
    work = float(found["energy.external_work"][-1])
    record_figure("work up to the stroke", work, done.curve.energy_at(end), 0.05, "J", relative=True)
    # without a law the walls yield at the squash force
    assert float(plain["energy.external_work"][-1]) > 2.0 * work
