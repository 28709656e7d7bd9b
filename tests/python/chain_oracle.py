# SPDX-License-Identifier: BSD-3-Clause
"""The worm-like chain solved exactly, apart from every formula of the library.

Marko and Siggia (1995): a long chain under tension is a dipole on a sphere in a field, its free energy the lowest
eigenvalue of H = l (l + 1)/2 - f cos(theta); the extension is that value's derivative.
"""

from __future__ import annotations

import numpy as np

TERMS = 60


def worm_like_part(force: float) -> float:
    """Part of the contour to which F p/(k_B T) stretches the chain."""
    number = np.arange(TERMS)
    coupling = number[1:] / np.sqrt((2 * number[1:] - 1.0) * (2 * number[1:] + 1.0))
    matrix = np.diag(0.5 * number * (number + 1.0)) - force * (np.diag(coupling, 1) + np.diag(coupling, -1))
    _, vectors = np.linalg.eigh(matrix)
    ground = vectors[:, 0]
    return float(2.0 * np.sum(coupling * ground[1:] * ground[:-1]))


def worm_like_table() -> tuple[np.ndarray, np.ndarray]:
    """(part, force) over all that a test needs."""
    force = np.concatenate([[0.0], np.geomspace(1e-4, 600.0, 400)])
    return np.array([worm_like_part(f) for f in force]), force
