# SPDX-License-Identifier: BSD-3-Clause
"""Plans of adhesive contacts with laws around them against rings (`adhesive_rings_oracle.py`)."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import oracle_contact
import pytest
from adhesive_rings_oracle import AdhesiveRings

TIP = 135e9 / (1 - 0.35**2)


@pytest.fixture(scope="module")
def rings():
    return AdhesiveRings()


@pytest.mark.parametrize("end", [30e-9, 5e-9, 1e-9])
def test_alone_it_is_maugis_dugdale(rings, end):
    """In closed form, lambda 1 to 40; the mesh resolves 1e-6."""
    radius, modulus, work = 1e-6, 1e6, 1e-3
    closed = oracle_contact.Maugis(radius, modulus, work, work / end)
    for a in np.array([0.6, 1.0, 1.5]) * (4.5 * np.pi * work * radius**2 / modulus) ** (1 / 3):
        found = rings.touching(None, a, radius, modulus, work / end, end, end)
        assert found.force == pytest.approx(closed.values(np.array([-found.gap]))[0][0], rel=1e-6)


@pytest.mark.parametrize(
    ("young", "radius", "work", "z0", "energy", "length", "accuracy"),
    [(80e9, 890e-9, 4.35e-5, 4.8e-10, -7.2e-7, 0.89e-9, 2.4e-4), (1e6, 1e-6, 1e-3, 1e-9, 2e-4, 5e-9, 1e-2)],
)
def test_a_law_around_a_contact_is_in_the_bound(rings, young, radius, work, z0, energy, length, accuracy):
    """On a stiff sample what the law does to the stiffness is largest where the bodies first touch."""
    scene = nt.Scene(tip={"radius": radius}, sample={"youngs_modulus": young, "poisson_ratio": 0.3},
                     medium={"kind": "liquid", "hydration_energy": energy, "hydration_length": length},
                     adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0, "equilibrium_distance": z0},
                     range={"maximum_load": 20 * work * radius})  # fmt: skip
    plans = {quantity: scene.plan(accuracy, quantity=quantity) for quantity in ("force", "stiffness")}
    modulus, end = 1 / (0.91 / young + 1 / TIP), 9 * np.sqrt(3) / 16 * z0

    def law(g):
        p = energy / length * np.exp(-(g - end + z0) / length)
        return p, -p / length

    a0 = (4.5 * np.pi * work * radius**2 / modulus) ** (1 / 3)
    for a in a0 * np.array([0.75, 1.0, 1.4]):
        below, here, above = (
            rings.touching(law, a * share, radius, modulus, work / end, end, 20 * length) for share in (0.999, 1, 1.001)
        )
        for quantity, plan in plans.items():
            value = nt.Interaction(plan, "retract").eval(np.array([[0.0, 0.0, here.gap]]))
            true = here.force if quantity == "force" else -(above.force - below.force) / (above.gap - below.gap)
            found = value.Fz[0] if quantity == "force" else value.k[0]
            assert abs(found - true) <= (plan.bound + 2e-6) * max(abs(true), plan.scale), quantity
