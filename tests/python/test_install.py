# SPDX-License-Identifier: BSD-3-Clause
"""The installed package and the command `make demo` ends with."""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent


def test_package_is_well_installed(tmp_path: Path) -> None:
    """In a process of its own, away from the source tree: this one has imported much already."""
    command = [sys.executable, "-W", "error", str(ROOT / "tests/install/wheel.py")]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_demo(tmp_path: Path) -> None:
    """`make demo`, as a newcomer types it; the set-up finds everything in place."""
    out = tmp_path / "out"
    command = ["make", "--no-print-directory", "-C", str(ROOT), "demo", f"OUT={out}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert str(out) in done.stdout
    summary = json.loads((out / "summary.json").read_text())
    assert summary["pull_off_force_N"] > 0
    for name in ("recording.mcap", "time.png", "force_gap.png", "view.png"):
        assert (out / name).stat().st_size > 1000, name
