# SPDX-License-Identifier: BSD-3-Clause
"""The force of the free cantilever: a line, and the wave that stray light draws over it.

Tilt comes from drag, drift and light that misses the cantilever; it differs between the branches. The line is a robust
one (Tukey's weights) through the far half of the travel, then through all of it beyond the outermost point that this
line cannot explain, so that it is hardly extrapolated to where it is needed. Light reflected by the sample interferes
with that of the cantilever and adds a wave over z, one period for half a wavelength of height; it is fitted too where
the residuals of the line prove it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue
from .flicker import Noise, split_noise

Floats = NDArray[np.float64]
Kind = Literal["auto", "line", "wave", "constant"] | tuple[float, float]
KINDS = ("auto", "line", "wave", "constant")

_FEWEST = 16  # points of a baseline between given ends
_FAR = 0.5  # part of the travel taken for the first baseline
_MARGIN = 0.05  # of the travel, kept between an event and the baseline that judges it
EVENT = 5.0  # standard deviations of the noise: one in 2e6 points
WAVE = 3.0  # standard deviations of the scatter about the line, where interference makes waves
MAD = 1.4826  # standard deviation over median absolute deviation, for Gaussian noise
_TUKEY = 4.685  # 95 % efficiency on Gaussian noise
_ROUNDS = 10  # of Tukey's weights at most
_SETTLED = 1e-3  # of the scatter, by which the line may still move
_BLOCKS = 10  # the residuals' correlation is judged from the scatter of this many block means
_PERIODS = 160e-9, 800e-9  # m: half the wavelengths of common lasers, with room for inclined beams
_CYCLES = 1.5  # periods that have to be seen
_SHARE = 0.3  # of the variance of the residuals that a wave has to make
_GRID = 1024  # points of the spectrum it is looked for in
_CORRELATED = 5.0  # of white noise this ratio is 1 +- 0.45
_EVIDENCE = 10.0  # difference in BIC: very strong
_SEEN = 2.5  # periods from which on less has to be explained
_CLEARER, _MUCH_CLEARER = 1.5, 5.0  # scatter about the line over that about the wave, with more periods and with fewer


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

    def at(self, x: Floats) -> Floats:
        """At x = z - z_mean [m], in N."""
        phase = 2.0 * np.pi / self.period * x
        return np.asarray(self.cosine * np.cos(phase) + self.sine * np.sin(phase))


@dataclass(frozen=True)
class Baseline:
    """Force of the free cantilever: ``force + slope (z - z_mean)``, and a wave.

    Attributes
    ----------
    force : float
        Force at `z_mean` [N].
    slope : float
        Tilt [N/m].
    z_mean : float
        Mean z of the points it was fitted to [m].
    scatter : float
        Robust standard deviation of those points about the baseline [N].
    variance : tuple of float
        Variances of `force` [N^2] and `slope` [N^2/m^2], flicker noise included.
    noise : Noise
        White and flicker noise of those points [N^2].
    wave : Wave or None
        Of interference.
    """

    force: float
    slope: float
    z_mean: float
    scatter: float
    variance: tuple[float, float]
    noise: Noise
    wave: Wave | None = None

    def at(self, z: Floats) -> Floats:
        """The baseline at z [m], in N."""
        x = z - self.z_mean
        line = self.force + self.slope * x
        return line if self.wave is None else line + self.wave.at(x)

    def sigma(self, z: float) -> float:
        """Standard uncertainty of the baseline at z [m], in N."""
        return float(np.sqrt(self.variance[0] + self.variance[1] * (z - self.z_mean) ** 2))


def point_noise(force: Floats) -> float:
    """Standard deviation of white noise, from differences of neighbours, so that no shape of the curve enters [N].

    Where more than half of them are 0, because the converter's step exceeds the noise, from the root mean square of all
    but the largest hundredth.
    """
    differences = np.abs(np.diff(force))
    middle = MAD * float(np.median(differences))
    if middle == 0.0:
        middle = float(np.sqrt(np.mean(np.sort(differences)[: int(0.99 * differences.size)] ** 2)))
    return middle / float(np.sqrt(2.0))


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
    if not isinstance(kind, str):
        return _between(z, force, kind)
    if kind not in KINDS:
        raise InvalidValue(f"baseline {kind!r}: valid are {', '.join(KINDS)}")
    far = np.asarray(z >= z.max() - _FAR * np.ptp(z), dtype=bool)
    if kind == "constant":
        return _constant(z[far], force[far])
    free = _free_part(z, force, far, _line(z[far], force[far]))
    line = _line(z[free], force[free])
    if kind == "line" or (kind == "auto" and _correlation(force[free] - line.at(z[free]), line.scatter) < _CORRELATED):
        return line
    waved = _with_wave(z[free], force[free], line)
    if waved is None or (kind == "auto" and not _is_evident(line, waved, z[free], force[free])):
        return line
    return waved


def _between(z: Floats, force: Floats, ends: tuple[float, float]) -> Baseline:
    inside = (z >= ends[0]) & (z <= ends[1])
    if np.count_nonzero(inside) < _FEWEST:
        raise InvalidValue(
            f"baseline {ends[0]:g} .. {ends[1]:g} m holds {np.count_nonzero(inside)} points, expected {_FEWEST} or more"
        )
    return _line(z[inside], force[inside])


def _constant(z: Floats, force: Floats) -> Baseline:
    level = float(np.median(force))
    rest = force - level
    scatter = MAD * float(np.median(np.abs(rest)))
    noise = split_noise(rest, scatter)
    return Baseline(level, 0.0, float(z.mean()), scatter, (noise.white / z.size + noise.flicker, 0.0), noise)


def _free_part(z: Floats, force: Floats, far: NDArray[np.bool_], line: Baseline) -> NDArray[np.bool_]:
    """All beyond the outermost point that the line through the far half cannot explain."""
    off = np.abs(force - line.at(z))
    event = off > max(EVENT * point_noise(force), WAVE * line.scatter) + 0.1 * float(off.max())
    start = float(z[event].max(initial=-np.inf)) + _MARGIN * float(np.ptp(z))
    return np.asarray(far | (z > start), dtype=bool) if np.isfinite(start) else far


def _line(z: Floats, force: Floats) -> Baseline:
    """By iterated least squares with Tukey's weights."""
    x, weight = z - z.mean(), np.ones(z.size)
    slope = level = centre = 0.0
    for _ in range(_ROUNDS):
        total = float(weight.sum())
        centre, level = float(weight @ x) / total, float(weight @ force) / total
        spread = float(weight @ (x - centre) ** 2)
        before = slope
        slope = float(weight @ ((x - centre) * (force - level))) / spread if spread > 0 else 0.0
        rest = force - (level - slope * centre) - slope * x
        scatter = MAD * float(np.median(np.abs(rest)))
        if scatter == 0.0 or abs(slope - before) * float(np.ptp(x)) < _SETTLED * scatter:
            break
        weight = np.clip(1 - (rest / (_TUKEY * scatter)) ** 2, 0.0, None) ** 2
    noise = split_noise(rest, scatter)
    return Baseline(level - slope * centre, slope, float(z.mean()), scatter, _variance(noise, x), noise)


def _variance(noise: Noise, x: Floats) -> tuple[float, float]:
    """Of level and slope of a line."""
    worth = noise.white + x.size * noise.flicker
    return worth / x.size, worth / max(float(x @ x), 1e-300)


def _correlation(rest: Floats, scatter: float) -> float:
    """By how much the residuals' correlation raises the variance of their mean (1 for white noise)."""
    size = rest.size // _BLOCKS
    if scatter == 0.0 or size < 2:
        return 1.0
    means = rest[: size * _BLOCKS].reshape(_BLOCKS, size).mean(1)
    return max(1.0, float(means @ means) / _BLOCKS * size / scatter**2)


def _is_evident(line: Baseline, waved: Baseline, z: Floats, force: Floats) -> bool:
    """Whether the wave is one, and not the wandering of a drifting force, which has no period.

    By the BIC of the line over that of the wave, with as many points as the residuals of the wave are worth; and by how
    much scatter it explains, of which drift leaves more, the more periods are seen.
    """
    if waved.scatter == 0.0 or waved.wave is None:
        return True
    gain = line.scatter / waved.scatter
    worth = z.size / _correlation(force - waved.at(z), waved.scatter)
    many = float(np.ptp(z)) / waved.wave.period >= _SEEN
    evidence = worth * 2.0 * float(np.log(gain)) - 3.0 * float(np.log(max(worth, 1.0)))
    return gain >= (_CLEARER if many else _MUCH_CLEARER) and evidence >= _EVIDENCE


def _with_wave(z: Floats, force: Floats, line: Baseline) -> Baseline | None:
    """Line and wave together with Tukey's weights; None if no wave stands out of the residuals of the line."""
    start = _likely_period(z, force - line.at(z))
    if start is None:
        return None
    x = z - z.mean()
    weight = np.clip(1 - ((force - line.at(z)) / (_TUKEY * line.scatter)) ** 2, 0.0, None) ** 2
    best, step = 1.0 / start, 0.25 / float(np.ptp(z))
    for _ in range(4):
        around = best + step * np.linspace(-1.0, 1.0, 5)
        best = float(around[int(np.argmin([_wave_terms(x, force, weight, at)[1] for at in around]))])
        step /= 3.0
    for _ in range(3):
        terms, _ = _wave_terms(x, force, weight, best)
        wave = Wave(1.0 / best, float(terms[2]), float(terms[3]))
        rest = force - terms[0] - terms[1] * x - wave.at(x)
        scatter = MAD * float(np.median(np.abs(rest)))
        if scatter == 0.0:
            break
        weight = np.clip(1 - (rest / (_TUKEY * scatter)) ** 2, 0.0, None) ** 2
    noise = split_noise(rest, scatter)
    return Baseline(float(terms[0]), float(terms[1]), float(z.mean()), scatter, _variance(noise, x), noise, wave)


def _likely_period(z: Floats, rest: Floats) -> float | None:
    """The strongest period of interference in the residuals [m]; None if it makes too little of them."""
    shortest = max(_PERIODS[0], 4.0 * float(np.ptp(z)) / min(z.size, _GRID))
    longest = min(_PERIODS[1], float(np.ptp(z)) / _CYCLES)
    if longest <= shortest:
        return None
    order = np.argsort(z)
    even = np.interp(np.linspace(z[order[0]], z[order[-1]], _GRID), z[order], rest[order])
    power = np.abs(np.fft.rfft(even - even.mean(), 4 * _GRID)) ** 2
    inverse = np.arange(power.size) / (4.0 * float(np.ptp(z)))
    allowed = (inverse >= 1.0 / longest) & (inverse <= 1.0 / shortest)
    peak = int(np.argmax(np.where(allowed, power, 0.0)))
    share = 2.0 * power[peak] / (_GRID * float(np.sum((even - even.mean()) ** 2)))  # 1 for a pure wave
    return 1.0 / float(inverse[peak]) if share > _SHARE else None


def _wave_terms(x: Floats, force: Floats, weight: Floats, inverse_period: float) -> tuple[Floats, float]:
    """Level, slope, cosine and sine of one period, and the sum of squares they leave."""
    phase = 2.0 * np.pi * inverse_period * x
    scale = float(np.abs(x).max())
    design = np.stack([np.ones(x.size), x / scale, np.cos(phase), np.sin(phase)])
    weighted = design * weight
    terms = np.linalg.solve(weighted @ design.T, weighted @ force)
    rest = force - terms @ design
    return np.asarray(terms / np.array([1.0, scale, 1.0, 1.0])), float(weight @ rest**2)
