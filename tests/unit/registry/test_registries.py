"""Every line of every registry leads to what it promises, and what is registered is described."""

from __future__ import annotations

import inspect
import subprocess
import sys

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge.registry import AXIAL, BENDING, TORSION, FromFiles, needs_curve, options_of
from crumple.material.hardening.curve import HardeningCurve
from crumple.material.registry import HARDENING, RATE
from crumple.registry.keys import MISSING, keys_of, sentence_on
from crumple.registry.registry import Registry
from crumple.section import Section
from crumple.section.shapes.registry import SHAPES
from crumple.section.shapes.shape import Shape
from crumple.section.shapes.written import written_section

LAWS = [(registry, name) for registry in (BENDING, AXIAL, TORSION) for name in registry]


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_complete(name):
    shape = SHAPES[name]
    assert isinstance(shape, Shape)
    assert shape.sentence.endswith(".")
    assert all(key.text.endswith(".") for key in shape.keys)
    assert shape.examples
    for example in shape.examples:
        section = written_section(f"{name} {example.text}")
        assert isinstance(section, Section)
        assert section.area > 0.0


@pytest.mark.parametrize(("registry", "name"), LAWS)
def test_a_law_is_complete(registry, name):
    law = registry[name]
    assert list(inspect.signature(law.of).parameters)[:2] == ["section", "material"]
    assert sentence_on(law).endswith(".")
    assert all(key.text.endswith(".") for key in options_of(law)), name
    if isinstance(law, FromFiles):
        assert needs_curve(name)
        assert all(key.text.endswith(".") for key in law.file_keys)


@pytest.mark.parametrize("name", HARDENING)
def test_a_hardening_curve_is_complete(name):
    make = HARDENING[name]
    examples = {"plastic_strain": (0.0, 0.1), "true_stress": (300e6, 400e6)}
    curve = make(**{key.name: examples.get(key.name, 0.5) for key in keys_of(make)})
    assert isinstance(curve, HardeningCurve)
    np.testing.assert_allclose(curve.stress(0.0), curve.yield_stress)
    assert all(key.text.endswith(".") for key in keys_of(make) if key.name != "yield_stress")


@pytest.mark.parametrize("name", RATE)
def test_a_strain_rate_law_is_complete(name):
    assert all(key.text.endswith(".") for key in keys_of(RATE[name]))
    assert RATE[name](**{key.name: 2.0 for key in keys_of(RATE[name])}).factor(100.0) > 1.0


def test_an_unknown_name_is_refused_with_those_that_are_known():
    registry: Registry[object] = Registry("colour", {"red": "builtins:int", "blue": "builtins:float"})
    assert (list(registry), len(registry), "red" in registry, "green" in registry) == (
        ["red", "blue"],
        2,
        True,
        False,
    )
    assert registry["red"] is int
    assert dict(registry.items()) == {"red": int, "blue": float}
    with pytest.raises(InputError, match="unknown colour") as refusal:
        registry["green"]
    assert refusal.value.problems[0].allowed == "red, blue"


def test_names_alone_import_neither_shapes_nor_laws():
    code = (
        "import sys\n"
        "from crumple.section.shapes.registry import SHAPES\n"
        "print(list(SHAPES)[0], [n for n in sys.modules if n in ('numpy', 'pydantic')"
        " or n.startswith('crumple.section.shapes.') and not n.endswith('registry')])"
    )
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.split() == ["rectangular_tube", "[]"]


def test_keys_have_the_text_of_the_function():
    def made(first: float, *, colour: str = "red", second: int = 2) -> None:
        """Thing of two numbers.

        Parameters
        ----------
        first
            First number [m], which goes
            on here.
        colour, second
            The others.

        Raises
        ------
        ValueError
            Never.
        """

    first, colour, second = keys_of(made)
    assert (first.name, first.default, first.text) == ("first", MISSING, "First number, which goes on here.")
    assert (colour.default, colour.text, second.text) == ("red", "The others.", "The others.")
    assert [key.name for key in keys_of(made, options=True)] == ["colour", "second"]
    assert sentence_on(made) == "Thing of two numbers."
