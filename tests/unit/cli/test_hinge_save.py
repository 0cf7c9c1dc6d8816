"""`crumple hinge --save` writes a law file that a structure can refer to."""

import pytest
from typer.testing import CliRunner

from crumple.cli.main import app
from crumple.errors import InputError
from crumple.hinge import Trust, read_law

TUBE = ["hinge", "rectangular_tube 50x25x2.65 mm", "--material", "yield 488 MPa, E 210 GPa"]


def invoke(*arguments):
    return CliRunner().invoke(app, [*TUBE, *arguments], catch_exceptions=False)


@pytest.mark.parametrize(
    ("name", "method", "trust"),
    [
        ("library", "library", Trust.COMPUTED),
        ("estimate", "estimate", Trust.ESTIMATED),
        ("kecman", "formula", Trust.DERIVED),
    ],
)
def test_a_saved_law_says_where_it_comes_from(tmp_path, name, method, trust):
    file = tmp_path / "hinge.yaml"
    result = invoke("--law", name, "--save", str(file))
    assert result.exit_code == 0, result.output
    law = read_law(file.read_text(encoding="utf-8"))
    assert dict(law.origin)["method"] == method
    assert law.source.trust is trust


def test_saved_law_is_the_law_shown(tmp_path):
    file = tmp_path / "hinge.yaml"
    result = invoke("--law", "kecman", "--save", str(file))
    assert result.exit_code == 0, result.output
    law = read_law(file.read_text(encoding="utf-8"))
    assert law.law == "kecman"
    assert dict(law.origin)["method"] == "formula"
    assert float(law.moment_capacity(0.0)) == pytest.approx(1696.0, rel=1e-3)


def test_several_laws_are_refused(tmp_path):
    with pytest.raises(InputError, match="one law"):
        invoke("--save", str(tmp_path / "hinge.yaml"))


@pytest.mark.parametrize("name", ["table", "file"])
def test_a_law_without_a_formula_is_refused_with_what_to_do(name):
    with pytest.raises(InputError, match="comes from a file") as caught:
        invoke("--law", name)
    assert "--curve" in caught.value.problems[0].todo
