# SPDX-License-Identifier: BSD-3-Clause
"""Many force curves whose answers are known, for inference, learning and tests."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .. import contact as laws
from .._arrays import as_count, as_floats, check_between
from ..errors import InvalidValue
from .curve import ForceCurve, Segment
from .synthesis import ANY, FEWEST_POINTS, POSITIVE

Floats = NDArray[np.float64]
_CHUNK = 64  # curves that share a stream of noise; part of what a seed means
_POSITIVE = POSITIVE | {"radius": "m", "effective_modulus": "Pa", "cohesive_range": "m"}
_NOT_NEGATIVE = {"work_of_adhesion": "J/m^2", "noise": "N"}


@dataclass(frozen=True, eq=False)
class CurveBatch:
    """Force curves over one grid of heights.

    Attributes
    ----------
    z : ndarray, shape (points,)
        Height of the base [m], growing away from the sample.
    approach, retract : ndarray, shape (n, points)
        Force as recorded [N], + repulsive, in the order of `z`; the approach was recorded from its last point to its
        first.
    spring_constant : ndarray, shape (n,)
        As stated in the record [N/m].
    rate : float
        Points per second [1/s].
    truth : mapping
        Of each parameter its true values, shape (n,).
    """

    z: Floats
    approach: Floats
    retract: Floats
    spring_constant: Floats
    rate: float
    truth: Mapping[str, Floats]

    def __len__(self) -> int:
        return len(self.approach)

    def curve(self, number: int) -> ForceCurve:
        """One of them as a force curve, with its truth in ``meta``."""
        stated, time = float(self.spring_constant[number]), np.arange(2 * self.z.size) / self.rate
        branches = (
            ("approach", self.z[::-1], self.approach[number][::-1], time[: self.z.size]),
            ("retract", self.z, self.retract[number], time[self.z.size :]),
        )
        segments = tuple(
            Segment(role, at, z, "height (measured)", force, force / stated)  # type: ignore[arg-type]
            for role, z, force, at in branches
        )
        truth = {name: float(values[number]) for name, values in self.truth.items()}
        return ForceCurve(
            segments, {"spring constant": stated, "rate": self.rate, "truth": truth}, f"synthetic {number}"
        )


def synthesize_batch(
    n: int,
    model: laws.Model = "maugis",
    *,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
    spring_constant: ArrayLike,
    work_of_adhesion: ArrayLike = 0.0,
    cohesive_range: ArrayLike = 0.2e-9,
    depth: float = 60e-9,
    clearance: float = 450e-9,
    contact_point: ArrayLike = 0.0,
    points: int = 256,
    rate: float = 2000.0,
    noise: ArrayLike = 0.0,
    offset: ArrayLike = 0.0,
    tilt: ArrayLike = 0.0,
    drift: ArrayLike = 0.0,
    sensitivity_error: ArrayLike = 1.0,
    spring_constant_error: ArrayLike = 1.0,
    seed: int = 1,
    workers: int = 1,
) -> CurveBatch:
    """What an instrument would record in `n` quasi-static force curves, each with parameters of its own.

    Every parameter that is an `ArrayLike` is a number for all curves or an array of shape (n,): draw it from the
    distribution that you state, as ``rng.lognormal(np.log(20e-9), 0.1, n)``. The mechanics are those of
    :func:`synthesize`; forces are within 1e-9 of the largest one of the equilibrium on the lever.

    Parameters
    ----------
    n : int
        Curves, at least 1.
    model : {"maugis", "jkr", "dmt", "hertz"}
        The contact law.
    radius, effective_modulus, work_of_adhesion, cohesive_range : array_like
        R [m], E* [Pa], w [J/m^2], h0 = w/sigma0 [m]; the last is read by ``"maugis"`` alone.
    spring_constant, contact_point, noise, offset, tilt, drift, sensitivity_error, spring_constant_error : array_like
        As of :func:`synthesize`.
    depth, clearance, points, rate
        As of :func:`synthesize`, of all curves; depth and clearance count from z = 0.
    seed : int
        Of the noise. The same arguments give the same curves, whatever the number of workers.
    workers : int
        Threads.

    Raises
    ------
    InvalidValue
        A parameter outside its range, with the number of the curve; an array of another shape.
    """
    n, points, workers = as_count("n", n, 1), as_count("points", points, FEWEST_POINTS), as_count("workers", workers, 1)
    seed = as_count("seed", seed, 0)
    if model not in laws.MODELS:
        raise InvalidValue(f"model {model!r}: valid are {', '.join(laws.MODELS)}")
    for name, value in (("depth", depth), ("clearance", clearance), ("rate", rate)):
        check_between(name, value, POSITIVE[name], above=0.0)
    given = {"radius": radius, "effective_modulus": effective_modulus, "work_of_adhesion": work_of_adhesion,
             "cohesive_range": cohesive_range, "spring_constant": spring_constant, "contact_point": contact_point,
             "noise": noise, "offset": offset, "tilt": tilt, "drift": drift, "sensitivity_error": sensitivity_error,
             "spring_constant_error": spring_constant_error}  # fmt: skip
    truth = {name: _of_each(name, values, n) for name, values in given.items()}
    z = np.linspace(-depth, clearance, points)
    batch = CurveBatch(
        z,
        np.empty((n, points)),
        np.empty((n, points)),
        truth["spring_constant"] * truth["spring_constant_error"],
        rate,
        truth,
    )
    chunks = [slice(first, min(first + _CHUNK, n)) for first in range(0, n, _CHUNK)]
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda chunk: _fill(batch, model, chunk, seed), chunks))
    return batch


def _of_each(name: str, values: ArrayLike, n: int) -> Floats:
    array = as_floats(values, name)
    if array.shape not in ((), (n,)):
        raise InvalidValue(f"{name}: shape {array.shape}, expected a number or ({n},)")
    array = np.ascontiguousarray(np.broadcast_to(array, n))
    right = array > 0.0 if name in _POSITIVE else array >= 0.0 if name in _NOT_NEGATIVE else np.isfinite(array)
    wrong = np.flatnonzero(~(right & np.isfinite(array)))
    if wrong.size:
        unit = {**_POSITIVE, **_NOT_NEGATIVE, **ANY}[name]
        range_of = "above 0" if name in _POSITIVE else "at least 0" if name in _NOT_NEGATIVE else "finite"
        raise InvalidValue(
            f"{name} = {array[wrong[0]]:g} {unit}".rstrip() + f" of curve {wrong[0]}: it must be {range_of}"
        )
    return array


def _fill(batch: CurveBatch, model: laws.Model, chunk: slice, seed: int) -> None:
    """The forces of some curves."""
    of = {name: values[chunk] for name, values in batch.truth.items()}
    stress = of["work_of_adhesion"] / of["cohesive_range"]
    numbers = np.stack([of["radius"], of["effective_modulus"], of["work_of_adhesion"], stress], axis=1)
    rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(chunk.start // _CHUNK,))))
    scale = (of["sensitivity_error"] * of["spring_constant_error"])[:, None]
    above = batch.z - of["contact_point"][:, None]
    steps = np.arange(batch.z.size) / batch.rate  # since the deepest point
    for out, branch, age in ((batch.approach, "approach", -steps), (batch.retract, "stable", steps + 1.0 / batch.rate)):
        stage = -above - of["drift"][:, None] * age
        force = out[chunk]
        which = (laws.MODELS.index(model), laws.branch_index(branch), chunk.start)  # type: ignore[arg-type]
        rng.standard_normal(out=force)
        force *= of["noise"][:, None]
        force += _core.ramps(which, numbers, of["spring_constant"], stage)
        force += of["offset"][:, None] + of["tilt"][:, None] * above
        force *= scale
