# SPDX-License-Identifier: BSD-3-Clause
"""curves.synthesize: equilibrium and jumps as they must be, disturbances as asked; coverage of the fit's intervals."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import curves
from nanotouch.errors import InvalidValue

SOFT = nt.Contact(20e-9, 5e6, 0.05, cohesive_range=2e-9)
STIFFNESS, CONTACT = 0.5, 3e-7
MODELS: list[Any] = ["hertz", "dmt", "jkr", "maugis"]


def made(model: Any = "jkr", **given: Any) -> curves.ForceCurve:
    return curves.synthesize(SOFT, model, spring_constant=STIFFNESS, **given)


@pytest.mark.parametrize("model", MODELS)
def test_every_point_of_contact_is_an_equilibrium(model: Any) -> None:
    curve = made(model)
    for segment in curve.segments:
        assert segment.force is not None
        held = segment.force != 0.0
        # z = contact - delta - F/k_c: the force of the law at the indentation that z and F imply
        delta = CONTACT - segment.z[held] - segment.force[held] / STIFFNESS
        law = np.asarray(nt.contact.evaluate(model, delta, SOFT).F)
        slack = 1e-4 * float(
            np.abs(segment.force).max()
        )  # next to the displacement fold F(delta) is as steep as a wall
        np.testing.assert_allclose(law[:-20], segment.force[held][:-20], atol=slack)


def test_the_retraction_runs_through_its_lowest_force_to_where_the_spring_tears() -> None:
    curve = made("jkr", points=20_000)
    assert curve.retract is not None
    assert curve.approach is not None
    force, z = curve.retract.force, curve.retract.z
    assert force is not None
    assert force.min() == pytest.approx(-1.5 * np.pi * 0.05 * 20e-9, rel=1e-6)
    torn = int(np.flatnonzero(force)[-1])
    assert torn > int(np.argmin(force))
    # There the contact's stiffness is -k_c: dF/dz = -k/(1 + k/k_c) grows without bound, F ends above its minimum.
    assert force[torn] > force.min()
    assert z[torn + 1] - z[torn] < 1e-10
    assert curve.approach.force is not None
    assert np.all(curve.approach.force[curve.approach.z > CONTACT] == 0.0)


def test_a_softer_spring_tears_earlier_on_the_branch() -> None:
    def last(stiffness: float) -> float:
        curve = curves.synthesize(SOFT, "jkr", spring_constant=stiffness, points=20_000)
        assert curve.retract is not None
        assert curve.retract.force is not None
        return float(curve.retract.force[np.flatnonzero(curve.retract.force)[-1]])

    # JKR: -3/2 at the load fold (dead weight), -5/6 at the displacement fold (fixed grips), in units of pi w R
    unit = np.pi * 0.05 * 20e-9
    ends = [last(stiffness) / unit for stiffness in (0.02, 0.2, 1e3)]
    assert ends == sorted(ends)
    assert ends[0] == pytest.approx(-1.5, abs=0.03)
    assert ends[2] == pytest.approx(-5 / 6, abs=0.06)  # the last sample before the fold, where F(z) is vertical


def test_disturbances_are_those_asked_for() -> None:
    plain = made().segments
    noisy = made(noise=10e-12, offset=1e-9, tilt=1e-4, seed=5).segments
    for a, b in zip(plain, noisy, strict=True):
        assert a.force is not None
        assert b.force is not None
        rest = b.force - a.force - 1e-9 - 1e-4 * (a.z - CONTACT)
        assert abs(rest.mean()) < 4 * 10e-12 / np.sqrt(rest.size)
        assert rest.std() == pytest.approx(10e-12, rel=4 / np.sqrt(2 * rest.size))
    wrong = made(sensitivity_error=1.1, spring_constant_error=0.8)
    for a, b in zip(plain, wrong.segments, strict=True):
        np.testing.assert_allclose(b.force, 0.88 * a.force)  # type: ignore[operator]
        np.testing.assert_allclose(b.deflection, 1.1 * a.deflection)  # type: ignore[operator]
    assert wrong.spring_constant == pytest.approx(0.4)


def test_drift_moves_the_contact_from_approach_to_retraction() -> None:
    speed, rate = 1e-9, 1000.0
    still, moving = (curves.analyse(made("hertz", drift=drift, rate=rate)) for drift in (0.0, speed))
    # On the approach the contact point stands drift x (time until the deepest point) higher: 60/510 of 2 s.
    assert moving.contact_points["hertz"] - still.contact_points["hertz"] == pytest.approx(
        speed * 2.0 * 60 / 510, rel=0.3
    )


def test_the_same_seed_gives_the_same_curve_and_nonsense_is_refused() -> None:
    a, b, c = (made(noise=1e-11, seed=seed).segments[0].force for seed in (1, 1, 2))
    np.testing.assert_array_equal(a, b)  # type: ignore[arg-type]
    assert not np.array_equal(a, c)  # type: ignore[arg-type]
    for bad in ({"depth": 0.0}, {"points": 3}, {"sensitivity_error": -1.0}, {"noise": -1e-12}, {"noise": np.nan},
                {"noise": "10pN"}, {"noise": True}, {"offset": np.inf}, {"seed": 1.5}, {"depth": [1e-8]}):  # fmt: skip
        with pytest.raises(InvalidValue, match=next(iter(bad))):
            made(**bad)
    with pytest.raises(InvalidValue, match="model 'sphere': valid are maugis, jkr"):
        nt.curves.synthesize(nt.Contact(20e-9, 1e9), "sphere", spring_constant=1.0)  # type: ignore[arg-type]
