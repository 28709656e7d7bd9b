# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of docs/images.md. Run: python docs/pictures/images.py"""

from __future__ import annotations

import warnings
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import Topography, images, surface
from PIL import Image

HERE = Path(__file__).resolve().parent
N = 128


def save(figure: Any, name: str) -> None:
    """Small: 48 colours of the palette are enough."""
    raw = BytesIO()
    figure.savefig(raw, format="png", dpi=64)
    Image.open(raw).convert("RGB").quantize(48, dither=Image.Dither.NONE).save(HERE / name, optimize=True)


def levelling() -> None:
    """A grating along the fast axis, tilted, rows off by 8 nm rms: as read, step-aware, and every row alike."""
    rng = np.random.default_rng(1)
    across = surface.grating(6e-6, N).heights
    z = across.T + 8e-9 * rng.standard_normal((N, 1)) + 1e-9 * rng.standard_normal((N, N))
    tilted = Topography(z + np.add.outer(np.linspace(0, 4e-7, N), np.linspace(0, 6e-7, N)), (6e-6 / N, 6e-6 / N))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that medians erase it is the point
        pictures = {
            "as read": tilted,
            "plane+rows": images.level(tilted, "plane+rows")[0],
            "plane+medians": images.level(tilted, "plane+medians")[0],
        }
    save(images.draw(pictures), "levelling.png")


def particles() -> None:
    """Quantum dots with noise: image, and what is found in what the tip of 10 nm leaves of them."""
    dots = surface.dots(300e-9, N, count=16)
    rough = dots.heights + 0.15e-9 * np.random.default_rng(2).standard_normal(dots.shape)
    image = images.dilate(Topography(rough, dots.pixel_size), images.RoundedCone(10e-9, 0.3))
    pictures = {"dots": dots, "imaged by a tip of 10 nm": image}
    save(images.draw(pictures, grains=images.grains(image)), "particles.png")


if __name__ == "__main__":
    levelling()
    particles()
