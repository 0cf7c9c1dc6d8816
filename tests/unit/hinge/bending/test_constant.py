import pytest

from crumple.errors import InputError
from crumple.hinge import ConstantLaw, Trust, absorbed_energy, rotation_absorbing
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)


def test_plastic_moment_unless_given():
    tube, pipe = RectangularTube(0.05, 0.025, 0.002, 0.004), CircularTube(0.04, 0.002)
    for section in (tube, pipe):
        law = ConstantLaw.of(section, STEEL, "z")
        assert law.moment == pytest.approx(300e6 * section.plastic_section_modulus_z)
        assert law.source.trust is Trust.DERIVED
        assert "overestimates" in law.validity.warnings[0]
    given = ConstantLaw.of(tube, STEEL, moment=1234.0)
    assert given.moment == 1234.0
    assert given.source.trust is Trust.ASSUMED


def test_energy_is_moment_times_rotation():
    law = ConstantLaw(500.0)
    assert absorbed_energy(law, 0.3) == pytest.approx(150.0, rel=1e-14)
    assert rotation_absorbing(law, 150.0) == pytest.approx(0.3, rel=1e-12)


@pytest.mark.parametrize("moment", [0.0, -5.0, float("nan"), float("inf")])
def test_impossible_moments_are_refused(moment):
    with pytest.raises(InputError, match="positive"):
        ConstantLaw(moment)
