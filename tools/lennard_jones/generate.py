# SPDX-License-Identifier: BSD-3-Clause
"""Makes bindings/python/nanotouch/reference/lennard_jones.csv, and the table in docs/evidence/lennard_jones.md.

Run: python generate.py table         writes the table, with its errors in the header
     python generate.py convergence   prints what finer meshes change
Each takes some minutes on one core.

Every curve is sampled at the same values of the parameter q, a function of the gap H0 at the centre (sphere.py):

    q = mu H0^-9/(mu + 3/2) - ln(H0)/4

From far away, where it counts the logarithm of the gap, to deep contact, where it counts mu times the pressure at the
centre, which JKR and Hertz make a function of the load alone: so curves of different mu are alike and interpolate well.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the matrices are too small for threads to pay

import numpy as np
from scipy.optimize import brentq
from sphere import COARSE, FINE, NORMAL, Floats, Point, Resolution, advance, curve

OUTPUT = Path(__file__).resolve().parents[2] / "bindings/python/nanotouch/reference/lennard_jones.csv"
Q = np.linspace(-0.85, 1.0, 149)
MU_MIN, MU_MAX = 0.05, 5.0
#: Chebyshev's points in ln mu; every second one is a Chebyshev point of half as many
MU = np.round(np.sqrt(MU_MIN * MU_MAX) * (MU_MAX / MU_MIN) ** (-0.5 * np.cos(np.pi * np.arange(25) / 24)), 6)
#: not in the table: they measure it
INDEPENDENT = (0.07, 0.13, 0.25, 0.7, 1.3, 2.2, 3.0, 3.8, 4.6)
#: Maugis' unit of indentation (pi^2 w^2 R/K^2)^(1/3) in z0, over mu
INDENTATION_SCALE = (9.0 * np.pi**2 / 16.0) ** (1.0 / 3.0)
FIELDS = ("d", "P", "dd/dq", "dP/dq")


def parameter(gap: Floats | float, mu: float) -> Floats:
    return np.asarray(mu * gap**-9.0 / (mu + 1.5) - np.log(gap) / 4.0)


def parameter_slope(gap: Floats, mu: float) -> Floats:
    return -9.0 * mu * gap**-10.0 / (mu + 1.5) - 0.25 / gap


def centre_gap(q: float, mu: float) -> float:
    return float(brentq(lambda gap: parameter(gap, mu) - q, 0.5, 100.0, xtol=1e-14))


def reduced(points: list[Point], mu: float) -> Floats:
    """The FIELDS of points, in Maugis' units [4, points]."""
    H = np.array([point.centre_gap for point in points])
    scale, q_slope = INDENTATION_SCALE * mu, parameter_slope(H, mu)
    values = np.array([(point.D / scale, point.P, point.D_slope / scale, point.P_slope) for point in points]).T
    values[2:] /= q_slope
    return values


def sample(mu: float, resolution: Resolution = NORMAL, q: Floats = Q) -> tuple[list[Point], Floats]:
    """A curve at all q, and its FIELDS [4, q.size]."""
    start = time.perf_counter()
    points = list(curve(mu, np.array([centre_gap(value, mu) for value in q]), resolution))
    print(f"mu = {mu}: {time.perf_counter() - start:.1f} s, {points[-1].gap.size} nodes", file=sys.stderr, flush=True)
    return points, reduced(points, mu)


def interpolated(mus: Floats, tables: Floats, mu: float) -> Floats:
    """The polynomial in ln mu through all tables [mus, 4, Q.size], at mu."""
    x, weights = np.log(mus), np.ones(mus.size)
    for k in range(mus.size):
        weights[k] = np.prod([np.log(mu / mus[j]) / (x[k] - x[j]) for j in range(mus.size) if j != k])
    return np.tensordot(weights, tables, 1)


def distance(table: Floats, truth: Floats) -> float:
    """Largest distance between two curves along their normals in the plane of d and P over max(|P|, |P_pull-off|)."""
    scale = np.maximum(np.abs(truth[1]), -truth[1].min())
    (d, P), (d_slope, P_slope) = table[:2] - truth[:2], truth[2:]
    return float(np.max(np.abs(P * d_slope - d * P_slope) / np.hypot(d_slope * scale, P_slope)))


class Folds(NamedTuple):
    pull_off_load: float
    jump_in: float
    jump_out: float


def folds(points: list[Point], mu: float, resolution: Resolution) -> Folds:
    """Where P and d turn, by root finding on the equilibria's own derivatives; nan where they do not."""

    def turn(field: str, first: bool) -> Point | None:
        slopes = np.array([getattr(point, field) for point in points])
        turns = np.flatnonzero(slopes[:-1] * slopes[1:] < 0.0)
        if not turns.size:
            return None
        before, after = points[turns[0 if first else -1]], points[turns[0 if first else -1] + 1]

        def slope(gap: float) -> float:
            return float(getattr(advance(before, mu, gap, resolution), field))

        root = brentq(slope, before.centre_gap, after.centre_gap, xtol=1e-9)
        return advance(before, mu, root, resolution)

    scale = INDENTATION_SCALE * mu
    load, enter, leave = turn("P_slope", False), turn("D_slope", True), turn("D_slope", False)
    return Folds(load.P if load else np.nan, enter.D / scale if enter else np.nan, leave.D / scale if leave else np.nan)


def halfway(table: Floats) -> Floats:
    """The FIELDS between neighbouring Q, by the cubics that the library uses."""
    step = Q[1] - Q[0]
    values, slopes = table[:2], table[2:]
    middle = (values[:, :-1] + values[:, 1:]) / 2.0 + step * (slopes[:, :-1] - slopes[:, 1:]) / 8.0
    slope = 1.5 * np.diff(values) / step - (slopes[:, :-1] + slopes[:, 1:]) / 4.0
    return np.concatenate([middle, slope])


def write_table() -> None:
    """The table, with its errors as measured at q and mu that are not in it."""
    between = (Q[:-1] + Q[1:]) / 2.0
    tables = np.array([sample(mu)[1] for mu in MU])
    independent = {mu: sample(mu, q=between)[1] for mu in INDEPENDENT}
    left_out = max(distance(interpolated(MU[::2], tables[::2], mu), tables[2 * k + 1]) for k, mu in enumerate(MU[1::2]))
    errors = {mu: distance(halfway(interpolated(MU, tables, mu)), truth) for mu, truth in independent.items()}
    print({mu: f"{error:.1e}" for mu, error in errors.items()}, file=sys.stderr)
    with OUTPUT.open("w", encoding="ascii") as file:
        file.write(
            "# SPDX-License-Identifier: BSD-3-Clause\n"
            "# generated by tools/lennard_jones/generate.py: sphere on elastic half-space, Lennard-Jones 9-3 law\n"
            "# d in (pi^2 w^2 R/K^2)^(1/3), K = 4/3 E*, 0 where the undeformed gap is z0; P in pi w R, + repulsive\n"
            "# error = largest distance of curves in the plane of d and P/max(|P|, |P_pull-off|)\n"
            f"# error with every second mu left out: {left_out:.1e}\n"
            f"# error at independent mu and q: {max(errors.values()):.1e}\n"
            f"# mu (slowest): {' '.join(f'{mu:.7g}' for mu in MU)}\n"
            f"# q: {' '.join(f'{q:g}' for q in Q)}\n"
            f"# {','.join(FIELDS)}\n"
        )
        file.writelines(",".join(f"{v:.8g}" for v in row) + "\n" for table in tables for row in table.T)


def print_convergence() -> None:
    """What finer meshes change: the whole curve, and its pull-off load."""
    print(
        "mu, nodes, P at pull-off, d at jump-in, d at jump-out, distance of the curve from the coarser one, change of P"
    )
    for mu in (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 5.0):
        previous: tuple[Floats, float] | None = None
        for resolution in (COARSE, NORMAL, FINE):
            points, table = sample(mu, resolution)
            turns = folds(points, mu, resolution)
            print(f"{mu:g}, {points[-1].gap.size}", *(f"{value:.7f}" for value in turns), sep=", ", end="")
            if previous:
                print(f", {distance(previous[0], table):.1e}, {previous[1] / turns.pull_off_load - 1.0:.1e}", end="")
            print(flush=True)
            previous = table, turns.pull_off_load


if __name__ == "__main__":
    {"table": write_table, "convergence": print_convergence}[sys.argv[1]]()
