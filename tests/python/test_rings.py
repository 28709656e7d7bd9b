# SPDX-License-Identifier: BSD-3-Clause
"""Plans of soft samples against rings (`rings_oracle.py`), which share nothing with them."""

from __future__ import annotations

import re

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from rings_oracle import Rings

TIP = 135e9 / (1 - 0.35**2)


@pytest.fixture(scope="module")
def rings():
    return Rings()


def exponential(energy, length):
    return lambda g: (energy / length * np.exp(-g / length), -energy / length**2 * np.exp(-g / length))


def soft(modulus, energy, length, radius, load):
    return nt.Scene(
        tip={"radius": radius},
        sample={"youngs_modulus": modulus, "poisson_ratio": 0.5},
        medium={"kind": "liquid", "hydration_energy": energy, "hydration_length": length},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0, "equilibrium_distance": 1e-11},
        range={"maximum_load": load},
    )


def test_a_wide_pressure(rings):
    """u(0) = F/(sqrt(pi) E* sqrt(2 R l)) where M = e^-12, so 1e-5; other panels 1e-9."""
    state = rings.state(exponential(1.0, 1.0), 0.5, 1.0, 1.0, 12.0)
    assert state.displacement == pytest.approx(state.force / np.sqrt(np.pi), rel=1e-5)
    other = Rings(0.7, 14.0, 0.2).state(exponential(1.0, 1.0), 0.5, 1.0, 1.0, 0.5)
    assert rings.state(exponential(1.0, 1.0), 0.5, 1.0, 1.0, 0.5)[:3] == pytest.approx(other[:3], rel=1e-9)


@pytest.mark.parametrize("quantity", ["force", "stiffness"])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("modulus", [1e5, 3e5, 1e7])
def test_within_the_bound(rings, modulus, accuracy, quantity):
    length, radius, energy = 5e-9, 2e-6, 1e-4
    stiffness = 1 / (0.75 / modulus + 1 / TIP)
    states = [
        rings.state(exponential(energy, length), radius, stiffness, length, g)
        for g in np.array([60, 40, 25, 12, 8]) * 1e-9
    ]
    scene = soft(modulus, energy, length, radius, 1.01 * states[-1].force)
    plan = scene.plan(relative_accuracy=accuracy, quantity=quantity)
    value = plan.run([1e-6] + [s.gap for s in states])
    true = np.array([getattr(s, quantity) for s in states])
    found = (value.F if quantity == "force" else value.k)[1:]
    assert np.all(np.abs(found - true) <= plan.bound * np.maximum(np.abs(true), plan.scale))


@pytest.mark.parametrize(("modulus", "length", "energy"), [(1e7, 30e-9, 1e-5), (1e6, 30e-9, 1e-5), (1e7, 3e-9, 1e-6)])
def test_a_law_that_is_left_out_presses_the_surface_away(rings, modulus, length, energy):
    """At first touch the tip is below where the surface was: there Hertz alone would be stiff, the sample is not."""
    radius = 100e-9
    touch = rings.state(exponential(energy, length), radius, 1 / (0.75 / modulus + 1 / TIP), length, 1e-4 * length)
    plan = soft(modulus, energy, length, radius, 1e-9).plan(relative_accuracy=0.2, quantity="stiffness")
    found = plan.run([1e-6, touch.gap]).k[1]
    error = abs(found - touch.stiffness) / max(touch.stiffness, plan.scale)
    assert plan.explain()["terms"][5]["form"] == "off"
    assert 0.1 * plan.bound < error <= plan.bound


@pytest.mark.parametrize("accuracy", [1e-3, 1.1e-4])
def test_the_stiffest_contact_is_that_at_the_largest_load(accuracy):
    """A table's last nodes lie far apart: the stiffness at the load is between them."""
    scene = soft(39e6, 2e-6, 7e-10, 60e-9, 1e-9)
    scene.sample.poisson_ratio, scene.adhesion.equilibrium_distance = 0.3, 7e-11
    plan = scene.plan(relative_accuracy=accuracy)
    path = plan.run(np.append(1e-6, np.linspace(1e-9, -3e-9, 4001)))
    reached = scene.range.maximum_load >= path.F
    assert plan.maximum_stiffness >= path.k[reached].max() * (1 - 1e-3)  # the path's step
    assert plan.maximum_stiffness <= path.k[reached].max() * 1.05  # no more than a twentieth above the load


def at_load(rings, energy, length, radius, modulus, load):
    """The equilibrium at a load, before the bodies touch."""
    law, low, high = exponential(energy, length), 1e-3 * length, 50 * length
    for _ in range(60):
        middle = (low * high) ** 0.5
        if rings.state(law, radius, modulus, length, middle).force > load:
            low = middle
        else:
            high = middle
    return rings.state(law, radius, modulus, length, high), law(high)[0]


@pytest.mark.parametrize("accuracy", [0.1, 1e-3])
def test_depth_and_pressure_at_the_largest_load(rings, accuracy):
    """Before contact the laws press on the sample: it begins to yield where their pressure is 1.6 Y."""
    energy, length, radius, young, load = 1e-3, 5e-9, 2e-6, 1e6, 2e-9
    state, peak = at_load(rings, energy, length, radius, 1 / (0.75 / young + 1 / TIP), load)
    scene = soft(young, energy, length, radius, load)
    scene.sample.yield_strength = 0.95 * peak / 1.6
    plan = scene.plan(accuracy)
    assert plan.explain()["largest_indentation"] == pytest.approx(-state.gap, abs=2 * accuracy * length)
    (told,) = [w for w in plan.warnings if "where the sample begins to yield" in w.text]
    assert told.value == pytest.approx(peak, rel=max(accuracy, 1e-2) / 2)
    scene.sample.yield_strength = 1.05 * peak / 1.6
    assert not [w for w in scene.plan(accuracy).warnings if "begins to yield" in w.text]


def test_a_plastic_sample_is_refused_before_contact(rings):
    """Two thirds of the peak are 3 Y; a law of one's own that is the same exponential is refused alike."""
    energy, length, radius, young, load = 1e-3, 5e-9, 2e-6, 1e7, 6e-9
    _, peak = at_load(rings, energy, length, radius, 1 / (0.75 / young + 1 / TIP), load)
    scene, limit = soft(young, energy, length, radius, load), 2 * peak / 9
    scene.sample.yield_strength = 1.05 * limit
    scene.plan(0.01)
    own = scene.copy()
    own.medium.hydration_energy = 0.0
    own.add_term(registered_exponential(2 * np.pi * radius * energy, length))
    for refused in (scene, own):
        refused.sample.yield_strength = 0.95 * limit
        with pytest.raises(InvalidValue, match="mean pressure above 3 times the yield strength of the sample") as found:
            refused.plan(0.01)
        named = float(re.findall(r"valid is .* \.\. (\S+) N", str(found.value))[0])
        assert 0.85 * load < named < load
        refused.range.maximum_load = named
        refused.plan(1e-3)


def registered_exponential(force, length):
    """Of a sphere, 2 pi R W = force; its name."""
    nt.scene.register(
        "exponential_of_rings",
        energy=lambda gap: force * length * np.exp(-gap / length),
        force=lambda gap: force * np.exp(-gap / length),
        stiffness=lambda gap: force / length * np.exp(-gap / length),
        bound=lambda gap: force * np.exp(-gap / length),
    )
    return "exponential_of_rings"


def test_a_yukawa_force_of_a_long_range(rings):
    """On a sphere it is less than 2 pi R W by l/R, on a sample that hardly deforms, too (Fischbach 2001)."""
    radius, length, energy, young = 200e-9, 20e-9, 1e-4, 1e6
    scene = soft(young, 0.0, 1e-9, radius, 3e-11)
    scene.medium.yukawa_energy, scene.medium.yukawa_length = energy, length
    plan = scene.plan(1e-3)
    assert plan.explain()["deforms"]
    of_sphere = 1 - length / radius + (1 + length / radius) * np.exp(-2 * radius / length)
    law, stiffness = exponential(energy * of_sphere, length), 1 / (0.75 / young + 1 / TIP)
    states = [rings.state(law, radius, stiffness, length, g) for g in np.array([80, 60, 45, 35]) * 1e-9]
    value = plan.run([1e-6] + [s.gap for s in states])
    np.testing.assert_allclose(value.F[1:], [s.force for s in states], rtol=plan.bound, atol=plan.bound * plan.scale)


def test_van_der_waals_of_a_sphere_without_adhesion(rings):
    """A sample that deforms feels Hamaker's force of the sphere, which is less than a paraboloid's by some s/R."""
    radius, hamaker, z0, young, push = 275e-9, 1.65e-22, 4.2e-10, 3e5, exponential(3.6e-3, 0.6e-9)
    scene = soft(young, 3.6e-3, 0.6e-9, radius, 3e-11)
    scene.adhesion.hamaker_constant, scene.adhesion.equilibrium_distance = hamaker, z0
    plan = scene.plan(1e-2)
    assert plan.explain()["deforms"]

    def law(g):
        s, strength = g + z0, 2 / 3 * hamaker * radius**2 / (2 * np.pi)
        f, slope = s * (s + 2 * radius), 2 * s + 2 * radius
        pull = np.array([-2 * strength * slope / f**3, strength * (6 * slope**2 / f**4 - 4 / f**3)])
        return tuple(pull + push(g))

    stiffness = 1 / (0.75 / young + 1 / TIP)
    states = [rings.state(law, radius, stiffness, 0.6e-9, g) for g in np.array([27, 13.4, 9, 7]) * 1e-9]
    value = plan.run([1e-6] + [s.gap for s in states])
    true = np.array([s.force for s in states])
    assert np.all(np.abs(value.F[1:] - true) <= plan.bound * np.maximum(np.abs(true), plan.scale))


def test_a_pull_without_a_jump(rings):
    """Silicon under van der Waals alone, whose pressure is that of the plan's own sphere: p = k/(2 pi R)."""
    scene = nt.Scene(medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.0})
    plan, radius, z0 = scene.plan(0.01), scene.tip.radius, scene.adhesion.equilibrium_distance
    assert plan.explain()["rigid_error"] > 1.0

    def pressure(g):
        return np.reshape(plan.law("vdw", np.ravel(g)).k, np.shape(g)) / (2 * np.pi * radius)

    def law(g):
        d = 1e-5 * (g + z0)
        return pressure(g), (pressure(g + d) - pressure(g - d)) / (2 * d)

    for centre in np.array([3.0, 0.4, 0.1, 0.02, 0.005]) * 1e-9:
        state = rings.state(law, radius, TIP / 2, max((centre + z0) / 2, 1e-10), centre)
        found = plan.run([1e-6, state.gap]).F[1]
        assert abs(found - state.force) <= plan.bound * max(abs(state.force), plan.scale)
