# SPDX-License-Identifier: BSD-3-Clause
"""What _core has of rheology.h. For type checkers: no module at run time."""

from collections.abc import Sequence
from typing import Any

from numpy import float64
from numpy.typing import NDArray

_Floats = NDArray[float64]

class Rheology:
    fields: list[tuple[str, str, float, float, str]]
    def __init__(
        self, kind: int, numbers: Sequence[float], moduli: Sequence[float], times: Sequence[float], /
    ) -> None: ...
    def relaxation(self, time: _Floats, /) -> _Floats: ...
    def relaxation_integral(self, time: _Floats, /) -> _Floats: ...
    def creep(self, time: _Floats, /) -> _Floats: ...
    def discretize(
        self, shortest: float, longest: float, error: float, /
    ) -> tuple[float, list[float], list[float], float]: ...

class Viscoelastic:
    def __init__(
        self, shape: Any, rheology: Rheology, poisson_ratio: float, thickness: float, spring_constant: float, /
    ) -> None: ...
    def run(
        self, times: _Floats, positions: _Floats, contact: float, derivatives: bool, /
    ) -> tuple[_Floats, _Floats, _Floats | None, int, float, bool]: ...
    def run_adhesive(
        self, times: _Floats, positions: _Floats, contact: float, work_of_adhesion: float, crack_length: float, /
    ) -> tuple[_Floats, _Floats, int, float, float]: ...
