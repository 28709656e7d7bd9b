# SPDX-License-Identifier: BSD-3-Clause
"""How long the chain was that tore off: contour and persistence length of each rupture, by fit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from .._arrays import as_floats
from ..errors import InvalidValue
from .baseline import Floats
from .curve import ForceCurve
from .events import Branch, Rupture
from .flicker import correlated_noise
from .report import CurveReport
from .thermal import check_temperature

ChainModel = Literal["worm-like", "freely-jointed"]

BOLTZMANN = 1.380649e-23  # J/K
_BOUCHIAT = (-0.5164228, -2.737418, 16.07497, -38.87607, 39.49944, -14.17718)  # of u^2 .. u^7, Bouchiat et al. 1999
_STARTS = (0.2e-9, 0.5e-9, 2e-9, 10e-9, 50e-9)  # m, persistence or Kuhn length
_USUAL = {"worm-like": 0.4e-9, "freely-jointed": 0.8e-9}  # m, of unfolded proteins
_SURELY = 3.0  # standard deviations
_FEWEST = 12  # points
_FEW = 100  # points of a first fit
_HALVINGS = 36
_STEPS = 40  # of the fit
_SMALL = 1e-5  # relative change for a derivative
_SHORTEST, _LONGEST = 1e-11, 1e-6  # m, of persistence and Kuhn length
_MISFIT = 3.0  # residual over noise
_DETERMINED = 0.5  # sigma over value
_STIFF = 0.9  # contact slope over spring constant from where tip and sample part at a kink


@dataclass(frozen=True)
class Chain:
    """The chain that one rupture ended, fitted from the rupture before (or the contact) to it.

    Attributes
    ----------
    rupture : Rupture
        What tore off.
    contour_length, contour_length_sigma : float
        L_c [m] and its standard uncertainty, with those of contact point, baseline and noise; NaN where the curve does
        not determine it. The spring constant's and sensitivity's are apart.
    segment_length, segment_length_sigma : float
        Persistence length (worm-like) or Kuhn length (freely jointed) [m]; sigma 0 where it was held.
    misfit : float
        Residuals over noise, RMS; above 3 the chain is not believed.
    points : int
        How many were fitted.
    """

    rupture: Rupture
    contour_length: float
    contour_length_sigma: float
    segment_length: float
    segment_length_sigma: float
    misfit: float
    points: int


def worm_like(part: Floats) -> Floats:
    """F p/(k_B T) of a worm-like chain stretched to this part of its contour (Bouchiat et al. 1999), to 0.4 %."""
    u = as_floats(part, "part")
    more = np.zeros_like(u)
    for coefficient in reversed(_BOUCHIAT):
        more = more * u + coefficient
    return np.asarray(0.25 / (1.0 - u) ** 2 - 0.25 + u + more * u * u)


def freely_jointed(force: Floats) -> Floats:
    """Part of its contour to which F b/(k_B T) stretches a freely jointed chain: Langevin's function."""
    f = as_floats(force, "force")
    small = np.abs(f) < 1e-3
    safe = np.where(small, 1.0, f)
    return np.where(small, f / 3.0, 1.0 / np.tanh(safe) - 1.0 / safe)


def chains(
    curve: ForceCurve,
    report: CurveReport,
    model: ChainModel = "worm-like",
    *,
    segment_length: float | Literal["free"] | None = None,
    temperature: float = 298.15,
) -> tuple[Chain, ...]:
    """Contour length of what each rupture ended, by fitting a chain's law to the pull before it.

    Parameters
    ----------
    curve : ForceCurve
        With a spring constant.
    report : CurveReport
        Of :func:`analyse`.
    model : {"worm-like", "freely-jointed"}
        Marko and Siggia's chain in the form of Bouchiat et al.; or Kuhn's.
    segment_length : float or "free", optional
        Persistence or Kuhn length [m], held; 0.4 nm (worm-like) or 0.8 nm, of unfolded proteins, if not given. "free":
        fitted, which one pull seldom determines beside the contour length. DNA of two strands has some 50 nm.
    temperature : float
        [K], 77 .. 1000; room temperature is 298, not 25.

    Returns
    -------
    tuple of Chain
        One for each of ``report.ruptures``. The chain is taken to begin where the undeformed bodies touch: on a stiff
        sample where the lines of contact and free lever meet, else the contact point of the report. Lengths never fall
        within a pull, as what tore off cannot tear off again: one that surely does is NaN, and one that may not is as
        long as that before it.
    """
    laws = {"worm-like": _worm_like_force, "freely-jointed": _freely_jointed_force}
    if model not in laws:
        raise InvalidValue(f"model {model!r}: valid are {', '.join(laws)}")
    if segment_length is None:
        segment_length = _USUAL[model]
    held = None if segment_length == "free" else float(segment_length)
    if held is not None and not _SHORTEST <= held <= _LONGEST:
        raise InvalidValue(f"segment_length: {held:g} m, valid is {_SHORTEST:g} to {_LONGEST:g} m")
    check_temperature(temperature)
    stiffness, retract = curve.spring_constant, report.branches.get("retract")
    if stiffness is None:
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read, or --spring-constant")
    if retract is None:
        return ()
    contact = _contact(report, retract, stiffness)
    found, after = [], contact[0]
    for rupture in report.ruptures:
        pull = _Pull.of(retract, after, rupture, contact, BOLTZMANN * temperature, stiffness)
        found.append(_chain(rupture, pull, laws[model], held))
        after = rupture.z
    return _growing(found)


def _growing(found: list[Chain]) -> tuple[Chain, ...]:
    """With lengths that do not fall from one rupture to the next."""
    made: list[Chain] = []
    longest = longest_sigma = 0.0
    for chain in found:
        short = longest - chain.contour_length
        if short > _SURELY * np.hypot(longest_sigma, chain.contour_length_sigma):
            made.append(Chain(chain.rupture, np.nan, np.nan, np.nan, np.nan, chain.misfit, chain.points))
            continue
        if short > 0.0:
            sigma = float(np.hypot(chain.contour_length_sigma, short))
            kept = replace(chain, contour_length=longest, contour_length_sigma=sigma)
        else:
            kept = chain
        if kept.contour_length > longest:
            longest, longest_sigma = kept.contour_length, kept.contour_length_sigma
        made.append(kept)
    return tuple(made)


def _contact(report: CurveReport, retract: Branch, stiffness: float) -> tuple[float, float]:
    """z where the chain begins [m], and its standard uncertainty.

    On a stiff sample the methods that look for the first deviation from the baseline lie some 1 nm inside the contact,
    which is where their noise ends: the kink, where two lines meet, has no such bias.
    """
    methods = report.contact_points
    kink, foot = methods.get("two_lines", np.nan), methods.get("hertz", np.nan)
    if not (retract.contact_slope[0] > _STIFF * stiffness and np.isfinite([kink, foot]).all()):
        return report.contact_point, report.sigma["contact_point"]
    return kink, float(np.hypot(kink - foot, retract.noise / retract.contact_slope[0]))


Law = Callable[["_Pull", float, float], Floats]


@dataclass(frozen=True)
class _Pull:
    """Base's height over the contact and pull, positive, of the points of one chain."""

    height: Floats
    pull: Floats
    noise: float
    contact_sigma: float
    level_sigma: float
    energy: float
    stiffness: float

    @classmethod
    def of(
        cls,
        retract: Branch,
        after: float,
        rupture: Rupture,
        contact: tuple[float, float],
        energy: float,
        stiffness: float,
    ) -> _Pull:
        settled = after + 3.0 * float(np.median(np.diff(retract.z)))  # right after a tear the lever still swings
        inside = (retract.z > max(settled, contact[0])) & (retract.z <= rupture.z)
        free = retract.baseline.noise
        points = int(np.count_nonzero(inside))
        return cls(
            height=retract.z[inside] - contact[0],
            pull=-retract.force[inside],
            noise=max(retract.noise, correlated_noise(retract.noise, free, points)),
            contact_sigma=contact[1],
            level_sigma=retract.baseline.sigma(rupture.z),
            energy=energy,
            stiffness=stiffness,
        )

    def thinned(self) -> _Pull:
        """Some of the points, the last ones among them, to find a start by."""
        every = max(1, self.height.size // _FEW)
        values = dict(vars(self)) | {"height": self.height[::-1][::every], "pull": self.pull[::-1][::every]}
        return _Pull(**values)

    def moved(self, height: float, pull: float) -> _Pull:
        values = dict(vars(self)) | {"height": self.height + height, "pull": self.pull + pull}
        return _Pull(**values)


def _solve(height: Floats, reach: Callable[[Floats], Floats], top: float) -> Floats:
    """The argument in 0 .. top where a growing function reaches each height."""
    low, high = np.zeros(height.size), np.full(height.size, top)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        below = reach(middle) < height
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray(0.5 * (low + high))


def _worm_like_force(pull: _Pull, contour: float, persistence: float) -> Floats:
    scale = pull.energy / persistence
    part = _solve(pull.height, lambda u: contour * u + scale * worm_like(u) / pull.stiffness, 1.0 - 1e-9)
    return scale * worm_like(part)


def _freely_jointed_force(pull: _Pull, contour: float, kuhn: float) -> Floats:
    scale = pull.energy / kuhn
    top = float(pull.height.max(initial=0.0)) * pull.stiffness / scale + 1.0
    return scale * _solve(pull.height, lambda f: contour * freely_jointed(f) + scale * f / pull.stiffness, top)


def _chain(rupture: Rupture, pull: _Pull, law: Law, held: float | None) -> Chain:
    unknown = Chain(rupture, np.nan, np.nan, np.nan, np.nan, np.nan, pull.height.size)
    if pull.height.size < _FEWEST or rupture.force < 5.0 * pull.noise:
        return unknown
    starts = _STARTS if held is None else (held,)
    reach = float(pull.height[-1]) - rupture.force / pull.stiffness
    if reach <= 0.0:
        return unknown
    few = pull.thinned()
    first = min(
        (_fit(few, law, np.log([1.1 * reach, start]), held is None) for start in starts), key=lambda one: one[1]
    )
    value, square, covariance = _fit(pull, law, first[0], held is None)
    misfit = float(np.sqrt(square / pull.height.size))
    covariance = covariance * max(1.0, misfit**2)
    for height, level in ((pull.contact_sigma, 0.0), (0.0, pull.level_sigma)):
        if np.isfinite(height) and height + level > 0.0:
            other, *_ = _fit(few.moved(height, level), law, first[0], held is None)
            covariance = covariance + np.outer(other - first[0], other - first[0])
    spread = np.sqrt(np.diag(covariance))
    if misfit > _MISFIT or not spread[0] < _DETERMINED:
        return Chain(rupture, np.nan, np.nan, np.nan, np.nan, misfit, pull.height.size)
    contour, segment = np.exp(value)
    known = spread[1] < _DETERMINED
    return Chain(
        rupture,
        float(contour),
        float(contour * spread[0]),
        float(segment) if known else np.nan,
        float(segment * spread[1]) if known else np.nan,
        misfit,
        pull.height.size,
    )


def _fit(pull: _Pull, law: Law, value: Floats, free: bool) -> tuple[Floats, float, Floats]:
    """Levenberg and Marquardt over the logarithms of contour and segment: values, chi^2, covariance."""
    damping = 1e-2
    columns = 2 if free else 1
    left = (pull.pull - law(pull, *np.exp(value))) / pull.noise
    square = float(left @ left)
    normal = np.eye(columns)
    for _ in range(_STEPS):
        slopes = []
        for place in range(columns):
            other = value.copy()
            other[place] += _SMALL
            slopes.append((law(pull, *np.exp(other)) - law(pull, *np.exp(value))) / _SMALL / pull.noise)
        jacobian = np.stack(slopes, 1)
        normal = jacobian.T @ jacobian
        step = np.linalg.lstsq(normal + damping * np.diag(np.diag(normal) + 1e-30), jacobian.T @ left, rcond=None)[0]
        tried = value.copy()
        tried[:columns] += np.clip(step, -1.0, 1.0)
        tried[1] = np.clip(tried[1], np.log(_SHORTEST), np.log(_LONGEST))
        rest = (pull.pull - law(pull, *np.exp(tried))) / pull.noise
        if float(rest @ rest) < square:
            gain = square - float(rest @ rest)
            value, left, square, damping = tried, rest, float(rest @ rest), max(0.1 * damping, 1e-9)
            if gain < 1e-6 * max(square, 1.0):
                break
        else:
            damping *= 10.0
            if damping > 1e6:
                break
    covariance = np.zeros((2, 2))
    covariance[:columns, :columns] = np.linalg.pinv(normal, rcond=1e-12)
    return value, square, covariance
