# SPDX-License-Identifier: BSD-3-Clause
"""Calibration of a simulated rig whose numbers are known, of synthetic readings, and what it writes to a rig file."""

from __future__ import annotations

import math
import shutil
import tomllib
from pathlib import Path

import calibrations
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import rig_file
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch.touch import calibrate
from nanotouch.touch.calibrate import Driven, Value
from nanotouch.touch.hal import Action, Capabilities, Reading
from nanotouch_app.main import main
from nanotouch_app.rigs import calibrate as command

pytest.importorskip("scipy")

FILE = Path(__file__).parents[2] / "docs/examples/rig/rig.toml"
BOLTZMANN = 1.380649e-23


@pytest.fixture(scope="module")
def plan() -> nt.scene.plan.Plan:
    return nt.Scene().plan()


def test_stage_and_master_of_drawn_rigs_are_found(plan: nt.scene.plan.Plan) -> None:
    """calibrations.py has the coverage of many; here no number is off by six sigma."""
    found = calibrations.stage(1, plan, 1.0) | calibrations.master(1, plan, 1.0) | calibrations.sensitivity(3, plan)
    assert max(map(abs, found.values())) < 6.0, found


def test_a_slope_with_noise_covers_its_truth() -> None:
    """200 presses of a lever that is 3 % softer than told: the sigma is that of the scatter."""
    draw, off = np.random.default_rng(1), []
    way = np.concatenate([np.linspace(-100e-9, 100e-9, 400), np.linspace(100e-9, -100e-9, 400)])
    for _ in range(200):
        felt = np.maximum(0.0, way) / 1.03
        run = Driven(1e-3, way, way + 1e-9 * draw.standard_normal(way.size), felt, 0.0)
        off.append(calibrations.off(calibrate.contact_slope(run), 1.03))
    assert 0.85 < np.std(off) < 1.15
    assert abs(np.mean(off)) < 0.3


class Lever(nt.hal.Slave):
    """A stage that presses a lever of 0.3 N/m onto one of this stiffness, from 20 nm on."""

    def __init__(self, stiffness: float, flags: tuple[str, ...] = ()) -> None:
        self.share = stiffness / (stiffness + 0.3)
        self.travel, self.ticks, self.flags, self.lowest = 0.0, 0, flags, 0.0

    def describe(self) -> Capabilities:
        return Capabilities(axes=1, feels=True)

    def read(self) -> Reading:
        self.ticks += 1
        felt = self.share * max(0.0, self.travel - 20e-9) + 1e-12 * (self.ticks % 7)
        flags = self.flags if self.ticks > 50 else ()
        return Reading(position=(math.nan, math.nan, self.travel), felt=(math.nan, math.nan, felt), flags=flags)

    def write(self, action: Action) -> None:
        self.travel = action.target[2]

    def disarm(self) -> None:
        self.travel -= 1e-6
        self.lowest = self.travel


def pressed(lever: Lever) -> Value:
    path = np.linspace(0.0, 150e-9, 200)
    return calibrate.contact_slope(calibrate.drive(lever, path, period=1e-3, turn=50e-9, returns=True))


def test_reference_lever() -> None:
    found = calibrate.reference_lever(pressed(Lever(1e9)), pressed(Lever(0.6)), 0.6, stiffness_sigma=0.03)
    assert found.value == pytest.approx(0.3, rel=1e-3)
    assert found.sigma == pytest.approx(0.3 * 0.05, rel=0.02)
    with pytest.raises(InvalidValue, match="expected more"):
        calibrate.reference_lever(Value(1.0, 0.01, ""), Value(0.9, 0.01, ""), 0.6, stiffness_sigma=0.03)


@pytest.mark.parametrize("flag", ["emergency_stop", "limit_switch", "invalid", "saturated"])
def test_a_drive_is_stopped_and_lifts(flag: str) -> None:
    lever = Lever(0.6, (flag,))
    with pytest.raises(DeviceError, match=r"stopped after 50 periods"):
        calibrate.drive(lever, np.linspace(0.0, 10e-9, 200), period=1e-3)
    assert lever.lowest < -0.9e-6


def test_a_drive_turns_at_the_deflection() -> None:
    lever = Lever(0.6)
    run = calibrate.drive(lever, np.linspace(0.0, 1e-6, 1000), period=1e-3, turn=50e-9, returns=True)
    assert 50e-9 <= run.felt.max() < 53e-9
    assert run.told[-1] == pytest.approx(0.0, abs=2e-9)


@pytest.mark.parametrize("path", [[], [0.0], [0.0, math.nan], [[0.0, 1.0]]])
def test_a_path_that_cannot_be_is_refused(path: list[float]) -> None:
    with pytest.raises(InvalidValue, match="path"):
        calibrate.drive(Lever(1.0), path)


def spectrum(k: float, floor: float, averages: int, draw: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Of an oscillator of 0.3 N/m at 20 kHz, Q = 60, and white noise [m^2/Hz]."""
    f = np.linspace(10e3, 30e3, 800)
    mean = 2.0 * BOLTZMANN * 295.0 / (math.pi * k * 20e3 * 60.0)
    density = mean / (((f / 20e3) ** 2 - 1.0) ** 2 + (f / 20e3 / 60.0) ** 2) + floor
    return f, density * draw.gamma(averages, 1.0 / averages, f.size)


def test_thermal_motion_and_what_hides_it() -> None:
    draw, off = np.random.default_rng(2), []
    options = {"averages": 50, "temperature": 295.0, "correction": 1.0, "sensitivity_sigma": 0.0}
    for _ in range(20):
        found = calibrate.thermal(*spectrum(0.3, 1e-28, 50, draw), temperature_sigma=0.0, **options)
        off.append(calibrations.off(found, 0.3))
    assert np.sqrt(np.mean(np.square(off))) < 1.6
    wide = calibrate.thermal(*spectrum(0.3, 1e-28, 50, draw), **options | {"sensitivity_sigma": 0.02})
    assert wide.sigma > 0.04 * wide.value  # S enters squared
    with pytest.raises(InvalidValue, match="times the detector's noise"):
        calibrate.thermal(*spectrum(8.0, 1e-22, 50, draw), **options)


def test_methods_are_weighed_and_their_scatter_counts() -> None:
    both = calibrate.combined({"a": Value(1.0, 0.1, "N/m"), "b": Value(1.1, 0.1, "N/m")})
    assert both.value == pytest.approx(1.05)
    assert both.sigma == pytest.approx(0.1 / math.sqrt(2))
    apart = calibrate.combined({"a": Value(1.0, 0.1, "N/m"), "b": Value(3.0, 0.1, "N/m")})
    assert apart.sigma == pytest.approx(1.0)


# --- the file ---


def test_what_is_found_is_written_and_the_rest_stays(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    shutil.copy(FILE, path)
    sensitivity = 35.1234567890123e-9
    values = {"stage.gain": Value(0.98, 0.001, ""), "probe.sensitivity": Value(sensitivity, 0.02 * sensitivity, "m/V"),
              "stage.resonance": Value(451.0, 0.2, "Hz"), "probe.spring_constant": Value(7.5, 0.3, "N/m")}  # fmt: skip
    command.write(path, values, rig_file.read(path))
    text, found = path.read_text(), rig_file.read(path)
    assert found.slave is not None
    assert found.slave.setup["driven"][2]["gain"] == pytest.approx(0.98e-6)
    assert found.slave.setup["driven"][2]["uncertainty"] == pytest.approx(math.hypot(0.001 / 0.98, 0.005))
    assert found.slave.setup["felt"][2]["gain"] == pytest.approx(sensitivity, rel=3e-16)  # to the last digit
    rig = nt.Rig.from_tables(found.rig)
    assert rig.stage.resonance == 451.0
    assert (rig.probe.spring_constant, rig.probe.spring_constant_sigma) == pytest.approx((7.5, 0.04))
    assert (rig.probe.sensitivity, rig.probe.sensitivity_sigma) == pytest.approx((sensitivity, 0.02))
    assert "# +- 0.2 Hz, 20" in text
    assert [line for line in text.splitlines() if line.startswith("#")] == [
        line for line in FILE.read_text().splitlines() if line.startswith("#")
    ]
    calibrated = tomllib.loads(text)["slave"]
    assert calibrated["travel_z"]["calibrated"] > calibrated["position_z"]["calibrated"]


def test_the_uncertainty_of_a_channel_enters_the_guarantee(tmp_path: Path) -> None:
    promised = []
    for percent in (1, 2, 5):
        path = tmp_path / f"{percent}.toml"
        path.write_text(FILE.read_text().replace("uncertainty_percent = 2", f"uncertainty_percent = {percent}"))
        rig = nt.Rig.from_tables(rig_file.read(path).rig)
        assert rig.probe.sensitivity_sigma == pytest.approx(0.01 * percent)
        promised.append(nt.Session(rig=rig).guarantee().force)
    assert promised[0] < promised[1] < promised[2]


@pytest.mark.parametrize(("channel", "field"), [("travel_z", "travel_sigma"), ("position_z", "position_sigma")])
def test_so_does_that_of_the_stage(channel: str, field: str) -> None:
    promised = []
    for uncertainty in (0.0, 0.01, 0.1):
        tables = tomllib.loads(FILE.read_text())
        tables["slave"][channel]["uncertainty_percent"] = 100.0 * uncertainty
        rig = nt.Rig.from_tables(rig_file.from_tables(tables).rig)
        assert getattr(rig.stage, field) == pytest.approx(uncertainty)
        found = nt.Session(rig=rig, scene=nt.Scene(sample={"youngs_modulus": 1e6})).guarantee()
        promised.append(found.indentation)
    assert promised[0] < promised[1] < promised[2]


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "rig.toml"
    path.write_text("[probe]\nspring_constant_N_per_m = 0.3  # by its maker\n")
    sizes = ["--length", "225um", "--width", "28um", "--resonance", "75kHz", "--quality", "200"]
    assert main(["rig", "calibrate", str(path), "sensitivity", "sader", *sizes, "--write"]) == 0
    said = capsys.readouterr().out
    assert "probe.sensitivity: 33.0" in said
    rig = nt.Rig.from_tables(rig_file.read(path).rig)
    assert rig.probe.spring_constant == pytest.approx(2.35, rel=0.01)
    before = path.read_text()
    for arguments, words in [
        (["lever"], "job lever needs sensitivity before it"),
        (["thermal"], "--spectrum is missing"),
        (["sader"], "--length is missing"),
        (["stage", "--stroke", "1mm"], "valid is up to half of the travel"),
        (["sensitivity", "--way", "100nm"], "no contact within it"),
        (["thermal", "--spectrum", str(path), "--averages", "9"], "two columns are expected"),
    ]:
        assert main(["rig", "calibrate", str(path), *arguments, "--write"]) == 2
        assert words in capsys.readouterr().err
    assert path.read_text() == before


def test_the_sigma_of_a_slope_counts_noise_that_drifts() -> None:
    """A random walk that forgets within a fortieth of the run: taken as independent, 18 % of such slopes lie within two
    sigma."""
    n, draws, off = 2000, 100, []
    rng = np.random.default_rng(5)
    columns = np.stack([np.ones(n), np.linspace(-1.0, 1.0, n)], axis=1)
    for _ in range(draws):
        noise = np.zeros(n)
        for i, step in enumerate(rng.normal(size=n)):
            noise[i] = (1.0 - 40.0 / n) * noise[i - 1] + step
        found, sigma = calibrate._linear(columns, columns @ [0.5, 1.2] + noise, 2 * calibrate.FEW)
        off.append(abs(found[1] - 1.2) / sigma[1])
    assert np.mean(np.array(off) < 2.0) > 0.75  # sums over eight blocks scatter, too
    assert np.mean(np.array(off) < 1.0) > 0.45
