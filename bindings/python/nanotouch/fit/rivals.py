# SPDX-License-Identifier: BSD-3-Clause
"""What a curve says against the model over time that was fitted to it: another kernel or tip describes it better, the
force rises with another power of the indentation, or the approach alone asks for other values (adhesion, a pause that
was not recorded, drift)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nanotouch.errors import Error

from .models import extension
from .over_time import OVER_TIME
from .ting import Found, Law, Track, solve

_WIDENED = 2.0  # sigma over that of white noise, from where others are tried
_STRUCTURED = 1.5  # the same, from where the power is looked at
_POWER, _POWER_SIGMAS = 0.15, 3.0  # least difference from the law's power that counts, and in standard uncertainties
_SMALL = 5e-4  # of the load: residuals that change nothing
_BETTER = 0.25  # of the squared residual beyond the noise
_SIGMAS = 2.5
_APART = {"exponent": 0.01}  # least difference that counts
_RELATIVE = 0.2  # the same of other parameters
_KERNELS = {"ting_power": "ting_sls", "ting_sls": "ting_power"}  # with more arms a curve is always described better
_TIPS = {"paraboloid": "_cone", "sphere": "_cone", "cone": "", "punch": ""}


def doubt_of(law: Law, track: Track, found: Found) -> str:
    """In words; empty where the residuals are noise, or where nothing else describes the curve better."""
    beyond = _beyond(law, track, found)
    least = max(_margin(law, track), (_SMALL * float(found.raw["peak"])) ** 2)
    track, each = track.thinned()
    law = replace(law, noise=law.noise / each**0.5)
    if widened(found) < _WIDENED or not beyond > least:
        return _doubt_of_power(law, track) if widened(found) > _STRUCTURED else ""
    for name in _rivals(law):
        other = _fitted(replace(law, model=OVER_TIME[name]), track)
        if other is not None and _beyond(law, track, other) < _BETTER * beyond + _margin(law, track):
            return f"{name} describes the curve better"
    return _doubt_of_approach(law, track, found, beyond) or _doubt_of_power(law, track)


def widened(found: Found) -> float:
    """Sigma over that of white noise."""
    raw = found.raw
    return float(np.sqrt(max(raw["chi_square"] / max(raw["bins"], 1), 1.0) * raw["correlation"]))


def _rivals(law: Law) -> list[str]:
    """Models with as many parameters: another kernel, another tip."""
    kernel, ending = law.model.kernel, law.model.name.removeprefix(law.model.kernel)
    own = {parameter.name for parameter in law.model.parameters}
    names = [_KERNELS[kernel] + ending] if kernel in _KERNELS and not own & law.held.keys() else []
    return [*names, kernel + _TIPS[law.model.tip]] if law.thickness == 0.0 else names


def _fitted(law: Law, track: Track) -> Found | None:
    try:
        found = solve(extension(), law, track)
    except Error:
        return None
    return found if found.raw["converged"] else None


def _beyond(law: Law, track: Track, found: Found) -> float:
    """Mean squared residual beyond the noise [N^2]."""
    return found.rms(track) ** 2 - law.noise**2


def _margin(law: Law, track: Track) -> float:
    """Of the same, what chance makes [N^2]."""
    return float(3.0 * np.sqrt(2.0 / np.count_nonzero(track.fitted)) * law.noise**2)


def _doubt_of_power(law: Law, track: Track) -> str:
    """A mixture of this tip's curve and that of another power, each fitted: its share tells the power. Of a layer,
    whose force has none, nothing is said."""
    if law.thickness > 0.0:
        return ""
    rival = OVER_TIME[law.model.kernel + _TIPS[law.model.tip]]
    try:  # at an end of the exponent's range a fit may stop early
        own, other = (solve(extension(), replace(law, model=model), track) for model in (law.model, rival))
    except Error:
        return ""
    towards = (other.fitted - own.fitted)[track.fitted]
    square, difference = float(towards @ towards), rival.exponent - law.model.exponent
    if not square > 0.0:
        return ""
    apart = difference * float((track.force - own.fitted)[track.fitted] @ towards) / square
    sigma = abs(difference) * law.noise / square**0.5
    if not abs(apart) > max(_POWER, _POWER_SIGMAS * sigma):
        return ""
    power, cause = law.model.exponent + apart, "another tip, a layer on stiff ground, a soft film, or a bent baseline"
    if 0.5 < power < 3.0:
        cause = f"but {power:.2g}: {cause}"
    return f"the power of the indentation with which the force rises is not {law.model.exponent:g} ({cause})"


def _doubt_of_approach(law: Law, track: Track, found: Found, beyond: float) -> str:
    if len(track.starts) < 2 or not track.fitted[track.starts[-1] :].any():
        return ""
    alone = replace(track, fitted=track.fitted & (np.arange(track.time.size) < track.starts[-1]))
    other = _fitted(law, alone)
    if other is None or _beyond(law, alone, other) > _BETTER * beyond + _margin(law, alone):
        return ""
    sigma = [dict(zip(one.free, np.sqrt(np.diag(one.covariance).clip(0.0)), strict=True)) for one in (found, other)]
    for parameter in law.model.parameters:
        name = parameter.name
        if name in law.held or name not in sigma[1] or (law.model.kernel == "ting_power" and name not in _APART):
            continue  # E at 1 s goes with the exponent
        apart = abs(other.values[name] - found.values[name])
        least = max(
            _APART.get(name, _RELATIVE * found.values[name]), _SIGMAS * np.hypot(sigma[0][name], sigma[1][name])
        )
        if apart > least:
            said = f"without the retraction {name} is {other.values[name]:.3g}, not {found.values[name]:.3g}"
            return f"{said} (adhesion, a pause that is not recorded, or another law)"
    return ""
