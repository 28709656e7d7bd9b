# SPDX-License-Identifier: BSD-3-Clause
"""The supervisor on plain numbers, and the guarantee that it gives."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from nanotouch import _core
from nanotouch.columns import STATES
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings

#: names of the bits of ``reasons``
REASONS: tuple[str, ...] = _core.reasons
FLAGS = {"emergency_stop": 1, "limit_switch": 2, "invalid": 4, "saturated": 8, "device_lost": 16}


class Verdict(NamedTuple):
    """What the supervisor decides in one tick."""

    state: str
    """RUN, HOLD, RETRACT or LATCHED"""
    reasons: tuple[str, ...]


class Guarantee(NamedTuple):
    """What holds whatever the operator does (docs/safety.md): limits, and how far they may be overshot."""

    reaction_time: float
    """from the sample that shows it until the stage turns [s]"""
    motion: float
    """stage and surface come closer meanwhile, times stiffness [N]"""
    ringing: float
    """the stage's resonance, excited by its own commands [N]"""
    snap_in: float
    """the tip arrives with the energy of the attraction [N]"""
    noise: float
    """of the reading [N]"""
    force: float
    """limit and all of these: never more than this on the sample, either sign [N]"""
    with_faults: float
    """the same whatever fails at once, a stage that turns its sign while nothing is read of it among it [N]"""
    indentation: float
    """never more than this past first touch, where the tip stands sideways [m]"""
    moves_sideways: bool
    """no: the stage has one axis, and all this holds at the place where the session starts"""

    def __str__(self) -> str:
        terms = self.motion + self.ringing + self.snap_in + self.noise
        return (
            f"force on the sample at most {self.force * 1e9:.0f} nN, which is the limit of "
            f"{(self.force - terms) * 1e9:.0f} nN and {terms * 1e9:.0f} nN before a stop shows (motion "
            f"{self.motion * 1e9:.0f}, ringing {self.ringing * 1e9:.0f}, snap-in {self.snap_in * 1e9:.0f}, noise "
            f"{self.noise * 1e9:.0f}); indentation at most {self.indentation * 1e9:.0f} nm; reaction within "
            f"{self.reaction_time * 1e3:.2f} ms; at most {self.with_faults * 1e9:.0f} nN whatever "
            "fails at once, a stage that turns its sign unseen among it"
            + ("" if self.moves_sideways else "; the tip stays at its place, for the stage has one axis")
        )


class Supervisor:
    """RUN, HOLD, RETRACT, LATCHED, from what was measured in a tick; call it once per control period.

    >>> supervise = Supervisor()          # doctest: +SKIP
    >>> supervise(deflection=1.0)         # doctest: +SKIP
    Verdict(state='RETRACT', reasons=('deflection saturated', 'force limit', ...))
    """

    def __init__(self, rig: Rig | None = None, settings: Settings | None = None) -> None:
        rig = Rig() if rig is None else rig
        settings = Settings.for_rig(rig) if settings is None else settings
        self._core = _core.Supervisor(rig.core, settings.core)

    def __call__(
        self,
        *,
        deflection: float = 0.0,
        stage_position: float = 0.0,
        master_position: float = 0.0,
        operator_force: float = 0.0,
        age: float = 0.0,
        lateness: float = 0.0,
        flags: tuple[str, ...] = (),
        reference: float = math.nan,
        moves_sideways: bool = False,
        unstable: bool = False,
    ) -> Verdict:
        """Judge one sample.

        Parameters
        ----------
        deflection, stage_position, master_position : float
            zeta, x_s and x_m [m].
        operator_force : float
            f_m [N].
        age, lateness : float
            Of the sample, and of this tick against its deadline [s].
        flags : tuple of str
            Any of ``FLAGS``.
        reference : float
            Where the stage was told to be [m]; by default where it is.
        moves_sideways : bool
            The surface may rise and fall under the tip: indentation is not counted.
        unstable : bool
            The passivity observer has nothing left.
        """
        unknown = [flags] if isinstance(flags, str) else [name for name in flags if name not in FLAGS]
        if unknown:
            raise InvalidValue(f"flags: {unknown[0]!r}: valid is a tuple of {', '.join(FLAGS)}")
        numbers: dict[str, Any] = {
            "deflection": deflection, "stage_position": stage_position, "master_position": master_position,
            "operator_force": operator_force, "age": age, "lateness": lateness,
        }  # fmt: skip
        numbers = {name: float(value) for name, value in numbers.items()}
        numbers["flags"] = sum({FLAGS[name] for name in flags})
        if math.isnan(reference):
            reference = stage_position
        state, reasons = self._core.step(numbers, reference, moves_sideways, unstable)
        return Verdict(STATES[state], tuple(name for bit, name in enumerate(REASONS) if reasons >> bit & 1))

    def arm(self, confirmed: bool = False) -> None:
        """Back to RUN after RETRACT; after LATCHED only with ``confirmed``."""
        self._core.arm(confirmed)
