# SPDX-License-Identifier: BSD-3-Clause
"""What a lever measures sideways: friction loops, calibration on a slope, friction that reads as load. All SI.

docs/friction.md has the equations and what was measured against what.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch._arrays import Floats, as_floats
from nanotouch.errors import InvalidValue

_SLIDES = 0.9
"""share of the loop's width from which on the tip slides on both ways"""


class Loop(NamedTuple):
    """A friction loop, in the unit of its signal."""

    half_width: float
    """friction: half of what lies between the two ways, where the tip slides on both"""
    half_width_sigma: float
    """standard error, from the scatter of independent points"""
    offset: float
    """mean of the two ways there: slope, cross-talk, zero"""
    offset_sigma: float
    """standard error"""
    sticks: float
    """length at either end over which the tip sticks, the longer one [m]"""


class Wedge(NamedTuple):
    """A lateral calibration."""

    factor: float
    """force per signal [N per unit of the signal]"""
    factor_sigma: float
    """standard deviation"""
    coefficient: float
    """of friction, mu"""
    coefficient_sigma: float
    """standard deviation"""


def loop(x: ArrayLike, trace: ArrayLike, retrace: ArrayLike) -> Loop:
    """Half-width and offset of a friction loop.

    Parameters
    ----------
    x : array (n,)
        Places, rising, the same for both ways [m].
    trace, retrace : array (n,)
        Lateral signal on the way to larger x, and on the way back.
    """
    places, there, back = (as_floats(values, name) for values, name in ((x, "x"), (trace, "trace"), (retrace, "back")))
    if places.ndim != 1 or len(places) < 8 or there.shape != places.shape or back.shape != places.shape:
        raise InvalidValue(f"a loop of {places.shape}, {there.shape}, {back.shape}: three equal arrays of 8 or more")
    if not (np.all(np.isfinite(there + back)) and np.all(np.diff(places) > 0.0)):
        raise InvalidValue("a loop needs finite signals at rising places")
    half, middle = 0.5 * (there - back), 0.5 * (there + back)
    first, last = _sliding(half)
    if last - first < 4:
        raise InvalidValue(f"the tip slides on both ways at {last - first} of {len(places)} places: 4 are needed")
    count = math.sqrt(last - first)
    return Loop(
        float(np.mean(half[first:last])),
        float(np.std(half[first:last], ddof=1)) / count,
        float(np.mean(middle[first:last])),
        float(np.std(middle[first:last], ddof=1)) / count,
        float(max(places[first] - places[0], places[-1] - places[last - 1])),
    )


def _sliding(half: Floats) -> tuple[int, int]:
    """From where to where both ways slide: the width is there, and as far again inside, where the turn has gone out."""
    level = np.median(half[len(half) // 4 : -(len(half) // 4)])
    wide = np.flatnonzero(half * np.sign(level) >= _SLIDES * abs(level))
    if level == 0.0 or len(wide) == 0:
        raise InvalidValue("the two ways do not differ: there is no loop")
    first, last = int(wide[0]), len(half) - 1 - int(wide[-1])
    return 2 * first, len(half) - 2 * last


class LateralImage(NamedTuple):
    """What trace and retrace tell at each place; arrays of their shape."""

    half_width: Floats
    """half of what lies between the two ways [N]: friction on a flat"""
    offset: Floats
    """mean of the two ways [N]: what topography turns aside"""
    coefficient: Floats
    """mu, friction over normal force, free of the slope; NaN where no slope explains both ways"""
    slope: Floats
    """of the sample across the lever [rad]"""


def image(trace: ArrayLike, retrace: ArrayLike, load: float, adhesion: float = 0.0) -> LateralImage:
    """Friction apart from topography, at each place of an image or a line; the inverse of ``slope_forces``.

    Parameters
    ----------
    trace, retrace : array (n,) or (rows, columns)
        Lateral force of the lever on the way to larger x, and on the way back, at the same places [N]; zero and
        cross-talk taken off.
    load, adhesion : float
        Of the lever, above 0, and normal to the surface, 0 or above [N].
    """
    up, down = as_floats(trace, "trace"), as_floats(retrace, "retrace")
    if up.shape != down.shape or up.size == 0:
        raise InvalidValue(f"trace and retrace of {up.shape} and {down.shape}: two equal arrays")
    if not (0.0 < load < math.inf and 0.0 <= adhesion < math.inf):
        raise InvalidValue(f"load, adhesion = {load:g}, {adhesion:g} N: load above 0, adhesion 0 or above")
    # without adhesion the ways are L tan(slope +- atan mu)
    slope = 0.5 * (np.arctan(up / load) + np.arctan(down / load))
    for _ in range(40 if adhesion > 0.0 else 0):
        slope = slope - _mismatch(slope, up, down, load, adhesion)
    s, c = np.sin(slope), np.cos(slope)
    coefficient = (up * c - load * s) / (up * s + load * c + adhesion)
    other = (load * s - down * c) / (down * s + load * c + adhesion)
    explained = np.abs(coefficient - other) <= 1e-9 * (1.0 + np.abs(coefficient))
    nothing = np.where(explained, 0.0, np.nan)
    return LateralImage(0.5 * (up - down), 0.5 * (up + down), coefficient + nothing, slope + nothing)


def _mismatch(slope: Floats, up: Floats, down: Floats, load: float, adhesion: float) -> Floats:
    """Newton's step to the slope at which mu is the same both ways: the balances, times both normal forces."""
    s, c = np.sin(slope), np.cos(slope)
    pulls, holds = up * c - load * s, load * s - down * c
    above, below = up * s + load * c + adhesion, down * s + load * c + adhesion
    value = pulls * below - holds * above
    rise = -(above - adhesion) * below - pulls * holds - (below - adhesion) * above - holds * pulls
    step: Floats = np.clip(value / rise, -0.2, 0.2)
    return step


class Crosstalk(NamedTuple):
    """What the read-outs of a lever take from each other."""

    lateral_per_normal: float
    """lateral signal per normal signal where nothing acts sideways"""
    lateral_per_normal_sigma: float
    """standard deviation"""
    normal_per_lateral: float = 0.0
    """normal signal per lateral signal where nothing presses the more"""

    def remove(self, normal: ArrayLike, lateral: ArrayLike) -> tuple[Floats, Floats]:
        """Normal and lateral signals as they would be without: both equations solved at each place."""
        seen_n, seen_l = as_floats(normal, "normal"), as_floats(lateral, "lateral")
        whole = 1.0 - self.lateral_per_normal * self.normal_per_lateral
        if not whole > 0.0:
            raise InvalidValue(f"the product of both cross-talks is {1.0 - whole:g}: valid is below 1")
        return (seen_n - self.normal_per_lateral * seen_l) / whole, (seen_l - self.lateral_per_normal * seen_n) / whole


def crosstalk(normal: ArrayLike, lateral: ArrayLike, normal_per_lateral: float = 0.0) -> Crosstalk:
    """From a tip that is pressed on a flat and does not slide: lateral over normal signal, by least squares.

    Parameters
    ----------
    normal, lateral : array (n,)
        Both signals, in the unit of each, at 3 or more loads.
    normal_per_lateral : float
        The other one, where it is known.
    """
    n, t = as_floats(normal, "normal"), as_floats(lateral, "lateral")
    if n.ndim != 1 or n.shape != t.shape or len(n) < 3 or not np.ptp(n) > 0.0:
        raise InvalidValue(f"normal and lateral of {n.shape} and {t.shape}: two equal arrays of 3 or more loads")
    far = n - np.mean(n)
    slope = float(far @ t / (far @ far))
    left = t - np.mean(t) - slope * far
    sigma = math.sqrt(float(left @ left) / (len(n) - 2) / float(far @ far))
    return Crosstalk(slope, sigma, normal_per_lateral)


def slope_forces(slope: float, coefficient: float, load: float, *, adhesion: float = 0.0) -> tuple[float, float]:
    """Half-width and offset of the loop [N] on a slope [rad] across the lever, under a load [N] of the lever and an
    adhesion [N] normal to the slope (Varenberg, Etsion, Halperin, Rev. Sci. Instrum. 74 (2003) 3362).

    From the balance of forces, uphill and downhill, with friction mu times the normal force.
    """
    s, c, mu = math.sin(slope), math.cos(slope), coefficient
    steep = c * c - mu * mu * s * s
    if not steep > 0.0:
        raise InvalidValue(f"slope = {slope:g} rad: a tip with mu = {mu:g} does not slide up it")
    return mu * (load + adhesion * c) / steep, ((1.0 + mu * mu) * load * s * c + mu * mu * adhesion * s) / steep


def wedge(
    slope: float,
    half_width: tuple[float, float],
    offset: tuple[float, float],
    *,
    load: tuple[float, float],
    adhesion: tuple[float, float] = (0.0, 0.0),
) -> Wedge:
    """Force per lateral signal, and mu, from the loop on a known slope (Ogletree, Carpick, Salmeron 1996; with adhesion
    Varenberg 2003). Two mu fit; this is the smaller one, below sqrt(L cos(slope)/(L cos(slope) + A)).

    Parameters
    ----------
    slope : float
        Against the plane that the load is normal to, across the lever [rad].
    half_width, offset : (value, sigma)
        Of the loop there, in the unit of the signal; the offset less that on a flat, which is cross-talk and zero.
    load, adhesion : (value, sigma)
        Of the lever, and the pull-off force [N].
    """
    measured = np.array([half_width[0], offset[0], load[0], adhesion[0]])
    sigmas = np.array([half_width[1], offset[1], load[1], adhesion[1]])
    if not 0.0 < slope < 0.5 * math.pi:
        raise InvalidValue(f"slope = {slope:g} rad: valid is above 0 to below {0.5 * math.pi:.4g} rad")
    if not (np.all(measured[:3] > 0.0) and measured[3] >= 0.0 and np.all(sigmas >= 0.0)):
        raise InvalidValue(f"half-width, offset, load, adhesion = {measured}: above 0, adhesion and sigmas 0 or above")

    def solve(values: Floats) -> Floats:
        return np.array(_calibrated(slope, *values))

    factor, coefficient = solve(measured)
    spread = np.sqrt(np.sum((_slopes(solve, measured, sigmas) * sigmas) ** 2, axis=1))
    return Wedge(float(factor), float(spread[0]), float(coefficient), float(spread[1]))


def _slopes(solve: Callable[[Floats], Floats], at: Floats, sigmas: Floats) -> Floats:
    """Derivatives by what has a sigma, by differences."""
    out = np.zeros((2, len(at)))
    for i in np.flatnonzero(sigmas > 0.0):
        step = np.zeros_like(at)
        step[i] = min(1e-6 * at[i] if at[i] > 0.0 else sigmas[i], sigmas[i])
        low = at - step if at[i] > 0.0 else at
        out[:, i] = (solve(at + step) - solve(low)) / (at + step - low)[i]
    return out


def _calibrated(slope: float, width: float, offset: float, load: float, adhesion: float) -> tuple[float, float]:
    """offset/width = (s c L (1 + mu^2) + mu^2 A s)/(mu (L + A c)): the smaller root, with which the tip slides."""
    s, c = math.sin(slope), math.cos(slope)
    square, line, rest = s * (c * load + adhesion), offset / width * (load + adhesion * c), s * c * load
    inside = line * line - 4.0 * square * rest
    if not inside >= 0.0:
        least = 2.0 * math.sqrt(square * rest) / (load + adhesion * c)
        raise InvalidValue(f"offset over half-width = {offset / width:g}: valid on this slope is {least:.6g} and above")
    mu = 2.0 * rest / (line + math.sqrt(inside))
    return slope_forces(slope, mu, load, adhesion=adhesion)[0] / width, mu


def seen_as_load(
    friction: float, tip_height: float, length: float, *, measured: Literal["deflection", "angle"] = "angle"
) -> float:
    """What friction along a lever [N] reads as load [N]: 3 h/2 L of it in deflection, 2 h/L in angle (Euler's beam
    with the moment F h at its end)."""
    if not (length > 0.0 and 0.0 <= tip_height <= length):
        raise InvalidValue(f"tip height {tip_height:g} m of a lever of {length:g} m: valid is 0 to its length")
    if measured not in ("deflection", "angle"):
        raise InvalidValue(f"measured {measured!r}: valid are deflection, angle")
    return friction * (1.5 if measured == "deflection" else 2.0) * tip_height / length
