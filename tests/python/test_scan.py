# SPDX-License-Identifier: BSD-3-Clause
"""Scans: the slow flow beside the time domain, images beside the surface, the 480 nm grating, its file."""

from __future__ import annotations

import math
import shutil
import subprocess
from pathlib import Path
from typing import Any, Literal

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import images, scan
from nanotouch.errors import InvalidValue, SolverError

LEVER: Any = {"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3}
FAST: Any = {"resonance": 20e3, "quality": 5.0}


def dry(radius: float = 10e-9) -> nt.Scene:
    return nt.Scene(
        tip={"radius": radius}, sample={"youngs_modulus": 10e9}, medium={"relative_humidity": 0.0}
    )  # fmt: skip


def rig(**probe: Any) -> nt.Rig:
    lever: Any = LEVER | probe
    return nt.Rig(probe=lever, stage=FAST)


def test_the_slow_flow_is_that_of_the_time_domain() -> None:
    plan = nt.Scene(tip={"radius": 10e-9}).plan()
    flow, tapping = nt.SlowFlow(plan, rig()), nt.Tapping(plan, rig())
    _, value, settled = flow.settle(14e-9)
    truth = tapping.settle(14e-9).value
    assert settled
    assert value.amplitude == pytest.approx(truth.amplitude, abs=2.0 * 20e-9 / 200.0)
    assert value.peak_force == pytest.approx(truth.peak_force, rel=0.15)
    with pytest.raises(InvalidValue, match="time = 0 s"):
        flow.step(flow.free(), 14e-9, 0.0)


def test_the_amplitude_grows_as_a_free_oscillator_does() -> None:
    """1 - exp(-w0 t/2 Q), closed form."""
    scene = dry()
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    flow = nt.SlowFlow(scene.plan(), rig(), nt.Drive(drive={"at": "tip"}))
    state, time = scan.FlowState(0.0, -1e-13), 1.3 * 2.0 * 200.0 / (2.0 * math.pi * 300e3)
    for _ in range(10):
        state, _ = flow.step(state, 1e-6, 0.1 * time)
    assert math.hypot(*state[:2]) == pytest.approx(20e-9 * -math.expm1(-1.3), rel=1e-4)


@pytest.mark.parametrize("mode", ["contact", "tapping", "phase"])
def test_a_slow_image_is_the_surface(mode: Literal["contact", "tapping", "phase"]) -> None:
    """A wave of 5 nm over 1 um, with tilt: trace and retrace are what the tip sees, to the loop's lag, v s/K_I."""
    x = np.arange(64) / 64 * 1e-6
    wave = images.Topography(np.tile(5e-9 * np.cos(2e6 * np.pi * x), (64, 1)), (x[1], x[1]))
    scene = dry()
    surface = nt.Surface.touched_by(scene, wave)
    settings = nt.Scan(
        zloop={"mode": mode, "noise": 0.0, "set_force": 20e-9, "rate": 20e3},
        raster={"width": 0.9e-6, "height": 0.1e-6, "pixels": 32, "lines": 2, "line_rate": 2.0, "tilt_y": 0.05},
    )
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig())
    image = scanner.run()
    at = np.arange(32) * 0.9e-6 / 32
    y = np.arange(2) * 0.05e-6
    expected = np.asarray(surface.height(at[None, :], y[:, None])) + 0.05 * y[:, None]
    lag = scanner.speed * 2e6 * np.pi * 5e-9 / scanner.integral
    for channels in image[:2]:
        found = channels.height - channels.height.mean() - (expected - expected.mean())
        assert np.abs(found[:, 2:-2]).max() < 2.0 * lag + 0.1e-9
    reading = {
        "contact": image.trace.signal * 40.0 / 20e-9,
        "tapping": image.trace.signal / 14e-9,
        "phase": image.trace.phase / (math.pi / 4.0),
    }[mode]
    assert reading[:, 4:] == pytest.approx(1.0, abs=0.1)


def test_what_does_not_depend_on_the_cores() -> None:
    settings = nt.Scan(raster={"pixels": 8, "lines": 150, "line_rate": 50.0}, zloop={"rate": 20e3})
    scanner = nt.Scanner(dry().plan(), settings, rig())
    one, two = scanner.run(7, threads=1), scanner.run(7, threads=3)
    assert np.array_equal(one.trace.height, two.trace.height)
    assert not np.array_equal(one.trace.height, scanner.run(8).trace.height)


def test_hysteresis_and_drift_shift_what_is_seen() -> None:
    """Trace and retrace part by the opening of the loop in the middle, by closed form; drift shifts line after line."""
    x = np.arange(256) / 256 * 1e-6
    ridge = images.Topography(np.tile(5e-9 * np.exp(-(((x - 0.5e-6) / 50e-9) ** 2)), (16, 1)), (x[1], x[1]))
    scene = dry()
    plan = scene.plan(0.1, surface=nt.Surface.touched_by(scene, ridge))
    shared: dict[str, Any] = {"width": 1e-6, "height": 50e-9, "pixels": 250, "lines": 4, "line_rate": 1.0}
    loop: Any = {"mode": "contact", "noise": 0.0, "set_force": 20e-9, "rate": 20e3}

    def ridges(**raster: float) -> tuple[np.ndarray, np.ndarray]:
        made_of: Any = shared | raster
        image = nt.Scanner(plan, nt.Scan(zloop=loop, raster=made_of), rig()).run()
        places = (np.arange(250) + 0.5) * 4e-9
        there, back = (channels.height - channels.height.min() for channels in image[:2])
        return there @ places / there.sum(axis=1), back @ places / back.sum(axis=1)

    there, back = ridges()
    assert np.abs(there - back).max() < 3e-9
    there, back = ridges(hysteresis=0.1)
    assert (there - back).mean() == pytest.approx(0.1e-6, rel=0.05)
    there, back = ridges(drift_x=10e-9)
    assert np.diff(there) == pytest.approx(10e-9, abs=0.5e-9)
    assert (back - there).mean() == pytest.approx(5e-9, abs=3e-9)


def test_the_grating_after_our_own_levelling_and_tip_correction(tmp_path: Path) -> None:
    """480 nm, through noise, tilt and hysteresis of the scanner, from the file: the step within 1 nm, the width of the
    ridge within a pixel."""
    pytest.importorskip("gwyfile")
    pytest.importorskip("SurfaceTopography")
    scene = dry(20e-9)
    surface = nt.Surface.touched_by(scene, nt.surface.grating(size=6e-6, pixels=256))
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 100e-9, "rate": 20e3, "noise": 0.1e-9},
        raster={"width": 6e-6, "height": 6e-6, "pixels": 256, "lines": 16, "line_rate": 0.1, "tilt_x": 0.01,
                "tilt_y": -0.02, "hysteresis": 0.0},
    )  # fmt: skip
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig(spring_constant=8.0))
    tip = images.RoundedCone(20e-9, scene.tip.half_angle)
    scanner.run().write(tmp_path / "grating.gwy", tip)
    names = [channel.name for channel in images.channels(tmp_path / "grating.gwy")]
    assert {"Height", "Height retrace", "Deflection", "Error", "Peak force", scan.UNDONE} <= set(names)
    read = images.read(tmp_path / "grating.gwy")
    assert read.channel == "Height"
    level, report = images.level(read, "terraces")
    clean, _ = images.erode(level, tip)
    z = clean.heights
    top, bottom = (np.median(z[(z > z.mean()) == side]) for side in (True, False))
    assert top - bottom == pytest.approx(480e-9, abs=1e-9), report
    # near the top: beside the foot of a wall the tip does not reach, and nothing can be undone
    widths = np.count_nonzero(z > top - 30e-9, axis=1) * 6e-6 / 256
    assert np.median(widths) == pytest.approx(3e-6, abs=2 * 6e-6 / 256)  # two ridges


def test_gwyfile_and_gwyddion_read_what_a_scan_writes(tmp_path: Path) -> None:
    """Every channel by gwyfile, values and sizes as they were, the first row at the top; and Gwyddion's own reader."""
    gwyfile = pytest.importorskip("gwyfile")
    settings = nt.Scan(raster={"pixels": 12, "lines": 5, "line_rate": 50.0, "width": 60e-9, "height": 20e-9},
                       zloop={"rate": 20e3})  # fmt: skip
    image = nt.Scanner(dry().plan(), settings, rig()).run()
    path = image.write(tmp_path / "scan.gwy", images.Paraboloid(10e-9))
    held = gwyfile.util.get_datafields(gwyfile.load(str(path)))
    expected = {
        "Height": "height",
        "Amplitude": "signal",
        "Phase": "phase",
        "Error": "error",
        "Peak force": "peak_force",
    }
    for name, key in expected.items():
        for direction, channels in (("", image.trace), (" retrace", image.retrace)):
            field = held[name + direction]
            np.testing.assert_array_equal(field.data[::-1], getattr(channels, key))
            assert (field.xreal, field.yreal) == pytest.approx((60e-9, 20e-9), rel=1e-12)
            assert field.si_unit_z.unitstr == {"phase": "rad", "peak_force": "N"}.get(key, "m")
    assert set(held) == {name + way for name in expected for way in ("", " retrace")} | {scan.UNDONE}
    if gwyddion := shutil.which("gwyddion"):
        again = tmp_path / "again.gwy"
        subprocess.run([gwyddion, f"--convert-to-gwy={again}", str(path)], check=True, timeout=120)
        assert set(gwyfile.util.get_datafields(gwyfile.load(str(again)))) == set(held)


def test_the_speed_limit_of_the_grating() -> None:
    """The speed at which the loop is 1 nm behind on the steepest flank is what is told, within 20 %."""
    scene = dry(20e-9)
    surface = nt.Surface.touched_by(scene, nt.surface.grating(size=6e-6, pixels=256))
    plan = scene.plan(0.1, surface=surface)

    def made(line_rate: float) -> nt.Scanner:
        settings = nt.Scan(
            zloop={"mode": "contact", "set_force": 100e-9, "rate": 50e3, "noise": 0.0},
            raster={"x": 1.9e-6, "width": 1e-6, "height": 1e-6, "pixels": 512, "lines": 1, "line_rate": line_rate},
        )
        return nt.Scanner(plan, settings, rig(spring_constant=8.0))

    told = scan.forecast(made(1.0), scene, surface)
    rate = told.speed_limit / 2e-6
    error = np.abs(made(rate).run().trace.error[:, 16:]).max()
    assert error == pytest.approx(1e-9, rel=0.2)


def test_the_forecast_in_words() -> None:
    scene = nt.Scene(tip={"radius": 10e-9})
    scanner = nt.Scanner(scene.plan(), None, rig())
    told = scan.forecast(scanner, scene)
    words = str(told)
    for word in ("repulsive motion: peak force", "safe set point", "phase margin 45", "advice: up to"):
        assert word in words
    assert told.speed_limit == math.inf
    tapping = nt.Tapping(scene.plan(), rig())
    heights = [one.value for one in tapping.sweep(np.linspace(16e-9, 13e-9, 13))]
    truth = np.interp(0.7, [v.amplitude / 20e-9 for v in heights[::-1]], [v.peak_force for v in heights[::-1]])
    assert told.motions[0].peak_force == pytest.approx(truth, rel=0.05)


def test_the_forecast_is_of_the_motion_that_the_lever_comes_to() -> None:
    """In humid air: lowered it is attracted, lifted it taps. Beside a sweep of the time domain, each force within what
    is told."""
    scene, rig = nt.Scene(), nt.Rig()
    scanner = nt.Scanner(scene.plan(), None, rig)
    lowered, lifted = scan.forecast(scanner, scene).motions
    tapping = nt.Tapping(scene.plan(), rig, tolerance=1e-7)
    swept = tapping.sweep(np.arange(19e-9, 14e-9, -0.5e-9))  # above, it is caught now and then, and does not settle
    reached = min(swept, key=lambda one: abs(one.value.amplitude - 14e-9)).value
    assert lowered.phase == pytest.approx(reached.phase, abs=0.02)
    assert lowered.phase > math.pi / 2 > lifted.phase
    up = tapping.sweep(np.linspace(10e-9, 14e-9, 5))[-1]
    assert up.settled
    assert up.value.amplitude == pytest.approx(14e-9, abs=0.1e-9)
    assert abs(lifted.peak_force - up.value.peak_force) < lifted.force_bound + 0.005 * lifted.peak_force
    assert 0.0 < lifted.force_bound < 0.02 * lifted.peak_force


def test_no_tap_is_harder_than_forecast() -> None:
    """Over dots, where the lever goes over from one motion to the other: harder than any steady motion, within the
    bound. A set point with one motion, and an amplitude that keeps below the limit, are what they are told to be."""
    scene, rig = nt.Scene(), nt.Rig()
    scene.range.maximum_load = 400e-9
    surface = nt.Surface.touched_by(scene, nt.surface.dots())
    raster: Any = {"width": 500e-9, "height": 40e-9, "y": 200e-9, "pixels": 48, "lines": 4, "line_rate": 0.64}
    settings = nt.Scan(raster=raster)
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig)
    told = scan.forecast(scanner, scene, surface)
    image = scanner.run(9)
    reached = max(float(channels.peak_force.max()) for channels in image[:2])
    assert 1.2 * max(motion.peak_force for motion in told.motions) < reached < told.peak_bound
    assert "no harder than" in str(told)
    alone = nt.Scan(raster=raster, zloop={"set_amplitude": told.single_set_point})
    assert len(scan.forecast(nt.Scanner(scene.plan(), alone, rig), scene).motions) == 1
    assert told.safe_free_amplitude < 20e-9
    gentle = nt.Drive(drive={"free_amplitude": told.safe_free_amplitude})
    settings["raster.line_rate"] *= told.safe_free_amplitude / 20e-9
    below = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig, gentle)
    assert scan.peak_bounds(below, scene, surface)[0] <= told.force_limit < told.peak_bound
    with pytest.raises(InvalidValue, match="rise = -1 m/s"):
        scanner.peak_bound((0.0, 0.0), -1.0, 0.0)


def test_a_set_point_without_a_steady_motion_is_forecast() -> None:
    scene, rig = nt.presets.silicon_on_gold()
    told = scan.forecast(nt.Scanner(scene.plan(), None, rig), scene)
    assert "no steady motion: from tap to tap the tip is caught or not" in str(told)
    held, rig = nt.presets.polyester()
    with pytest.raises(SolverError, match="holds the tip"):
        scan.forecast(nt.Scanner(held.plan(), None, rig), held)


def test_a_steady_image_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """The amplitude is that of the set point everywhere; trace and retrace are one."""
    for module in ("gwyfile", "SurfaceTopography", "matplotlib"):
        pytest.importorskip(module)
    from nanotouch_app.main import main

    line = ["scan", "inas_dots", "--pixels", "16", "--lines", "6", "--out", str(tmp_path / "out"), "--steady"]
    assert main([*line, "10%"]) == 0
    assert "differ by 0 nm" in capsys.readouterr().out
    held = images.read(tmp_path / "out" / "scan.gwy", "Amplitude")
    assert np.all(held.heights == 14e-9)
    for wrong, word in (
        (["60%"], "valid is"),
        (["x"], "not a number"),
        (["5%", "--mode", "contact"], "in contact mode"),
    ):
        assert main([*line, *wrong, "--overwrite"]) == 2
        assert word in capsys.readouterr().err


def test_phase_feedback_wants_the_resonance() -> None:
    settings, drive = nt.Scan(zloop={"mode": "phase"}), nt.Drive(drive={"frequency": 301e3})
    with pytest.raises(InvalidValue, match=r"drive\.frequency"):
        nt.Scanner(dry().plan(), settings, rig(), drive)


def test_the_tilt_of_a_scan_is_taken_out_before_it_is_touched(tmp_path: Path, capsys: Any, undrawn: None) -> None:
    for module in ("gwyfile", "SurfaceTopography"):
        pytest.importorskip(module)
    from nanotouch_app.main import main

    file, out = tmp_path / "tilted.toml", tmp_path / "scanned"
    file.write_text("[raster]\ntilt_x = 0.05\n")
    line = ["scan", "flat", "--scene", str(file), "--mode", "contact", "--area", "0um,0um,1um,1um", "--pixels", "16",
            "--lines", "6"]  # fmt: skip
    assert main([*line, "--out", str(out)]) == 0
    assert "surface.gwy: auto levelling" in capsys.readouterr().out
    assert np.ptp(images.read(out / "scan.gwy", "Height").heights) > 40e-9
    assert np.ptp(images.read(out / "surface.gwy").heights) < 1e-9


def test_two_commands_from_scan_to_touch(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """Scan, then touch what was scanned."""
    for module in ("gwyfile", "SurfaceTopography", "matplotlib", "mcap"):
        pytest.importorskip(module)
    from nanotouch_app.main import main

    out, touched = tmp_path / "scanned", tmp_path / "touched"
    line = ["scan", "dots", "--mode", "contact", "--set-point", "100nN", "--pixels", "64", "--lines", "16"]
    assert main([*line, "--out", str(out)]) == 0
    words = capsys.readouterr().out
    told = ("safe set point", "z loop", "parachuting", f"nanotouch touch {out}/surface.gwy")
    assert all(word in words for word in told)
    assert main(["touch", str(out / "surface.gwy"), "--out", str(touched), "--no-window"]) == 0
    assert (touched / "summary.json").exists()
    found = images.read(out / "scan.gwy", "Height")
    assert found.shape == (16, 64)
    words = capsys.readouterr().out
    assert "chosen" not in words
    assert "repaired" not in words
    ready = images.read(out / "surface.gwy")
    assert ready.channel == images.READY
    assert np.array_equal(images.prepare(ready)[0].heights, ready.heights)  # touched as it was scanned
