# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces to touch without a file: the built-in ones by name, and the one on which each preset is at home."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np

from nanotouch_app.common import samples

WAVES = 6  # of a gentle relief, each of another direction


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


def cell(size: float = 60e-6, height: float = 3e-6, pixels: int = 128) -> nt.Topography:
    """A cell that lies spread on its dish: a dome over a nucleus that runs out flat."""
    y, x = np.meshgrid(*2 * [np.linspace(-1.0, 1.0, pixels)], indexing="ij")
    r = np.hypot(x * (1.0 + 0.2 * y), 1.15 * y)
    z = np.exp(-((r / 0.55) ** 2)) + 0.25 * np.exp(-(((x - 0.1) ** 2 + (y + 0.05) ** 2) / 0.08))
    return _between(z, size, height, "cell")


def _between(z: Any, size: float, height: float, name: str) -> nt.Topography:
    z = (z - z.min()) / np.ptp(z) * height
    return nt.Topography(heights=z, pixel_size=2 * (size / len(z),), name=name)


def glass(width: float = 10e-6) -> nt.Topography:
    """So much of it, flat [m]."""
    return nt.Topography(heights=np.zeros((128, 128)), pixel_size=2 * (width / 128,), name="glass")


def polished() -> nt.Topography:
    """200 nm of it, flat."""
    return nt.Topography(heights=np.zeros((512, 512)), pixel_size=2 * (200e-9 / 512,), name="polished gold")


BUILT_IN: dict[str, Callable[[], nt.Topography]] = {
    "grating": nt.surface.grating,
    "dots": nt.surface.dots,
    "flat": nt.surface.flat,
    "spikes": nt.surface.spikes,
    "spheres": nt.surface.spheres,
}

OF_SCENE: dict[str, Callable[[], nt.Topography]] = {
    "silicon_in_air": lambda: relief(500e-9, 6e-9, "polished silicon"),
    "silicon_on_gold": lambda: terraces(2e-6, 2.4e-9, 5, "terraces of gold", pixels=192),
    "mica_in_air": lambda: terraces(600e-9, 1e-9, 2, "steps of mica", pixels=192),
    "polyester": lambda: relief(20e-6, 60e-9, "polyester film", seed=3),
    "silicone_rubber": lambda: relief(60e-6, 400e-9, "silicone rubber", seed=5),
    "polystyrene_ball": lambda: relief(8e-6, 10e-9, "polished glass", seed=7),
    "inas_dots": lambda: nt.surface.dots(pixels=320),
    "cell_in_liquid": cell,
    "chondrocyte": lambda: cell(40e-6, 1.5e-6),
    "polymer_gel": lambda: relief(20e-6, 60e-9, "polymer gel", seed=9),
    "paper_inas": nt.surface.dots,
    "grating": lambda: nt.surface.grating(size=12e-6, pixels=384, height=100e-9),
    "spikes": lambda: nt.surface.spikes(pixels=256),
    "dna": samples.dna,
    "rough": samples.rough,
    "soft_gold": polished,
    "latex_on_glass": glass,
    "wire_on_glass": lambda: glass(6e-6),
}
"""what each preset is touched on where no surface is named; the paper's other scenes: its grating"""


def of_scene(name: str | None) -> nt.Topography:
    """The surface of a preset by its name; the grating for a scene from a file, or for None."""
    return OF_SCENE.get(name or "", BUILT_IN["grating"])()
