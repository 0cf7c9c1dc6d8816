"""The law type `measured`: curves from files, band from specimens or given, and a fold that is bent back."""

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import InputError
from crumple.hinge import SofteningVariable, bounded, build_law
from crumple.hinge.measured.measured import measured_band
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 355e6)
TUBE = RectangularTube(0.06, 0.04, 0.002)
ROTATION = np.radians([0, 0.25, 0.4, 0.5, 1, 2, 3, 5, 10, 20, 40])
MOMENT = 1e3 * np.array([0, 0.45, 0.72, 0.9, 1.55, 1.9, 1.95, 1.75, 1.2, 0.8, 0.55])
CSV = "rotation [deg], moment [kN*m]\n" + "\n".join(
    f"{np.degrees(x):.6g}, {y / 1e3:.6g}" for x, y in zip(ROTATION, MOMENT, strict=True)
)
CYCLE = """
crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {{tube: {{type: rectangular_tube, width: 60 mm, depth: 40 mm, thickness: 2 mm}}}}
hinge_laws:
  joint: {{type: measured, file: joint.csv, elastic_stiffness: 1.8 kN*m/deg, form: elastic-plastic{more}}}
nodes: {{root: [0 m, 0 m, 0 m], tip: [0.8 m, 0 m, 0 m]}}
members:
  arm:
    nodes: [root, tip]
    section: tube
    material: steel
    hinges: [{{name: joint, at: root, offset: 0 mm, law: joint}}]
supports:
  clamp: {{node: root, fix: all}}
  ram:
    node: tip
    motion: {{z: {{table: {{time: [0 s, 1 s, 2 s, 3 s], value: [0 mm, 80 mm, 0 mm, -80 mm]}}}}}}
analysis: {{stages: [{{name: cycle, kind: quasi-static, duration: 3 s}}]}}
"""


def law(*scales, **options):
    given = {"rotations": [ROTATION for _ in scales], "moments": [scale * MOMENT for scale in scales]}
    return build_law("measured", TUBE, STEEL, "y", **given, **options)


def test_the_mean_of_specimens_is_nominal_and_their_scatter_the_band():
    scales = (0.9, 1.0, 1.1)
    found = law(*scales)
    band = measured_band([(ROTATION, scale * MOMENT) for scale in scales])
    at = np.linspace(0.0, band.abscissa[-1], 7)
    for bound, edge in (("nominal", band.mean), ("lower", band.lower), ("upper", band.upper)):
        expected = np.interp(at, band.abscissa, edge)
        np.testing.assert_allclose(bounded(found, bound).moment_capacity(at), expected, rtol=1e-12)
    assert found.validity.uncertainty == pytest.approx(band.scatter)


def test_a_single_specimen_has_the_scatter_that_is_given_or_none():
    with pytest.raises(InputError, match="scatter of this law is unknown"):
        bounded(law(1.0), "lower")
    known = law(1.0, scatter=0.15)
    assert float(bounded(known, "upper").moment_capacity(0.2)) == pytest.approx(
        1.15 * float(known.moment_capacity(0.2))
    )
    assert known.softening_variable is SofteningVariable.ACCUMULATED


@pytest.mark.parametrize(("more", "regains"), [("", False), (", softening: rotation", True)])
def test_a_folded_joint_bent_back_does_not_regain_its_virgin_moment(tmp_path, more, regains):
    """Bent by 5 degrees, straightened, bent the other way: only the reversible curve returns to its peak."""
    (tmp_path / "joint.csv").write_text(CSV, encoding="utf-8")
    result = solve(loads(CYCLE.format(more=more), directory=tmp_path))
    moment = np.abs(result["hinge.joint.moment"])
    before, after = moment[result.time < 1.0].max(), moment[result.time > 1.2].max()
    assert before > 1900.0
    assert bool(after > 0.98 * before) is regains
    if not regains:
        # 4.8 degrees folded and 4.8 back: beyond the curve's value at twice that rotation
        assert moment[-1] < 1100.0


def test_mistakes_are_refused(tmp_path):
    (tmp_path / "joint.csv").write_text("rotation [deg], moment [kN*m]\n0, x\n", encoding="utf-8")
    with pytest.raises(InputError, match="not a number"):
        loads(CYCLE.format(more=""), directory=tmp_path)
    text = CYCLE.format(more="").replace("file: joint.csv, ", "")
    with pytest.raises(InputError, match="no curves"):
        loads(text, directory=tmp_path)
    with pytest.raises(InputError, match="given twice"):
        loads(CYCLE.format(more=", files: [joint.csv]"), directory=tmp_path)
    lists = ", rotations: [[0 deg, 4 deg]], moments: [[0 kN*m, 2 kN*m]]"
    with pytest.raises(InputError, match="give files or the lists"):
        loads(CYCLE.format(more=lists), directory=tmp_path)
