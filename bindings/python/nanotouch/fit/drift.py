# SPDX-License-Identifier: BSD-3-Clause
"""Drift of the force in a fit over time: a tilt over height is the same before and after contact, a drift is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .models import Floats, extension
from .ting import Found, Law, Track, solve

_MARGIN = 0.05  # of the depth, by which a point has to be out of contact
_FEWEST = 16
_STEP = 0.1  # standard uncertainties, for the shift with them
_TAKEN, _TOLD = 1.0, 3.0  # standard uncertainties from where it is taken off, and from where a note says so


def without_drift(law: Law, track: Track, found: Found) -> tuple[Track, Found]:
    """The track less a drift, and its fit, with what the drift is known to in its covariance.

    The same ones where the free parts before and after contact show none, or where the fit is no better without it.
    """
    rate, sigma = _drift(law, track, found)
    if not abs(rate) > _TAKEN * sigma:
        return track, found
    level = _less(track, rate)
    better = solve(extension(), law, level)
    if not better.rms(level) < found.rms(track):
        return track, found
    near = replace(law, start={name: better.values[name] for name in better.free})
    moved = solve(extension(), near, _less(track, rate + _STEP * sigma))
    shift = _shift(better, moved)
    level = replace(level, drift=rate if abs(rate) > _TOLD * sigma else 0.0)
    return level, better._replace(covariance=better.covariance + np.outer(shift, shift))


def _shift(found: Found, moved: Found) -> Floats:
    """Of the free parameters, by one standard uncertainty of the drift; of an exponent at its bound as if it had none,
    and of the others as far as they go with it."""
    shift = np.array([(moved.values[name] - found.values[name]) / _STEP for name in found.free])
    if "exponent" not in found.free or found.values["exponent"] > 0.0:
        return shift
    place = found.free.index("exponent")
    beyond = (moved.raw["free_exponent"] - found.raw["free_exponent"]) / _STEP
    return np.asarray(shift + beyond * found.covariance[place] / found.covariance[place, place])


def _less(track: Track, rate: float) -> Track:
    return replace(track, force=track.force - rate * (track.time - track.time[0]))


def _drift(law: Law, track: Track, found: Found) -> tuple[float, float]:
    """Of the free lever, beside its level, tilt and drag, and its standard uncertainty [N/s]; 0 where it is not free
    before and after contact."""
    depth = max(float(found.raw["indentation"]), 0.0)
    free, deepest = found.indentation < -_MARGIN * depth, int(np.argmax(found.indentation))
    free &= track.fitted
    if min(np.count_nonzero(free[:deepest]), np.count_nonzero(free[deepest:])) < _FEWEST:
        return 0.0, np.inf
    after = np.arange(track.time.size) > deepest
    columns = [track.position, after.astype(float), track.time]  # tilt, drag, drift
    design = np.stack([column[free] - column[free].mean() for column in columns], axis=1)
    scale = np.sqrt(np.sum(design**2, axis=0))
    inverse = np.linalg.pinv((design / scale).T @ (design / scale), rcond=1e-9)
    force = track.force[free] - track.force[free].mean()
    values = inverse @ ((design / scale).T @ force) / scale
    return float(values[-1]), float(law.noise * np.sqrt(inverse[-1, -1]) / scale[-1])
