# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces to touch, as they are sold or prepared; the same for the same seed."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np

PERSISTENCE = 50e-9  # of double-stranded DNA: Rivetti, Guthold, Bustamante, J. Mol. Biol. 264 (1996) 919 [m]


def dna(
    size: float = 500e-9, length: float = 700e-9, height: float = 0.8e-9, pixels: int = 256, seed: int = 3
) -> nt.Topography:
    """A strand of DNA that lies on mica in air, 0.8 nm high as images show it: a worm-like chain in two dimensions."""
    rng, step = np.random.default_rng(seed), 2e-9
    turns = rng.normal(0.0, math.sqrt(step / PERSISTENCE), round(length / step))
    angle = np.cumsum(turns)
    chain = np.cumsum(step * np.stack([np.cos(angle), np.sin(angle)], axis=1), axis=0)
    chain += 0.5 * size - 0.5 * (chain.max(axis=0) + chain.min(axis=0))
    place = (np.arange(pixels) + 0.5) * size / pixels
    x, y = np.meshgrid(place, place)
    nearest = np.full(x.shape, np.inf)
    for along, across in chain:
        nearest = np.minimum(nearest, np.hypot(x - along, y - across))
    z = height * np.exp(-((nearest / 4e-9) ** 2))
    return nt.Topography(heights=z, pixel_size=2 * (size / pixels,), name="DNA on mica")


def rough(size: float = 1e-6, rms: float = 2e-9, hurst: float = 0.8, pixels: int = 256, seed: int = 5) -> nt.Topography:
    """A self-affine surface of this RMS roughness: amplitudes fall as q^-(1 + H), flat below four waves to its size."""
    rng = np.random.default_rng(seed)
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(pixels), np.fft.fftfreq(pixels))) * pixels
    amplitude = np.maximum(q, 4.0) ** -(1.0 + hurst) * (q > 0.0) * (q < pixels / 8)
    z = np.fft.ifft2(amplitude * np.exp(2j * math.pi * rng.random(q.shape))).real
    z *= rms / z.std()
    return nt.Topography(heights=z - z.min(), pixel_size=2 * (size / pixels,), name="rough")
