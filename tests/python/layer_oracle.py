# SPDX-License-Identifier: BSD-3-Clause
"""Laws of contact that owe nothing to the library, and curves of an instrument that errs over them.

A rigid shape on an incompressible layer of thickness 1, bonded to rigid ground, E* = 1: the integral equation of
Lebedev and Ufliand (1958) for an even phi on (0, a), by Gauss and Legendre,

    phi(x) - 1/pi Int_0^a (L(x - t) + L(x + t)) phi(t) dt = delta - g(x)     phi(a) = 0     F = 2 Int_0^a phi
    L(u) = Int_0^inf (1 - K(s)) cos(s u) ds     K(s) = (sinh 2s - 2s)/(cosh 2s + 2s^2 + 1)

where g is the shape's one-dimensional profile: x^2/R of a paraboloid, pi/2 x/tan(psi) of a cone whose half angle psi
lies between axis and flank.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import nanotouch as nt
import numpy as np

_S, _WEIGHT = np.polynomial.legendre.leggauss(400)
_S, _WEIGHT = 10.0 * (_S + 1.0), 10.0 * _WEIGHT  # beyond s = 20 K is 1
_K = (np.sinh(2 * _S) - 2 * _S) / (np.cosh(2 * _S) + 2 * _S**2 + 1)
_GAUSS = np.polynomial.legendre.leggauss(60)
THREE_SIDED = 0.8796  # F/(E* tan(psi) delta^2), tests/c/test_contact_pyramid.c


def _kernel(x: Any, t: Any) -> Any:
    """L(x - t) + L(x + t), of cos((x - t) s) + cos((x + t) s) = 2 cos(x s) cos(t s)."""
    return 2.0 * (np.cos(np.multiply.outer(x, _S)) * ((1.0 - _K) * _WEIGHT)) @ np.cos(np.multiply.outer(_S, t))


def solved(shape: str, a: float) -> tuple[float, float]:
    """Indentation and force at a contact radius, of a paraboloid of R = 1 or a cone of tan(psi) = 1."""
    t, weight = 0.5 * a * (_GAUSS[0] + 1.0), 0.5 * a * _GAUSS[1]
    matrix = np.eye(t.size) - _kernel(t, t) * weight / math.pi
    profile, edge = (t**2, a**2) if shape == "layer" else (math.pi / 2 * t, math.pi / 2 * a)
    one, bent = np.linalg.solve(matrix, np.stack([np.ones(t.size), profile], axis=1)).T
    row = _kernel(a, t) * weight / math.pi
    depth = (edge + row @ bent) / (1.0 + row @ one)
    return float(depth), float(2.0 * weight @ (depth * one - bent))


@cache
def _table(shape: str) -> tuple[Any, Any]:
    rows = np.array([solved(shape, a) for a in np.linspace(0.0, 2.2, 200)[1:]])
    power = 1.5 if shape == "layer" else 2.0
    return np.concatenate([[0.0], rows[:, 0]]), np.concatenate([[1.0], rows[:, 1] / _space(shape, rows[:, 0], power)])


def _space(shape: str, depth: Any, power: float) -> Any:
    return (4.0 / 3.0 if shape == "layer" else 2.0 / math.pi) * depth**power


def force(shape: str, depth: Any, modulus: float, size: float, thickness: float = math.inf) -> Any:
    """Force [N] at indentations [m]; size is R [m] of sphere and layer, psi [rad] of pyramid3 and layer_cone."""
    depth = np.maximum(np.asarray(depth, dtype=np.float64), 0.0)
    if shape == "sphere":
        a = np.linspace(0.0, 0.999, 20001)
        a = size * np.interp(depth / size, a * np.arctanh(a), a)
        for _ in range(3):  # Newton: delta = a artanh(a/R)
            slope = np.arctanh(a / size) + a / size / (1.0 - (a / size) ** 2)
            a -= np.where(depth > 0.0, (a * np.arctanh(a / size) - depth) / np.where(slope > 0, slope, 1.0), 0.0)
        return modulus * ((a**2 + size**2) * np.arctanh(a / size) - a * size)
    if shape == "pyramid3":
        return THREE_SIDED * modulus * math.tan(size) * depth**2
    reduced = depth * size / thickness**2 if shape == "layer" else depth * math.tan(size) / thickness
    unit = modulus * thickness**3 / size if shape == "layer" else modulus * thickness**2 / math.tan(size)
    power = 1.5 if shape == "layer" else 2.0
    return unit * _space(shape, reduced, power) * np.interp(reduced, *_table(shape))


def measured(
    law: Any, k: float, depth: float, rng: Any, errors: tuple[float, float], noise: Any, points: int = 1500
) -> nt.curves.ForceCurve:
    """A curve as an instrument shows it whose sensitivity and spring constant err; law: force over indentation."""
    contact = 3e-7 + 1e-9 * rng.random()
    fine = np.linspace(0.0, 2.0 * depth, 20001)
    travel, load = fine + law(fine) / k, law(fine)
    z = np.linspace(contact + 1.5e-6, contact - float(np.interp(depth, fine, travel)), points)
    tilt, drift, segments = 1e-5 * rng.standard_normal(), 2e-13 * rng.standard_normal(), []
    for place, role in enumerate(("approach", "retract")):
        here = z if role == "approach" else z[::-1]
        time = (place * z.size + np.arange(z.size)) * 0.75 / points
        pushed = np.where(contact - here > 0.0, np.interp(contact - here, travel, load), 0.0)
        shown = pushed + 1e-10 + tilt * (here - contact) + drift * time + noise[place * z.size :][: z.size]
        deflection = shown / k * errors[0]
        segments.append(
            nt.curves.Segment(role, time, here, "height (measured)", k * errors[1] * deflection, deflection)
        )
    return nt.curves.ForceCurve(tuple(segments), {"spring constant": k * errors[1], "truth": contact}, "independent")
