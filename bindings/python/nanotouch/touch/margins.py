# SPDX-License-Identifier: BSD-3-Clause
"""How far a loop is from its stability limit, what the hand can feel through it, and with how many steps: before a
session from numbers alone, afterwards from its recording. Formulas and sources: docs/margins.md."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch._arrays import check_between
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings
from nanotouch.scene.plan import Plan
from nanotouch.touch._calm import CLEARLY_FELT, RINGING_MOST, Calm, calm
from nanotouch.touch._motor_bound import MotorBound, motor_bound
from nanotouch.touch._path import MODES, Mode, core_mode
from nanotouch.touch._response import Response, passive_up_to, response
from nanotouch.touch.record import Recording

__all__ = [
    "CLEARLY_FELT", "HAND_BAND", "MINIMUM", "RINGING_MOST", "UNKNOWN", "Calm", "Felt", "ForceRange", "Margins",
    "MotorBound", "Resolution", "Response", "Width", "calm", "compute", "felt_alpha_f", "force_range",
    "heuristic_alpha_f", "motor_bound", "of_own_law", "of_recording", "resolution", "response", "z_width",
]  # fmt: skip
Floats = NDArray[np.float64]
MINIMUM = 1.5
"""a loop closer to its limit than this is refused, unless told otherwise"""
HAND_BAND = 33.0
"""the paper's bandwidth of the haptic device [Hz]"""


class Margins(NamedTuple):
    """Rules R1 to R5 and the exact limit of the sampled loop, hand and filters included; infinite where nothing limits.

    K_f is 0 for a law without operator force, the master's damping is what a velocity feed-forward leaves of it.
    """

    loop_stiffness: float
    """kappa = (1 + K_f) alpha_f alpha_p k_eff at the stiffest contact [N/m]"""
    loop_delay: float
    """D: two hops of hold and dead time, and the stage's lag [s]"""
    stability_limit: float
    """R1, a rule of thumb that knows no hand: kappa up to b_m/D, less what the stage's integral costs [N/m]"""
    margin: float
    """R1: limit over stiffness"""
    pad_limit: float
    """R2: K_f at which the pad of the finger (hand.damping) oscillates, f_m unfiltered"""
    mass_limit: float
    """R3: K_f at which a finger rigidly on the gauge (hand.mass) does, f_m unfiltered"""
    quantisation_step: float
    """R4: motor force of one step of stage or scaled master [N]"""
    force_noise: float
    """R5: motor noise that the sensors make, RMS [N]"""
    height_margin: float
    """topography mode: of the height servo or of the master's spring, the smaller one"""
    exact_limit: float
    """kappa at which the sampled loop is unstable [N/m]"""
    exact_frequency: float
    """at which it then oscillates [Hz]; NaN where there is no limit"""
    force_gain_limit: float
    """K_f at which it is, in air or at the contact, whichever comes first"""
    integral_limit: float
    """integral gain at which the stage's own loop oscillates, whoever holds the master [1/s]"""
    coupling_margin: float
    """of tool and stage behind a virtual coupling, the master held still; exact; infinite without a coupling"""
    bandwidth: float
    """up to here the hand feels the contact's stiffness within 3 dB [Hz]"""
    passive_up_to: float
    """above this frequency the loop can give energy to the hand, Re Z < 0 at the contact: the low-pass of f_m and the
    delays; half the rate if nowhere [Hz]"""
    least: float
    """the smallest margin of those that count in this mode; 1 is the limit"""
    rule: str
    """which one that is"""
    llewellyn: float
    """Llewellyn's number at its least below HAND_BAND; absolutely stable at 1, which no sampled loop reaches"""
    free_damping: float
    """Z-width, lower end: what the hand feels in air, b_m/(1 + K_f) [N s/m]"""
    free_mass: float
    """m_m/(1 + K_f) [kg]"""
    passive_stiffness: float
    """Z-width, upper end: the stiffest contact at the hand, alpha_f alpha_p k_eff, that is passive by R1 [N/m]"""
    stable_stiffness: float
    """the stiffest that is stable [N/m]"""

    @property
    def verdict(self) -> str:
        """The smallest margin in words."""
        if math.isinf(self.least):
            return "none is needed: no loop is closed, the stage goes where it is told"
        return f"{self.least:.3g} ({self.rule}; 1 is the limit)"

    @property
    def refusal(self) -> str | None:
        """Why a session would not be armed; None if it would."""
        return (
            None if self.least >= MINIMUM else f"{self.rule}: margin {self.least:.3g}, at least {MINIMUM:g} is needed"
        )


_NANS: dict[str, Any] = dict.fromkeys(Margins._fields, math.nan)
UNKNOWN = Margins(**_NANS | {"rule": "own law, of no kind that can be judged"})
"""of a loop about which nothing can be told"""


def compute(rig: Rig, settings: Settings, contact_stiffness: float, mode: Mode = "point") -> Margins:
    """Margins of a loop in a mode of a session, at a contact stiffness k [N/m] (``math.inf``: a rigid sample)."""
    if math.isnan(contact_stiffness) or contact_stiffness < 0.0:
        raise InvalidValue(f"contact_stiffness = {contact_stiffness} N/m: it must be 0 N/m or more")
    rig.check()
    settings.check()
    found: dict[str, Any] = _core.margins(rig.core, settings.core, contact_stiffness, core_mode(mode))
    gain, damping = 1.0 + found.pop("force_gain"), found.pop("damping")
    band = np.geomspace(0.1, 1.0, 30) * min(HAND_BAND, 0.5 * settings.gains.rate)
    return Margins(
        **found,
        passive_up_to=passive_up_to(rig, settings, contact_stiffness),
        llewellyn=float(np.min(response(rig, settings, contact_stiffness, band).llewellyn)),
        free_damping=damping / gain,
        free_mass=rig.master.mass / gain,
        passive_stiffness=found["stability_limit"] / gain,
        stable_stiffness=found["exact_limit"] / gain,
    )


def of_own_law(
    rig: Rig, settings: Settings, amounts: Settings | None, *, contact_stiffness: float, mode: Mode
) -> Margins:
    """Margins of a law of one's own, from the settings with which the default law does the same; NaN where there are
    none. The height servo does not ask the law."""
    if amounts is not None:
        return compute(rig, amounts, contact_stiffness, mode)
    if core_mode(mode) == "touch":
        return UNKNOWN
    other = compute(rig, settings, contact_stiffness, mode)
    return UNKNOWN._replace(height_margin=other.height_margin, least=other.least, rule=other.rule)


class Resolution(NamedTuple):
    """With how many steps a session works (paper, Eq. 20, 21, in SI); ``str()`` is a report."""

    slave_step: float
    """delta_p: of the stage's command or read-out, the coarser [m]"""
    slave_force: float
    """delta_f: noise of the probe peak to peak, or one step of the stage, the coarser [N]"""
    slave_steps: float
    """N_p over the path"""
    force_steps: float
    """N_f over the probe's range"""
    master_steps: float
    """N_p of the master"""
    gauge_steps: float
    """N_f of the gauge, 0 without one"""
    master_travel: float
    """what the path needs of the master's travel [m]"""
    master_force: float
    """one step of force at the hand, alpha_f delta_f [N]"""

    def __str__(self) -> str:
        return "\n".join(
            [
                f"stage   N_p = {self.slave_steps:.0f} steps of {self.slave_step * 1e9:.3g} nm",
                f"probe   N_f = {self.force_steps:.0f} steps of {self.slave_force * 1e9:.3g} nN",
                f"master  N_p = {self.master_steps:.0f}; the path takes {self.master_travel * 1e3:.3g} mm of it",
                f"gauge   N_f = {self.gauge_steps:.0f}; one step of the probe is {self.master_force:.3g} N at the hand",
            ]
        )


def resolution(rig: Rig, settings: Settings, slave_path: float) -> Resolution:
    """The resolution budget for a path of the stage, clearance and indentation together, L + delta_max [m]."""
    check_between("slave_path", slave_path, "m", above=0.0, up_to=1.0)
    return Resolution(**_core.resolution(rig.core, settings.core, slave_path))


class ForceRange(NamedTuple):
    """The forces on the tip [N], + repulsive, that shall fill the range of the hand."""

    lowest: float
    highest: float


def force_range(source: Plan | Recording, highest: float | None = None) -> ForceRange:
    """What Eq. 19 divides by: from a plan (the largest pull-off on the surface, the load wanted), or a test touch."""
    if isinstance(source, Plan):
        if highest is None:
            raise InvalidValue("force_range of a plan needs the highest load that is wanted: highest=... N")
        return ForceRange(-float(source.explain()["largest_pull_off_force"]), highest)
    force = source.slave_force[np.isfinite(source.slave_force)]
    if not len(force):
        raise InvalidValue("force_range needs a recording with forces")
    return ForceRange(float(np.min(force)), float(np.max(force)) if highest is None else highest)


def heuristic_alpha_f(rig: Rig, span: ForceRange) -> float:
    """alpha_f = (f_m max - f_m min)/(f_s max - f_s min) (Eq. 19) for the gauge's range, or the motor's without one."""
    if not span.highest > span.lowest:
        raise InvalidValue(
            f"the force range {span.lowest:g} .. {span.highest:g} N is empty: highest must be above lowest"
        )
    reach: float = min(rig.master.gauge_range, rig.master.max_force) if rig["master.gauge"] else rig.master.max_force
    return 2.0 * reach / (span.highest - span.lowest)


def felt_alpha_f(rig: Rig, settings: Settings, plan: Plan, *, load: float) -> float:
    """alpha_f at which the sample's pull-off is clearly felt, CLEARLY_FELT at the hand: that of a session that is told
    nothing about it.

    As much as leaves a margin of 3 and calm at the plan's stiffest contact. Never above Eq. 19 for forces from the
    pull-off to ``load`` [N], nor below that of the settings.
    """
    return _core.felt_alpha_f(rig.core, settings.core, plan.pull_off_force, load, plan.maximum_stiffness)


class Felt(NamedTuple):
    """What a recording shows of its loop."""

    margins: Margins
    """at the stiffness that was met"""
    contact_stiffness: float
    """k of the stiffest contact that was met, from slave force against travel [N/m]; infinite if stiffer than k_c"""
    felt_stiffness: float
    """alpha_f d f_s/d x_m where it was stiffest, at the hand [N/m]: the top of the Z-width that was used"""
    free_damping: float
    """f_m/x_m' in air by least squares [N s/m]: its bottom; NaN if the master did not move there"""
    energy: Floats
    """[J], shape (n,): what the hand has put in so far"""
    dissipated: Floats
    """[J], shape (n,): the part of it that did not go into the surface, integral of (f_m - alpha_f f_s) dx_m; too much
    by some half k_r delta^2 for every step delta of the master's sensor, which the force answers only afterwards"""

    @property
    def is_passive(self) -> bool:
        """Whether master, loop and stage never gave back more than they had taken, but for the sensors' steps."""
        return float(self.dissipated.min(initial=0.0)) >= -0.02 * float(np.ptp(self.energy))


class Width(NamedTuple):
    """Z-width of a recorded loop: impedances at the hand [N s/m] over frequency [Hz], each shape (n,)."""

    frequency: Floats
    free: Floats
    """in air"""
    contact: Floats
    """pressed on the stiffest contact that was met"""
    passive: Floats
    """a spring of the stiffest that is passive (R1)"""
    stable: Floats
    """and of the stiffest that is stable"""
    drag: float
    """measured in air, NaN if the master did not move there [N s/m]"""


def z_width(recording: Recording) -> Width:
    """Between what the hand feels in air and in the stiffest contact met; from 0.1 Hz to three times HAND_BAND."""
    felt, (rig, _, settings) = of_recording(recording), _described(recording)
    if settings is None:
        raise InvalidValue(f"Z-width of a recording: {UNKNOWN.rule}")
    frequency = np.geomspace(0.1, min(3.0 * HAND_BAND, 0.5 * settings.gains.rate), 200)
    angular = 2.0 * np.pi * frequency
    air, pressed = (response(rig, settings, k, frequency) for k in (0.0, felt.contact_stiffness))
    return Width(
        frequency,
        np.abs(air.impedance),
        np.abs(pressed.impedance),
        felt.margins.passive_stiffness / angular,
        felt.margins.stable_stiffness / angular,
        felt.free_damping,
    )


def _described(recording: Recording) -> tuple[Rig, Settings, Settings | None]:
    """What it was recorded with, and the settings that its law amounts to, None where that is not known."""
    metadata = recording.metadata
    if not len(recording):
        raise InvalidValue("the recording has no row")
    if metadata.get("mode", "point") not in MODES:
        raise InvalidValue(f"the recording's metadata: mode {metadata['mode']!r}: valid are {', '.join(MODES)}")
    try:
        rig, settings, control = Rig(**metadata["rig"]), Settings(**metadata["settings"]), metadata["control"]
        if control == "own":
            amounts = metadata.get("amounts")
            return rig, settings, None if amounts is None else Settings(**amounts)
        _core.set_control(settings.core, control)
    except KeyError as error:
        raise InvalidValue(f"the recording's metadata lacks {error}: it was not made by a session") from error
    except (TypeError, ValueError) as error:
        raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
    return rig, settings, settings


def of_recording(recording: Recording) -> Felt:
    """Margins, energies and Z-width of a recording made by a session, from measured columns only."""
    rig, settings, amounts = _described(recording)
    k_eff = _steepest(recording, rig)
    k_c = rig.probe.spring_constant
    k = math.inf if k_eff >= 0.999 * k_c else k_eff / (1.0 - k_eff / k_c)
    gains = (amounts or settings).gains
    position = _held(recording.master_position)
    moved = np.diff(position, prepend=position[:1])
    given = _middle(recording.parameter("alpha_f") * _held(recording.slave_force))
    hand = _middle(_hand_force(recording, rig, settings))
    return Felt(
        margins=of_own_law(rig, settings, amounts, contact_stiffness=k, mode=recording.metadata.get("mode", "point")),
        contact_stiffness=k,
        felt_stiffness=gains.alpha_f * gains.alpha_p * k_eff,
        free_damping=_drag(recording, rig),
        energy=np.cumsum(hand * moved),
        dissipated=np.cumsum((hand - given) * moved),
    )


def _middle(column: Floats) -> Floats:
    """Over each step, 0 before the first."""
    middle: Floats = 0.5 * (column + np.concatenate([[0.0], column[:-1]]))
    return middle


def _held(column: Floats) -> Floats:
    """Where a sensor has failed its last good reading stands, 0 before the first."""
    good = np.isfinite(column)
    last = np.maximum.accumulate(np.where(good, np.arange(len(column)), -1)) if len(column) else np.arange(0)
    held: Floats = np.where(last < 0, 0.0, column[np.maximum(last, 0)])
    return held


def _hand_force(recording: Recording, rig: Rig, settings: Settings) -> Floats:
    """f_m [N]; without a gauge what the master shows of it, b v - tau_m, the motor force that acted, v over 20 ms."""
    if rig["master.gauge"]:
        return _held(recording.operator_force)
    position, rate = _held(recording.master_position), settings.gains.rate
    count, reach = len(position), max(1, round(0.01 * rate))
    rows = np.arange(count)
    moved = position[np.minimum(rows + reach, count - 1)] - position[np.maximum(rows - reach, 0)]
    delay = round(settings.gains.delay) + 1  # the force that has been held when the sample is taken
    acted = np.concatenate([np.zeros(delay), recording.motor_force])[:count]
    force: Floats = rig.master.damping * moved * rate / (2 * reach) - acted
    return force


def _bins(recording: Recording) -> tuple[Floats, Floats, Floats, Floats]:
    """Means over 20 ms: time, x_m, x_s, f_s."""
    step = float(np.median(np.diff(recording.time))) if len(recording) > 1 else 1.0
    rows = max(1, round(0.02 / step))
    count = len(recording) // rows
    columns = (recording.time, recording.master_position, recording.stage_position, recording.slave_force)
    mean = [_held(column)[: count * rows].reshape(count, rows).mean(axis=1) for column in columns]
    return mean[0], mean[1], mean[2], mean[3]


def _steepest(recording: Recording, rig: Rig) -> float:
    """The largest slope of slave force over travel while pressed [N/m], 0 if it never was: chords over five times the
    noise, or two fifths of the largest force: the steps of a short one would count as slope."""
    _, _, travel, force = _bins(recording)
    peak = float(np.max(force, initial=0.0))
    noise = rig.probe.spring_constant * rig.probe.sensitivity * rig.probe.noise / 6.0
    chord = max(5.0 * noise, 0.4 * peak)
    if peak < 2.0 * chord:
        return 0.0
    best = 0.0
    start = 0
    for end in range(len(force)):
        if force[end] <= 0.0 or force[start] <= 0.0:
            start = end
            continue
        while force[end] - force[start] > chord and start < end:
            travelled = travel[end] - travel[start]
            if travelled > 0.0:
                best = max(best, float((force[end] - force[start]) / travelled))
            start += 1
        if force[end] < force[start]:
            start = end
    return best


def _drag(recording: Recording, rig: Rig) -> float:
    """f_m over speed while the probe feels nothing [N s/m]."""
    noise = rig.probe.spring_constant * rig.probe.sensitivity * rig.probe.noise
    time, position, _, force = _bins(recording)
    if len(time) < 3:
        return math.nan
    speed = np.gradient(position, time)
    hand = np.interp(time, recording.time, _held(recording.operator_force))
    free = (np.abs(force) < noise) & (np.abs(speed) > 2.0 * rig.master.resolution / 0.02)
    total = float(np.sum(speed[free] ** 2))
    return float(np.sum(hand[free] * speed[free])) / total if total > 0.0 else math.nan
