# SPDX-License-Identifier: BSD-3-Clause
"""What a rig's numbers are, with their uncertainties: paths that drive one half alone, and fits of what was read.

Nothing is controlled meanwhile. A drive ends, and the half lets go, at an emergency stop, a limit switch, an invalid
reading or a deflection at the end of its range. ``nanotouch rig calibrate`` runs all of it (docs/hardware.md).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core
from nanotouch._arrays import as_floats
from nanotouch.errors import DeviceError, InvalidValue, require
from nanotouch.scene import Rig
from nanotouch.scene.plan import Plan
from nanotouch.touch.hal import Mailbox, Master, SharedObject, Slave
from nanotouch.touch.rig_file import Converters

Floats = NDArray[np.float64]
LEAST_PEAK = 3.0
"""of a thermal resonance over the detector's noise, as densities [-]"""
RAYLEIGH = 0.12
"""how well the square law tells the hysteresis of the whole travel from that of a small stroke, over it [-]"""
ROUNDED = 5e-5
"""what rounded readings may shift a resonance by, over it, beside what is random; of Q ten times that [-]"""
LONGEST_DELAY = 8.0
"""that is sought [periods]"""
BLOCKS = 50
"""of a run, whose sums are taken to be independent"""
FEW = 4
"""such blocks of a run of a few dozen points"""
_STEP = 12.0**-0.5  # standard deviation of what is rounded, over the step


class Value(NamedTuple):
    """A number that was found."""

    value: float
    sigma: float
    """standard uncertainty, in the same unit"""
    unit: str


@dataclass(frozen=True, eq=False)
class Driven:
    """What was told and read, a value a period."""

    period: float
    """[s]"""
    told: Floats
    """travel towards the sample [m]; of a master its motor force [N]"""
    position: Floats
    """[m]"""
    felt: Floats
    """deflection, + upwards [m]; of a master the force of the hand [N]"""
    lead: float
    """of the measurements before the writes of the same period, on average [s]"""


def simulated(rig: Rig, plan: Plan, *, period: float = 1e-4, clearance: float = 1e-6, seed: int = 1) -> Any:
    """A simulated rig to drive: its half for :func:`drive`, as often as one likes. ``clearance`` is the height of the
    tip over the sample at the start [m]."""
    return _core.rigs.Simulated(plan.core, rig.core, period, clearance, seed)


def drive(
    half: Converters | Mailbox | SharedObject | Master | Slave | Any,
    path: ArrayLike,
    *,
    period: float = 1e-4,
    is_master: bool = False,
    turn: float = math.inf,
    returns: bool = False,
) -> Driven:
    """Play a path on one half, a point a period.

    Parameters
    ----------
    half : Converters, Mailbox, SharedObject, Master, Slave, or what :func:`simulated` gives
        What is driven; it is opened, armed, and let go.
    path : array_like
        Travel from where the stage stands [m], or motor forces of a master [N].
    period : float
        [s].
    turn : float
        The path ends where a slave's deflection reaches this [m].
    returns : bool
        From its end the path is played backwards, to its start.

    Raises
    ------
    DeviceError
        It was stopped: the message says by what.
    """
    points = as_floats(path, "path")
    if points.ndim != 1 or points.size < 2 or not np.all(np.isfinite(points)):
        raise InvalidValue(f"path: shape {points.shape}, expected at least 2 finite numbers")
    if not 1e-6 <= period <= 0.999:
        raise InvalidValue(f"period = {period} s: valid is 1e-06 .. 0.999 s")
    found = _core.rigs.drive(half, is_master, period, points.tolist(), turn, returns)
    if found["stopped"]:
        raise DeviceError(f"stopped after {len(found['told'])} periods: {found['stopped']}")
    columns = {name: np.asarray(found[name]) for name in ("told", "position", "felt", "measured", "written")}
    lead = float(np.mean(columns["written"] - columns["measured"])) if columns["told"].size else 0.0
    return Driven(period, columns["told"], columns["position"], columns["felt"], lead)


# --- paths ---


def staircase(stroke: float, *, steps: int = 20, ramp: float = 0.02, hold: float = 0.1, period: float = 1e-4) -> Floats:
    """Up from 0 by `stroke`, down by it and back, away from the sample first, resting on each of the steps."""
    corners = np.concatenate([np.linspace(0.0, -1.0, steps + 1), np.linspace(-1.0, 0.0, steps + 1)[1:]])
    corners = np.concatenate([corners, corners[1:]]) * stroke  # the second round is on the closed loop
    ramps, rests = round(ramp / period), round(hold / period)
    legs = [np.concatenate([np.linspace(a, b, ramps), np.full(rests, b)])
            for a, b in itertools.pairwise(corners)]  # fmt: skip
    return np.concatenate(legs)


def sweep(speed: float, *, lowest: float, highest: float, seconds: float = 2.0, period: float = 1e-4) -> Floats:
    """A sine whose frequency grows from `lowest` to `highest` [Hz], and whose speed stays below a tenth of the stage's
    limit, `speed` [m/s]: its driver takes time for each step of a command."""
    time = np.arange(round(seconds / period)) * period
    growth = math.log(highest / lowest) / seconds
    frequency = lowest * np.exp(growth * time)
    phase = 2.0 * math.pi * (frequency - lowest) / growth
    return np.asarray(0.1 * speed / (2.0 * math.pi * frequency) * np.sin(phase))


def pushes(rig: Rig, *, seconds: float = 4.0, period: float = 1e-4) -> Floats:
    """Forces of a master to and fro, each for a random time, that move it by some third of its travel and back."""
    master, draw = rig.master, np.random.default_rng(1)
    count = round(seconds / 0.03)
    forces, lengths = draw.uniform(0.3, 1.0, count) * (-1.0) ** np.arange(count), draw.uniform(0.01, 0.05, count)
    path = np.concatenate([np.full(round(t / period), f) for f, t in zip(forces, lengths, strict=True)])
    window = round(0.2 / period)  # no way is gained over longer times
    path -= np.convolve(np.pad(path, window // 2, mode="reflect"), np.full(window, 1.0 / window), "same")[
        window // 2 : window // 2 + path.size
    ]
    moved = np.ptp(_master_moves(master.mass, master.damping, 0.0, path, period))
    return np.asarray(path * min(master.max_force / np.abs(path).max(), 0.3 * master.travel / moved))


# --- fits ---


def _solved(
    residual: Callable[[Floats], Floats], starts: list[Floats], reach: Floats, least: float
) -> tuple[Floats, Floats]:
    """The best of some starts, each within +- `reach`, and the covariance. `least` is the smallest standard deviation
    of a residual.

    Residuals of rounded readings are alike for many ticks: the covariance is that of sums over blocks (a sandwich), or
    that of independent ones where it is larger.
    """
    optimize = require("scipy.optimize", "curves")

    def inside(x: Floats, start: Floats) -> Floats:
        return residual(np.clip(x, start - reach, start + reach))

    found = min((optimize.least_squares(inside, start, method="lm", args=(start,), diff_step=1e-6) for start in starts),
                key=lambda one: float(one.cost))  # fmt: skip
    free = found.fun.size - found.x.size
    inverse = np.linalg.pinv(found.jac.T @ found.jac)
    alone = max(2.0 * float(found.cost) / free, least**2) * inverse
    sums = np.add.reduceat(found.jac * found.fun[:, None], np.arange(0, found.fun.size, found.fun.size // BLOCKS))
    together = inverse @ (sums.T @ sums) @ inverse * BLOCKS / (BLOCKS - found.x.size)
    spread = np.sqrt(np.maximum(1.0, np.diag(together) / np.diag(alone)))
    return found.x, alone * np.outer(spread, spread)


def _linear(columns: Floats, values: Floats, blocks: int, least: float = 0.0) -> tuple[Floats, Floats]:
    """A linear fit and the standard deviations of what it finds, `least` at least of a residual. Where noise drifts
    slowly the residuals of neighbours are alike: as in :func:`_solved`, by sums over blocks."""
    found, *_ = np.linalg.lstsq(columns, values, rcond=None)
    rest = values - columns @ found
    free = rest.size - found.size
    inverse = np.linalg.inv(columns.T @ columns)
    alone = max(float(rest @ rest) / free, least**2) * inverse
    sums = np.add.reduceat(columns * rest[:, None], np.arange(0, rest.size, max(1, rest.size // blocks)))
    together = inverse @ (sums.T @ sums) @ inverse * len(sums) / (len(sums) - found.size)
    return np.asarray(found), np.asarray(np.sqrt(np.maximum(np.diag(alone), np.diag(together))))


def stage_gain(run: Driven, rig: Rig, *, stroke: float, steps: int = 20) -> dict[str, Value]:
    """Gain of the travel and hysteresis, from a :func:`staircase` without a sample.

    The loop of a small stroke opens as its square (Rayleigh); the hysteresis is that of the whole travel.
    """
    each = run.told.size // (4 * steps)
    place = np.array([(run.told[n * each - 1], np.mean(run.position[n * each - each // 4 : n * each]))
                      for n in range(2 * steps + 1, 4 * steps + 1)])  # fmt: skip
    told, position = place[:, 0], place[:, 1]
    middle, half = 0.5 * (told.max() + told.min()), 0.5 * stroke
    down = np.where(np.arange(told.size) < steps, -1.0, 1.0)  # away from the sample first
    shape = down * (1.0 - ((told - middle) / half) ** 2)
    columns = np.stack([np.ones_like(told), told - middle, shape], axis=1)
    found, sigma = _linear(columns, position, FEW, _STEP * rig.stage.resolution)
    # down lags above: the branch towards the sample stands short of it
    opening = rig.stage.travel / stroke**2
    hysteresis = -2.0 * float(found[2]) * opening
    scaled = RAYLEIGH * abs(hysteresis) if stroke < 0.95 * rig.stage.travel else 0.0
    return {
        "stage.gain": Value(float(found[1]), float(sigma[1]), ""),
        "stage.hysteresis": Value(hysteresis, math.hypot(2.0 * float(sigma[2]) * opening, scaled), ""),
    }


def _held(frequency: float, quality: float, length: float) -> tuple[Floats, Floats]:
    """Eq. 13 over a time with a held command: state to state, command to state."""
    w = 2.0 * math.pi * frequency
    root = np.sqrt(complex(0.25 / quality**2 - 1.0))
    slow, fast = w * (-0.5 / quality + root), w * (-0.5 / quality - root)
    vectors = np.array([[1.0, 1.0], [slow, fast]])
    over = np.real(vectors @ np.diag(np.exp(np.array([slow, fast]) * length)) @ np.linalg.inv(vectors))
    return over, (np.eye(2) - over) @ np.array([1.0, 0.0])


def _follows(frequency: float, quality: float, delay: float, told: Floats, period: float) -> Floats:
    """Where a stage of gain 1 is at the ticks, its commands held and `delay` late."""
    signal = require("scipy.signal", "curves")
    whole = math.floor(delay / period)
    part = delay - whole * period
    first, old = _held(frequency, quality, part)  # the old command acts on, then the new one
    second, new = _held(frequency, quality, period - part)
    A, b_old, b_new = second @ first, second @ old, new
    trace, determinant = float(np.trace(A)), float(np.linalg.det(A))
    # position of (z - A)^-1 b is (b_0 z + A_01 b_1 - A_11 b_0) over z^2 - trace z + determinant
    top = [np.array([b[0], A[0, 1] * b[1] - A[1, 1] * b[0]]) for b in (b_new, b_old)]
    numerator = np.concatenate([np.zeros(whole + 1), top[0], [0.0]]) + np.concatenate([np.zeros(whole + 2), top[1]])
    return np.asarray(signal.lfilter(numerator, [1.0, -trace, determinant], told))


def stage_response(run: Driven, rig: Rig) -> dict[str, Value]:
    """Resonance, quality factor, gain and delay from a :func:`sweep`, by Eq. 13 with held commands."""
    told, position = run.told - run.told[0], run.position - np.mean(run.position)
    size = max(float(np.std(position)), rig.stage.resolution)
    drive = np.abs(np.fft.rfft(told))
    least = 3e-3 * drive.max()  # below it there is noise alone
    ratio = np.where(drive > least, np.abs(np.fft.rfft(position)), 0.0) / np.maximum(drive, least)
    frequency = np.fft.rfftfreq(told.size, run.period)
    peak = float(frequency[1:][np.argmax(ratio[1:])])

    def residual(x: Floats) -> Floats:
        moved = _follows(math.exp(x[0]), math.exp(x[1]), abs(x[2]) * run.period, told, run.period)
        columns = np.stack([np.ones_like(moved), moved], axis=1)
        found, *_ = np.linalg.lstsq(columns, position, rcond=None)
        return np.asarray((columns @ found - position) / size)

    grid = [np.array([math.log(peak), math.log(Q), d + 0.25])
            for Q in (5.0, 20.0, 60.0) for d in np.arange(0.0, LONGEST_DELAY, 0.5)]  # fmt: skip
    starts = sorted(grid, key=lambda start: float(np.sum(residual(start) ** 2)))[:3]
    reach = np.array([0.5, 2.2, 3.0])
    x, covariance = _solved(residual, starts, reach, _STEP * rig.stage.resolution / size)
    sigma = np.sqrt(np.diag(covariance))
    f_n, Q = math.exp(x[0]), math.exp(x[1])
    steps = np.abs(np.diff(told))  # a driver may take steps/speed for each, which counts by its energy
    slewing = 0.5 * float(np.sum(steps**3) / np.sum(steps**2)) / rig.stage.max_speed
    return {
        "stage.resonance": Value(f_n, f_n * math.hypot(float(sigma[0]), ROUNDED), "Hz"),
        "stage.quality": Value(Q, Q * math.hypot(float(sigma[1]), 10.0 * ROUNDED), ""),
        "delay": Value(
            abs(float(x[2])) * run.period - run.lead, math.hypot(float(sigma[2]) * run.period, 0.5 * slewing), "s"
        ),
    }


def _master_moves(mass: float, damping: float, delay: float, force: Floats, period: float) -> Floats:
    """Where Eq. 12 goes with held forces, `delay` late: x'' m + x' b = f."""
    time = np.arange(force.size) * period
    late = np.interp(time - delay, time, np.cumsum(force) * period - force * period, left=0.0)  # impulse so far
    decay = math.exp(-damping * period / mass)
    signal = require("scipy.signal", "curves")
    # b x + m v = impulse: v from held slopes of it
    slope = np.diff(late, append=late[-1]) / period
    velocity = signal.lfilter([0.0, (1.0 - decay) / damping], [1.0, -decay], slope)
    return np.asarray((late - mass * velocity) / damping)


def master_motion(run: Driven, rig: Rig) -> dict[str, Value]:
    """Mass and damping from :func:`pushes`, by Eq. 12 with held forces, nobody holding the master."""
    force, position = run.told, run.position - run.position[0]
    size = max(float(np.std(position)), rig.master.resolution)

    def residual(x: Floats) -> Floats:
        moved = _master_moves(math.exp(x[0]), math.exp(x[1]), x[2] * run.period, force, run.period)
        return np.asarray((moved + x[3] * size - position) / size)

    starts = [np.array([math.log(m), math.log(rig.master.damping), 1.0, 0.0])
              for m in (0.5 * rig.master.mass, 2.0 * rig.master.mass)]  # fmt: skip
    reach = np.array([3.0, 3.0, 20.0, 1.0])
    x, covariance = _solved(residual, starts, reach, _STEP * rig.master.resolution / size)
    sigma = np.sqrt(np.diag(covariance))
    m, b = math.exp(x[0]), math.exp(x[1])
    return {
        "master.mass": Value(m, m * float(sigma[0]), "kg"),
        "master.damping": Value(b, b * float(sigma[1]), "N s/m"),
    }


def contact_slope(run: Driven, *, least: float = 0.2, most: float = 0.95) -> Value:
    """Way of the stage over deflection in contact, both as the rig reads them now, from a run that turned.

    Both branches, each with an offset of its own: friction and lag shift them. 1 on a hard sample, if both gains are
    right.
    """
    top = int(np.argmax(run.felt))
    zero = float(np.median(run.felt[: max(2, top // 4)]))
    felt = run.felt - zero
    inside = (felt > least * felt[top]) & (felt < most * felt[top])
    branch = np.arange(felt.size) > top
    if np.count_nonzero(inside & ~branch) < 8 or np.count_nonzero(inside & branch) < 8:
        raise InvalidValue("too few points in contact: press more slowly, or deeper")
    columns = np.stack([~branch & inside, branch & inside, felt], axis=1)[inside].astype(float)
    found, sigma = _linear(columns, run.position[inside], 2 * FEW)
    return Value(float(found[2]), float(sigma[2]), "")


def sensitivity(hard: Value, rig: Rig, *, position_sigma: float = 0.0, sample_stiffness: float = math.inf) -> Value:
    """S from the slope on a hard sample, k_c/k_s of which goes into the sample, known to half of that [m/V]."""
    yields = 1.0 + rig.probe.spring_constant / sample_stiffness
    share = math.hypot(hard.sigma / hard.value, position_sigma, 0.5 * (yields - 1.0))
    found = rig.probe.sensitivity * hard.value / yields  # of what the rig takes for S
    return Value(found, found * share, "m/V")


def reference_lever(hard: Value, reference: Value, stiffness: float, *, stiffness_sigma: float) -> Value:
    """k_c from the slopes on a hard sample and on a lever of known stiffness: k_ref (c_ref/c_hard - 1) [N/m].

    Torii et al., Meas. Sci. Technol. 7 (1996) 179, with the point of contact at the end of that lever.
    """
    ratio = reference.value / hard.value
    if not ratio > 1.0:
        raise InvalidValue(
            f"slopes: {reference.value:g} on the lever, {hard.value:g} on the hard sample: expected more"
        )
    found = stiffness * (ratio - 1.0)
    slopes = math.hypot(hard.sigma / hard.value, reference.sigma / reference.value) * ratio / (ratio - 1.0)
    return Value(found, found * math.hypot(slopes, stiffness_sigma / stiffness), "N/m")


def thermal(
    frequency: ArrayLike,
    density: ArrayLike,
    *,
    averages: int,
    temperature: float,
    correction: float,
    sensitivity_sigma: float,
    temperature_sigma: float = 1.0,
) -> Value:
    """k_c from thermal motion, by :func:`nanotouch.curves.thermal_tune`; refused where noise hides the motion, as that
    of a piezoresistive probe does [N/m]. S enters squared."""
    from nanotouch.curves.thermal import thermal_tune

    tune = thermal_tune(frequency, density, averages=averages, temperature=temperature, correction=correction)
    peak = float(np.max(as_floats(density, "density")))
    if peak < LEAST_PEAK * tune.floor * (1.0 + 5.0 / math.sqrt(averages)):
        raise InvalidValue(f"thermal motion: its peak is {peak / tune.floor:.2g} times the detector's noise, at least "
                           f"{LEAST_PEAK:g} is needed: take Sader's method or a reference lever")  # fmt: skip
    k = tune.spring_constant
    share = math.hypot(tune.sigma["spring_constant"] / k, 2.0 * sensitivity_sigma, temperature_sigma / temperature)
    return Value(k, k * share, "N/m")


def combined(values: Mapping[str, Value]) -> Value:
    """The mean of several methods, each weighed by 1/sigma^2; its sigma grows by their scatter where that is larger."""
    found = list(values.values())
    weights = np.array([1.0 / one.sigma**2 for one in found])
    numbers = np.array([one.value for one in found])
    mean = float(weights @ numbers / weights.sum())
    chi2 = float(weights @ (numbers - mean) ** 2) / max(1, len(found) - 1)
    return Value(mean, math.sqrt(max(1.0, chi2) / float(weights.sum())), found[0].unit)
