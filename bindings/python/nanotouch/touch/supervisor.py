# SPDX-License-Identifier: BSD-3-Clause
"""The supervisor on plain numbers, and the guarantee that it gives."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings
from nanotouch.touch._motor_bound import MotorBound
from nanotouch.touch._stopped import REASONS as REASONS
from nanotouch.touch._stopped import reasons_of
from nanotouch.touch.columns import STATES

FLAGS = {
    "emergency_stop": 1,
    "limit_switch": 2,
    "invalid": 4,
    "saturated": 8,
    "device_lost": 16,
    "master_alone": 32,
    "slave_alone": 64,
}


class Verdict(NamedTuple):
    """What the supervisor decides in one tick."""

    state: str
    """RUN, HOLD, RETRACT or LATCHED"""
    reasons: tuple[str, ...]


class Guarantee(NamedTuple):
    """What holds whatever the operator does (docs/safety.md): limits, and how far they may be overshot."""

    reaction_time: float
    """from the sample that shows it until the stage turns [s]"""
    speed: float
    """at which tip and surface come closer, at most [m/s]"""
    calibration: float
    """of the limit, if spring constant and sensitivity are off by 3 sigma [N]"""
    motion: float
    """stage and surface come closer meanwhile, times stiffness [N]"""
    ringing: float
    """the stage's resonance, excited by its own commands [N]"""
    snap_in: float
    """what is left of the swing of a jump when the force is there [N]"""
    arrival: float
    """a snap-in alone presses with this, limit or not [N]"""
    noise: float
    """of the reading [N]"""
    tare: float
    """the sample's force at the start, which the tare takes off [N]"""
    force: float
    """limit and all of these: never more than this on the sample, either sign [N]"""
    zero_drift: float
    """and this more for each second since the tare [N/s]"""
    failures: dict[str, float]
    """what each adds if it is the one thing that fails; infinite where nothing would show it [N]"""
    with_failure: float
    """force and the largest of them, where the tip stands sideways [N]"""
    indentation: float
    """never more than this past first touch, where the tip stands sideways [m]"""
    lateral_force: float
    """never more than this on the sample in x and y [N]"""
    moves_sideways: bool
    """no: the stage has one axis, and all this holds at the place where the session starts"""
    help_time: float
    """a stop lifts from the drift of the frame for this long [s]"""
    frame_drift: float
    """a stop that cannot lift is pressed by this much more in a second [N/s]"""
    hand: MotorBound
    """what is promised to the hand"""

    @property
    def limit(self) -> float:
        """The force limit in it [N]."""
        return self.force - (self.calibration + self.motion + self.ringing + self.snap_in + self.noise + self.tare)

    @property
    def warning(self) -> str | None:
        """What of it makes little sense for the sample, or None."""
        if self.arrival <= self.limit:
            return None
        return (
            f"the tip may snap in with {self.arrival * 1e9:.3g} nN where the limit is {self.limit * 1e9:.3g} nN: that "
            "limit does not protect the sample; take a stiffer or better damped lever, less attraction, or approach "
            "more slowly"
        )

    def __str__(self) -> str:
        terms = self.force - self.limit
        bounded = {name: most for name, most in self.failures.items() if math.isfinite(most)}
        unseen = [name for name in self.failures if name not in bounded]
        worst = max(bounded, key=lambda name: bounded[name])
        failing = (
            f"at most {(self.force + bounded[worst]) * 1e9:.4g} nN if one thing fails while the tip stands sideways "
            f"({worst})"
        )
        next_worst = max(most for name, most in bounded.items() if name != worst)
        if bounded[worst] > 3.0 * next_worst:
            failing += f", {(self.force + next_worst) * 1e9:.4g} nN if anything else does"
        if unseen:
            failing += f", but without bound for {' or '.join(unseen)}: nothing would show it"
        tare = f", tare {self.tare * 1e9:.3g}" if self.tare > 1e-3 * self.force else ""
        lines = [
            f"force on the sample at most {self.force * 1e9:.4g} nN: the limit of {self.limit * 1e9:.4g} nN and "
            f"{terms * 1e9:.4g} nN before a stop shows",
            f"these are calibration {self.calibration * 1e9:.3g}, motion {self.motion * 1e9:.3g}, ringing "
            f"{self.ringing * 1e9:.3g}, snap-in {self.snap_in * 1e9:.3g}, noise {self.noise * 1e9:.3g}{tare} nN; and "
            f"{self.zero_drift * 1e9:.3g} nN more for each second since the tare",
            str(self.hand),
            f"indentation at most {self.indentation * 1e9:.4g} nm; reaction within {self.reaction_time * 1e3:.2f} ms",
            failing,
            f"after a stop help is needed within {_long(self.help_time)}; at once if the stage does not lift "
            f"({self.frame_drift * 1e9:.3g} nN more each second)",
        ]
        if self.lateral_force > 0.0 and (self.moves_sideways or self.lateral_force > 1e-3 * self.force):
            lines.insert(3, f"sideways at most {self.lateral_force * 1e9:.4g} nN")
        if not self.moves_sideways:
            lines.append("the tip stays at its place, for the stage has one axis")
        if self.warning is not None:
            lines.append(f"WARNING: {self.warning}")
        return "\n".join(lines)


def _long(seconds: float) -> str:
    if not math.isfinite(seconds):
        return "any time"
    return f"{seconds / 3600.0:.3g} h" if seconds > 3600.0 else f"{seconds:.3g} s"


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
        return Verdict(STATES[state], reasons_of(reasons))

    def arm(self, confirmed: bool = False) -> None:
        """Go back to RUN after RETRACT. After LATCHED this needs ``confirmed``: somebody has looked at the rig."""
        self._core.arm(confirmed)
