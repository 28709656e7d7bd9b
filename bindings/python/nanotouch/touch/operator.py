# SPDX-License-Identifier: BSD-3-Clause
"""The simulated operator: what hand and tip do, one step after another."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol, SupportsFloat

import numpy as np

from nanotouch import _core
from nanotouch._arrays import Floats
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings
from nanotouch.scene.plan import Plan
from nanotouch.touch._path import Mode

APPROACH_FORCE = 0.2  # [N]
PRESS_FORCE = 2.0  # [N]
SCAN_FORCE = 0.4  # [N]
RETRACT_FORCE = 0.3  # [N]
LIMIT_SHARE = 0.6  # of the force limit, at the hand
SCAN_TIMES = (10.0, 60.0)  # shortest and longest default scan [s]
LED_TIME, LED_SETTLE = 30.0, 3.0  # a hand on a device has; before and after the path [s]


#: What holds the master beside the force of the script, for ``Rig(hand=...)``: a finger pad whose rest position follows
#: the master within 0.3 s, and a finger that moves with it. Both are what rules R2 and R3 are about (docs/control.md).
FINGER_PAD: dict[str, float] = {"damping": 2.0, "stiffness": 1000.0, "relaxation": 0.3}
RIGID_FINGER: dict[str, float] = {"mass": 0.02}


def adversary(force: float = 5.0, rate: float = 30.0) -> dict[str, float]:
    """A hand for ``Rig(hand=...)`` that adds any force within +- ``force`` [N], changing ``rate`` times per second."""
    return {"random_force": force, "random_rate": rate}


class Input(NamedTuple):
    """Hand and tip go there on a straight line, then stay.

    ``operator_force`` f_m [N], + towards the sample; ``x``, ``y`` [m]; ``duration`` [s].
    """

    operator_force: float
    x: float
    y: float
    duration: float


class Hold(NamedTuple):
    """The hand holds the master where it will, as a mouse does, and the tip goes there: on a straight line, then both
    stay.

    ``master_position`` x_m [m], + towards the sample, or three of them (x, y, x_m) for a master of three axes; ``x``,
    ``y`` [m], NaN where the tip follows the master; ``duration`` [s].
    """

    master_position: float | tuple[float, float, float]
    x: float
    y: float
    duration: float


def core_input(input: Input | Hold) -> _core.Input:
    """As the C library takes it."""
    x, y, duration = _number("x", input.x), _number("y", input.y), _number("duration", input.duration)
    if isinstance(input, Hold):
        return _core.Input(0.0, _along(input.master_position, "master_position"), x, y, duration)
    return _core.Input(_along(input.operator_force, "operator_force"), None, x, y, duration)


def _number(name: str, value: object) -> float:
    if type(value) is float:  # at once: the protocol below costs microseconds, and this is asked in every period
        return value
    if isinstance(value, bool | str) or not isinstance(value, SupportsFloat):
        raise InvalidValue(f"input.{name} = {told(value)}: it must be a number")
    return float(value)


def _along(value: object, name: str) -> float | tuple[float, float, float]:
    """A number along z, or three of them."""
    if type(value) is float:
        return value
    if not isinstance(value, Sequence | np.ndarray) or isinstance(value, str):
        return _number(name, value)
    if len(value) != 3:
        raise InvalidValue(f"input.{name} = {told(value)}: it must be a number, or three of them (x, y, z)")
    x, y, z = (_number(name, one) for one in value)
    return x, y, z


class Touch(Protocol):
    """The part of a session that a script of the hand needs: path, rig, scales and plan."""

    rig: Rig
    clearance: float
    """of the tip above the surface at the start [m]"""

    @property
    def mode(self) -> Mode:
        """That it is in."""

    @property
    def settings(self) -> Settings:
        """That hold."""

    @property
    def path(self) -> Sequence[tuple[float, float]]:
        """Where the tip goes [m]."""

    @property
    def plan(self) -> Plan:
        """What is computed."""

    @property
    def is_led(self) -> bool:
        """Whether a device is the master, so that nothing can push the hand."""

    def path_heights(self) -> tuple[Floats, Floats]:
        """Distance along the path and height of the surface there [m]."""


def stretched(script: Sequence[Input | Hold], duration: float | None) -> Sequence[Input | Hold]:
    """The script over another time [s]."""
    if duration is None:
        return script
    total = sum(step.duration for step in script)
    if not (0.0 < duration < math.inf and total > 0.0):
        raise InvalidValue(f"duration = {duration} s: it must be above 0 s, and so must the script's own, {total:g} s")
    return [step._replace(duration=step.duration * duration / total) for step in script]


def script_for(session: Touch) -> list[Input]:
    """Approach, press and retract at a point; or approach, follow the path, retract; or follow it at constant force.
    Where a device is the master its hand does all that, and the script leads the tip along the path at the most."""
    if session.is_led and session.mode not in ("topography", "approach", "curve"):
        return _led(session)
    if session.mode == "topography":
        return _follow(session)
    if session.mode == "scan":
        return _scan(session)
    if session.mode in ("approach", "curve"):
        return _descend(session)
    return _press(session)


def _led(session: Touch) -> list[Input]:
    """No hand force: stay at the point, or where a device of one axis leads the height, follow the path meanwhile."""
    x, y = session.path[0]
    if session.mode != "scan" or session.rig.master.axes != 1.0:
        return [Input(0.0, x, y, LED_TIME)]
    along = _along_path(session, 0.0, _slave_speed(session, 0.5 * SCAN_FORCE))
    return [Input(0.0, x, y, LED_SETTLE), *along, Input(0.0, *session.path[-1], LED_SETTLE)]


def _slave_speed(session: Touch, force: float) -> float:
    """Speed of the stage [m/s] when the hand pushes with a force [N] in free air: alpha_p (1 + K_f) f_m/b_m."""
    gains = session.settings.gains
    return float(gains.alpha_p * (1.0 + gains.force_gain) * force / session.rig.master.damping)


def _contact_force(session: Touch, wanted: float) -> float:
    """No more than a share of what the force limit lets through to the hand."""
    return min(wanted, float(LIMIT_SHARE * session.settings.gains.alpha_f * session.settings.limits.force))


def _approach(session: Touch) -> list[Input]:
    x, y = session.path[0]
    force = _contact_force(session, APPROACH_FORCE)
    travel_time = 1.3 * session.clearance / _slave_speed(session, force)
    return [Input(force, x, y, 0.5), Input(force, x, y, travel_time + 0.5)]


def _depth(session: Touch, force: float) -> float:
    """Travel of the stage past first touch to press with a hand force [N]: indentation and deflection [m]."""
    load = force / float(session.settings.gains.alpha_f)
    indentation = np.geomspace(1e-11, 1e-5, 1000)
    reached = np.interp(load, session.plan.force(-indentation, "retract"), indentation)
    return float(reached + load / session.rig.probe.spring_constant)


def _retract(session: Touch, pressed: float) -> list[Input]:
    """Back from where a hand force [N] has pressed, by pulling with more than the adhesion at the operator's scale, but
    not with more than the gauge can read."""
    x, y = session.path[-1]
    adhesion = session.settings.gains.alpha_f * session.plan.pull_off_force
    force = -min(max(RETRACT_FORCE, 2.0 * adhesion), 0.9 * session.rig.master.gauge_range)
    stretch = session.plan.pull_off_force / session.rig.probe.spring_constant
    travel_time = (_depth(session, pressed) + stretch + session.clearance) / _slave_speed(session, -force)
    return [Input(force, x, y, 3.0), Input(force, x, y, travel_time), Input(0.0, x, y, 0.2), Input(0.0, x, y, 0.3)]


def _press(session: Touch) -> list[Input]:
    x, y = session.path[0]
    force = _contact_force(session, PRESS_FORCE)
    return [*_approach(session), Input(force, x, y, 1.5), Input(force, x, y, 1.5), *_retract(session, force)]


def _along_path(session: Touch, force: float, slave_speed: float) -> list[Input]:
    """The path's legs, slow enough for the stage to climb 95 % of its slopes at ``slave_speed`` [m/s]."""
    distance, height = session.path_heights()
    slope = np.quantile(np.abs(np.gradient(height, distance)), 0.95) if distance[-1] > 0.0 else 0.0
    shortest, longest = SCAN_TIMES
    time = float(np.clip(distance[-1] * slope / slave_speed, shortest, longest))
    corners = np.asarray(session.path)
    legs = np.hypot(*np.diff(corners, axis=0).T)
    shares = legs / legs.sum() if legs.sum() > 0.0 else np.full(len(legs), 1.0 / len(legs))
    return [Input(force, x, y, time * share) for (x, y), share in zip(session.path[1:], shares, strict=True)]


def _scan(session: Touch) -> list[Input]:
    """Half the contact force may be spent on moving the master."""
    x, y = session.path[0]
    force = _contact_force(session, SCAN_FORCE)
    settle = [Input(force, x, y, 0.5), Input(force, x, y, 0.5)]
    return [
        *_approach(session),
        *settle,
        *_along_path(session, force, _slave_speed(session, 0.5 * force)),
        *_retract(session, force),
    ]


def _follow(session: Touch) -> list[Input]:
    """No hand force; the height servo climbs at its gain times a third of the set-point's deflection."""
    gains = session.settings.gains
    x, y = session.path[0]
    speed = gains.height_gain * gains.set_point / session.rig.probe.spring_constant
    settle = 2.0 * session.clearance / speed + 0.5
    return [Input(0.0, x, y, settle), *_along_path(session, 0.0, speed / 3.0), Input(0.0, *session.path[-1], 0.3)]


def _descend(session: Touch) -> list[Input]:
    """No hand force: long enough for the stage to find the surface, and to draw a curve."""
    gains, x, y = session.settings.gains, *session.path[0]
    stretch = gains.set_point / session.rig.probe.spring_constant
    down = session.clearance + _depth(session, gains.set_point * gains.alpha_f) + stretch
    back = gains.curve_length if session.mode == "curve" else 0.0
    settle = 5.0 / gains.height_gain if session.mode == "approach" and gains.height_gain > 0.0 else 0.0
    return [Input(0.0, x, y, 1.1 * (down + back) / gains.approach_speed + settle + 0.1)]
