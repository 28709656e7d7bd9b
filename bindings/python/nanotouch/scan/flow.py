# SPDX-License-Identifier: BSD-3-Clause
"""Tapping by its slow flow: amplitude and lag change little in one period, so that only what the force does over a
whole period counts. Hundreds of times as fast as the time domain, and less exact (docs/scan.md)."""

from __future__ import annotations

from typing import NamedTuple

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.scan.tapping import Drive, Lever
from nanotouch.scene import Rig
from nanotouch.scene.plan import Plan


class FlowState(NamedTuple):
    """Amplitude and lag of the tip's way q = q0 + Re(Z e^(i w t)); enough to go on from."""

    real: float
    """of Z [m]"""
    imaginary: float
    """of Z [m]"""
    mean: float = 0.0
    """q0 [m]"""
    attached: bool = False
    """a contact holds through the whole period"""


class FlowValue(NamedTuple):
    """What a period does."""

    amplitude: float
    """of the deflection [m]"""
    phase: float
    """its lag behind the drive [rad]; pi/2 free at resonance, less in repulsion, more in attraction"""
    mean: float
    """deflection [m]"""
    peak_force: float
    """the larger of those at the lowest and the highest point [N]"""
    lowest_gap: float
    """[m]"""
    virial: float
    """mean of force times way [J]"""
    tip_loss: float
    """taken by the contact in a period [J]"""


class SlowFlow(Lever):
    """A driven lever over a plan by averages over a period.

    Parameters
    ----------
    plan : Plan
        The force, over a flat or a surface.
    rig : Rig, optional
        Its probe is the lever; Q at least 10.
    drive : Drive, optional
        By default 20 nm at the base, at the free resonance.
    """

    def __init__(self, plan: Plan, rig: Rig | None = None, drive: Drive | None = None) -> None:
        super().__init__(plan, rig, drive)
        self._core = _core.Flow(self.rig.core, self.drive.core, plan.core)

    def free(self) -> FlowState:
        """The lever swinging with its free amplitude."""
        return FlowState(*self._core.free())

    def step(
        self, state: FlowState, base_height: float, time: float, at: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[FlowState, FlowValue]:
        """One step of a time [s], good up to some sqrt(Q) periods, with the base at a height over (x, y) [m].

        Returns
        -------
        state, value : FlowState, FlowValue
            Where the lever is then, and the period in the middle of the step.
        """
        if not time > 0.0:
            raise InvalidValue(f"time = {time:g} s: it must be above 0 s")
        after, value, _, _ = self._core.go_on(tuple(state), *at, base_height, time)
        return FlowState(*after), FlowValue(*value)

    def settle(
        self, base_height: float, state: FlowState | None = None, at: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[FlowState, FlowValue, bool]:
        """The steady motion from a state, without one from the free swing; and whether it settled within 60 Q
        periods."""
        begun = self.free() if state is None else state
        after, value, settled, _ = self._core.go_on(tuple(begun), *at, base_height, 0.0)
        return FlowState(*after), FlowValue(*value), settled
