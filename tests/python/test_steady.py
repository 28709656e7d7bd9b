# SPDX-License-Identifier: BSD-3-Clause
"""Steady tapping by tiers: beside the time domain, another integrator and closed forms; steady images beside scans."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import images
from nanotouch.errors import InvalidValue, SolverError

A0, K, Q, F0 = 20e-9, 40.0, 200.0, 300e3


def dry(modulus: float = 10e9) -> nt.Scene:
    return nt.Scene(
        tip={"radius": 10e-9}, sample={"youngs_modulus": modulus}, medium={"relative_humidity": 0.0}
    )  # fmt: skip


def rig(**probe: Any) -> nt.Rig:
    lever: Any = {"spring_constant": K, "quality": Q, "resonance": F0} | probe
    return nt.Rig(probe=lever, stage={"resonance": 20e3, "quality": 5.0})


def tip_drive() -> nt.Drive:
    return nt.Drive(drive={"at": "tip", "free_amplitude": A0})


@pytest.mark.parametrize(("accuracy", "tier"), [(0.5, "slow flow"), (0.02, "harmonic balance"), (2e-6, "time domain")])
def test_the_cheapest_tier_that_keeps_the_demand(accuracy: float, tier: str) -> None:
    plan = dry().plan()
    found = nt.Steady(plan, rig(), tip_drive(), accuracy=accuracy).at_amplitude(0.6 * A0)
    assert found is not None
    assert found.tier == tier
    truth = nt.Tapping(plan, rig(), tip_drive()).settle(found.base_height).value
    scale = max(truth.peak_force, plan.pull_off_force)
    assert abs(found.amplitude - truth.amplitude) <= max(found.amplitude_bound, 1e-5 * A0)
    assert abs(found.peak_force - truth.peak_force) <= max(found.force_bound, 5e-5 * scale)
    assert abs(found.peak_force - truth.peak_force) <= accuracy * scale + 5e-5 * scale
    assert found.evaluations > 0


def test_another_integrator_settles_where_harmonic_balance_says() -> None:
    """LSODA of scipy on Hertz' formula over 60 periods of a lever with Q = 20, from rest."""
    integrate = pytest.importorskip("scipy.integrate")
    scene = dry(1e9)
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    plan = scene.plan()
    found = nt.Steady(plan, rig(quality=20.0), tip_drive(), accuracy=1e-3).at_height(14e-9)
    assert found is not None
    hertz = 4.0 / 3.0 * plan.explain()["effective_modulus"] * math.sqrt(10e-9)

    def slope(t: float, y: np.ndarray) -> list[float]:
        force = hertz * max(0.0, -(14e-9 + A0 * y[0])) ** 1.5
        return [y[1], -y[0] - y[1] / 20.0 + force / K / A0 + math.cos(t) / 20.0]

    times = 2.0 * math.pi * (59.0 + np.arange(513) / 512)
    solved = integrate.solve_ivp(
        slope, (0.0, times[-1]), [0.0, 0.0], "LSODA", times, rtol=1e-9, atol=1e-11, max_step=0.1
    )
    samples = solved.y[0] * np.exp(1j * times)
    locked = 2.0 * np.mean(0.5 * (samples[1:] + samples[:-1]))
    peak = hertz * max(0.0, -(14e-9 + A0 * solved.y[0].min())) ** 1.5
    assert found.amplitude / A0 == pytest.approx(abs(locked), abs=1e-3)
    assert found.phase == pytest.approx(np.angle(locked), abs=2e-3)
    assert found.peak_force == pytest.approx(peak, rel=2e-3)


def test_both_motions_keep_the_energy_of_one_harmonic() -> None:
    """E = (pi k A^2/Q) ((A0/A) sin phi - 1) (Cleveland 1998), without loss sin phi = A/A0; one motion attracts, one
    repels."""
    steady = nt.Steady(dry().plan(), rig(quality=400.0), tip_drive(), accuracy=0.3)
    curve = steady.curve()
    between = ~curve.stable & (curve.amplitude > 0.5 * A0)
    assert between.any()
    height = float(np.mean(curve.base_height[between]))
    motions = steady.at_height(height), steady.at_height(height, lifted=True)
    for motion, attracts in zip(motions, (True, False), strict=True):
        assert motion is not None
        assert (motion.phase > math.pi / 2) == attracts
        A = motion.amplitude
        loss = math.pi * K * A**2 / 400.0 * (A0 / A * math.sin(motion.phase) - 1.0)
        assert motion.tip_loss == pytest.approx(loss, abs=2e-3 * math.pi * K * A**2 / 400.0)
        truth = nt.Tapping(steady.plan, steady.rig, steady.drive).settle(height, motion.state).value
        assert truth.phase == pytest.approx(motion.phase, abs=0.02)


def wavy() -> tuple[nt.Scene, nt.Surface]:
    x = np.arange(64) / 64 * 1e-6
    wave = images.Topography(np.tile(5e-9 * np.cos(2e6 * np.pi * x), (64, 1)), (x[1], x[1]))
    return dry(), nt.Surface.touched_by(dry(), wave)


@pytest.mark.parametrize("mode", ["tapping", "phase"])
def test_a_steady_image_is_that_of_a_slow_scan(mode: Any) -> None:
    scene, surface = wavy()
    settings = nt.Scan(
        zloop={"mode": mode, "noise": 0.0, "rate": 20e3},
        raster={"width": 0.9e-6, "height": 0.1e-6, "pixels": 32, "lines": 2, "line_rate": 0.5, "tilt_y": 0.05},
    )
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig())
    image, scanned = scanner.steady(0.3), scanner.run()
    lag = scanner.speed * 2e6 * np.pi * 5e-9 / scanner.integral
    assert np.abs(image.trace.height - scanned.trace.height)[:, 2:-2].max() < 2.0 * lag + 0.1e-9
    assert image.trace.peak_force[:, 2:-2] == pytest.approx(scanned.trace.peak_force[:, 2:-2], rel=0.1)
    more = scanner.steady(0.02)
    assert np.abs(more.trace.height - image.trace.height).max() < 0.1e-9
    assert np.array_equal(scanner.steady(0.3, threads=1).trace.height, image.trace.height)


def test_what_has_no_steady_motion_is_told() -> None:
    soft = nt.Steady(dry().plan(), rig(), tip_drive())
    assert soft.at_amplitude(1.5 * A0) is None
    with pytest.raises(InvalidValue, match="accuracy = 0: valid is 1e-6"):
        nt.Steady(dry().plan(), rig(), accuracy=0.0)
    contact = nt.Scanner(dry().plan(), nt.Scan(zloop={"mode": "contact"}), rig())
    with pytest.raises(InvalidValue, match=r"zloop\.mode = contact"):
        contact.steady()
    wet = nt.Scene(
        tip={"radius": 20e-9}, sample={"youngs_modulus": 1e9}, medium={"relative_humidity": 0.5}
    )  # fmt: skip
    settings = nt.Scan(raster={"pixels": 4, "lines": 1}, zloop={"set_amplitude": 0.9})
    small = nt.Drive(drive={"free_amplitude": 16e-9})
    scanner = nt.Scanner(wet.plan(), settings, rig(spring_constant=2.4, quality=239.0), small)
    with pytest.raises(SolverError, match="line 0, pixel 0: no motion of the set point repeats"):
        scanner.steady()


def test_a_branch_goes_on_below_the_gap_of_capture() -> None:
    """On mica contact takes hold at a gap with next to no loss: lowered in small steps by the time domain the lever
    stays attracted below it, and so it does here."""
    scene, rig = nt.presets.mica_in_air()
    steady = nt.Steady(scene.plan(), rig, accuracy=0.05)
    heights = np.arange(17.5e-9, 13.5e-9, -0.25e-9)
    swept = nt.Tapping(scene.plan(), rig, tolerance=1e-8).sweep([19e-9, 18.5e-9, 18e-9, *heights])[3:]
    capture = scene.plan().explain()["capture_gap"]
    assert swept[0].value.lowest_gap > capture > swept[-1].value.lowest_gap
    for height, truth in zip(heights, swept, strict=True):
        found = steady.at_height(float(height))
        assert found is not None
        assert found.phase == pytest.approx(truth.value.phase, abs=0.01)
        assert abs(found.amplitude - truth.value.amplitude) <= found.amplitude_bound
