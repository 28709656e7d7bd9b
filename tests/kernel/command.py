#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`nanotouch touch --scene rig.toml` in the test kernel beside the same command on the simulated rig (run.sh).

Usage: command.py FOLDER prepare    write FOLDER/rig.toml, from the rig file of the docs, and touch the simulated one
       command.py FOLDER compare    FOLDER/real, which the kernel has recorded, beside FOLDER/simulated
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from nanotouch import record, rig_file
from nanotouch_app.main import main as nanotouch

RIG = Path(__file__).parents[2] / "docs/examples/rig/rig.toml"
SPEED, RATE = 0.1e-6, 1e3  # [m/s], [Hz]: a tick is a step of 0.1 nm
LOOP = "[gains]\nrate_kHz = 1\napproach_speed_um_per_s = 0.1\ncurve_length_nm = 200\n"
RESOLUTION = 1e-9  # of the simulated stage's own read-out [m], on whose edge both may lie


def prepare(folder: Path) -> int:
    """The rig of the docs without the noise of its probe: what is left are the steps of the converters. And without
    debounce, for gpio-sim lets a request pull its lines down, as no closed switch does."""
    text = RIG.read_text().replace("[probe]\n", "[probe]\nnoise_V = 0\n").replace("debounce_ms = 2\n", "") + LOOP
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rig.toml").write_text(text)
    (folder / "simulated.toml").write_text(text.replace('"spidev"', '"simulated"'))
    given = ["--scene", str(folder / "simulated.toml"), "--surface", "flat", "--mode", "curve", "--no-window"]
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


if __name__ == "__main__":
    sys.exit({"prepare": prepare, "compare": compare}[sys.argv[2]](Path(sys.argv[1])))
