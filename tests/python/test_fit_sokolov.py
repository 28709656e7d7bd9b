# SPDX-License-Identifier: BSD-3-Clause
"""Sokolov's model of a cell with a brush: a named fit that finds its own truth within sigma, and tells by how much
springs in series err beside a half-space whose gap and displacement are solved together."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import reference
from nanotouch.errors import InvalidValue
from nanotouch.fit import sokolov

pytest.importorskip("nanotouch._fit", reason="built without Ceres")

#: those of the preset cell_in_liquid
RADIUS, MODULUS, THICKNESS = 2.5e-6, 1e3 / 0.75, 0.5e-6
PRESSURE = 1.380649e-23 * 310.15 / 80e-9**3
CONTACT, SPRING = 3e-6, 0.06


def curve_of(law: Callable[[Any], Any], noise: float, seed: int, points: int = 1000) -> nt.ForceCurve:
    """Approach and retraction on a lever, over the base."""
    rng = np.random.default_rng(seed)
    delta = np.linspace(-3e-6, 1.5e-6, 20001)
    force = law(delta)
    z = np.linspace(CONTACT + 2e-6, CONTACT - 1.2e-6, points)
    clean = np.interp(CONTACT - z, delta + force / SPRING, force)

    def branch(role: Any, order: slice, first: int) -> nt.curves.Segment:
        shown = clean[order] + noise * rng.standard_normal(points)
        time = (first + np.arange(points)) / 2000.0
        return nt.curves.Segment(role, time, z[order], "height (measured)", shown, shown / SPRING)

    segments = branch("approach", slice(None), 0), branch("retract", slice(None, None, -1), points)
    return nt.ForceCurve(segments, {"spring constant": SPRING, "rate": 2000.0}, "synthetic cell")


def series(delta: Any) -> Any:
    return sokolov.force_of(delta, RADIUS, MODULUS, THICKNESS, PRESSURE)


def test_one_force_goes_through_both_springs() -> None:
    """What is left of the brush carries what Hertz' cell does; nothing beyond the brush."""
    delta = np.linspace(-0.6e-6, 1e-6, 3001)
    force = series(delta)
    held = force > 0.0
    gives = np.cbrt(9.0 * force**2 / (16.0 * MODULUS**2 * RADIUS))
    left = (gives - delta)[held]
    np.testing.assert_allclose(
        2.0 * np.pi * RADIUS * reference.brush(PRESSURE, THICKNESS).energy(left), force[held], rtol=1e-8
    )
    assert np.all(np.diff(force) >= 0.0)
    assert np.all(force[delta <= -THICKNESS] == 0.0)


@pytest.mark.parametrize(("force", "alone", "together"), [(1e-9, 502e-9, 387e-9), (0.3e-9, 225e-9, 129e-9)])
def test_the_bias_is_that_of_the_cell_in_liquid(force: float, alone: float, together: float) -> None:
    bias = sokolov.series_bias(force, RADIUS, MODULUS, thickness=THICKNESS, pressure=PRESSURE)
    assert bias.series == pytest.approx(alone, rel=2e-3)
    assert bias.self_consistent == pytest.approx(together, rel=2e-3)
    assert bias.modulus == pytest.approx((alone / together) ** 1.5, rel=0.01)
    with pytest.raises(InvalidValue, match="thickness"):
        sokolov.series_bias(force, RADIUS, MODULUS, thickness=-1.0, pressure=PRESSURE)


def test_it_is_found_by_its_name_and_tells_its_bias() -> None:
    assert "sokolov" in nt.fit.models()
    result = nt.fit.fit_curve(curve_of(series, 5e-12, 1, points=300), "sokolov", radius=RADIUS, poisson_ratio=0.5)
    assert result.title == "Sokolov's springs in series"
    assert result.status == "ok"
    note = next(note for note in result.notes if note.startswith("springs in series err"))
    assert "where gap and displacement are solved together" in note
    assert note in str(result)
    assert sokolov.spacing(PRESSURE, 310.15) == pytest.approx(80e-9)
    with pytest.raises(InvalidValue, match="a scene cannot have it"):
        result.to_scene()
    with pytest.raises(InvalidValue, match="one of the library"):
        nt.fit.register(nt.fit.SOKOLOV)


def test_the_truth_is_within_sigma() -> None:
    """Eight curves of known truth: 2 sigma hold it, of E* and of the contact point, in six of them at least."""
    truth = {"effective_modulus": MODULUS, "contact_point": CONTACT}
    off: dict[str, list[float]] = {name: [] for name in truth}
    for seed in range(8):
        curve = curve_of(series, 5e-12, seed, points=150)
        options = nt.fit.Uncertainties(sensitivity=1e-6)
        fixed = {"brush_pressure": PRESSURE}
        result = nt.fit.fit_curve(curve, UNTOLD, radius=RADIUS, uncertainties=options, fixed=fixed)
        for name, value in truth.items():
            off[name].append((result.values[name] - value) / result.sigma[name])
    for name, values in off.items():
        assert np.max(np.abs(values)) < 4.5, name
        assert np.count_nonzero(np.abs(values) < 2.0) >= 6, name


#: without the note, which is a solution of its own for each curve
UNTOLD = nt.fit.Model("sokolov_untold", sokolov.force_of, nt.fit.SOKOLOV.parameters, valid="as sokolov")


def test_a_cell_that_deforms_as_a_whole_is_fitted_too_stiff() -> None:
    """The truth is self-consistent, with that brush: E* of the series comes out above it, as the note says."""
    sample = reference.Deformation(reference.brush(PRESSURE, THICKNESS), RADIUS, MODULUS, tolerance=1e-5)
    gaps = np.linspace(0.49e-6, -0.9e-6, 40)
    forces = np.array([state.force for state in sample.curve(gaps)])
    law = lambda delta: np.interp(delta, -gaps, forces, left=0.0)  # noqa: E731
    result = nt.fit.fit_curve(
        curve_of(law, 2e-12, 1), "sokolov", radius=RADIUS,
        fixed={"brush_pressure": PRESSURE, "brush_thickness": THICKNESS}, contact_point=CONTACT,
    )  # fmt: skip
    assert 1.04 < result.values["effective_modulus"] / MODULUS < 1.13  # 1.08 was measured, +- 0.05
