# SPDX-License-Identifier: BSD-3-Clause
"""The background that the flat pieces of a surface agree on.

A background fitted to all pixels is pulled by steps (a grating with unequal ridges and grooves keeps a false tilt). So
the image is cut along its steep places into pieces, and one polynomial is fitted with a height of its own for every
piece. On a surface without steps that is one piece and the ordinary (robust) least squares. It is done on means over
blocks of pixels, with the basis averaged in the same way: least squares over all pixels at the cost of a few.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import require
from ._robust import MAD, block_means, middle, reduction, sample

SMALLEST_PIECE = 16  # [block]
_ROUNDS = 6  # cutting and fitting alternate; two rounds settle a grating, the others are for rough films
_STEEP = 4.0  # a place is steep where the slope differs from the background's by more than so many standard deviations
_HUBER = 1.345  # 95 % efficiency on Gaussian noise
_ENOUGH = 1 << 14  # blocks, of a quarter of a million pixels
_SAME = 0.02  # of the range of heights: terraces closer than this are on one level


@dataclass(frozen=True)
class Terrace:
    """One level of a terraced surface.

    Attributes
    ----------
    height : float
        Above the largest level [m].
    share : float
        Of the area of all levels [-].
    pieces : int
        Number of connected pieces on it.
    """

    height: float
    share: float
    pieces: int


@dataclass(frozen=True)
class Background:
    """``sum c[a, b] P_a(y) P_b(x)``, Legendre polynomials over the image, and the pieces that agree on it."""

    coefficients: Floats
    labels: NDArray[np.int32]  # of the blocks: from 1, 0 where steep
    pieces: int
    along_y: int = 6  # highest order along y that was fitted

    def plane(self, shape: tuple[int, int]) -> tuple[Floats, Floats]:
        """The terms of first order, along y and along x [m]: the plane is their sum."""
        ny, nx = shape
        return self.coefficients[1, 0] * places(ny), self.coefficients[0, 1] * places(nx)

    def bow(self, shape: tuple[int, int]) -> Floats:
        """All terms of higher order on the pixels [m]."""
        higher = self.coefficients.copy()
        higher[:2, :2] = np.diag([0.0, higher[1, 1]])
        return Background(higher, self.labels, self.pieces).values(shape)

    def values(self, shape: tuple[int, int], blocks: tuple[int, int] = (1, 1)) -> Floats:
        """On the pixels, or as means over blocks of them [m]."""
        vy, vx = (basis(n, len(self.coefficients) - 1, f) for n, f in zip(shape, blocks, strict=True))
        return np.asarray(vy @ self.coefficients @ vx.T)


def places(n: int) -> Floats:
    """The pixels along one axis as -1 .. 1."""
    return np.asarray(np.linspace(-1.0, 1.0, n))


def basis(n: int, order: int, size: int) -> Floats:
    """Legendre polynomials up to `order` as means over blocks of `size` of n pixels: (blocks, order + 1)."""
    return block_means(np.asarray(legendre.legvander(places(n), order), np.float64), size, 0)


def fit(strips: Floats, shape: tuple[int, int], order: int, floor: float, *, along_y: int | None = None) -> Background:
    """The polynomial of a total order that the flat pieces agree on.

    Parameters
    ----------
    strips : ndarray, shape (ny, columns)
        Means over blocks along x [m]; NaN where a pixel of the block is not to count.
    shape : tuple of int
        Of the image [pixel].
    order : int
        1 for a plane.
    floor : float
        Differences from block to block below this are never steep: the digitiser's step [m].
    along_y : int, optional
        Highest order along y where that is less.
    """
    highest = order if along_y is None else along_y
    fy, fx = reduction(shape[0]), reduction(shape[1])
    blocks = block_means(strips, fy, 0)
    known = np.isfinite(blocks)
    if np.count_nonzero(known) < SMALLEST_PIECE and fy > 1:
        fy, blocks, known = 1, strips, np.isfinite(strips)
    vy, vx = basis(shape[0], order, fy), basis(shape[1], order, fx)
    coefficients = np.zeros((order + 1, order + 1))
    # P_1 rises by this much from block to block
    rise = [2.0 * f / (n - 1) for n, f in zip(shape, (fy, fx), strict=True)]
    coefficients[1, 0] = _known_middle(np.diff(blocks, axis=0)) / rise[0]
    coefficients[0, 1] = _known_middle(np.diff(blocks, axis=1)) / rise[1]
    rest, labels, pieces = blocks - vy @ coefficients @ vx.T, known.astype(np.int32), 1
    floor = max(floor, 1e-3 * float(np.nanmax(rest) - np.nanmin(rest)))
    settled = 0.01 * MAD * _known_middle(np.abs(np.diff(rest, axis=1)))
    for _ in range(_ROUNDS):
        labels, pieces = _cut(rest, known, floor)
        change = _change(rest, labels, vy, vx, highest)
        coefficients += change
        rest = blocks - vy @ coefficients @ vx.T
        if np.abs(change).max() <= settled:
            break
    return Background(coefficients, labels, pieces, highest)


def levels(strips: Floats, background: Background) -> tuple[tuple[Terrace, ...], float]:
    """The levels of what is left over a background, largest first, and the height of the largest [m].

    Pieces closer than 2 % of the range of heights are on one level.

    `strips` is as for :func:`fit`, with the background taken out.
    """
    labels = background.labels
    rest = block_means(strips, len(strips) // len(labels), 0)[: len(labels)]
    inside = labels > 0
    area = np.bincount(labels[inside], minlength=background.pieces + 1)[1:]
    height = np.bincount(labels[inside], rest[inside], minlength=background.pieces + 1)[1:] / area
    order = np.argsort(height)
    height, area = height[order], area[order]
    group = np.concatenate([[0], np.cumsum(np.diff(height) > _SAME * np.ptp(rest[inside]))])
    share = np.bincount(group, area)
    mean = np.bincount(group, area * height) / share
    count = np.bincount(group)
    rank = np.argsort(-share, kind="stable")
    base = mean[rank[0]]
    found = (Terrace(float(mean[k] - base), float(share[k] / share.sum()), int(count[k])) for k in rank)
    return tuple(found), float(base)


def refit(strips: Floats, shape: tuple[int, int], found: Background) -> Background:
    """The change of a background that the same pieces ask for in strips of which something was taken out since."""
    order = len(found.coefficients) - 1
    blocks = block_means(strips, len(strips) // len(found.labels), 0)
    vy, vx = (basis(n, order, n // m) for n, m in zip(shape, found.labels.shape, strict=True))
    return Background(_change(blocks, found.labels, vy, vx, found.along_y), found.labels, found.pieces, found.along_y)


def _known_middle(steps: Floats) -> float:
    some = sample(steps)
    return middle(some[np.isfinite(some)])


def _gentle(rest: Floats, floor: float, axis: int) -> NDArray[np.bool_]:
    """Where a difference from block to block is no more than noise and the digitiser's steps explain."""
    size = np.abs(np.diff(rest, axis=axis))
    return np.asarray(size <= max(_STEEP * MAD * _known_middle(size), floor), dtype=bool)


def _cut(rest: Floats, known: NDArray[np.bool_], floor: float) -> tuple[NDArray[np.int32], int]:
    """Label the connected flat pieces from 1; 0 is steep or too small. Without any piece all known blocks are one."""
    cv2 = require("cv2", "images")
    flat = known.copy()
    flat[:-1] &= _gentle(rest, floor, 0)
    flat[:, :-1] &= _gentle(rest, floor, 1)
    count, labels = cv2.connectedComponents(flat.astype(np.uint8), connectivity=4)
    area = np.bincount(labels.ravel(), minlength=count)
    kept = area >= SMALLEST_PIECE
    kept[0] = False
    if not kept.any():
        return known.astype(np.int32), 1
    new_label = np.where(kept, np.cumsum(kept), 0).astype(np.int32)
    return new_label[labels], int(kept.sum())


def _change(rest: Floats, labels: NDArray[np.int32], vy: Floats, vx: Floats, along_y: int) -> Floats:
    """Change of the coefficients by Huber-weighted least squares with a free height for each piece.

    The least-norm solution leaves a direction alone in which no piece extends.
    """
    order = vy.shape[1] - 1
    terms = [(a, b) for a in range(min(order, along_y) + 1) for b in range(order + 1 - a) if a + b]
    inside = sample(np.flatnonzero(labels), _ENOUGH)
    j, i = np.divmod(inside, labels.shape[1])
    piece = labels[j, i] - 1
    values = np.stack([rest[j, i], *(vy[j, a] * vx[i, b] for a, b in terms)])
    weight = np.ones(inside.size)
    change = np.zeros(len(terms))
    for _ in range(3):
        z, *columns = _centred(values, piece, weight)
        design = np.stack(columns)
        weighted = design * weight
        change = np.linalg.lstsq(weighted @ design.T, weighted @ z, rcond=1e-12)[0]
        residual = np.abs(z - change @ design)
        limit = _HUBER * MAD * middle(residual)
        if limit == 0.0:
            break
        weight = np.minimum(1.0, limit / np.maximum(residual, limit))
    out = np.zeros((order + 1, order + 1))
    for (a, b), value in zip(terms, change, strict=True):
        out[a, b] = value
    return out


def _centred(values: Floats, piece: NDArray[np.int32], weight: Floats) -> Floats:
    """Each row of values less its weighted mean over its piece."""
    if not piece.any():
        return np.asarray(values - (values @ weight / weight.sum())[:, None])
    total = np.bincount(piece, weight)
    total[total == 0.0] = 1.0  # a piece of which nothing was sampled
    return np.stack([v - (np.bincount(piece, weight * v) / total)[piece] for v in values])
