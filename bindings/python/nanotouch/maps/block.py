# SPDX-License-Identifier: BSD-3-Clause
"""One block of curves fitted: what runs where the curves are, in this process or in a worker of a cluster."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._arrays import Floats
from ..errors import InvalidValue
from ..fit.models import extension, find
from ..fit.uncertainties import Uncertainties
from .over_time import Curves, fit_curves
from .settings import Settings
from .store import Columns
from .volume import Block, CurveVolume, Volume

#: besides the parameters: name -> (unit, what it is); those of MEASURED have a sigma too
MEASURED = {
    "pull_off_force": ("N", "depth of the retraction below its baseline, positive; 0 where no dip is visible"),
    "snap_in_force": ("N", "depth of the approach below its baseline, positive; 0 where no dip is visible"),
    "adhesion_work": ("J", "area of the retraction below its baseline"),
    "contact_slope": ("N/m", "-dF/dz over the upper half of the load"),
    "branch_offset": ("N", "by which the retraction ends below the approach: drag, or what still holds"),
}
PLAIN = {
    "pull_off_least": ("N", "lower end of the 95 % interval of the pull-off force"),
    "pull_off_most": ("N", "upper end of the 95 % interval of the pull-off force"),
    "ruptures": ("1", "how many tear off on the retraction"),
    "rating": ("1", "0 (reject) to 10, by the largest residuals beside the load"),
    "noise": ("N", "standard deviation of the force from point to point"),
    "baseline_tilt": ("N/m", "slope of the baseline over z"),
    "residual_rms": ("N", "root mean square of force minus fit"),
    "contact_radius": ("m", "radius of the fitted contact at the deepest point"),
    "contact_stiffness": ("N/m", "stiffness of the fitted contact at the deepest point"),
}
_GAUSSIAN = 1.959963984540054
_OF_THE_LAW = ("begins_in_contact", "other_power", "adhesive", "hysteresis")
_TELLS_NOTHING = 1e3  # a bound this many times the value
EXCLUDED = "EXCLUDED"  # status of a curve that a person left out
LOST = "LOST"  # status of a curve whose block killed the workers it was given to


def fit_block(stored: Mapping[str, Any], block: Block | Curves, threads: int = 1) -> Columns:
    """Fit every curve of a block.

    Parameters
    ----------
    stored : mapping
        :meth:`Settings.as_json`.
    threads : int
        0: one per processor.

    Returns
    -------
    dict of ndarray, shape (n,)
        ``status``, ``flags``, ``reason`` and, NaN where a curve has no result, each quantity with its ``_sigma``, for
        parameters also ``_sigma_statistical`` and ``_sigma_calibration`` [SI].
    """
    if isinstance(block, Curves):
        return fit_curves(stored, block, tuple(PLAIN), tuple(MEASURED))
    settings = Settings.from_json(stored)
    found = _batch(settings.recipe(), block, threads)
    columns: Columns = {"status": found["status"].astype(np.int8), "flags": found["flags"].astype(np.uint32)}
    columns["reason"] = np.array([found["reason"].get(i, "") for i in range(len(block))], dtype=np.str_)
    shifts = [
        (_batch(recipe, block, threads, factor)["value"] - found["value"]) / step
        for recipe, step, factor in settings.calibrations()
    ]
    for name, (place, _) in settings.parameters().items():
        sign = -1.0 if name == "contact_point" else 1.0  # the C library counts towards the sample
        columns[name] = sign * found["value"][:, place]
        columns |= _uncertainties(name, place, found, shifts, settings.uncertainties)
        if settings.asks(name):
            unknown = (found["status"] == 0) & (found["sigma"][:, place] != 0.0) & ~found["identifiable"][:, place]
            columns["flags"] |= np.where(unknown, undetermined_flag(place), 0).astype(np.uint32)
    if settings.poisson_ratio is not None:
        columns |= _sample_modulus(settings, columns)
    if find(settings.model).exponent == 1.5:
        columns["effective_modulus_least"] = _least_modulus(settings, columns, found, block)
    columns["effective_modulus_most"] = _most_modulus(columns)
    for name in MEASURED:
        columns[name], columns[f"{name}_sigma"] = found[name], found[f"{name}_sigma"]
    return columns | {name: found[name] for name in PLAIN}


def part_of(volume: Volume, stored: Mapping[str, Any], start: int, stop: int) -> Block | Curves:
    """What :func:`fit_block` takes of a volume: with its times where the model needs them."""
    if not Settings.from_json(stored).over_time:
        return volume.block(start, stop)
    if not isinstance(volume, CurveVolume):
        raise InvalidValue("an array has no times: a map of a viscoelastic sample takes a file or a list of curves")
    return Curves(tuple(volume.places.get(number) for number in range(start, stop)))


def _least_modulus(settings: Settings, columns: Columns, found: dict[str, Any], block: Block) -> Floats:
    """The 95 % lower bound of E* [Pa] where a stiff contact does not determine it; NaN elsewhere.

    The compliance of the contact is that of the slope less the cantilever's, which is as uncertain as the sensitivity.
    At one load k^3 goes as E*^2, so the bound follows from the fitted contact: E* (k_least/k)^(3/2).
    """
    known, flags = settings.uncertainties, extension().flags
    if known.sensitivity == 0.0:
        return np.full(len(block), np.nan)
    against = sum(flags[name] for name in ("calibration", "wrong_model", "misfit", *_OF_THE_LAW))
    unknown = (columns["flags"] & undetermined_flag(0) != 0) & (columns["flags"] & against == 0)
    slope, stiffness = found["contact_slope"], found["contact_stiffness"]
    with np.errstate(invalid="ignore", divide="ignore"):
        spread = np.hypot(known.sensitivity, found["contact_slope_sigma"] / slope)
        compliance = np.exp(_GAUSSIAN * spread) / slope - 1.0 / block.spring_constant
        least = columns["effective_modulus"] * (1.0 / (compliance * stiffness)) ** 1.5
        least *= np.exp(-_GAUSSIAN * np.hypot(known.spring_constant, 0.5 * known.radius))
        least = np.where(unknown & (slope > 0.0) & (compliance > 0.0), least, np.nan)
        imprecise = unknown & (columns["flags"] & flags["imprecise"] != 0)
        return np.where(
            imprecise, columns["effective_modulus"] / np.exp(np.where(imprecise, _factor(columns), 0.0)), least
        )


def _most_modulus(columns: Columns) -> Floats:
    """The 95 % upper bound of E* [Pa] where a soft contact does not determine it; NaN elsewhere.

    The upper end of its interval, symmetric in the logarithm; none where that is a thousand times the value.
    """
    flags = extension().flags
    names = ("calibration", "wrong_model", "misfit", "stiff", "not_converged", "wide", *_OF_THE_LAW)
    against = sum(flags[name] for name in names)
    unknown = (columns["flags"] & undetermined_flag(0) != 0) & (columns["flags"] & against == 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        factor = _factor(columns)
        tells = unknown & (factor < np.log(_TELLS_NOTHING))
        return np.where(tells, columns["effective_modulus"] * np.exp(np.where(tells, factor, 0.0)), np.nan)


def _factor(columns: Columns) -> Floats:
    """Logarithm of what the upper end of the 95 % interval of E* is over its value."""
    return np.asarray(_GAUSSIAN * columns["effective_modulus_sigma"] / columns["effective_modulus"])


def undetermined_flag(place: int) -> int:
    """The bit of a parameter that a curve does not determine, by its place in the C library."""
    return 1 << (8 + place)


def _batch(recipe: Any, block: Block, threads: int, factor: float = 1.0) -> dict[str, Any]:
    """All curves of a block, forces and spring constants multiplied by a factor."""
    z = block.z if block.z.size == block.force.size else np.tile(block.z, len(block))
    force, stiffness = block.force, block.spring_constant
    if factor != 1.0:
        force, stiffness = force * factor, stiffness * factor
    found: dict[str, Any] = extension().batch(recipe, z, force, block.edges, stiffness, threads)
    return found


def _uncertainties(
    name: str, place: int, found: dict[str, Any], shifts: list[Floats], known: Uncertainties
) -> dict[str, Floats]:
    """Statistical: with the sensitivity known exactly, C_ii - C_is^2/C_ss. Calibration: all the rest."""
    variance, with_sensitivity = found["sigma"][:, place] ** 2, found["with_sensitivity"]
    own = with_sensitivity[:, -1]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = np.where(np.isfinite(own) & (own > 0.0), with_sensitivity[:, place] ** 2 / own, 0.0)
        part = np.where(np.isnan(variance), np.nan, np.minimum(np.nan_to_num(part), variance))
        calibration = part + sum((shift[:, place] ** 2 for shift in shifts), np.zeros_like(part))
        if known.correlation and known.spring_constant > 0.0:  # whose shift is the first
            crossed = np.copysign(np.sqrt(part), with_sensitivity[:, place]) * shifts[0][:, place]
            calibration = np.maximum(calibration + 2.0 * known.correlation * np.nan_to_num(crossed), 0.0)
        statistical = np.where(np.isinf(variance), np.inf, variance - part)
        return {
            f"{name}_sigma": np.sqrt(statistical + calibration),
            f"{name}_sigma_statistical": np.sqrt(statistical),
            f"{name}_sigma_calibration": np.sqrt(calibration),
        }


def _sample_modulus(settings: Settings, columns: Columns) -> Columns:
    """E of the sample from 1/E* = (1 - nu^2)/E + (1 - nu_t^2)/E_t [Pa]; NaN where all of it is the tip's."""
    assert settings.poisson_ratio is not None
    tip = 0.0
    if settings.tip_modulus is not None:
        tip = (1.0 - settings.tip_poisson_ratio**2) / settings.tip_modulus
    modulus = columns["effective_modulus"]
    with np.errstate(invalid="ignore", divide="ignore"):
        compliance = np.where(1.0 / modulus > tip, 1.0 / modulus - tip, np.nan)
        value = (1.0 - settings.poisson_ratio**2) / compliance
        gain = value / (modulus**2 * compliance)
        by_ratio = 2.0 * settings.poisson_ratio / compliance * settings.uncertainties.poisson_ratio
        statistical = columns["effective_modulus_sigma_statistical"] * gain
        calibration = np.hypot(columns["effective_modulus_sigma_calibration"] * gain, by_ratio)
    return {
        "youngs_modulus": value,
        "youngs_modulus_sigma": np.hypot(statistical, calibration),
        "youngs_modulus_sigma_statistical": statistical,
        "youngs_modulus_sigma_calibration": calibration,
    }


def lost_block(stored: Mapping[str, Any], count: int, reason: str) -> Columns:
    """The columns of a block of which nothing came back."""
    empty = Block(np.empty(0), np.empty(0), np.zeros(2 * count + 1, np.int64), np.full(count, np.nan))
    columns = fit_block(stored, Curves((None,) * count) if Settings.from_json(stored).over_time else empty)
    columns["status"][:] = status_names()[LOST]
    columns["reason"] = np.full(count, reason)
    return columns


def status_names() -> dict[str, int]:
    """Every status of a curve and its number: those of the C library, LOST and EXCLUDED."""
    statuses: dict[str, int] = dict(extension().statuses)
    return statuses | {LOST: len(statuses), EXCLUDED: len(statuses) + 1}


def flag_names(model: str) -> dict[str, int]:
    """Every flag of a curve and its bit."""
    flags: dict[str, int] = dict(extension().flags)
    settings = Settings(model=model, fit_offset=True, thickness=1.0 if find(model).is_layer else None)
    places = settings.parameters().items()
    return flags | {f"{n}_undetermined": undetermined_flag(place) for n, (place, _) in places if settings.asks(n)}
