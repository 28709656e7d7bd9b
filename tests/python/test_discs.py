# SPDX-License-Identifier: BSD-3-Clause
"""Plans of samples that yield against discs (`discs_oracle.py`): what a random attack broke, with the cause mended."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from discs_oracle import apart, touching

TIP = 135e9 / (1 - 0.35**2)
DUGDALE = 9 * np.sqrt(3) / 16


def maugis(radius, modulus, work, range_, m):
    """Radius of contact, force, indentation at m = c/a, in closed form (Maugis 1992)."""
    K, root = 4 / 3 * modulus, np.sqrt((m - 1) * (m + 1))
    angle = np.arctan(root)
    strength = 2 * work / range_ * (radius / (np.pi * work * K**2)) ** (1 / 3)
    A, B = strength / 2 * (root + (m * m - 2) * angle), 4 * strength**2 / 3 * (root * angle - m + 1)
    a = 2 / (B + np.sqrt(B * B + 4 * A))
    load = a**3 - strength * a * a * (root + m * m * angle)
    depth = a * a - 4 / 3 * a * strength * root
    unit = np.pi * work * radius**2 / K
    return a * unit ** (1 / 3), load * np.pi * work * radius, depth * unit ** (2 / 3) / radius


def hydration(energy, length):
    def law(g):
        p = energy / length * np.exp(-g / length)
        return p, -p / length

    return law


def scene_of(young, radius, work, z0, energy, length, load):
    return nt.Scene(tip={"radius": radius}, sample={"youngs_modulus": young, "poisson_ratio": 0.3},
                    medium={"kind": "liquid", "hydration_energy": energy, "hydration_length": length},
                    adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0, "equilibrium_distance": z0},
                    range={"maximum_load": load})  # fmt: skip


@pytest.mark.parametrize("m", [1.001, 1.2, 4.0])
def test_alone_it_is_maugis_dugdale(m):
    radius, modulus, work, range_ = 1e-6, 1.3e6, 1e-3, 0.2e-9
    a, force, depth = maugis(radius, modulus, work, range_, m)
    none = lambda g: (0 * g, 0 * g)  # noqa: E731
    found = touching(none, m, a * m * 1.02, radius, modulus, work / range_, range_, range_)
    assert found == pytest.approx((-depth, force, a), rel=5e-5)


@pytest.mark.parametrize(("log_M", "f"), [(-2, 0.3679509), (0, 1.676247), (4, 9.202063)])
def test_an_exponential_has_its_published_force(log_M, f):
    """F = E* l sqrt(2 R l) f(M), of pressures p0 exp(-g/l); by one mesh."""
    radius, length, modulus = 1e-6, 1e-9, 1e6
    h = length * (np.log(np.sqrt(2 * radius / length)) - log_M)
    gaps = np.linspace(h + 8e-9, h, 12)
    force = apart(hydration(modulus * length, length), gaps, radius, modulus, 60e-9)[0][-1]
    assert force == pytest.approx(modulus * length * np.sqrt(2 * radius * length) * f, rel=4e-4)


def test_a_law_that_reaches_a_tenth_of_the_tip_is_in_the_bound():
    """Its far part was cut at half a radius, which cost 1.3e-3 of the pull-off 0.5 pm beside the fold."""
    m, young, radius, work, z0, energy, length = 4.0, 219e6, 13.1e-9, 5.16e-3, 2e-10, -1.42e-3, 1.56e-9
    plan = scene_of(young, radius, work, z0, energy, length, 2e-10).plan(1e-4)
    modulus, end = 1 / (0.91 / young + 1 / TIP), DUGDALE * z0
    a = maugis(radius, modulus, work, end, m)[0]
    law = hydration(energy * np.exp(-(z0 - end) / length), length)
    true = touching(law, m, a * m, radius, modulus, work / end, end, 30 * length)
    value = nt.Interaction(plan, "retract").eval(np.array([[0.0, 0.0, true.gap]]))
    assert abs(value.Fz[0] - true.force) <= plan.bound * max(abs(true.force), plan.scale)
