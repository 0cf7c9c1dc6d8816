"""Types of the compiled module; see native/*/bind.cpp."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

class _Planar:
    class Model:
        def __init__(
            self,
            parent: NDArray[np.int64],
            joint: NDArray[np.int64],
            bodies: NDArray[np.float64],
            q0: Sequence[float],
            hinges: list[dict[str, Any]],
            loads: list[tuple[Any, ...]],
            drives: list[tuple[Any, ...]],
            holds: list[tuple[Any, ...]],
            welds: list[tuple[Any, ...]],
            gravity: Sequence[float],
            length: float,
            breaks: Sequence[float],
            resolved_frequency: float,
        ) -> None: ...

    class Simulation:
        def __init__(
            self,
            model: _Planar.Model,
            accuracy: float,
            minimum_step: float,
            maximum_step: float,
            parts: int = 1,
        ) -> None: ...
        def set_motion(self, velocity: NDArray[np.float64], impulse: NDArray[np.float64]) -> float: ...
        def set_rates(self, w: Sequence[float]) -> None: ...
        def run(
            self, times: Sequence[float], poll: Callable[[float], bool] | None = None
        ) -> dict[str, Any]: ...
        def step(self, h: float) -> bool: ...
        def effective_inertia(self, dof: int) -> float: ...
        def summary(self) -> NDArray[np.float64]: ...
        @property
        def time(self) -> float: ...
        @property
        def q(self) -> list[float]: ...
        @property
        def w(self) -> list[float]: ...

    tangent: Any
    def solve_many(
        self,
        models: list[Model],
        model_of: NDArray[np.int64],
        end: float,
        velocity: NDArray[np.float64] | None,
        impulse: NDArray[np.float64] | None,
        capacity_scale: NDArray[np.float64] | None,
        load_scale: NDArray[np.float64] | None,
        bodies: NDArray[np.float64] | None,
        gravity: NDArray[np.float64] | None,
        accuracy: float,
        minimum_step: float,
        maximum_step: float,
        threads: int,
        poll: Callable[[float], bool] | None,
        times: Sequence[float] = (),
        parts: int = 1,
    ) -> dict[str, Any]: ...

class _Spatial:
    class Guide: ...

    class Simulation:
        def __init__(
            self,
            model: dict[str, Any],
            accuracy: float,
            minimum_step: float,
            maximum_step: float,
            parts: int = 1,
        ) -> None: ...
        def set_motion(self, velocity: NDArray[np.float64], impulse: NDArray[np.float64]) -> float: ...
        def stage(
            self, quasi_static: bool, drives: list[int], obstacles: list[int], until: list[tuple[Any, ...]]
        ) -> None: ...
        def run(
            self, times: Sequence[float], poll: Callable[[float], bool] | None = None
        ) -> dict[str, Any]: ...
        def step(self, h: float) -> bool: ...
        def keep_guide(self) -> None: ...
        def guide(self) -> _Spatial.Guide | None: ...
        def be_guided_by(self, lead: _Spatial.Guide, pairs: bool) -> None: ...
        def crushed(self) -> list[tuple[int, int, int, float]]: ...
        def freedoms(self) -> tuple[int, int]: ...
        def redundant(self) -> list[int]: ...
        @property
        def time(self) -> float: ...

    class Case:
        def __init__(self, model: dict[str, Any]) -> None: ...
        def add_stage(
            self,
            duration: float,
            quasi_static: bool,
            drives: list[int],
            obstacles: list[int],
            until: list[tuple[Any, ...]],
        ) -> None: ...

    def solve_many(
        self,
        cases: list[Case],
        case_of: NDArray[np.int64],
        velocity: NDArray[np.float64] | None,
        impulse: NDArray[np.float64] | None,
        capacity_scale: NDArray[np.float64] | None,
        load_scale: NDArray[np.float64] | None,
        bodies: NDArray[np.float64] | None,
        gravity: NDArray[np.float64] | None,
        accuracy: float,
        minimum_step: float,
        maximum_step: float,
        threads: int,
        poll: Callable[[float], bool] | None,
        led: bool,
        times: Sequence[float] = (),
        parts: int = 1,
        guided: bool = False,
    ) -> dict[str, Any]: ...

    HingeElement: Any
    surface_point: Any
    surface_gauge: Any

record_columns: dict[str, list[str]]
planar: _Planar
spatial: _Spatial
shell: Any
