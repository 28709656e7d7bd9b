# SPDX-License-Identifier: BSD-3-Clause
"""Reference recordings: scripted sessions with explicit seeds, so that a rebuilt session can be held against the old.

``python tests/reference/recordings.py FILE.npz`` makes them anew. Made right after the noise became
counter-based, and every column but the ages (whole nanoseconds now) came out of the rebuilt session to the last bit.
Made anew when a plan no longer depended on the probe: the simulated samples have forces since that it left out. Made
anew, "faults" alone, when a stop went on lifting while no force can be read and a stage kept to its speed whatever
fails; the other six kept every bit. Made
anew, "scan", "requests" and "faults", when a stop's fade became as short as the hand needs. Made
anew, "requests" alone, when the way that a clutch cuts short no longer went on after it. A
change of bits is a change of behaviour and has to be meant. Each column is kept as a digest of all its
bytes (the same machine and build: equal) and as every ``STRIDE``-th row (another libm may round differently)."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.touch.faults import Faults
from nanotouch.touch.operator import Input, adversary

STRIDE = 199
HARD = {"maximum_load": 1.0}  # all that the rig can press with
Columns = dict[str, np.ndarray[Any, Any]]


def _joined(blocks: list[Columns]) -> Columns:
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _point() -> Columns:
    return nt.Session(nt.Scene(range=HARD), seed=1).run(1.5).columns


def _scan() -> Columns:
    surface = nt.Surface(nt.surface.grating(), tip_radius=20e-9)
    scene = nt.Scene(tip={"radius": 20e-9}, range=HARD)
    return nt.Session(scene, surface=surface, mode="scan", seed=2).run(2.0).columns


def _topography() -> Columns:
    surface = nt.Surface(nt.surface.dots(seed=3), tip_radius=20e-9)
    scene = nt.Scene(tip={"radius": 20e-9}, range=HARD)
    return nt.Session(scene, surface=surface, mode="topography", seed=3).run(2.0).columns


def _curve() -> Columns:
    rig = nt.Rig(probe={"spring_constant": 1.0})
    return (
        nt.Session(nt.Scene(range=HARD), rig=rig, mode="curve", seed=4, probe_model="dynamic", rate=5000.0)
        .run(0.8)
        .columns
    )


def _converters() -> Columns:
    rig = nt.Rig(converters={"adc_bits": 16, "adc_rate": 7000.0, "adc_latency": 50e-6, "dac_bits": 16,
                             "dac_latency": 30e-6}, stage={"hysteresis": 0.1, "creep": 0.01})  # fmt: skip
    return nt.Session(nt.Scene(range=HARD), rig=rig, seed=5, delay=150e-6).run(1.0).columns


def _requests() -> Columns:
    session = nt.Session(nt.Scene(range=HARD), rig=nt.Rig(hand=adversary(1.0)), seed=6)
    x, y = session.path[0]
    blocks = [session.advance(0.4, Input(0.6, x, y, 0.3))]
    session.rescale(alpha_f=0.5 * session.settings.gains.alpha_f)
    blocks.append(session.advance(0.2))
    session.clutch(True)
    blocks.append(session.advance(0.1))
    session.clutch(False)
    blocks.append(session.advance(0.2))
    session.set_mode("approach")
    blocks.append(session.advance(0.2))
    session.emergency_stop()
    blocks.append(session.advance(0.05))
    session.emergency_stop(False)
    session.arm(confirmed=True)
    blocks.append(session.advance(0.1))
    return _joined(blocks)


def _faults() -> Columns:
    faults = Faults()
    for number, (kind, channel, duration) in enumerate([
        ("nan", "deflection", 1.5e-4), ("stuck", "operator_force", 0.02), ("noise", "deflection", 0.01),
        ("late", "rig", 3e-4), ("stale", "rig", 2.5e-4), ("dropout", "rig", 1e-4), ("drift", "stage_position", 0.02),
        ("push", "rig", 0.01), ("gain", "stage", 0.005),
    ]):  # fmt: skip
        faults.add(kind, channel, at=0.1 + 0.15 * number, duration=duration)
    session = nt.Session(nt.Scene(range=HARD), seed=7, faults=faults, clearance=20e-9)
    x, y = session.path[0]
    blocks = [session.advance(0.3, Input(1.5, x, y, 0.05))]
    for _ in range(4):
        blocks.append(session.advance(0.3))
        if blocks[-1]["state"][-1] >= 2:
            session.arm(confirmed=True)
    return _joined(blocks)


SESSIONS: dict[str, Callable[[], Columns]] = {
    "point": _point, "scan": _scan, "topography": _topography, "curve": _curve, "converters": _converters,
    "requests": _requests, "faults": _faults,
}  # fmt: skip


def digest(values: np.ndarray[Any, Any]) -> str:
    """Of all bytes of a column."""
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


def make(path: str) -> None:
    """Write all recordings into one file."""
    arrays: dict[str, Any] = {}
    for name, play in SESSIONS.items():
        columns = play()
        for column, values in columns.items():
            arrays[f"{name}/{column}"] = values[::STRIDE]
            arrays[f"{name}/{column}/digest"] = np.array(digest(values))
        print(f"{name}: {len(columns['time'])} rows, at most {1e9 * np.nanmax(columns['tip_force']):.0f} nN")
    np.savez_compressed(path, **arrays)


if __name__ == "__main__":
    make(sys.argv[1])
