# SPDX-License-Identifier: BSD-3-Clause
"""curves.synthesize_batch: each curve by the law that it states, noise of its own, the same whatever the workers."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import curves
from nanotouch.errors import InvalidValue

GIVEN: dict[str, Any] = {"radius": 20e-9, "effective_modulus": 5e6, "spring_constant": 0.5, "work_of_adhesion": 0.05}


def drawn(n: int, seed: int = 3) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    return {
        "radius": 20e-9 * rng.lognormal(0.0, 0.2, n),
        "effective_modulus": 5e6 * rng.lognormal(0.0, 1.0, n),
        "work_of_adhesion": 0.05 * rng.lognormal(0.0, 0.5, n),
        "cohesive_range": 1e-9 * rng.lognormal(0.0, 0.5, n),
        "spring_constant": 0.5 * rng.lognormal(0.0, 0.5, n),
        "contact_point": 5e-9 * rng.standard_normal(n),
    }


@pytest.mark.parametrize("model", nt.contact.MODELS)
def test_every_force_is_an_equilibrium_of_its_own_contact(model: Any) -> None:
    """F = law(D - F/k_c), by the prepared law of each curve; within 1e-8 of the largest force away from the pull-off,
    where rounding of D counts as its square root."""
    batch = curves.synthesize_batch(20, model, points=200, **drawn(20))
    for i in range(20):
        true = {name: float(values[i]) for name, values in batch.truth.items()}
        contact = nt.Contact(
            true["radius"], true["effective_modulus"], true["work_of_adhesion"], cohesive_range=true["cohesive_range"]
        )
        for force in (batch.approach[i], batch.retract[i]):
            held = np.flatnonzero(force)[:-3]
            delta = true["contact_point"] - batch.z[held] - force[held] / true["spring_constant"]
            law = nt.contact.evaluate(model, delta, contact)
            error = (law.F - force[held]) / (1.0 + law.k / true["spring_constant"])
            assert np.abs(error).max() < 1e-8 * np.abs(force).max()


def test_one_of_them_is_what_synthesize_gives() -> None:
    batch = curves.synthesize_batch(
        3,
        "maugis",
        points=64,
        cohesive_range=2e-9,
        tilt=1e-3,
        drift=1e-8,
        sensitivity_error=1.1,
        spring_constant_error=0.9,
        **GIVEN,
    )
    contact = nt.Contact(20e-9, 5e6, 0.05, cohesive_range=2e-9)
    alone = curves.synthesize(
        contact,
        "maugis",
        spring_constant=0.5,
        points=64,
        contact_point=0.0,
        tilt=1e-3,
        drift=1e-8,
        sensitivity_error=1.1,
        spring_constant_error=0.9,
    )
    one = batch.curve(2)
    for mine, other in zip(one.segments, alone.segments, strict=True):
        np.testing.assert_allclose(mine.z, other.z, atol=1e-22)
        np.testing.assert_allclose(mine.time, other.time, atol=1e-12)
        np.testing.assert_allclose(mine.force, other.force, atol=1e-16)  # type: ignore[arg-type]
        np.testing.assert_allclose(mine.deflection, other.deflection, atol=1e-15)  # type: ignore[arg-type]
    assert one.spring_constant == pytest.approx(alone.spring_constant)
    assert one.meta["truth"]["work_of_adhesion"] == 0.05


def test_noise_is_white_of_the_stated_size_and_of_each_curve() -> None:
    """700 curves span many streams; correlations of 256 points scatter by 1/16."""
    batch = curves.synthesize_batch(700, "hertz", noise=20e-12, offset=1e-10, seed=8, **GIVEN)
    far = batch.retract[:, 128:] - 1e-10
    assert far.std() == pytest.approx(20e-12, rel=4.0 / np.sqrt(2.0 * far.size))
    assert abs(far.mean()) < 4.0 * 20e-12 / np.sqrt(far.size)
    for a, b in (
        (far[0], far[64]),
        (far[0], far[1]),
        (far[0], batch.approach[0, 128:] - 1e-10),
        (far[0, 1:], far[0, :-1]),
    ):
        assert abs(np.corrcoef(a, b)[0, 1]) < 5.0 / np.sqrt(128)


def test_workers_do_not_change_a_bit_and_seeds_do() -> None:
    one, many, other = (
        curves.synthesize_batch(600, "jkr", points=32, noise=1e-11, seed=seed, workers=workers, **GIVEN)
        for seed, workers in ((1, 1), (1, 3), (2, 1))
    )
    np.testing.assert_array_equal(one.approach, many.approach)
    np.testing.assert_array_equal(one.retract, many.retract)
    assert not np.array_equal(one.approach, other.approach)


def test_a_fit_finds_what_was_put_in() -> None:
    batch = curves.synthesize_batch(
        4,
        "hertz",
        noise=5e-12,
        points=500,
        radius=1e-6,
        effective_modulus=[1e3, 3e3, 1e4, 3e4],
        spring_constant=0.05,
        depth=6e-7,
        clearance=1.5e-6,
    )
    for i in range(4):
        found = nt.fit.fit_curve(batch.curve(i), "hertz", radius=1e-6)
        assert found.values["effective_modulus"] == pytest.approx(batch.truth["effective_modulus"][i], rel=0.02)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"radius": -1e-9}, r"radius = -1e-09 m of curve 0: it must be above 0"),
        ({"noise": np.array([0.0, 0.0, np.nan])}, r"noise = nan N of curve 2"),
        ({"tilt": [1.0, 2.0]}, r"tilt: shape \(2,\), expected a number or \(3,\)"),
        ({"points": 8}, r"points = 8: valid is a whole number from 16 on"),
        ({"points": 100.5}, r"points = 100.5: valid is a whole number"),
        ({"workers": None}, r"workers = None"),
        ({"seed": -1}, r"seed = -1: valid is a whole number from 0 on"),
        ({"rate": [1.0, 2.0]}, r"rate = \[1.0, 2.0\]: it must be a number \[1/s\]"),
        ({"depth": 0.0}, r"depth = 0 m"),
        ({"model": "johnson"}, r"valid are hertz"),
        ({"work_of_adhesion": 1e-30, "cohesive_range": 1e3}, r"curve 0"),
    ],
)
def test_nonsense_is_refused(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        curves.synthesize_batch(3, **{**GIVEN, **wrong})
