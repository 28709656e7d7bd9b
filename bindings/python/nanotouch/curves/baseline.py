# SPDX-License-Identifier: BSD-3-Clause
"""The force of the free cantilever: a line, and the wave that stray light draws over it (``nanotouch/curves.h``)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import InvalidValue
from .flicker import Noise

Floats = NDArray[np.float64]
Kind = Literal["auto", "line", "wave", "constant"] | tuple[float, float]
KINDS = ("auto", "line", "wave", "constant")


@dataclass(frozen=True)
class Wave:
    """``cosine cos(2 pi (z - z_mean)/period) + sine sin(...)`` [N], period [m]."""

    period: float
    cosine: float
    sine: float

    @property
    def amplitude(self) -> float:
        """[N]."""
        return float(np.hypot(self.cosine, self.sine))


class Bend(NamedTuple):
    """What bends the line of a free cantilever: ``film/(max(z, nearest) - pole) + bow (z - z_mean)^2`` [N].

    `film` [N m] is the repulsion of the fluid under the lever, `bow` [N/m^2] a curved baseline; 0 where there is none.
    """

    film: float
    pole: float
    nearest: float
    bow: float


@dataclass(frozen=True)
class Baseline:
    """Force of the free cantilever: ``force + slope (z - z_mean)``, a wave and what bends it.

    Attributes
    ----------
    force : float
        Force at `z_mean` [N].
    slope : float
        Tilt [N/m].
    z_mean : float
        Mean z of the points it was fitted to [m].
    nearest : float
        Least z of these [m].
    scatter : float
        Robust standard deviation of those points about the baseline [N].
    variance : tuple of float
        Variances of `force` [N^2] and `slope` [N^2/m^2], flicker noise included.
    noise : Noise
        White and flicker noise [N^2]: that of both branches where both are there and do not contradict each other.
    wave : Wave or None
        Of interference.
    bend : Bend or None
        Of an approach, where a squeeze film or a bow is evident; of the retraction beside it the same bow.
    """

    force: float
    slope: float
    z_mean: float
    nearest: float
    scatter: float
    variance: tuple[float, float]
    noise: Noise
    wave: Wave | None = None
    bend: Bend | None = None

    @classmethod
    def of(cls, terms: tuple[float, ...]) -> Baseline:
        """From the numbers of the C library."""
        force, slope, z_mean, nearest, scatter, level, tilt, white, flicker, period, cosine, sine, *bent = terms
        bend = Bend(*bent)
        wave = Wave(period, cosine, sine) if cosine or sine else None
        noise = Noise(white, flicker)
        kept = bend if bend.film or bend.bow else None
        return cls(force, slope, z_mean, nearest, scatter, (level, tilt), noise, wave, kept)

    def _terms(self) -> tuple[float, ...]:
        wave = self.wave or Wave(1.0, 0.0, 0.0)
        return (
            self.force, self.slope, self.z_mean, self.nearest, self.scatter, *self.variance, *self.noise,
            wave.period, wave.cosine, wave.sine, *(self.bend or Bend(0.0, 0.0, 0.0, 0.0)),
        )  # fmt: skip

    def at(self, z: Floats) -> Floats:
        """The baseline at z [m], in N."""
        return _core.baseline_at(self._terms(), z)

    def sigma(self, z: float) -> float:
        """Standard uncertainty of the baseline at z [m], in N."""
        return _core.baseline_sigma(self._terms(), z)


def choice_of(kind: Kind) -> tuple[int, float, float]:
    """What the C library is asked for: the kind and the ends of z [m]."""
    if not isinstance(kind, str):
        return _core.baseline_kinds["between"], float(kind[0]), float(kind[1])
    if kind not in KINDS:
        raise InvalidValue(f"baseline {kind!r}: valid are {', '.join(KINDS)}")
    return _core.baseline_kinds[kind], 0.0, 0.0


def fit_baseline(z: Floats, force: Floats, kind: Kind = "auto") -> Baseline:
    """The baseline of one branch.

    Parameters
    ----------
    z, force : ndarray, shape (n,)
        Height of the base [m] and force [N].
    kind : {"auto", "line", "wave", "constant"} or (float, float)
        ``"auto"``: a line, with a wave where there is very strong evidence for one. ``"constant"``: the median of the
        far half, which leaves the tilt in the force, as many published values do. A pair: a line through the points
        with z between these [m].
    """
    return Baseline.of(_core.fit_baseline(z, force, choice_of(kind)))
