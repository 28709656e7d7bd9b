# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Sequence
from typing import Any

from numpy import float64
from numpy.typing import NDArray

Floats = NDArray[float64]

parameters: tuple[tuple[str, str], ...]

class Options:
    radius: float
    spring_constant: float
    loss: int
    loss_scale: float
    force_noise: float
    pull_off_force: float
    pull_off_sigma: float
    compliance_sigma: float
    max_iterations: int
    def __init__(self, model: int) -> None: ...
    def start(self, name: str, value: float, /) -> None: ...
    def hold(self, name: str, value: float, /) -> None: ...
    def free(self, name: str, /) -> None: ...
    def bound(self, name: str, minimum: float, maximum: float, /) -> None: ...
    def is_free(self, name: str, /) -> bool: ...

def model_has(model: int, name: str, /) -> bool: ...
def run(options: Options, position: Floats, force: Floats) -> dict[str, Any]: ...
def evaluate(options: Options, value: Sequence[float], position: Floats) -> tuple[Floats, Floats]: ...
