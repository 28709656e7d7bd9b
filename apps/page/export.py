# SPDX-License-Identifier: BSD-3-Clause
"""What the page takes from the Python tables, so that no word and no number stands twice: presets with their surfaces,
sliders, tasks, lesson, help, colours, units.

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
from nanotouch.manipulation import Particles
from nanotouch.manipulation.particles import polystyrene
from nanotouch.touch.columns import STATES
from nanotouch.touch.supervisor import REASONS
from nanotouch_app.live import balls, hand, host, look, readings, relief, seen, sliders, stage
from nanotouch_app.live import tasks as laying
from nanotouch_app.live.subject import PRESETS, felt, of_preset
from nanotouch_app.training import LESSON, TASKS, dent, find, pull_off, push, staircase, steady, stiffer, trace
from nanotouch_app.training.lesson_pages import PAGES
from nanotouch_app.training.lesson_texts import TEXTS as LESSON_TEXTS
from nanotouch_app.training.task_texts import TEXTS as TASK_TEXTS

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
        "particles": None if subject.particles is None else of_particles(subject.particles(subject.scene)),
    }  # fmt: skip


def of_particles(laid: Particles) -> dict[str, Any]:
    """What they are like: the values of both tables of fields (page_particles.c), and which go with the tip's own."""
    values = [*laid.particle._all(), *(laid.between or polystyrene())._values(), 0.0, 0.0, 0.0]
    rolling = len(laid.particle._all()) - 1  # of the contact with the tip, the last field
    return {"values": values, "with_tip": {"radius": [1, rolling], "half_angle": [2]}}


def constants() -> dict[str, Any]:
    """Numbers of the design that both front ends share."""
    taken = {hand: "LATERAL_REACH DOWN_REACH COUPLING SETTLING LOAD_SHARE PRESS_SHARE GLIDE STEPS APPROACH",
             host: "SPEEDS REWIND STEP_TICKS INDENTATION_SHARE",
             seen: "HISTORY SLICES TAIL TRACE TRACE_STEP STALE READINGS LAXER ANSWERS",
             relief: "RELIEF SLENDER LADDER HIGHEST",
             stage: "TIP_HEIGHT LEVER LEVER_POINTS BALL FAR BEND SHADOW LIFTED VIEWS",
             balls: "PARTICLE RING THICK", laying: "ASIDE",
             readings: "TIP_STEP HAND_STEPS NOTED", look: "PROPERTY_COLOURS PROPERTY_NAMES"}  # fmt: skip
    shared = {name: getattr(module, name) for module, names in taken.items() for name in names.split()}
    return {name: sorted(value) if isinstance(value, set) else value for name, value in shared.items()}


def tasks() -> dict[str, Any]:
    """The tasks with their numbers, the pages of the lesson with what they change."""
    numbers = {"find": (find, "SHARE HELD"), "pull_off": (pull_off, "NEEDED ALLOWED"),
               "trace": (trace, "PARTS NEEDED ALLOWED"),
               "dent": (dent, "SHARES ALLOWED"), "scratch": (dent, "SHARES ALLOWED GROOVE LONG"),
               "push": (push, "RADIUS ALLOWED WORST LOSS"), "pattern": (push, "RADIUS ALLOWED WORST LOSS"),
               "steady": (steady, "TARGET BAND TIME WAY NEEDED"), "stiffer": (stiffer, "LOAD DULL")}  # fmt: skip
    listed = [{"name": name, "title": task.title, "preset": task.preset, "asked": task.asked,
               "hides": sorted(task.hides),
               **{key: getattr(numbers[name][0], key) for key in numbers[name][1].split()},
               **({"starts": task.starts, "targets": task.targets} if issubclass(task, push.Push) else {})}
              for name, task in TASKS.items() if name in numbers]  # fmt: skip
    pages = [{"name": lesson.name, "follows": lesson.follows, "key": page.key, "preset": page.preset, "then": page.then,
              "changes": page.changes} for lesson, page in zip(LESSON, PAGES, strict=True)]  # fmt: skip
    return {"tasks": listed, "lesson": pages, "right": staircase.RIGHT, "period": trace.Trace.period}


def everything() -> dict[str, Any]:
    """The whole table."""
    palettes = {name: dataclasses.asdict(palette)
                for name, palette in (("light", look.LIGHT), ("dark", look.DARK))}  # fmt: skip
    return {
        "presets": [preset(name) for name in PRESETS],
        "offered": sliders.OFFERED, "given": sliders.GIVEN,
        "constants": constants(), "help": readings.HELP, "states": list(STATES), "reasons": list(REASONS),
        "palettes": palettes, "units": units.UNITS, "texts": {**TASK_TEXTS, **LESSON_TEXTS}, **tasks(),
    }  # fmt: skip


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(everything(), separators=(",", ":")), encoding="utf-8")
