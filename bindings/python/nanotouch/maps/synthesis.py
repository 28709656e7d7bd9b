# SPDX-License-Identifier: BSD-3-Clause
"""Force volumes whose answer is known."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import contact as laws
from .. import curves
from ..errors import InvalidValue
from .volume import ArrayVolume

_DEPTH, _CLEARANCE, _CONTACT_POINT = 60e-9, 240e-9, 300e-9  # m; of a curve at height 0


def synthesize(
    effective_modulus: ArrayLike,
    work_of_adhesion: ArrayLike = 0.0,
    height: ArrayLike = 0.0,
    model: laws.Model = "maugis",
    *,
    radius: float,
    spring_constant: float,
    cohesive_range: float = 0.2e-9,
    noise: float = 0.0,
    pixel: float = 50e-9,
    seed: int = 1,
    **of_curve: Any,
) -> ArrayVolume:
    """What an instrument would record over a sample that varies from place to place.

    Parameters
    ----------
    effective_modulus, work_of_adhesion, height : array, shape (ny, nx), or float
        E* [Pa], w [J/m^2], topography [m] of each place; one curve is computed for each combination that occurs.
    model, radius, spring_constant, cohesive_range
        Law; R [m], k_c [N/m], h0 [m] of all.
    noise : float
        White, of the force [N], with `seed`.
    pixel : float
        Distance of neighbours [m].
    **of_curve
        As for :func:`nanotouch.curves.synthesize`: ``points`` of each branch, ``depth``, ``clearance``, ``tilt``, ...
    """
    maps = np.broadcast_arrays(effective_modulus, work_of_adhesion, height)
    if maps[0].ndim != 2:
        raise InvalidValue(f"a map has shape (y, x), not {maps[0].shape}")
    shape = maps[0].shape
    kinds, which = np.unique(np.stack([m.ravel() for m in maps], axis=1), axis=0, return_inverse=True)
    depth, clearance = of_curve.pop("depth", _DEPTH), of_curve.pop("clearance", _CLEARANCE)
    made = []
    for modulus, work, lift in kinds:
        contact = laws.Contact(radius, modulus, work, cohesive_range=cohesive_range if work > 0.0 else None)
        curve = curves.synthesize(
            contact, model if work > 0.0 else "hertz", spring_constant=spring_constant, depth=depth + lift,
            clearance=clearance - lift, contact_point=_CONTACT_POINT + lift, **of_curve
        )  # fmt: skip
        made.append(curve)
    force = np.stack([np.concatenate([segment.force for segment in curve.segments]) for curve in made])
    z = np.concatenate([segment.z for segment in made[0].segments])
    values = force[which.ravel()].reshape(*shape, z.size)
    if noise > 0.0:
        rng = np.random.default_rng(seed)
        for row in values:
            row += noise * rng.standard_normal(row.shape)
    coordinates = {axis: (np.arange(count) + 0.5) * pixel for axis, count in zip("yx", shape, strict=True)}
    return ArrayVolume(values, z, spring_constant, name=f"synthetic {model} map", coordinates=coordinates)
