# SPDX-License-Identifier: BSD-3-Clause
"""What the page takes from the Python tables, so that no word and no number stands twice: presets with their surfaces,
help, colours, units. Tasks, sliders and all that is said of a session are in the C library.

Usage: python apps/page/export.py FILE.json"""

from __future__ import annotations

import base64
import dataclasses
import json
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import units
from nanotouch.manipulation import Particles, Rod
from nanotouch.manipulation.particles import polystyrene
from nanotouch.touch import host as c_host
from nanotouch.touch.columns import STATES
from nanotouch.touch.supervisor import REASONS
from nanotouch_app.common.scenes import felt
from nanotouch_app.live import balls, host, instrument, look, readings, relief, seen, stage
from nanotouch_app.live.subject import PRESETS, of_preset

STEPS = 65535  # of a height in the page


def surface_of(topography: Any) -> dict[str, Any]:
    """Heights as whole numbers of 16 bits over their range, deflated."""
    heights = np.asarray(topography.heights, dtype=float)
    low, size = float(heights.min()), max(float(np.ptp(heights)), 1e-15)
    rounded = np.rint((heights - low) / size * STEPS).astype(np.uint16)
    across = np.diff(rounded, axis=1, prepend=np.uint16(0)).astype("<u2")  # neighbours are alike: it deflates better
    planes = across.tobytes()[0::2] + across.tobytes()[1::2]
    return {
        "shape": heights.shape, "pixel_size": list(topography.pixel_size), "low": low, "step": size / STEPS,
        "data": base64.b64encode(zlib.compress(planes, 9)).decode(),
    }  # fmt: skip


def preset(name: str) -> dict[str, Any]:
    """One card with all that it lays."""
    subject = of_preset(name)
    return {
        "name": name, "title": subject.title, "hint": subject.hint, "felt": felt(name),
        "scene": subject.scene.to_dict(), "rig": subject.rig.to_dict(), "surface": surface_of(subject.topography),
        "accuracy": subject.accuracy, "relief": float(subject.topography.height_range),
        "pushed": PRESETS[name]["pushed"],
        "particles": None if subject.particles is None else of_particles(subject.particles(subject.scene)),
        "rod": None if subject.rod is None else of_rod(subject.rod(subject.scene)),
    }  # fmt: skip


def of_particles(laid: Particles) -> dict[str, Any]:
    """What they are like: the values of both tables of fields (page_particles.c), and which go with the tip's own."""
    values = [*laid.particle._all(), *(laid.between or polystyrene())._values(), 0.0, 0.0, 0.0]
    rolling = len(laid.particle._all()) - 1  # of the contact with the tip, the last field
    return {"values": values, "with_tip": {"radius": [1, rolling], "half_angle": [2]}}


def of_rod(rod: Rod) -> dict[str, Any]:
    """The same of a rod."""
    names = [field.name for field in dataclasses.fields(rod)]
    values = [float(getattr(rod, name)) for name in names]
    with_tip = {key: [names.index(f"tip_{key}")] for key in ("radius", "half_angle")}
    return {"values": values, "with_tip": with_tip}


def constants() -> dict[str, Any]:
    """Numbers of the design that both front ends share."""
    taken = {host: "SPEEDS REWIND STEP_TICKS VALUES",
             seen: "HISTORY SLICES TAIL TRACE TRACE_STEP STALE READINGS LAXER ANSWERS",
             relief: "RELIEF SLENDER LADDER HIGHEST",
             stage: "FLOOR LIGHTS FAR LIFTED RAISED VIEWS ZOOM CLOSEST",
             instrument: "TIP_HEIGHT LEVER LEVER_POINTS NOSE TILT CHIP CAST BALL BEND SHADOW SHADES BEAM_SHADES",
             balls: "PARTICLE RING THICK",
             readings: "TIP_STEP HAND_STEPS NOTED", look: "PROPERTY_COLOURS PROPERTY_NAMES"}  # fmt: skip
    shared = {name: getattr(module, name) for module, names in taken.items() for name in names.split()}
    return {name: sorted(value) if isinstance(value, set) else value for name, value in shared.items()}


def everything() -> dict[str, Any]:
    """The whole table."""
    palettes = {name: dataclasses.asdict(palette)
                for name, palette in (("light", look.LIGHT), ("dark", look.DARK))}  # fmt: skip
    return {
        "presets": [preset(name) for name in PRESETS],
        "tasks": c_host.tasks(),
        "constants": constants(), "help": readings.HELP, "states": list(STATES), "reasons": list(REASONS),
        "palettes": palettes, "units": units.UNITS,
    }  # fmt: skip


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(everything(), separators=(",", ":")), encoding="utf-8")
