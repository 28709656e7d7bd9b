# SPDX-License-Identifier: BSD-3-Clause
"""Tapping through the hal: the same call on the simulated slave, on a device of one's own, and ``nanotouch scan``
with a rig file. The lever of that device is not ours: its amplitude is its height above a staircase."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import rig_file
from nanotouch.errors import DeviceError, Error, InvalidValue
from nanotouch_app.common import scenes
from nanotouch_app.main import main

FILE = Path(__file__).parents[2] / "docs/examples/rig/tapping.toml"
RASTER = ["--area", "0.6um,0.5um,0.8um,0.1um", "--pixels", "16", "--lines", "4"]


class Stairs(nt.hal.Slave):
    """A stage with x and y and a lever that taps on a staircase of 10 nm, 0.1 um below where it starts."""

    gain, fails_at, lasts, dies_at = 1.0, math.inf, math.inf, math.inf

    def open(self, host: Any) -> None:
        self.at, self.reads, self.drive, self.amplitude = np.zeros(3), 0, 0.0, 0.0
        self.asked: list[tuple[float, float]] = []

    def describe(self) -> nt.hal.Capabilities:
        return nt.hal.Capabilities(axes=3, feels=True, taps=True)

    def read(self) -> nt.hal.Reading:
        self.reads += 1
        ground = 10e-9 if self.at[0] > 1e-6 else 0.0
        drive = self.drive if self.reads < self.lasts else 0.0
        gap = 0.1e-6 - float(self.at[2]) - ground
        self.amplitude += 0.5 * (min(self.gain * drive, max(gap, 0.0)) - self.amplitude)
        noise = 2e-11 * math.sin(1.7 * self.reads)
        free = self.gain * drive  # a contact without loss: sin(lag) = A/A0
        lag = math.asin(min(self.amplitude / free, 1.0)) if free > 0.0 else 0.5 * math.pi
        amplitude = math.nan if self.reads > self.fails_at else self.amplitude + noise
        amplitude = amplitude if self.reads < self.dies_at else 12e-9
        felt = (math.nan, math.nan, max(-gap, 0.0) + 1e-11 * math.sin(2.3 * self.reads))
        return nt.hal.Reading(position=self.at, felt=felt, amplitude=amplitude, lag=lag)

    def write(self, action: nt.hal.Action) -> None:
        self.at = np.array(action.target)
        self.drive = action.drive_amplitude
        self.asked.append((action.drive_amplitude, action.drive_frequency))


def tapping_rig() -> nt.Rig:
    return nt.Rig(probe={"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3}, stage={"axes": 3})


def opened(slave: nt.hal.Slave | None, **given: Any) -> nt.Session:
    scene = nt.Scene(tip={"radius": 10e-9}, medium={"relative_humidity": 0.0})
    path = [(0.5e-6, 0.5e-6), (1.5e-6, 0.5e-6)]
    return nt.Session(scene, tapping_rig(), mode="tapping", path=path, slave=slave, **given)


def scan(mode: str = "tapping") -> nt.Scan:
    raster = {"x": 0.6e-6, "y": 0.5e-6, "width": 0.8e-6, "height": 1e-7, "pixels": 16, "lines": 1, "line_rate": 0.5}
    return nt.Scan(zloop={"mode": mode, "set_amplitude": 0.6}, raster=raster)


def test_a_device_of_ones_own() -> None:
    slave = Stairs()
    image = nt.raster.image(opened(slave), scan())
    for channels in image[:2]:
        assert channels.height[0, 12] - channels.height[0, 3] == pytest.approx(10e-9, abs=0.2e-9)
        assert channels.signal[0, 12] == pytest.approx(12e-9, rel=0.02)
        assert channels.phase[0, 12] == pytest.approx(math.asin(0.6), abs=0.02)
        assert np.isnan(channels.peak_force).all()
    assert image.mode == "tapping"
    assert set(slave.asked[-100:]) == {(20e-9, 300e3)}


def test_the_simulated_slave() -> None:
    """Over a staircase of its own, with the lever of the slow flow; beside the scanner's steady image of the same."""
    scene = nt.Scene(tip={"radius": 10e-9}, medium={"relative_humidity": 0.0})
    heights = 10e-9 * np.sin(2.0 * np.pi * np.arange(64) / 64) * np.ones((16, 1))
    surface = nt.Surface(heights, pixel_size=(1e-6 / 64, 1e-6 / 64))
    raster = {"x": 0.1e-6, "y": 0.1e-6, "width": 0.8e-6, "height": 1e-8, "pixels": 16, "lines": 1, "line_rate": 0.2}
    settings = nt.Scan(zloop={"mode": "tapping", "set_amplitude": 0.7}, raster=raster)
    session = nt.Session(
        scene, tapping_rig(), surface=surface, mode="tapping", path=[(0.1e-6, 0.1e-6), (0.9e-6, 0.1e-6)]
    )
    image = nt.raster.image(session, settings)
    there = nt.Scanner(session.plan, settings, session.rig, nt.Drive()).steady(0.1).trace
    seen, steady = (h[0] - h[0].mean() for h in (image.trace.height, there.height))
    assert np.ptp(steady) > 15e-9
    assert np.abs(seen - steady).max() < 0.5e-9  # noise of the read-out, and the servo's lag on the slope
    assert np.degrees(image.trace.phase.mean()) == pytest.approx(np.degrees(there.phase.mean()), abs=3.0)


@pytest.mark.parametrize(("attribute", "value"), [("fails_at", 15_000), ("lasts", 15_000)])
def test_what_fails_ends_the_scan(attribute: str, value: int) -> None:
    slave = Stairs()
    setattr(slave, attribute, value)
    with pytest.raises(DeviceError, match="the supervisor went to"):
        nt.raster.image(opened(slave), scan())


def test_an_amplifier_that_dies_at_the_set_point_ends_the_scan() -> None:
    """z then stands still; that x goes on tells it."""
    slave = Stairs()
    slave.dies_at = 15_000
    with pytest.raises(DeviceError, match="sensor stuck"):
        nt.raster.image(opened(slave), scan())


@pytest.mark.parametrize("gain", [0.0, 0.5, 1.2, math.nan])
def test_another_free_amplitude_is_refused(gain: float) -> None:
    slave = Stairs()
    slave.gain = gain
    with pytest.raises(Error, match="free amplitude as measured"):
        opened(slave)


def test_what_does_not_tap_is_refused() -> None:
    class Mute(Stairs):
        def describe(self) -> nt.hal.Capabilities:
            return nt.hal.Capabilities(axes=3, feels=True)

    with pytest.raises(Error, match="no lock-in amplifier"):
        opened(Mute())
    with pytest.raises(InvalidValue, match=r"probe\.quality"):
        nt.Session(rig=nt.Rig(probe={"quality": 5.0}), mode="tapping", path=[(0.0, 0.0), (1e-7, 0.0)])
    session = opened(Stairs())
    with pytest.raises(InvalidValue, match="topography with"):
        nt.raster.image(session, scan("contact"))
    with pytest.raises(Error, match="mode"):
        session.set_mode("point")
    with pytest.raises(Error, match=r"tap\.free_amplitude"):
        session.change("settings", "tap.free_amplitude", 10e-9)


def test_a_recording_is_replayed() -> None:
    recording = opened(None).run(0.2, operator=[nt.Input(0.0, 0.5e-6, 0.5e-6, 0.2)])
    again = recording.replay()
    assert recording.amplitude[-1] == pytest.approx(14e-9, abs=1e-9)
    for name in ("stage_command", "state", "reasons"):
        assert np.array_equal(getattr(again, name), getattr(recording, name))


# --- the rig file ---


def test_the_file_of_the_docs() -> None:
    file = rig_file.read(FILE)
    assert isinstance(file.slave, rig_file.Converters)
    assert file.slave.setup["driven"][3]["gain"] == pytest.approx(20e-9)
    assert file.slave.setup["driven"][4] is None
    assert [one["gain"] for one in file.slave.setup["lock_in"]] == pytest.approx([10e-9, -0.314159])
    assert file.rig["tap"]["noise_m"] == pytest.approx(30e-12)
    assert file.rig["tap"]["resolution_m"] == pytest.approx(200e-9 / 65536, rel=1e-3)


@pytest.mark.parametrize(
    ("table", "change", "words"),
    [
        ("lag", None, "amplitude and lag"),
        ("amplitude", None, "amplitude and lag"),
        ("amplitude", {"gain_nm_per_V": None}, r"\[slave\.amplitude\] gain is missing"),
        ("amplitude", {"gain_nm_per_V": None, "gain_rad_per_V": 1.0}, r"\[slave\.amplitude\]"),
        ("amplitude", {"channel": 5}, r"\[slave\.amplitude\] and \[slave\.lag\] are the same wire"),
        ("amplitude", {"chip": "dac", "channel": 3}, "channels of an ADC"),
        ("amplitude", {"channel": 9}, "channel"),
        ("amplitude", {"maximum_nm": 900}, "maximum"),
        ("lag", {"calibrated": None}, "calibrated is missing"),
        ("drive_amplitude", {"minimum_nm": 5}, "switches it off"),
        ("drive_amplitude", {"chip": "adc", "channel": 7}, "channels of a DAC"),
        ("drive_amplitude", {"channel": 2}, "are the same wire"),
        ("drive_amplitude", {"gain_nm_per_V": 0}, "gain"),
    ],
)
def test_what_is_wrong_is_named(table: str, change: dict[str, Any] | None, words: str) -> None:
    given = tomllib.loads(FILE.read_text())
    if change is None:
        del given["slave"][table]
    else:
        new = given["slave"][table] | change
        given["slave"][table] = {key: value for key, value in new.items() if value is not None}
    with pytest.raises(InvalidValue, match=words):
        rig_file.from_tables(given)


def test_a_drive_is_the_slaves() -> None:
    given = tomllib.loads(FILE.read_text())
    given["master"] = {"backend": "spidev", "amplitude": given["slave"]["amplitude"]}
    with pytest.raises(InvalidValue):
        nt.Rig.from_tables(rig_file.from_tables(given).rig)


# --- the command ---


@pytest.fixture
def device(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> type[Stairs]:
    """The rig file of the docs, whose slave is played by a device in Python."""
    (tmp_path / "rig.toml").write_text(FILE.read_text() + "\n[medium]\nrelative_humidity_percent = 0\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(scenes, "real_halves", lambda *_: {"slave": Stairs()})
    monkeypatch.setattr(Stairs, "gain", 1.0)
    return Stairs


def test_the_command_scans(device: type[Stairs], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scan", "--scene", "rig.toml", *RASTER, "--out", "out"]) == 0
    told = capsys.readouterr().out
    assert "an amplitude of 14 nm is held" in told
    assert "each tap presses with" in told
    height = nt.images.read("out/scan.gwy", channel="Height").heights
    assert height[0, 12] - height[0, 3] == pytest.approx(10e-9, abs=0.3e-9)
    amplitude = nt.images.read("out/scan.gwy", channel="Amplitude").heights
    assert amplitude[0, 12] == pytest.approx(14e-9, rel=0.02)
    with pytest.raises(Error):
        nt.images.read("out/scan.gwy", channel="Peak force")
    assert json.loads(Path("out/scan.json").read_text())["peak_force"] is None


@pytest.mark.usefixtures("undrawn")
def test_the_command_holds_a_phase(device: type[Stairs], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scan", "--scene", "rig.toml", *RASTER, "--mode", "phase", "--out", "out"]) == 0
    assert "a phase of 45 degrees is held" in capsys.readouterr().out
    height = nt.images.read("out/scan.gwy", channel="Height").heights
    assert height[0, 12] - height[0, 3] == pytest.approx(10e-9, abs=0.3e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["--steady"], "scans in time"),
        (["--mode", "contact", "--free-amplitude", "10nm"], "goes with --mode tapping"),
        (["--gain", "20kHz"], "amplitude servo|height_gain|margin"),
        (["--set-point", "0.05"], "set_amplitude"),
    ],
)
def test_the_command_refuses(
    device: type[Stairs], given: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["scan", "--scene", "rig.toml", *RASTER, *given]) == 2
    assert re.search(words, capsys.readouterr().err)


def test_the_command_refuses_another_drive(
    device: type[Stairs], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(Stairs, "gain", 0.7)
    assert main(["scan", "--scene", "rig.toml", *RASTER]) == 2
    assert "free amplitude as measured" in capsys.readouterr().err


def test_a_rig_file_without_a_lock_in_amplifier(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = FILE.parent / "rig.toml"
    assert main(["scan", "--scene", str(file), "--mode", "tapping"]) == 2
    assert "no [slave.amplitude] and [slave.lag]" in capsys.readouterr().err
