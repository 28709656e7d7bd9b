# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable, Sequence
from typing import Any, overload

from numpy import bool_, float64, int64
from numpy.typing import NDArray

Floats = NDArray[float64]

models: tuple[str, ...]
flags: dict[str, int]
statuses: dict[str, int]

class Options:
    radius: float
    half_angle: float
    spring_constant: float
    tilt_position: float
    loss: int
    loss_scale: float
    force_noise: float
    tear_position: float
    tear_sigma: float
    max_iterations: int
    @overload
    def __init__(self, model: str) -> None: ...
    @overload
    def __init__(
        self,
        name: str,
        parameters: list[tuple[str, str, float, float, float]],
        force: Callable[[Floats, Floats], Floats],
    ) -> None: ...
    @property
    def parameters(self) -> tuple[tuple[str, str, float, float] | None, ...]: ...
    def start(self, name: str, value: float, /) -> None: ...
    def know(self, name: str, value: float, sigma: float, /) -> None: ...
    def hold(self, name: str, value: float, /) -> None: ...
    def free(self, name: str, /) -> None: ...
    def bound(self, name: str, minimum: float, maximum: float, /) -> None: ...
    def is_free(self, name: str, /) -> bool: ...

def run(options: Options, position: Floats, force: Floats) -> dict[str, Any]: ...
def evaluate(options: Options, value: Sequence[float], position: Floats) -> tuple[Floats, Floats, NDArray[bool_]]: ...
def gradient(options: Options, value: Sequence[float], position: Floats) -> Floats: ...
def tear_position(options: Options, value: Sequence[float]) -> float: ...

class Recipe:
    approach: bool
    baseline: int
    fit_offset: bool
    loss_scale: float
    lowest_force: float
    highest_force: float
    sensitivity_uncertainty: float
    def __init__(self, options: Options) -> None: ...
    def check(self) -> None: ...
    def hold(self, place: int, /) -> None: ...

good_rating: float

def rating(indentation: Floats, force: Floats, fitted: Floats, noise: float) -> float: ...
def batch(
    recipe: Recipe, z: Floats, force: Floats, edges: NDArray[int64], spring_constant: Floats, threads: int
) -> dict[str, Any]: ...
