# SPDX-License-Identifier: BSD-3-Clause
"""The loop over frequency: what the hand feels, and up to where it is given no energy (docs/margins.md)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core
from nanotouch._arrays import as_floats, check_between
from nanotouch.scene import Rig, Settings

Floats = NDArray[np.float64]


class Response(NamedTuple):
    """The loop over frequency, each shape (n,)."""

    frequency: Floats
    """[Hz]"""
    path: NDArray[np.complex128]
    """C: from x_m over stage and contact to the force at the motor, 1 at rest"""
    impedance: NDArray[np.complex128]
    """Z = f_m/x_m' as the hand feels it in contact, the low-pass of f_m included [N s/m]; passive where Re Z >= 0"""
    llewellyn: Floats
    """Llewellyn's number; the two-port is absolutely stable where it is 1 or more"""


def response(rig: Rig, settings: Settings, contact_stiffness: float, frequency: ArrayLike) -> Response:
    """The loop at frequencies [Hz] above 0, up to half the rate."""
    f = np.atleast_1d(as_floats(frequency, "frequency"))
    check_between("the lowest frequency", float(f.min()), "Hz", above=0.0, up_to=0.5 * settings.gains.rate)
    check_between("the highest frequency", float(f.max()), "Hz", above=0.0, up_to=0.5 * settings.gains.rate)
    rows = _core.loop_response(rig.core, settings.core, contact_stiffness, f)
    return Response(f, rows[:, 0] + 1j * rows[:, 1], rows[:, 2] + 1j * rows[:, 3], rows[:, 4])


def passive_up_to(rig: Rig, settings: Settings, contact_stiffness: float) -> float:
    """Where Re Z turns negative first, between samples that are 3 % apart [Hz]."""
    nyquist = 0.5 * settings.gains.rate
    frequency = np.geomspace(1e-4 * nyquist, nyquist, 300)
    real = response(rig, settings, contact_stiffness, frequency).impedance.real
    if not real.min() < 0.0:
        return float(nyquist)
    first = int(np.argmax(real < 0.0))
    if first == 0:
        return float(frequency[0])
    (low, high), (before, after) = frequency[first - 1 : first + 1], real[first - 1 : first + 1]
    return float(low + (high - low) * before / (before - after))
