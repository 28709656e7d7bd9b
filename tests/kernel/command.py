#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`nanotouch touch` and `nanotouch scan` on a rig file in the test kernel, beside the simulated rig (run.sh).

Usage: command.py FOLDER prepare    write FOLDER/rig.toml, from the rig file of the docs, and touch the simulated one
       command.py FOLDER compare    FOLDER/real, which the kernel has recorded, beside FOLDER/simulated
       command.py FOLDER prepare-scan, compare-scan    likewise FOLDER/scan.toml and FOLDER/scanned
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import nanotouch as nt
import numpy as np
from nanotouch import record, rig_file
from nanotouch_app.main import main as nanotouch

RIG = Path(__file__).parents[2] / "docs/examples/rig/rig.toml"
SPEED, RATE = 0.1e-6, 1e3  # [m/s], [Hz]: a tick is a step of 0.1 nm
LOOP = "[gains]\nrate_kHz = 1\napproach_speed_um_per_s = 0.1\ncurve_length_nm = 80\n"
SCAN = (
    '[zloop]\nmode = "contact"\nset_force_nN = 50\n[raster]\nx_um = 0.5\ny_um = 0.5\nwidth_um = 1\nheight_um = 0.2\n'
    "pixels = 16\nlines = 4\nline_rate_Hz = 2\n"
)
RESOLUTION = 1e-9  # of the simulated stage's own read-out [m], on whose edge both may lie


def prepare(folder: Path) -> int:
    """The rig of the docs without the noise of its probe: what is left are the steps of the converters. And without
    debounce, for gpio-sim lets a request pull its lines down, as no closed switch does."""
    text = RIG.read_text().replace("[probe]\n", "[probe]\nnoise_V = 0\n").replace("debounce_ms = 2\n", "") + LOOP
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rig.toml").write_text(text)
    (folder / "simulated.toml").write_text(text.replace('"spidev"', '"simulated"'))
    given = [
        "--scene",
        str(folder / "simulated.toml"),
        "--surface",
        "flat",
        "--mode",
        "curve",
        "--no-window",
        "--no-pictures",
    ]
    return nanotouch(["touch", *given, "--out", str(folder / "simulated"), "--overwrite"])


def compare(folder: Path) -> int:
    """1 if they differ by more than a tick and the steps of the converters."""
    real, simulated = (record.read(folder / name / "recording.mcap") for name in ("real", "simulated"))
    slave = rig_file.read(folder / "rig.toml").slave
    assert isinstance(slave, rig_file.Converters)
    steps = 2.0 * (20e-6 / (2**20 - 1) + 20e-6 / 2**16)
    bend_bound = SPEED / RATE + steps
    way_bound = bend_bound + RESOLUTION
    rows = len(simulated.time)
    way = np.abs(real.stage_position - simulated.stage_position).max()
    beside = np.pad(simulated.deflection, 2, mode="edge")  # where the lever jumps, it may do so a tick apart
    bend = np.min([np.abs(real.deflection - beside[at : at + rows]) for at in range(5)], axis=0).max()
    checks = {
        "rows": len(real.time) == rows,
        "pressed and pulled": real.slave_force.max() > 90e-9 and real.slave_force.min() < -10e-9,
        "states": np.array_equal(real.state, simulated.state),
        "whole": real.phase[-1] == simulated.phase[-1] == 2,
        "travel": way <= way_bound,
        "deflection": bend <= bend_bound,
    }
    print(
        f"nanotouch touch --scene rig.toml, {rows} ticks: pressed by {real.slave_force.max() * 1e9:.1f} nN, pulled by "
        f"{-real.slave_force.min() * 1e9:.1f} nN; beside the simulated one travel within {way * 1e9:.2f} nm (steps: "
        f"{way_bound * 1e9:.2f} nm), deflection within {bend * 1e9:.2f} nm"
    )
    failed = [name for name, is_kept in checks.items() if not is_kept]
    if failed:
        print(f"not as in the simulated run: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


def prepare_scan(folder: Path) -> int:
    """A rig of three axes: an AD5686 drives x, y and z, the AD7606 reads them and the lever."""
    tables = tomllib.loads(RIG.read_text())
    probe, lines = "spring_constant_N_per_m = 8\nnoise_V = 0\n", '[slave.lines]\nemergency_stop = "estop"\n'
    chips = {"dac": ("AD5686", 0, 0, 5), "adc": ("AD7606", 1, -10, 10)}
    text = f'[probe]\n{probe}[stage]\naxes = 3\n[slave]\nbackend = "spidev"\naxes = 3\n{lines}'
    text += 'limit_switch = "limit"\nlaser_enable = "laser-en"\nwatchdog = "watchdog"\nconvert = "convert"\n'
    for name, (chip, at, low, high) in chips.items():
        text += f'[slave.chips.{name}]\nchip = "{chip}"\ndevice = "/dev/spidev0.{at}"\nclock_MHz = 10\n'
        text += f"low_V = {low}\nhigh_V = {high}\n"
    common = f"uncertainty_percent = 1\ncalibrated = {tables['slave']['travel_z']['calibrated']}\n"
    for channel, axis in enumerate("xyz"):
        ends = "minimum_um = -10\nmaximum_um = 9.999\n" + common
        text += f'[slave.travel_{axis}]\nchip = "dac"\nchannel = {channel}\ngain_um_per_V = 4\noffset_um = -10\n{ends}'
        text += f'[slave.position_{axis}]\nchip = "adc"\nchannel = {channel}\ngain_um_per_V = 1\noffset_um = 0\n{ends}'
    text += '[slave.deflection_z]\nchip = "adc"\nchannel = 3\ngain_nm_per_V = 33\noffset_nm = 0\nminimum_nm = -330\n'
    text += f"maximum_nm = 329.98\n{common}[gains]\nrate_kHz = 1\nheight_gain_per_s = 100\n{SCAN}"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scan.toml").write_text(text)
    return 0


def compare_scan(folder: Path) -> int:
    """1 if the heights differ by more than the steps of converters and read-out."""
    tables = tomllib.loads((folder / "scan.toml").read_text())
    parts = rig_file.from_tables(tables).rig
    scene, rig, settings = nt.Scene.from_tables(parts), nt.Rig.from_tables(parts), nt.Scan.from_tables(parts)
    x = np.arange(64) / 64 * 2e-6
    wave = nt.images.Topography(np.tile(20e-9 * np.cos(1e6 * np.pi * x), (64, 1)), (x[1], x[1]))
    loop = nt.Settings.for_rig(rig)
    loop.update_from_tables(parts)
    loop.gains.set_point = settings.zloop.set_force
    session = nt.Session(scene, rig, settings=loop, surface=nt.Surface.touched_by(scene, wave), mode="topography",
                         path=[(0.5e-6, 0.5e-6), (1.5e-6, 0.5e-6)], minimum_margin=0.0)  # fmt: skip
    simulated = nt.raster.image(session, settings).trace.height
    real = nt.images.read(folder / "scanned/scan.gwy", channel="Height").heights
    apart = np.abs((real - real.mean()) - (simulated - simulated.mean())).max()
    bound = 2.0 * (20e-6 / 2**16 + 20e-6 / 2**16) + RESOLUTION
    print(
        f"nanotouch scan --scene scan.toml, {real.shape[1]} x {real.shape[0]} pixels: heights over "
        f"{np.ptp(real) * 1e9:.1f} nm; within {apart * 1e9:.2f} nm of the simulated ones (steps: {bound * 1e9:.2f} nm)"
    )
    return 0 if np.ptp(real) > 15e-9 and apart <= bound else 1


JOBS = {"prepare": prepare, "compare": compare, "prepare-scan": prepare_scan, "compare-scan": compare_scan}
if __name__ == "__main__":
    sys.exit(JOBS[sys.argv[2]](Path(sys.argv[1])))
