# SPDX-License-Identifier: BSD-3-Clause
"""Tapping mode at one place: a driven lever over a surface, and what its lock-in amplifier shows (docs/scan.md)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig
from nanotouch.scene.plan import Plan

if TYPE_CHECKING:
    from nanotouch._fields import DriveFields
else:
    from nanotouch.scene.description import Description

    DriveFields = Description

#: Of a step's error over the free amplitude: keeps energy and virial to 1e-6.
TOLERANCE = 1e-9


class Drive(DriveFields, core_type=_core.Drive):
    """How a lever is driven: at its tip or its base, at which frequency, to which free amplitude. In a file it is the
    table ``[drive]``."""


class TappingState(NamedTuple):
    """Where a lever is when a period of the drive begins; enough to go on from."""

    position: float
    """way of the tip along its own direction [m]"""
    speed: float
    """over the resonance's angular frequency [m]"""
    step: float = 0.0
    """of the integration, a guess for the next one [rad]; 0: none"""
    attached: bool = False
    """in contact, or held by a meniscus"""
    dissipated: float = 0.0
    """energy lost in jumps so far [J]"""
    port: float = 0.0
    """energy put in by slow changes so far [J]"""


class TappingValue(NamedTuple):
    """What happened in whole periods of the drive: works and losses per period, means over the time."""

    amplitude: float
    """of the deflection at the drive's frequency [m]"""
    phase: float
    """its lag behind the drive [rad]; pi/2 free at resonance, less in repulsion, more in attraction"""
    mean: float
    """deflection [m]"""
    peak_force: float
    """largest force on the tip [N]"""
    pull: float
    """largest attraction, positive [N]"""
    lowest_gap: float
    """[m]"""
    contact_time: float
    """share of the period with a contact area"""
    drive_work: float
    """done by the drive [J]"""
    medium_loss: float
    """taken by the medium, all harmonics [J]"""
    tip_loss: float
    """taken by the contact: minus the closed integral of force over way [J]"""
    jump_loss: float
    """of that, what the law says that its jumps took [J]"""
    mean_force: float
    """[N]"""
    virial: float
    """mean of force times way [J]"""
    energy_error: float
    """what the energies do not add up to, over what the drive put in"""
    virial_error: float
    """the same of the virial theorem, over k_c A0^2"""
    change: float
    """of the state from the first to the last end of a period, over the free amplitude"""
    steps: int
    """of the integration"""
    evaluations: int
    """of the force"""


class Settled(NamedTuple):
    """A steady motion."""

    value: TappingValue
    """of one of its periods"""
    state: TappingState
    """where it begins"""
    settled: bool
    """False: it does not repeat each period; the value is then of its last one"""
    periods: int
    """that it took"""


class Lever:
    """What taps, as it was given: later changes of a rig or a drive do not count."""

    def __init__(self, plan: Plan, rig: Rig | None, drive: Drive | None) -> None:
        self.plan = plan
        self.rig = Rig() if rig is None else rig.copy()
        self.drive = Drive() if drive is None else drive.copy()


class Tapping(Lever):
    """A driven lever over a plan, in the time domain: one mode of the lever, all harmonics of the force.

    Parameters
    ----------
    plan : Plan
        The force, over a flat or a surface.
    rig : Rig, optional
        Its probe is the lever; Q at least 10, for below that the second eigenmode takes part in every tap.
    drive : Drive, optional
        By default 20 nm at the base, at the free resonance.
    tolerance : float, optional
        Largest error of a step over the free amplitude, 1e-13 .. 1e-3.
    """

    def __init__(
        self, plan: Plan, rig: Rig | None = None, drive: Drive | None = None, *, tolerance: float = TOLERANCE
    ) -> None:
        super().__init__(plan, rig, drive)
        self._core = _core.Tapping(self.rig.core, self.drive.core, tolerance, plan.core)

    @property
    def frequency(self) -> float:
        """Of the drive [Hz]."""
        return float(self._core.frequency)

    @property
    def strength(self) -> float:
        """D: the drive's force over k_c; of a driven base its amplitude [m]."""
        return float(self._core.strength)

    def free(self) -> TappingState:
        """The lever swinging with its free amplitude."""
        return TappingState(*self._core.free())

    def run(
        self, state: TappingState, base_height: float, periods: int = 1, at: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[TappingState, TappingValue]:
        """Whole periods of the drive with the base at a height over a place (x, y) [m].

        Returns
        -------
        state, value : TappingState, TappingValue
            Where the lever is then, and what happened.
        """
        if periods < 1:
            raise InvalidValue(f"periods = {periods}: at least 1")
        after, value, _, _ = self._core.run(tuple(state), *at, base_height, periods)
        return TappingState(*after), TappingValue(*value)

    def settle(
        self, base_height: float, state: TappingState | None = None, at: tuple[float, float] = (0.0, 0.0)
    ) -> Settled:
        """The steady motion that the lever comes to from a state; without one, from its free swing.

        Where an attractive and a repulsive motion coexist the state decides which; :meth:`sweep` finds both.
        """
        begun = self.free() if state is None else state
        after, value, settled, periods = self._core.run(tuple(begun), *at, base_height, 0)
        return Settled(TappingValue(*value), TappingState(*after), settled, periods)

    def sweep(self, base_heights: Iterable[float], at: tuple[float, float] = (0.0, 0.0)) -> list[Settled]:
        """The steady motions at these heights [m] in their order, each from the one before, the first from the free
        swing: an amplitude curve. Down and up again it shows both branches where two coexist."""
        found: list[Settled] = []
        for height in base_heights:
            found.append(self.settle(height, found[-1].state if found else None, at))
        return found
