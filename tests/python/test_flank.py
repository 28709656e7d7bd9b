# SPDX-License-Identifier: BSD-3-Clause
"""Laws beside contact are those of a sphere: what a plan says where the tip is none, against sums over its rings."""

from __future__ import annotations

import math

import pytest
from nanotouch import Plan, Scene
from scipy.integrate import quad

RADIUS, ANGLE, ENERGY, LENGTH, NEAREST = 50e-9, 0.5, 1e-3, 2e-9, 2e-10


def planned(shape: str, quantity: str = "force", **adhesion: float) -> Plan:
    scene = Scene(tip={"radius": RADIUS, "half_angle": ANGLE}, medium={"kind": "liquid"})
    scene.tip.shape = shape
    scene.medium.hydration_energy, scene.medium.hydration_length = ENERGY, LENGTH
    scene.adhesion.work_of_adhesion, scene.adhesion.hamaker_constant = 0.0, adhesion.get("hamaker_constant", 0.0)
    return scene.plan(relative_accuracy=0.2, quantity=quantity)


def on_rings(shape: str) -> float:
    """Int p 2 pi r dr at the nearest gap, p = (W/l) exp(-g/l)."""
    slope = 0.0 if shape == "cone" else RADIUS
    pressure = ENERGY / LENGTH

    def ring(r: float) -> float:
        gap = NEAREST + (r - slope) / math.tan(ANGLE)
        return pressure * math.exp(-gap / LENGTH) * 2.0 * math.pi * r

    flat = math.pi * slope**2 * pressure * math.exp(-NEAREST / LENGTH)
    return flat if shape == "punch" else flat + quad(ring, slope, slope + 60.0 * LENGTH, epsrel=1e-10)[0]


@pytest.mark.parametrize("shape", ["cone", "punch", "truncated"])
def test_difference_of_the_shape_is_told(shape: str) -> None:
    plan = planned(shape)
    sphere = 2.0 * math.pi * RADIUS * ENERGY * math.exp(-NEAREST / LENGTH)
    (told,) = [warning for warning in plan.warnings if "sphere of the tip's radius" in warning.text]
    # the midpoint rule with steps of a tenth in ln(gap): (0.1)^2/24 of terms that are some units in size
    assert told.value * plan.scale == pytest.approx(abs(on_rings(shape) - sphere), rel=1e-2)


def test_figures_of_the_docs() -> None:
    """docs/plan.md: a punch feels 12.5 times the sphere's force, a cone a hundredth; Derjaguin: R/(2 l), tan^2 l/R."""
    sphere = 2.0 * math.pi * RADIUS * ENERGY * math.exp(-NEAREST / LENGTH)
    assert on_rings("punch") / sphere == pytest.approx(12.5, rel=1e-9)
    assert on_rings("cone") / sphere == pytest.approx(0.012, rel=0.02)


def test_van_der_waals_without_adhesion_is_told() -> None:
    """A flat end pulls by H R^2/(6 z0^3); with adhesion it is all in w, and on a sphere it is planned."""
    plan = planned("punch", hamaker_constant=1e-20)
    (told,) = [warning for warning in plan.warnings if "van der Waals force of this shape" in warning.text]
    assert told.value == pytest.approx(1e-20 * RADIUS**2 / (6.0 * 2e-10**3), rel=1e-9)


def test_paraboloids_and_radii_have_no_such_difference() -> None:
    for plan in (planned("paraboloid"), planned("sphere"), planned("cone", "radius")):
        assert not [warning for warning in plan.warnings if "sphere of the tip's radius" in warning.text]
