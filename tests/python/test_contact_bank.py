# SPDX-License-Identifier: BSD-3-Clause
"""Many contacts at once against the single law; the slope with the radius; broadcasting; refusals."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.contact.bank import Bank
from nanotouch.errors import InvalidValue

BANK = Bank()
RNG = np.random.default_rng(5)
RADIUS = 10 ** RNG.uniform(-8.5, -5, 200)
MODULUS = 10 ** RNG.uniform(6, 11, 200)
WORK = 10 ** RNG.uniform(-3, -0.5, 200)
STRESS = WORK / 10 ** RNG.uniform(-9.7, -8.5, 200)
SCALE = (math.pi**2 * WORK**2 * RADIUS / (4 / 3 * MODULUS) ** 2) ** (1 / 3)


def test_against_the_single_law() -> None:
    """Within what the bank says of itself; lambdas on both sides of 0.9379 and outside its range, which is exact."""
    depth = SCALE * RNG.uniform(0.0, 5.0, 200)
    found = BANK.evaluate(depth, RADIUS, MODULUS, WORK, STRESS)
    assert BANK.force_error < 3e-5
    for i in range(200):
        contact = nt.contact.Contact(RADIUS[i], MODULUS[i], WORK[i], cohesive_stress=STRESS[i])
        exact = nt.contact.evaluate("maugis", depth[i], contact)
        scale = max(abs(exact.F), nt.contact.pull_off_force("maugis", contact))
        assert found.F[i] == pytest.approx(exact.F, abs=BANK.force_error * scale)
        assert found.U[i] == pytest.approx(exact.U, abs=1e-4 * scale * SCALE[i])


def test_slope_with_the_radius() -> None:
    """Central differences of U: truncation h^2, rounding 1e-16 / h, of the energy."""
    depth, h = SCALE * RNG.uniform(0.5, 5.0, 200), 1e-5
    up, down = (BANK.evaluate(depth, RADIUS * (1 + s), MODULUS, WORK, STRESS).U for s in (h, -h))
    found = BANK.evaluate(depth, RADIUS, MODULUS, WORK, STRESS)
    scale = np.abs(found.U) + math.pi * WORK * RADIUS * SCALE
    assert np.abs((up - down) / (2 * h) - RADIUS * found.dU_dR).max() < 1e-6 * scale.max()
    assert (np.abs((up - down) / (2 * h) - RADIUS * found.dU_dR) < 1e-6 * scale).all()


def test_broadcasts() -> None:
    grid = BANK.evaluate([1e-9, 2e-9, 3e-9], np.array([[20e-9], [40e-9]]), 70e9, 0.1, 5e8)
    assert grid.F.shape == (2, 3)
    one = BANK.evaluate(2e-9, 40e-9, 70e9, 0.1, 5e8)
    assert type(one.F) is float
    assert grid.F[1, 1] == one.F
    assert BANK.grip_indentation(np.array([20e-9, 40e-9]), 70e9, 0.1, cohesive_stress=5e8).shape == (2,)
    grip = BANK.grip_indentation(40e-9, 70e9, 0.1, cohesive_stress=5e8)
    assert BANK.evaluate(grip * 1.0001, 40e-9, 70e9, 0.1, 5e8).F == 0.0
    assert BANK.evaluate(grip * 0.9999, 40e-9, 70e9, 0.1, 5e8).F < 0.0


def test_what_is_no_contact_is_nan() -> None:
    found = BANK.evaluate(1e-9, [20e-9, -1.0, math.nan], 70e9, 0.1, 5e8)
    assert np.isnan(found.F).tolist() == [False, True, True]
    hertz = BANK.evaluate(1e-9, 20e-9, 70e9, 0.0, 5e8)
    assert pytest.approx(4 / 3 * 70e9 * math.sqrt(20e-9) * 1e-9**1.5, rel=1e-14) == hertz.F
    assert hertz.dU_dR == pytest.approx(hertz.U / 40e-9, rel=1e-14)
    with pytest.raises(InvalidValue, match="bank of tables"):
        Bank(lambda_range=(10.0, 1.0))
    with pytest.raises(InvalidValue, match="branch"):
        BANK.evaluate(1e-9, 20e-9, 70e9, 0.1, 5e8, "no")  # type: ignore[arg-type]
