# SPDX-License-Identifier: BSD-3-Clause
"""Lee and Radok's and Ting's force by quadrature, for an indentation that is straight between points: no exponential
sums, no recursion. Gauss-Jacobi takes the kernel's singularity at t, Gauss-Legendre after s = x^2 the elastic law's at
first touch; t_1 is a root by bisection."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import roots_jacobi, roots_legendre

Floats = NDArray[np.float64]
Kernel = Callable[[Floats], Floats]
GAUSS = 24


def integral(kernel: Kernel, exponent: float, slope: Callable[[Floats], Floats], time: float, pieces: Floats) -> float:
    """Of E(time - s) slope(delta(s)) d(delta) along straight pieces (start, end, delta there, delta here).

    ``exponent``: E goes as (time - s)^-exponent where s comes near to time.
    """
    x, w = roots_legendre(GAUSS)
    total = 0.0
    cut = 0.5 * (pieces[:, ::2] + pieces[:, 1::2])  # one singular end to a part
    halves = np.concatenate(
        [
            np.stack([pieces[:, 0], cut[:, 0], pieces[:, 2], cut[:, 1]], axis=1),
            np.stack([cut[:, 0], pieces[:, 1], cut[:, 1], pieces[:, 3]], axis=1),
        ]
    )
    for start, end, low, high in halves:
        length, speed = end - start, (high - low) / (end - start)
        if abs(end - time) < 1e-12 * time and exponent > 0.0:
            y, v = roots_jacobi(GAUSS, -exponent, 0.0)  # (1 - y)^-exponent, y = 1 at s = time
            s = start + 0.5 * length * (y + 1.0)
            smooth = kernel(time - s) * (time - s) ** exponent * slope(low + speed * (s - start))
            total += float(v @ smooth) * speed * (0.5 * length) ** (1.0 - exponent)
            continue
        # panels that grow away from both ends, so that neither end's root is near a node
        u = 0.5 * (x + 1.0)
        s = start + length * u * u * (3.0 - 2.0 * u)
        weight = 0.5 * w * 6.0 * u * (1.0 - u) * length
        total += float((kernel(time - s) * slope(low + speed * (s - start)) * speed) @ weight)
    return total


def force(
    kernel: Kernel, exponent: float, slope: Callable[[Floats], Floats], time: Floats, depth: Floats, index: int
) -> float:
    """F (1 - nu^2) at a point: contact grows up to the largest indentation, then shrinks; one of either.

    Time 0 is first touch, at depth 0. ``slope`` is g'(delta).
    """
    t = float(time[index])
    top = int(np.argmax(depth[: index + 1]))
    pieces = np.stack([time[:-1], time[1:], depth[:-1], depth[1:]], axis=1)[:index]

    def one(_: Floats) -> Floats:
        return np.ones_like(_)

    end = t
    if index > top:

        def condition(t1: float) -> float:
            return integral(kernel, exponent, one, t, _from(pieces, t1))

        if condition(1e-9 * t) < 0.0:
            return 0.0
        end = brentq(condition, 1e-9 * t, float(time[top]), xtol=1e-15, rtol=1e-14)
    return integral(kernel, exponent, slope, t, _until(pieces, end))


def _from(pieces: Floats, start: float) -> Floats:
    rest = pieces[pieces[:, 1] > start].copy()
    if len(rest):
        rest[0, 2] += (rest[0, 3] - rest[0, 2]) * max(0.0, start - rest[0, 0]) / (rest[0, 1] - rest[0, 0])
        rest[0, 0] = max(start, rest[0, 0])
    return rest


def _until(pieces: Floats, end: float) -> Floats:
    rest = pieces[pieces[:, 0] < end].copy()
    last = rest[-1]
    last[3] = last[2] + (last[3] - last[2]) * (min(end, last[1]) - last[0]) / (last[1] - last[0])
    last[1] = min(end, last[1])
    return rest
