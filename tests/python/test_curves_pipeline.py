# SPDX-License-Identifier: BSD-3-Clause
"""The C library reads curves as the NumPy code did that it replaced: its numbers, recorded before it went.

``curve_numbers.json`` holds them in SI. The NumPy code iterated its robust lines over all points, weights anew in each
round. The C library begins with a sample of 128, and then keeps the scatter that scales the weights. Both estimate the
same, so everything is compared in its own standard uncertainty, within a tenth of it: that adds 1 % to a variance. A
standard deviation of n values is known to 1/sqrt(2 n). White and 1/f noise are told apart in another way today, and so
are the uncertainties of level and tilt: ``test_curves_flicker.py``. The line leaves out the foot of a soft contact
today, so measured curves are compared with a constant level alone.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.curves.baseline import fit_baseline

NUMBERS: dict[str, list[float | None]] = json.loads((Path(__file__).parent / "curve_numbers.json").read_text())
MADE = ("stiff", "soft", "wave", "drift", "jitter")
COUNT, METHODS = 700, 5  # points of a branch; ways to find its contact
KINDS: tuple[Any, ...] = ("auto", "line", "wave", "constant", (4e-7, 1.1e-6))
REAL = sorted({key.rsplit(" ", 2)[0] for key in NUMBERS if not key.startswith(MADE)})


def noise(count: int, seed: int) -> np.ndarray:
    """Nearly Gaussian, exact on every machine: sums of twelve numbers of a linear congruence."""
    state, found = np.uint64(seed), []
    with np.errstate(over="ignore"):
        for _ in range(12 * count):
            state = state * np.uint64(6364136223846793005) + np.uint64(1442695040888963407)
            found.append(int(state >> np.uint64(40)))
    return np.asarray((np.array(found, float).reshape(count, 12) / 2.0**24).sum(1) - 6.0)


def branch(name: str, count: int = COUNT) -> tuple[np.ndarray, np.ndarray]:
    """Height [m] and force [N]: a retraction from a stiff contact; of "soft" an approach without adhesion."""
    z = np.linspace(0.0, 1.2e-6, count)
    x = z - 2e-7
    force = 12e-12 * noise(count, 5) + 3e-4 * z
    if name == "soft":
        force = force + 4e-2 * np.clip(-x, 0.0, None) ** 1.5 / 4.5e-4
        return z[::-1], force[::-1]
    force = force + np.where(x < 12e-9, -0.1 * x, 0.0)
    if name == "wave":
        phase = np.modf(z / 310e-9)[0]
        force = force + 2e-10 * (
            16 * phase * (0.5 - phase) * (phase < 0.5) - 16 * (phase - 0.5) * (1 - phase) * (phase >= 0.5)
        )
    if name == "drift":
        force = force + 2e-12 * np.cumsum(noise(count, 9))
    if name == "jitter":
        z = z + 2e-9 * noise(count, 3)
    return z, force


NEAR, EXACT = 0.1, 2e-12  # standard uncertainties; relative
OF_SPREAD = NEAR / (2.0 * COUNT) ** 0.5


def agree(found: list[float | None], key: str, within: Any = 0.0) -> None:
    """Within so much [SI], each or all, and rounding."""
    values, expected = (np.array([np.nan if v is None else v for v in row]) for row in (found, NUMBERS[key]))
    assert np.array_equal(np.isnan(values), np.isnan(expected)), key
    off = np.abs(values - expected) - EXACT * np.abs(expected)
    assert np.all((off <= within) | np.isnan(expected)), (key, values, expected, off, within)


def period_sigma(found: Any) -> float:
    """Of a sine of unknown phase in white noise, sqrt(24/n) noise/amplitude over 2 pi length in frequency [m]."""
    if found.wave is None:
        return 0.0
    amplitude, length = np.hypot(found.wave.cosine, found.wave.sine), 1.2e-6
    of_frequency = (24.0 / COUNT) ** 0.5 * found.scatter / amplitude / (2.0 * np.pi * length)
    return float(found.wave.period**2 * of_frequency)


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_baselines(name: str, kind: Any) -> None:
    found = fit_baseline(*branch(name), kind)
    wave = [] if found.wave is None else [found.wave.period, found.wave.cosine, found.wave.sine]
    values = [found.force, found.slope, found.z_mean, found.scatter, *wave]
    level, tilt = NEAR * np.sqrt(found.variance)
    parts = 2.0**0.5 * level  # cosine and sine: their squares are 1/2 in the mean
    near = [level, tilt, 0.0, OF_SPREAD * found.scatter, NEAR * period_sigma(found), parts, parts]
    agree(values, f"{name} {kind}", 0.0 if kind == "constant" else np.array(near[: len(values)]))


@pytest.mark.parametrize("name", MADE)
def test_events_and_contact_points(name: str) -> None:
    z, force = branch(name)
    role: Any = "approach" if name == "soft" else "retract"
    segment = curves.Segment(role, np.full(z.size, np.nan), z, "height (measured)", force)
    report = curves.analyse(curves.ForceCurve((segment,), {"spring constant": 0.2}, name), baseline="line")
    read = report.branches[role]
    points = [report.contact_points.get(k) for k in ("crossing", "deviation", "hertz", "two_lines", "gradient")]
    depth = (report.snap_in_force, report.snap_in_z) if name == "soft" else (report.pull_off_force, report.pull_off_z)
    values = [
        *depth, report.contact_point, report.sigma["contact_point"], report.contact_slope,
        report.sigma["contact_slope"], report.adhesion_work, report.noise,
        read.lowest, -1 if read.tear is None else read.tear, *points,
    ]  # fmt: skip
    place = NEAR * report.sigma["contact_point"]
    of = ("snap_in_force" if name == "soft" else "pull_off_force", "contact_slope", "adhesion_work")
    force, slope, work = (np.nan_to_num(NEAR * report.sigma[key]) for key in of)
    of_place = place / (2.0 * (METHODS - 1)) ** 0.5  # the spread of the methods
    of_slope = OF_SPREAD * report.sigma["contact_slope"]
    near = [force, 0.0, place, of_place, slope, of_slope, work, 0.0, 0.0, 0.0, *[place] * METHODS]
    agree(values, f"{name} line read", np.array(near))


@pytest.mark.parametrize("name", REAL)
def test_measured_curves(name: str) -> None:
    pytest.importorskip("afmformats")
    found = [path for path in synthetic.DATA.rglob(name) if path.is_file()] if synthetic.DATA.is_dir() else []
    if not found:
        pytest.skip(f"real data not here: {name}")
    curve = curves.read(found[0])[0]
    r = curves.analyse(curve, baseline="constant")
    values = [r.pull_off_force, r.snap_in_force, r.contact_point, r.contact_slope, r.adhesion_work]
    agree([*values, r.noise, r.baseline_tilt], f"{name} 0 constant")
