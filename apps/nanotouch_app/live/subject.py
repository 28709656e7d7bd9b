# SPDX-License-Identifier: BSD-3-Clause
"""What a person is to touch: a preset with its surface and what to try there, or what files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import presets

from nanotouch_app.live import samples

WAVES = 6  # of a gentle relief, each of another direction
LEAST_CLEARANCE = 20e-9  # [m]


@dataclass(frozen=True)
class Subject:
    """A scene with its rig and surface."""

    name: str
    title: str
    scene: nt.Scene
    rig: nt.Rig
    topography: nt.Topography
    felt: str = ""
    """what the hand feels, in a sentence"""
    hint: str = ""
    """what to try first"""
    surface: Callable[[nt.Scene], nt.Surface] | None = None
    """what the tip touches; None: the topography, dilated by it"""
    accuracy: float = 0.01
    """what its forces are planned for"""

    def touched(self, scene: nt.Scene) -> nt.Surface:
        """The surface for the tip of a scene."""
        return nt.Surface.touched_by(scene, self.topography) if self.surface is None else self.surface(scene)

    def clearance(self) -> float:
        """Where the tip begins above the surface [m]: where it feels next to nothing."""
        plan = self.scene.plan(relative_accuracy=self.accuracy)
        facts = plan.explain()
        reach = plan.cutoff_gap(0.002 * max(float(self.scene.range.maximum_load), plan.pull_off_force))
        release = float(facts["release_gap"])
        return float(max(LEAST_CLEARANCE, 1.5 * min(reach, 1e-6), 2.0 * release if np.isfinite(release) else 0.0))


def relief(size: float, height: float, name: str, seed: int = 1, pixels: int = 128) -> nt.Topography:
    """A gentle relief of so many metres from lowest to highest: waves of a third to a whole of the size [m]."""
    rng = np.random.default_rng(seed)
    y, x = np.meshgrid(*2 * [np.linspace(0.0, 2.0 * np.pi, pixels)], indexing="ij")
    z = np.zeros((pixels, pixels))
    for _ in range(WAVES):
        angle, waves, phase = rng.uniform(0.0, np.pi), rng.uniform(1.0, 3.0), rng.uniform(0.0, 2.0 * np.pi)
        z += np.cos(waves * (np.cos(angle) * x + np.sin(angle) * y) + phase) / waves
    return _between(z, size, height, name)


def terraces(size: float, step: float, count: int, name: str, pixels: int = 128) -> nt.Topography:
    """Terraces between steps of one height [m] that wander across the surface, each a sixteenth of it wide."""
    y, x = np.meshgrid(*2 * [np.linspace(0.0, 1.0, pixels)], indexing="ij")
    way = count * (x + 0.35 * y + 0.06 * np.sin(5.0 * y) + 0.03 * np.sin(11.0 * y + 4.0 * x))
    edge = np.tanh((way - np.floor(way) - 0.5) * 32.0 / count) * 0.5 + 0.5
    z = np.floor(way) + edge
    return nt.Topography(heights=(z - z.min()) * step, pixel_size=2 * (size / pixels,), name=name)


def cell(size: float = 40e-6, height: float = 3e-6, pixels: int = 128) -> nt.Topography:
    """A cell that lies spread on its dish: a dome over a nucleus that runs out flat."""
    y, x = np.meshgrid(*2 * [np.linspace(-1.0, 1.0, pixels)], indexing="ij")
    r = np.hypot(x * (1.0 + 0.2 * y), 1.15 * y)
    z = np.exp(-((r / 0.55) ** 2)) + 0.35 * np.exp(-(((x - 0.1) ** 2 + (y + 0.05) ** 2) / 0.05))
    return _between(z, size, height, "cell")


def _between(z: Any, size: float, height: float, name: str) -> nt.Topography:
    z = (z - z.min()) / np.ptp(z) * height
    return nt.Topography(heights=z, pixel_size=2 * (size / len(z),), name=name)


@dataclass(frozen=True)
class Preset:
    """Beside a scene of :mod:`nanotouch.scene.presets`: where it lies, and what to try."""

    title: str
    surface: Callable[[], nt.Topography]
    hint: str
    scene: str = ""
    """of :mod:`nanotouch.scene.presets`; "": that of its own name"""
    accuracy: float = 0.01
    """of its forces: where a slider leads to what is less well known, a little less is asked"""


PRESETS: dict[str, Preset] = {
    "silicon_in_air": Preset(
        "Silicon in air", lambda: relief(500e-9, 6e-9, "polished silicon"),
        "Scroll down until the water snaps, then pull up until it tears. Then set the humidity to 0.",
    ),
    "silicon_on_gold": Preset(
        "Silicon on gold", lambda: terraces(400e-9, 2.4e-9, 5, "terraces of gold", pixels=192),
        "Follow a terrace at a steady force and feel its edge.",
    ),
    "mica_in_air": Preset(
        "Mica in dry air", lambda: terraces(600e-9, 1e-9, 2, "steps of mica", pixels=192),
        "The soft lever jumps in before it touches: go down by single steps and watch its line meet the curve.",
        accuracy=0.03,
    ),
    "polyester": Preset(
        "Polyester", lambda: relief(20e-6, 60e-9, "polyester film", seed=3),
        "Press, then let go slowly: the way out is not the way in.",
    ),
    "silicone_rubber": Preset(
        "Silicone rubber", lambda: relief(60e-6, 400e-9, "silicone rubber", seed=5),
        "Press deep, then pull: the rubber stretches into a neck before it lets go.",
    ),
    "polystyrene_ball": Preset(
        "Polystyrene ball on glass", lambda: relief(4e-6, 10e-9, "polished glass", seed=7),
        "Press, then draw it sideways: it sticks, and then slips.",
    ),
    "inas_dots": Preset(
        "Quantum dots", lambda: nt.surface.dots(pixels=256),
        "Find a dot with the lightest touch that you can hold.",
    ),
    "grating": Preset(
        "Calibration grating", lambda: nt.surface.grating(size=12e-6, pixels=384, height=100e-9),
        "Draw the tip along x: the walls are felt before they are seen.", "silicon_in_air",
    ),
    "spikes": Preset(
        "Field of spikes", samples.spikes, "Go over a spike: what you feel is the shape of your own tip.",
        "silicon_in_air",
    ),
    "dna": Preset(
        "DNA on mica", samples.dna, "Find the strand and follow it with the lightest touch.", "mica_in_air",
        accuracy=0.02,
    ),
    "rough": Preset(
        "Rough film", samples.rough, "Pull off on a hill and in a hollow: the pull differs.", "silicon_in_air",
    ),
    "cell_in_liquid": Preset(
        "A living cell", cell,
        "Nothing snaps: feel the fur first, then the cell. Press on the nucleus, then on the rim.",
    ),
}  # fmt: skip


def of_preset(name: str) -> Subject:
    """A preset, its surface made."""
    known = PRESETS[name]
    of = known.scene or name
    scene, rig = getattr(presets, of)()
    return Subject(name, known.title, scene, rig, known.surface(), presets.FELT[of], known.hint,
                   accuracy=known.accuracy)  # fmt: skip
