# SPDX-License-Identifier: BSD-3-Clause
"""A map that is killed goes on from its finished blocks; a folder of something else is refused; memory stays flat."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import nanotouch as nt
import pytest

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("xarray")

from nanotouch import maps
from test_maps import volume

PROGRAM = """
import sys, time
sys.path.insert(0, {here!r})
from nanotouch import maps
from test_maps import volume
maps.fit(volume(8), "jkr", radius=20e-9, block=4, resume={folder!r}, progress=lambda done: time.sleep(0.1))
"""


def test_a_killed_run_goes_on_where_it_was(tmp_path: Path) -> None:
    folder = tmp_path / "blocks"
    program = PROGRAM.format(here=str(Path(__file__).parent), folder=str(folder))
    with subprocess.Popen([sys.executable, "-c", program]) as process:
        deadline = time.monotonic() + 60.0
        while len(list(folder.glob("block-*.npz"))) < 3 and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    finished = {file: file.stat().st_mtime_ns for file in folder.glob("block-*.npz")}
    assert 3 <= len(finished) < 16
    source = volume(8)
    data = maps.fit(source, "jkr", radius=20e-9, block=4, resume=folder)
    assert data.equals(maps.fit(source, "jkr", radius=20e-9))
    assert {file: file.stat().st_mtime_ns for file in finished} == finished, "finished blocks were made again"
    assert len(list(folder.glob("block-*.npz"))) == 16


@pytest.mark.parametrize("other", ["radius", "input", "model", "block", "calibration"])
def test_results_of_another_run_are_refused(tmp_path: Path, other: str) -> None:
    source = volume(2)
    maps.fit(source, "jkr", radius=20e-9, resume=tmp_path / "blocks")
    values = source.values * (1.0 + 1e-12) if other == "input" else source.values
    stiffness = 1.1 if other == "calibration" else 1.0
    with pytest.raises(nt.errors.InvalidValue, match="sha256" if other == "input" else other):
        maps.fit(
            maps.ArrayVolume(values, source.z, 1.0) if other != "calibration" else values,
            "dmt" if other == "model" else "jkr", radius=21e-9 if other == "radius" else 20e-9,
            block=3 if other == "block" else 256, resume=tmp_path / "blocks",
            **({"z": source.z, "spring_constant": stiffness} if other == "calibration" else {}),
        )  # fmt: skip


def test_a_damaged_block_is_made_again(tmp_path: Path) -> None:
    source = volume(4)
    whole = maps.fit(source, "jkr", radius=20e-9, block=4, resume=tmp_path)
    for number, damage in enumerate(
        (lambda b: b[: len(b) // 2], lambda b: b[:2000] + b"\xff" * 64 + b[2064:], lambda b: b"")
    ):
        file = tmp_path / f"block-{number:06d}.npz"
        file.write_bytes(damage(file.read_bytes()))
    assert maps.fit(source, "jkr", radius=20e-9, block=4, resume=tmp_path).equals(whole)


HUNGRY = """
import resource, sys
sys.path.insert(0, {here!r})
import numpy as np
from nanotouch import maps
from test_maps import volume

source = volume(8, points=2048)

class Rows:  # 256 MiB that are nowhere in memory at once
    def __init__(self, ny):
        self.shape = (ny, 128, 4096)
    def __getitem__(self, rows):
        count = len(range(*rows.indices(self.shape[0])))
        made = np.zeros((count, 128, 4096))  # constant curves: read, checked and refused
        made[:, :2] = source.values[0, :2]
        return made

def peak(ny):
    data = maps.fit(Rows(ny), "jkr", z=source.z, spring_constant=1.0, radius=20e-9)
    assert data.attrs["curves_without_result"] == 126 * ny
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
small = peak(4)
print(small, peak(64))
"""


def test_memory_does_not_grow_with_the_map() -> None:
    """15 times as many curves, 240 MiB more of them: all that may be added are the results, 2 MiB, and some slack."""
    pytest.importorskip("resource")
    program = HUNGRY.format(here=str(Path(__file__).parent))
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=True)
    small, large = map(float, said.stdout.split())
    assert large < small + 40.0
