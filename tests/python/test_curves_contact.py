# SPDX-License-Identifier: BSD-3-Clause
"""Contact point by several methods, work of adhesion, contact stiffness, sensitivity: curves whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.errors import InvalidValue

STIFFNESS = 0.8  # N/m
CONTACT = 3.0e-7  # m
HERTZ = 100.0  # N/m^1.5


def curve_of(
    force_in: synthetic.Array, z_in: synthetic.Array, force_out: synthetic.Array, z_out: synthetic.Array
) -> curves.ForceCurve:
    segments = []
    for role, z, force in (("approach", z_in, force_in), ("retract", z_out, force_out)):
        segments.append(
            curves.Segment(role, np.full(z.size, np.nan), z, "height (piezo)", force=force)  # type: ignore[arg-type]
        )
    return curves.ForceCurve(tuple(segments), {"spring constant": STIFFNESS, "sensitivity": 50e-9}, "synthetic")


def hertz_curve(noise: float, seed: int = 3, n: int = 2000) -> curves.ForceCurve:
    """F = c delta^1.5 with delta = z0 - z - F/k_c, solved by making z from delta."""
    rng = np.random.default_rng(seed)
    delta = np.linspace(0.0, 300e-9, 4000)
    table_force = HERTZ * delta**1.5
    table_travel = delta + table_force / STIFFNESS
    z = np.linspace(8e-7, 1e-7, n)
    force = np.interp(CONTACT - z, table_travel, table_force, left=0.0)
    noisy = [force + noise * rng.standard_normal(n) for _ in range(2)]
    return curve_of(noisy[0], z, noisy[1][::-1], z[::-1])


def stiff_curve(**given: float) -> curves.ForceCurve:
    known = synthetic.known_curve(**given)  # type: ignore[arg-type]
    return curve_of(known.approach_force, known.approach_z, known.retract_force, known.retract_z)


def test_methods_agree_on_a_stiff_adhesive_contact() -> None:
    report = curves.analyse(stiff_curve(noise=10e-12))
    assert set(report.contact_points) == {"crossing", "two_lines", "hertz"}
    # The slope is that of the spring: 10 pN of noise are 13 pm; Hertz asks for a curvature that is not there.
    assert report.contact_points["crossing"] == pytest.approx(CONTACT, abs=0.1e-9)
    assert report.contact_points["two_lines"] == pytest.approx(CONTACT, abs=0.1e-9)
    assert report.contact_points["hertz"] == pytest.approx(CONTACT, abs=1e-9)
    assert report.contact_point == np.median(list(report.contact_points.values()))
    assert abs(report.contact_point - CONTACT) < 3 * report.sigma["contact_point"]


def test_hertz_finds_the_foot_that_the_others_see_late() -> None:
    report = curves.analyse(hertz_curve(noise=5e-12))
    found = report.contact_points
    assert set(found) == {"deviation", "two_lines", "gradient", "hertz"}
    # The law is the right one: its only error is the noise at the foot, where dF/dz is small.
    assert found["hertz"] == pytest.approx(CONTACT, abs=2e-9)
    # 25 pN, five times the noise, are reached (25e-12/100)^(2/3) = 0.4 nm in; two lines meet within the load they span.
    assert CONTACT - 10e-9 < found["deviation"] < CONTACT
    assert CONTACT - 100e-9 < found["two_lines"] < CONTACT
    assert report.sigma["contact_point"] >= np.std(list(found.values()))
    assert abs(report.contact_point - CONTACT) < 3 * report.sigma["contact_point"]


def test_the_spread_of_the_methods_is_the_uncertainty() -> None:
    stiff, soft = curves.analyse(stiff_curve(noise=10e-12)), curves.analyse(hertz_curve(noise=10e-12))
    assert soft.sigma["contact_point"] > 3 * stiff.sigma["contact_point"]


def test_a_curve_without_contact_has_no_contact_point() -> None:
    rng, z = np.random.default_rng(1), np.linspace(5e-7, 1e-7, 500)
    report = curves.analyse(curve_of(1e-11 * rng.standard_normal(500), z, 1e-11 * rng.standard_normal(500), z[::-1]))
    assert np.isnan(report.contact_point)
    assert report.contact_points == {}


@pytest.mark.parametrize("seed", range(5))
def test_adhesion_work_is_the_area_of_the_triangle(seed: int) -> None:
    known = synthetic.known_curve(noise=10e-12, seed=seed)
    report = curves.analyse(stiff_curve(noise=10e-12, seed=seed))
    expected = 0.5 * known.pull_off_force**2 / STIFFNESS
    step = float(known.retract_z[1] - known.retract_z[0])
    # The jump back lies somewhere within one step of the base, of which the trapezium takes the half.
    assert report.adhesion_work == pytest.approx(
        expected, abs=0.6 * step * known.pull_off_force + 4 * report.sigma["adhesion_work"]
    )
    assert 0.0 < report.sigma["adhesion_work"] < 0.05 * expected


def test_no_adhesion_no_work() -> None:
    assert curves.analyse(hertz_curve(noise=5e-12)).adhesion_work == 0.0


def test_contact_stiffness_takes_the_cantilever_off() -> None:
    report = curves.analyse(hertz_curve(noise=1e-12))
    # k = 1.5 c sqrt(delta) over the upper half of the load; half the load is at 0.63 of the depth.
    deepest = 2e-7 - HERTZ * 2e-7**1.5 / STIFFNESS  # at least: the spring bends less than this
    assert 1.5 * HERTZ * np.sqrt(0.6 * deepest) < report.contact_stiffness < 1.5 * HERTZ * np.sqrt(2e-7)
    slope = report.contact_slope
    assert 1 / report.contact_stiffness + 1 / STIFFNESS == pytest.approx(1 / slope)


def test_sensitivity_from_a_stiff_contact() -> None:
    curve = stiff_curve(noise=10e-12)
    value, sigma = curves.sensitivity(curve)
    assert abs(value - 50e-9) < 4 * sigma
    assert sigma < 0.01 * value
    # A file that overstates it by a third: forces and stated sensitivity are wrong together, the answer is the same.
    wrong = [curves.Segment(s.role, s.time, s.z, s.z_channel, force=4 / 3 * s.force) for s in curve.segments]  # type: ignore[operator]
    stated = dict(curve.meta) | {"sensitivity": 4 / 3 * 50e-9}
    assert curves.sensitivity(curves.ForceCurve(tuple(wrong), stated, "wrong"))[0] == pytest.approx(value)


def test_sensitivity_needs_what_it_is_made_of() -> None:
    curve = stiff_curve()
    bare = curves.ForceCurve(curve.segments, {"spring constant": STIFFNESS}, "bare")
    with pytest.raises(InvalidValue, match="no sensitivity"):
        curves.sensitivity(bare)


def test_sensitivity_of_mica() -> None:
    path = synthetic.DATA / "curves" / "fsas" / "Test.001"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    value, sigma = curves.sensitivity(curves.read(path)[0])
    assert value == pytest.approx(30.5e-9, rel=0.03)  # as read off by others; the file says 41.14 nm/V
    assert sigma < 1e-9
