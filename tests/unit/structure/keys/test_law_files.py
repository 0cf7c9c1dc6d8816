"""A structure refers to a law file: its content is embedded and checked, its band reaches the hinge."""

import pytest

from crumple.errors import InputError
from crumple.hinge import build_law, stored_law, write_law
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.structure import LawKeys

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(0.05, 0.025, 0.00265)
TEXT = write_law(stored_law(build_law("kecman", TUBE, STEEL), {"method": "formula"}))


def test_content_is_embedded(tmp_path, monkeypatch):
    (tmp_path / "root.yaml").write_text(TEXT, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    law = LawKeys(type="file", file="root.yaml", bound="upper")
    assert "file" not in law.own
    assert law.text == TEXT
    assert law.bound == "upper"
    (tmp_path / "root.yaml").unlink()
    assert law.model_copy(update={"rate": "off"}).text == TEXT


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({}, "a law file is needed"),
        ({"file": "missing.yaml"}, "no such file"),
        ({"file": 3}, "name of a file"),
        ({"text": TEXT.replace("softening: peak", "softening: up")}, "unknown choice"),
        ({"text": TEXT, "file": "root.yaml"}, "given twice"),
        ({"text": "x"}, "cannot be read|no keys"),
    ],
)
def test_mistakes(given, what):
    with pytest.raises(InputError, match=what):
        LawKeys(type="file", **given)
