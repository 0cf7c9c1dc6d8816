"""A checkpoint belongs to one model; that of a stage belongs to models with the same structure."""

import dataclasses

import numpy as np
import pytest
from tests.support.shell.sheets import bits, grid, model

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError


@pytest.mark.parametrize(
    ("name", "of_next_stage"),
    [("position", False), ("thickness", False), ("materials", False), ("settings", True), ("velocity", True)],
)
def test_a_checkpoint_of_another_model_of_the_same_size_is_refused(name, of_next_stage):
    """A stage may differ in damping, but not in the structure; a restart may not differ at all."""
    one = model(*grid(4, 3), settings={"damping": 5.0})
    value = getattr(one, name)
    changed = {
        "materials": lambda: [dataclasses.replace(value[0], density=1.1 * value[0].density)],
        "settings": lambda: dataclasses.replace(value, damping=7.0),
        "velocity": lambda: np.full_like(one.position, 0.1),
    }.get(name, lambda: 1.1 * np.asarray(value))()
    other = ShellState(dataclasses.replace(one, **{name: changed}))
    state = ShellState(one)
    state.advance(1.0, steps=10)
    before = bits(other)
    with pytest.raises(InputError, match="another model"):
        other.restore(state.checkpoint())
    assert bits(other) == before
    if of_next_stage:
        other.restore(state.checkpoint(), of_stage_before=True)
        assert other.time == state.time
    else:
        with pytest.raises(InputError, match="another model"):
            other.restore(state.checkpoint(), of_stage_before=True)
