# SPDX-License-Identifier: BSD-3-Clause
"""Steady tapping to a demanded accuracy, by the cheapest tier that keeps it: one harmonic, harmonic balance, the time
domain (docs/scan.md)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch._arrays import Floats
from nanotouch.errors import InvalidValue
from nanotouch.scan.tapping import Drive, Lever, TappingState
from nanotouch.scene import Rig
from nanotouch.scene.plan import Plan

TIERS = ("slow flow", "harmonic balance", "time domain")
_HEIGHT, _AMPLITUDE, _PHASE = range(3)


class SteadyMotion(NamedTuple):
    """A motion that repeats each period."""

    tier: str
    """which one it is by: of :data:`TIERS`"""
    harmonics: int
    """of the lever that count; 0: all, in the time domain"""
    base_height: float
    """of the lever's base at rest [m]"""
    amplitude: float
    """of the deflection [m]"""
    phase: float
    """its lag behind the drive [rad]; pi/2 free at resonance, less in repulsion, more in attraction"""
    mean: float
    """deflection [m]"""
    peak_force: float
    """largest force on the tip [N]"""
    lowest_gap: float
    """[m]"""
    contact_time: float
    """share of the period with a contact area"""
    tip_loss: float
    """taken by the contact in a period [J]"""
    amplitude_bound: float
    """by how much the amplitude may be wrong [m]; 0 in the time domain"""
    force_bound: float
    """by how much the peak force may be wrong [N]; 0 in the time domain"""
    state: TappingState
    """when a period of the drive begins: to go on from by :class:`Tapping`"""
    evaluations: int
    """of the force: the cost"""


class AmplitudeCurve(NamedTuple):
    """All motions of a lever over one place, with one harmonic: each stable branch, and the unstable parts between."""

    base_height: Floats
    """[m]"""
    amplitude: Floats
    """of the deflection [m]"""
    phase: Floats
    """[rad]"""
    peak_force: Floats
    """[N]"""
    stable: NDArray[np.bool_]
    """at this height the lever keeps this motion"""
    piece: NDArray[np.int64]
    """points of one number hang together, in their order"""


class Steady(Lever):
    """Motions of a driven lever that repeat each period.

    Parameters
    ----------
    plan : Plan
        The force, over a flat or a surface.
    rig : Rig, optional
        Its probe is the lever; Q at least 10.
    drive : Drive, optional
        By default 20 nm at the base, at the free resonance.
    accuracy : float, optional
        Of the amplitude over A0 and of the peak force over the larger of itself and the pull-off, 1e-6 .. 0.5.
    """

    def __init__(
        self, plan: Plan, rig: Rig | None = None, drive: Drive | None = None, *, accuracy: float = 0.01
    ) -> None:
        check_accuracy(accuracy)
        super().__init__(plan, rig, drive)
        self.accuracy = accuracy
        self._core = _core.Steady(self.rig.core, self.drive.core, accuracy, plan.core)

    def curve(self, at: tuple[float, float] = (0.0, 0.0)) -> AmplitudeCurve:
        """All motions over a place (x, y) [m], from the free swing down to the surface."""
        height, amplitude, phase, force, stable, piece = self._core.trace(*at)
        return AmplitudeCurve(height, amplitude, phase, force, stable > 0.0, piece.astype(np.int64))

    def at_height(
        self, base_height: float, lifted: bool = False, at: tuple[float, float] = (0.0, 0.0)
    ) -> SteadyMotion | None:
        """The motion at a height of the base [m] of a lever that comes down from far, or up from the surface; None
        where none repeats each period."""
        return self._found(_HEIGHT, base_height, lifted, at)

    def at_amplitude(
        self, amplitude: float, lifted: bool = False, at: tuple[float, float] = (0.0, 0.0)
    ) -> SteadyMotion | None:
        """The same where the deflection's amplitude first falls to this one [m]: what a z loop holds. None also where
        only a tip that never leaves the contact has that amplitude."""
        return self._found(_AMPLITUDE, amplitude, lifted, at)

    def at_phase(self, phase: float, lifted: bool = False, at: tuple[float, float] = (0.0, 0.0)) -> SteadyMotion | None:
        """The same where the lag first falls to this one [rad]."""
        return self._found(_PHASE, phase, lifted, at)

    def _found(self, aim: int, value: float, lifted: bool, at: tuple[float, float]) -> SteadyMotion | None:
        found = self._core.find(at, (aim, value), lifted)
        if found is None:
            return None
        *values, state, evaluations = found[1:]
        return SteadyMotion._make((TIERS[found[0]], *values, TappingState(*state), evaluations))


def check_accuracy(accuracy: float) -> None:
    """Raise unless it is one that can be demanded."""
    if not 1e-6 <= accuracy <= 0.5:
        raise InvalidValue(f"accuracy = {accuracy:g}: valid is 1e-6 .. 0.5")
