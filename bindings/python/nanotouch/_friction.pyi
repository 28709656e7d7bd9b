# SPDX-License-Identifier: BSD-3-Clause
"""What _core has of friction.h. For type checkers: no module at run time."""

from numpy import float64
from numpy.typing import NDArray

_Floats = NDArray[float64]

class Friction:
    def __init__(self, modulus: float, compliance: float, strength: float, coefficient: float, /) -> None: ...
    def run(self, state: _Floats, ways: _Floats, contacts: _Floats, /) -> _Floats: ...
    def stiffness(self, radius: float, /) -> float: ...
    def limit(self, radius: float, load: float, /) -> float: ...
    @staticmethod
    def effective_shear_modulus(
        tip_modulus: float, tip_ratio: float, sample_modulus: float, sample_ratio: float, /
    ) -> float: ...
    @staticmethod
    def compressive_load(
        model: int,
        radius: float,
        modulus: float,
        adhesion: float,
        stress: float,
        force: _Floats,
        contact_radius: _Floats,
        /,
    ) -> _Floats: ...

class Corrugation:
    def __init__(
        self, energy: float, period: float, stiffness: float, damping: float, temperature: float, /
    ) -> None: ...
    def mean_force(self, speed: float, /) -> float: ...
    @property
    def onset(self) -> float: ...
    @property
    def largest_force(self) -> float: ...
