# SPDX-License-Identifier: BSD-3-Clause
"""Force curves whose answer is known."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .. import contact as laws
from .._arrays import as_count, as_number, check_between
from ..contact import geometry
from ..errors import InvalidValue
from .curve import ForceCurve, Segment

CurveModel = Literal["maugis", "jkr", "dmt", "hertz", "cone", "pyramid"]

#: what has to be above 0 in one curve and in many, and its unit
POSITIVE = {"spring_constant": "N/m", "depth": "m", "clearance": "m", "rate": "1/s",
            "sensitivity_error": "", "spring_constant_error": ""}  # fmt: skip
#: what may be any finite number (noise: not below 0), and its unit
ANY = {"contact_point": "m", "noise": "N", "offset": "N", "tilt": "N/m", "drift": "m/s"}
FEWEST_POINTS = 16  # of a branch
_TABLE = 20_001  # points of a cone's law between which it is taken as straight: below 1e-8 of the force


def synthesize(
    contact: laws.Contact,
    model: CurveModel = "maugis",
    *,
    spring_constant: float,
    depth: float = 60e-9,
    clearance: float = 450e-9,
    contact_point: float = 300e-9,
    points: int = 2000,
    rate: float = 2000.0,
    noise: float = 0.0,
    offset: float = 0.0,
    tilt: float = 0.0,
    drift: float = 0.0,
    sensitivity_error: float = 1.0,
    spring_constant_error: float = 1.0,
    half_angle: float | None = None,
    seed: int = 1,
) -> ForceCurve:
    """What an instrument would record over a known contact.

    The base moves evenly, slowly enough for equilibrium. On the approach the tip is free until the law's attraction
    begins (a gap of h0 for ``"maugis"``, first touch for the others), and then on the stable branch. On the retraction
    it follows that branch through its lowest force, until the cantilever pulls it off: where dF/d(delta) = -k_c, or at
    the law's own fold. Forces are within 1e-9 of the largest one of that equilibrium.

    Parameters
    ----------
    contact : Contact
        Tip and sample.
    model : {"maugis", "jkr", "dmt", "hertz", "cone", "pyramid"}
        The law; of the last two `contact` gives the modulus only.
    spring_constant : float
        True k_c [N/m].
    depth, clearance : float
        How far the base goes below and above the contact point [m].
    contact_point : float
        z of the base where the undeformed bodies touch [m], at the deepest point of the curve if there is drift.
    points : int
        Of each branch.
    rate : float
        Samples per second [1/s].
    noise : float
        Standard deviation of the force, white [N].
    offset, tilt : float
        Of the detector: force [N] at the contact point and its change with z of the base [N/m].
    drift : float
        Speed with which the sample recedes from the recorded z [m/s].
    sensitivity_error, spring_constant_error : float
        Stated over true calibration; both spoil the force, the first also the deflection.
    half_angle : float, optional
        Of cone (axis to flank) and pyramid (axis to face) [rad].
    seed : int
        Of the noise; the same arguments give the same curve.

    Returns
    -------
    ForceCurve
        ``meta["truth"]`` holds `contact`, `model`, `contact_point`, `spring_constant`.
    """
    for name, value in (("spring_constant", spring_constant), ("depth", depth), ("clearance", clearance),
                        ("rate", rate), ("sensitivity_error", sensitivity_error),
                        ("spring_constant_error", spring_constant_error)):  # fmt: skip
        check_between(name, value, POSITIVE[name], above=0.0)
    for name, value in (("contact_point", contact_point), ("noise", noise), ("offset", offset), ("tilt", tilt),
                        ("drift", drift)):  # fmt: skip
        number, unit = as_number(name, value, ANY[name]), ANY[name]
        if not np.isfinite(number) or (name == "noise" and number < 0.0):
            raise InvalidValue(f"{name} = {number:g} {unit}: it must be finite" + ", 0 or more" * (name == "noise"))
    if model not in get_args(CurveModel):
        raise InvalidValue(f"model {model!r}: valid are {', '.join(get_args(CurveModel))}")
    points, seed = as_count("points", points, FEWEST_POINTS), as_count("seed", seed, 0)
    rng = np.random.default_rng(seed)
    stated = spring_constant * spring_constant_error
    if model == "cone" or model == "pyramid":
        height, force_there = _equilibria_of_cone(contact, model, half_angle, spring_constant, depth)

    def force_at(role: Literal["approach", "retract"], stage: NDArray[np.float64]) -> NDArray[np.float64]:
        if model == "cone" or model == "pyramid":
            return np.where(stage > 0.0, np.interp(-stage, height, force_there), 0.0)
        numbers, spring = np.array([contact._numbers(model)]), np.array([spring_constant])
        branch = laws.branch_index("approach" if role == "approach" else "stable")
        force: NDArray[np.float64] = _core.ramps((laws.MODELS.index(model), branch, 0), numbers, spring, stage[None])[0]
        return force

    def branch(role: Literal["approach", "retract"], z: NDArray[np.float64], first: int) -> Segment:
        time = (first + np.arange(points)) / rate
        stage = contact_point - z - drift * (time - (points - 1) / rate)
        shown = force_at(role, stage) + offset + tilt * (z - contact_point) + noise * rng.standard_normal(points)
        deflection = shown / spring_constant * sensitivity_error
        return Segment(role, time, z, "height (measured)", stated * deflection, deflection)

    z = np.linspace(contact_point - depth, contact_point + clearance, points)
    truth = {"contact": contact, "model": model, "contact_point": contact_point, "spring_constant": spring_constant}
    meta = {"spring constant": stated, "rate": rate, "truth": truth}
    return ForceCurve((branch("approach", z[::-1], 0), branch("retract", z, points)), meta, f"synthetic {model} {seed}")


def _equilibria_of_cone(
    contact: laws.Contact, model: Literal["cone", "pyramid"], half_angle: float | None, stiffness: float, depth: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if half_angle is None:
        raise InvalidValue(f"model {model!r} needs half_angle")
    shape = geometry.Shape("cone", half_angle=half_angle, sides=4 if model == "pyramid" else 0)
    delta = np.linspace(1.0, 0.0, _TABLE) ** 2 * 1.2 * depth
    force = np.asarray(geometry.evaluate(shape, delta, contact.effective_modulus).F)
    return -delta - force / stiffness, force
