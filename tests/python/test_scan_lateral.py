# SPDX-License-Identifier: BSD-3-Clause
"""What a scan shows beside heights: friction there and back, noise, forces on flanks; and a scan through the hal."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import images, lateral, scan
from nanotouch.errors import DeviceError, InvalidValue


def rubbed() -> nt.Scene:
    return nt.Scene(
        tip={"radius": 20e-9}, sample={"youngs_modulus": 10e9}, medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        friction={"coefficient": 0.2, "shear_strength": 0.0},
    )  # fmt: skip


def rig(**probe: Any) -> nt.Rig:
    lever: Any = {"spring_constant": 8.0, "quality": 200.0, "resonance": 300e3} | probe
    return nt.Rig(probe=lever, stage={"resonance": 20e3, "quality": 5.0})


def contact(**raster: Any) -> nt.Scan:
    return nt.Scan(
        zloop={"mode": "contact", "set_force": 50e-9, "rate": 20e3, "noise": 0.0},
        raster={"width": 1e-6, "height": 1e-6, "pixels": 64, "lines": 2, "line_rate": 1.0} | raster,
    )


def test_friction_turns_with_the_direction_on_a_tilted_sample() -> None:
    """There mu F + F slope, back -mu F + F slope: the friction loop, mu back from it within 2 %."""
    scene = rubbed()
    image = nt.Scanner(scene.plan(), contact(tilt_x=0.02), rig()).run()
    there, back = image.trace.lateral[:, 8:-8], image.retrace.lateral[:, 8:-8]
    assert 0.5 * (there - back) == pytest.approx(0.2 * 50e-9, rel=0.02)
    assert 0.5 * (there + back) == pytest.approx(0.02 * 50e-9, rel=0.1)
    found = lateral.image(there, back, 50e-9)
    assert found.coefficient == pytest.approx(0.2, rel=0.02)


def test_read_outs_take_from_each_other() -> None:
    """Lateral and normal forces as they are read are a matrix times those that act: what is taken off by the same
    matrix is the friction of the load that acts. On a stiff flat."""
    per_normal, per_lateral, mu, kept = 0.15, 0.2, 0.2, 50e-9
    settings = contact()
    settings.readout.lateral_per_normal, settings.readout.normal_per_lateral = per_normal, per_lateral
    image = nt.Scanner(rubbed().plan(), settings, rig()).run()
    removed = lateral.Crosstalk(per_normal, 0.0, per_lateral)
    load = []
    for way, sign in ((image.trace, 1.0), (image.retrace, -1.0)):
        seen = 8.0 * way.signal[:, 8:-8]
        assert seen == pytest.approx(kept, rel=1e-3)  # the loop keeps what it reads
        normal, sideways = removed.remove(seen, way.lateral[:, 8:-8])
        assert normal == pytest.approx(kept / (1.0 + sign * mu * per_lateral), rel=1e-3)
        assert sideways == pytest.approx(sign * mu * normal, rel=1e-3)
        assert way.peak_force[:, 8:-8] == pytest.approx(normal, rel=1e-3)
        load.append(normal.mean())
    apart = (image.trace.height - image.retrace.height)[:, 8:-8].mean()
    radius, modulus = 20e-9, rubbed().plan().explain()["effective_modulus"]
    depth = [(0.75 * force / (modulus * math.sqrt(radius))) ** (2.0 / 3.0) for force in load]  # Hertz
    bend = (load[1] - load[0]) / 8.0
    assert apart == pytest.approx(bend + depth[1] - depth[0], rel=0.02)  # less load there: the base is higher


def test_noise_of_the_lateral_read_out() -> None:
    """A pixel is the mean of its ticks: sigma over the root of their number, within 4 standard errors; the loop of z
    does not see it."""
    settings, quiet = contact(), contact()
    settings.readout.lateral_noise = 1e-9
    plan = rubbed().plan()
    noisy, calm = nt.Scanner(plan, settings, rig()).run(), nt.Scanner(plan, quiet, rig()).run()
    assert np.array_equal(noisy.trace.height, calm.trace.height)
    apart = np.concatenate([(noisy.trace.lateral - calm.trace.lateral), (noisy.retrace.lateral - calm.retrace.lateral)])
    ticks = 0.5 * 20e3 / 64
    assert np.std(apart) == pytest.approx(1e-9 / math.sqrt(ticks), rel=4.0 / math.sqrt(2.0 * apart.size))


def test_a_session_reads_what_its_slave_shows() -> None:
    session = nt.Session(nt.Scene(), surface=nt.Surface.touched_by(nt.Scene(), nt.surface.dots()), mode="topography",
                         path=[(0.2e-6, 0.2e-6), (0.4e-6, 0.2e-6)])  # fmt: skip
    settings = contact(line_rate=0.5)
    settings.readout.lateral_noise = 1e-9
    with pytest.raises(InvalidValue, match=r"readout\.lateral_noise = 1e-09: of the simulated scanner"):
        nt.raster.image(session, settings)


def test_shear_strength_shows_the_area() -> None:
    """tau pi a^2 with Hertz' a at the set force."""
    scene = rubbed()
    scene.friction.coefficient, scene.friction.shear_strength = 0.0, 50e6
    plan = scene.plan()
    image = nt.Scanner(plan, contact(), rig()).run()
    radius = (0.75 * 50e-9 * 20e-9 / plan.explain()["effective_modulus"]) ** (1.0 / 3.0)
    half = 0.5 * (image.trace.lateral - image.retrace.lateral)[:, 8:-8]
    assert half == pytest.approx(50e6 * math.pi * radius**2, rel=0.02)


def test_lateral_channels_are_in_the_file(tmp_path: Path) -> None:
    pytest.importorskip("gwyfile")
    image = nt.Scanner(rubbed().plan(), contact(lines=4), rig()).run()
    image.write(tmp_path / "scan.gwy")
    names = {channel.name for channel in images.channels(tmp_path / "scan.gwy")}
    assert {"Lateral force", "Lateral force retrace"} <= names
    taps = nt.Scanner(rubbed().plan(), nt.Scan(raster={"pixels": 4, "lines": 1, "line_rate": 50.0}), rig()).run()
    assert not taps.trace.lateral.any()


@pytest.mark.parametrize("mode", ["contact", "tapping", "phase"])
def test_the_noise_of_the_heights(mode: Any) -> None:
    """Standard deviation on a flat as told, within 15 %."""
    settings = nt.Scan(
        zloop={"mode": mode, "set_force": 50e-9, "rate": 50e3, "noise": 20e-12},
        raster={"width": 1e-6, "height": 1e-6, "pixels": 512, "lines": 8, "line_rate": 1.0},
    )
    scene = rubbed()
    scene.sample.youngs_modulus = 100e9
    scanner = nt.Scanner(scene.plan(), settings, rig(spring_constant=0.5 if mode == "contact" else 40.0))
    heights = scanner.run().trace.height[:, 32:]
    assert float(heights.std()) == pytest.approx(scanner.noise, rel=0.15)


@pytest.mark.parametrize("mode", ["contact", "tapping"])
def test_the_force_up_a_flank_is_forecast(mode: Any) -> None:
    """A ramp up and down of slope 0.1 at a speed that lags by a nanometre: largest force of the scan within 15 %."""
    x = np.arange(128) / 128 * 1e-6
    ramp = images.Topography(np.tile(0.1 * np.minimum(x, 1e-6 - x), (8, 1)), (x[1], x[1]))
    scene = rubbed()
    surface = nt.Surface.touched_by(scene, ramp)
    settings = nt.Scan(
        zloop={"mode": mode, "set_force": 50e-9, "rate": 50e3, "noise": 0.0},
        raster={"x": 0.1e-6, "width": 0.35e-6, "height": 10e-9, "pixels": 32, "lines": 1, "line_rate": 1.0},
    )
    plan, lever = scene.plan(0.1, surface=surface), rig(spring_constant=8.0 if mode == "contact" else 40.0)
    slow = nt.Scanner(plan, settings, lever)
    settings["raster.line_rate"] = slow.integral * 1e-9 / 0.1 / 0.7e-6
    scanner = nt.Scanner(plan, settings, lever)
    told = scan.forecast(scanner, scene, surface)
    force = scanner.run().trace.peak_force[0, 16:].max()
    assert told.flank_force == pytest.approx(force, rel=0.15)
    assert told.flank_force > (1.05 if mode == "contact" else 1.0) * told.motions[0].peak_force
    assert "up that slope" in str(told)
    assert "keeps the tip at the surface" in str(told)


def test_the_force_in_a_hollow_is_forecast() -> None:
    """Tapping in a groove, as wide a contact as that of a tip twice as large: largest force of a slow scan within 5 %,
    beyond those over a flat and up the flanks."""
    x = np.arange(128) / 128 * 400e-9
    groove = images.Topography(np.tile(12e-9 * np.cos(2e7 * np.pi * x), (64, 1)), (x[1], x[1]))
    scene = rubbed()
    surface = nt.Surface.touched_by(scene, groove)
    settings = nt.Scan(
        zloop={"noise": 0.0},
        raster={"x": 0.1e-6, "y": 0.1e-6, "width": 0.2e-6, "height": 10e-9, "pixels": 64, "lines": 1, "line_rate": 0.1},
    )
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), settings, rig(spring_constant=40.0))
    told = scan.forecast(scanner, scene, surface)
    force = scanner.run().trace.peak_force[0].max()
    assert told.hollow_force == pytest.approx(force, rel=0.05)
    assert told.hollow_force > 1.1 * max(told.flank_force, told.motions[0].peak_force)
    assert "in the narrowest one" in str(told)


def test_a_scan_through_the_hal() -> None:
    """Contact mode by a session on the simulated rig, with its noise, stage and supervisor: what the tip sees."""
    x = np.arange(64) / 64 * 2e-6
    wave = images.Topography(np.tile(20e-9 * np.cos(1e6 * np.pi * x), (64, 1)), (x[1], x[1]))
    scene = rubbed()
    surface = nt.Surface.touched_by(scene, wave)
    session = nt.Session(scene, surface=surface, mode="topography", path=[(0.5e-6, 0.5e-6), (1.5e-6, 0.5e-6)])
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 50e-9},
        raster={"x": 0.5e-6, "y": 0.5e-6, "width": 1e-6, "height": 0.2e-6, "pixels": 32, "lines": 2, "line_rate": 0.5},
    )
    image = nt.raster.image(session, settings)
    expected = np.asarray(surface.height(0.5e-6 + np.arange(32) / 32 * 1e-6, 0.5e-6))
    for channels in image[:2]:
        found = channels.height - channels.height.mean(axis=1, keepdims=True) - (expected - expected.mean())
        assert np.abs(found[:, 2:-2]).max() < 2e-9
        assert channels.peak_force.max() < 75e-9
    settings["raster.line_rate"] = 1000.0
    with pytest.raises(InvalidValue, match="valid is up to"):
        nt.raster.image(session, settings)


def test_phase_feedback_through_the_hal() -> None:
    """On the simulated slave: what the tip sees, with the lag that is held; a session that holds something else is
    refused."""
    x = np.arange(64) / 64 * 2e-6
    wave = images.Topography(np.tile(10e-9 * np.cos(1e6 * np.pi * x), (64, 1)), (x[1], x[1]))
    scene = rubbed()
    surface = nt.Surface.touched_by(scene, wave)
    lever: Any = {"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3}
    tapping = nt.Rig(probe=lever, stage={"axes": 3})
    scan_of: Any = {"x": 0.5e-6, "y": 0.5e-6, "width": 1e-6, "height": 0.1e-6, "pixels": 32, "lines": 1}
    settings = nt.Scan(zloop={"mode": "phase", "set_phase": 0.8}, raster=scan_of | {"line_rate": 0.25})

    def session(hold: str) -> nt.Session:
        wanted = nt.Settings.for_rig(tapping)
        wanted["tap.hold"] = hold
        path = [(0.5e-6, 0.5e-6), (1.5e-6, 0.5e-6)]
        return nt.Session(scene, tapping, settings=wanted, surface=surface, mode="tapping", path=path)

    image = nt.raster.image(session("phase"), settings)
    expected = np.asarray(surface.height(0.5e-6 + np.arange(32) / 32 * 1e-6, 0.5e-6))
    for channels in image[:2]:
        found = channels.height[0] - channels.height[0].mean() - (expected - expected.mean())
        assert np.abs(found[2:-2]).max() < 1e-9
        assert channels.phase[0, 2:-2] == pytest.approx(0.8, abs=0.05)
        assert channels.signal[0].mean() == pytest.approx(20e-9 * math.sin(0.8), rel=0.05)
    with pytest.raises(InvalidValue, match=r"tap\.hold = amplitude"):
        nt.raster.image(session("amplitude"), settings)


class Bench(nt.hal.Slave):
    """A device of one's own: a stage with x and y, and a lever of 8 N/m that a hard staircase pushes up."""

    fails_at = math.inf

    def open(self, host: Any) -> None:
        self.at, self.reads = np.zeros(3), 0

    def read(self) -> nt.hal.Reading:
        self.reads += 1
        ground = 10e-9 if self.at[0] > 1e-6 else 0.0
        deflection = max(0.0, float(self.at[2]) - 0.1e-6 + ground) + 1e-11 * math.sin(1.7 * self.reads)
        felt = math.nan if self.reads > self.fails_at else deflection
        return nt.hal.Reading(position=self.at, felt=(math.nan, math.nan, felt))

    def write(self, action: nt.hal.Action) -> None:
        self.at = np.array(action.target)


def test_a_scan_on_a_device_of_ones_own() -> None:
    """The same call with another slave half finds its step of 10 nm; where its sensor fails, it is told."""
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 50e-9},
        raster={"x": 0.6e-6, "y": 0.5e-6, "width": 0.8e-6, "height": 1e-7, "pixels": 16, "lines": 1, "line_rate": 0.5},
    )
    for fails_at in (math.inf, 15_000):
        slave = Bench()
        slave.fails_at = fails_at
        session = nt.Session(rubbed(), mode="topography", path=[(0.5e-6, 0.5e-6), (1.5e-6, 0.5e-6)], slave=slave)
        if math.isinf(fails_at):
            image = nt.raster.image(session, settings)
            for channels in image[:2]:
                assert channels.height[0, 12] - channels.height[0, 3] == pytest.approx(10e-9, abs=0.2e-9)
                assert channels.signal[0, 12] == pytest.approx(50e-9 / 8.0, rel=0.05)
        else:
            with pytest.raises(DeviceError, match="the supervisor went to"):
                nt.raster.image(session, settings)
