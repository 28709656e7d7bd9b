# SPDX-License-Identifier: BSD-3-Clause
"""Plans of soft samples against rings (`rings_oracle.py`), which share nothing with them."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
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
