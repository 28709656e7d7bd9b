# SPDX-License-Identifier: BSD-3-Clause
"""The self-consistent half-space against limits in closed form and numbers of other solvers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from nanotouch import reference
from nanotouch.reference import Deformation, Layer

#: of a solver that was written apart: -ln M, F/(E* l sqrt(2 R l)), u(0)/l
ONE_GROUP = [
    (8, 1.053444e-3, 5.94297e-4),
    (4, 0.05626615, 0.0316175),
    (2, 0.3679509, 0.202415),
    (0, 1.676247, 0.855703),
    (-4, 9.202063, 3.68747),
    (-10, 30.1042, 9.10231),
    (-20, 82.3117, 18.6908),
]


def sugar_brush() -> reference.Pressure:
    """That of the preset cell_in_liquid."""
    return reference.brush(1.380649e-23 * 310.15 / 80e-9**3, 0.5e-6)


@pytest.mark.parametrize(("minus_log_m", "force", "displacement"), ONE_GROUP)
def test_an_exponential_has_one_group(minus_log_m: float, force: float, displacement: float) -> None:
    radius, modulus, length = 3e-6, 2e3, 5e-9
    pressure = 40.0 * modulus
    scale = modulus * length * math.sqrt(2.0 * radius * length)
    log = math.log(pressure / modulus * math.sqrt(2.0 * radius / length))
    found = Deformation(reference.exponential(pressure, length), radius, modulus).at(length * (minus_log_m + log))
    assert found.force / scale == pytest.approx(force, rel=2e-6)
    assert found.displacement / length == pytest.approx(displacement, rel=5e-6)


@pytest.mark.parametrize(
    ("layer", "displacements"),
    [(None, [5.568e-9, 129.00e-9, 387.12e-9]), (Layer(5e-6, 0.5), [4.732e-9, 104.28e-9, 305.74e-9])],
)
def test_the_cell_of_the_preset(layer: Layer | None, displacements: list[float]) -> None:
    law, radius = sugar_brush(), 2.5e-6
    sample = Deformation(law, radius, 1e3 / 0.75, layer)
    gaps = np.geomspace(1e-9, 0.5e-6, 200001)
    rigid = 2.0 * math.pi * radius * law.energy(gaps)
    for force, displacement in zip([1e-11, 0.3e-9, 1e-9], displacements, strict=True):
        stands = np.interp(-force, -rigid, gaps)  # what no sample that deforms would do
        assert stands - sample.at_force(force, 0.45e-6).gap == pytest.approx(displacement, rel=2e-4)


def test_force_is_the_slope_of_energy_and_stiffness_that_of_force() -> None:
    sample = Deformation(reference.exponential(1e4, 1e-9), 1e-6, 1e6)
    for gap in (2e-9, -3e-9):  # the last in contact
        here, step = sample.curve([gap])[0], 2e-12
        far, near = sample.curve([gap + step, gap - step])
        assert here.force == pytest.approx((near.energy - far.energy) / (2.0 * step), rel=3e-6)
        assert here.stiffness == pytest.approx((near.force - far.force) / (2.0 * step), rel=3e-6)


def test_on_a_layer_too() -> None:
    sample = Deformation(sugar_brush(), 2.5e-6, 1e3 / 0.75, Layer(2e-6, 0.4))
    for gap in (0.3e-6, -0.1e-6):
        here, step = sample.at(gap), 1e-10
        far, near = sample.at(gap + step), sample.at(gap - step)
        assert here.force == pytest.approx((near.energy - far.energy) / (2.0 * step), rel=3e-6)


def test_a_wide_pressure_bends_the_sample_by_force_over_its_width() -> None:
    radius, modulus, length = 1e-6, 1e9, 2e-9
    here = Deformation(reference.exponential(1e4, length), radius, modulus).at(3e-9)
    wide = here.force / (math.sqrt(math.pi) * modulus * math.sqrt(2.0 * radius * length))
    assert here.displacement == pytest.approx(wide, rel=1e-3)


def test_hertz_where_the_pressure_has_no_range() -> None:
    radius, modulus = 1e-6, 1e6
    here = Deformation(reference.exponential(1.0, 1e-10), radius, modulus).curve([-2e-8])[0]
    assert here.force == pytest.approx(4.0 / 3.0 * modulus * math.sqrt(radius) * 2e-8**1.5, rel=5e-6)
    assert here.contact_radius == pytest.approx(math.sqrt(radius * 2e-8), rel=5e-6)
    assert here.stiffness == pytest.approx(2.0 * modulus * here.contact_radius, rel=5e-6)


def test_a_thick_layer_gives_less_by_0_563_force_over_modulus_and_thickness() -> None:
    force, modulus, thickness = 0.1e-9, 1e3, 4e-5
    half, layer = (
        Deformation(sugar_brush(), 2.5e-6, modulus, layer).at_force(force, 0.45e-6)
        for layer in (None, Layer(thickness, 0.5))
    )
    assert layer.gap - half.gap == pytest.approx(0.563 * force / (modulus * thickness), rel=0.02)
    assert layer.displacement < half.displacement


def test_jumps_of_attraction_have_one_group() -> None:
    radius, modulus, length = 1e-6, 1e6, 1e-9
    jump = Deformation(reference.exponential(-1e5, length), radius, modulus).jump_in(0.1e-9, 2e-8)
    assert 1e5 / modulus * math.sqrt(2.0 * radius / length) * math.exp(-jump.gap / length) == pytest.approx(
        0.259261, rel=1e-4
    )
    assert jump.displacement == pytest.approx(-1.3236 * length, rel=1e-3)
    hamaker = 1e-19
    jump = Deformation(reference.power(-hamaker / (6.0 * math.pi), 3.0), radius, modulus).jump_in(1e-9, 1e-7)
    gap = (0.5955 * hamaker * math.sqrt(radius) / modulus) ** (2.0 / 7.0)
    assert jump.gap == pytest.approx(gap, rel=2e-4)
    assert jump.force == pytest.approx(-1.7359 * hamaker * radius / (6.0 * gap**2), rel=1e-3)
    assert jump.centre_gap == pytest.approx(0.6389 * gap, rel=2e-3)


@pytest.mark.parametrize("old", ["Yielding", "Yielded", "YieldedScene", "yielded", "yielded_force", "yielded_scene"])
def test_an_old_name_is_refused_with_the_new_one(old: str) -> None:
    with pytest.raises(AttributeError, match=rf"{old} is called nanotouch\.reference\.[Dd]eform") as said:
        getattr(reference, old)
    assert hasattr(reference, str(said.value).rpartition(".")[2])
    with pytest.raises(AttributeError, match="has no attribute 'yield'"):
        getattr(reference, "yield")
