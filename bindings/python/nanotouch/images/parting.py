# SPDX-License-Identifier: BSD-3-Clause
"""Particles that touch, parted by the saddles between their peaks (a watershed)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import require

_SADDLE = 0.2  # of the lower peak's height: two peaks are two particles if the saddle between them is so much lower


def parted(over: Floats, labels: NDArray[np.int32], least: float) -> NDArray[np.int32]:
    """Basins of the peaks of every particle, joined again where no saddle parts them.

    ``over`` is the height over the base [m], ``labels`` is 0 beside the particles, ``least`` is what a peak has to
    stand above a saddle [m]. A pixel belongs to the peak to which steepest ascent leads.
    """
    cv2 = require("cv2", "images")
    smooth = cv2.GaussianBlur(over, (0, 0), 1.0)
    smooth[labels == 0] = -np.inf
    target = _ascended(smooth)
    inside = np.flatnonzero(labels)
    roots = inside[target[inside] == inside]
    index = np.full(over.size, -1, np.int64)
    index[roots] = np.arange(len(roots))
    basin = index[target[inside]]
    index[inside] = basin
    peaks = smooth.ravel()[roots]
    joined = _joined(index.reshape(over.shape), smooth, peaks, least)
    out = np.zeros(over.size, np.int32)
    out[inside] = 1 + joined[basin]
    return out.reshape(over.shape)


def _ascended(z: Floats) -> NDArray[np.int64]:
    """For every pixel the index of the peak to which steepest ascent over 3 x 3 pixels leads."""
    ny, nx = z.shape
    padded = np.pad(z, 1, constant_values=-np.inf)
    highest, offset = z.copy(), np.zeros(z.shape, np.int64)
    for dj in (-1, 0, 1):
        for di in (-1, 0, 1):
            neighbour = padded[1 + dj : 1 + dj + ny, 1 + di : 1 + di + nx]
            np.copyto(offset, dj * nx + di, where=neighbour > highest)
            np.maximum(highest, neighbour, out=highest)
    target = np.arange(z.size) + offset.ravel()
    while True:  # each round doubles the steps taken
        further = target[target]
        if np.array_equal(further, target):
            return target
        target = further


def _saddles(index: NDArray[np.int64], z: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats]:
    """Pairs of basins that meet, and the highest place where they do, highest first."""
    keys, heights = [], []
    count = int(index.max()) + 1
    for dj, di in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(None, -dj or None), slice(max(-di, 0), -di if di > 0 else None))
        there = (slice(dj, None), slice(max(di, 0), di if di < 0 else None))
        near, far = index[here], index[there]
        meet = (near != far) & (near >= 0) & (far >= 0)
        one, other = near[meet], far[meet]
        keys.append(np.minimum(one, other) * count + np.maximum(one, other))
        heights.append(np.minimum(z[here][meet], z[there][meet]))
    pairs, which = np.unique(np.concatenate(keys), return_inverse=True)
    saddle = np.full(len(pairs), -np.inf)
    np.maximum.at(saddle, which, np.concatenate(heights))
    order = np.argsort(-saddle, kind="stable")
    low, high = np.divmod(pairs[order], count)
    return low, high, saddle[order]


def _joined(index: NDArray[np.int64], z: Floats, peaks: Floats, least: float) -> NDArray[np.int64]:
    """Which basins are one particle: saddles from the highest down, a peak that stands too little above one joins."""
    parent = list(range(len(peaks)))

    def top(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    for one, other, height in zip(*(column.tolist() for column in _saddles(index, z)), strict=True):
        a, b = top(one), top(other)
        low, high = (a, b) if peaks[a] < peaks[b] else (b, a)
        if a != b and peaks[low] - height < max(_SADDLE * peaks[low], least):
            parent[low] = high
    return np.array([top(k) for k in range(len(peaks))], dtype=np.int64)
