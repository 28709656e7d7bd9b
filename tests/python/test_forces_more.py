# SPDX-License-Identifier: BSD-3-Clause
"""All laws of a gap, and materials, from Python: published numbers, broadcasting, rules that every law keeps to."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import contact, forces, materials
from nanotouch.errors import InvalidValue

Call = Callable[..., Any]
VDW: dict[str, Any] = {"radius": 30e-9, "hamaker_constant": 2e-19, "roughness": 1e-9, "minimum_gap": 0.2e-9}
LAYER: dict[str, Any] = {
    "radius": 30e-9,
    "debye_length": 9.6e-9,
    "relative_permittivity": 78.5,
    "tip_potential": -0.02,
    "sample_potential": -0.012,
    "minimum_gap": 0.2e-9,
}
BRUSH = {"radius": 1e-6, "thickness": 20e-9, "spacing": 2e-9, "temperature": 298.15, "minimum_gap": 0.5e-9}
CONE = {"radius": 20e-9, "half_angle": 0.3, "height": 10e-6}


def charge(gap: Any, **parameters: Any) -> Any:
    return forces.double_layer(gap, boundary="charge", **parameters)


def exponential(gap: Any, **parameters: Any) -> Any:
    return forces.steric(gap, exponential=True, **parameters)


#: every law with a valid set of all its parameters
LAWS: list[tuple[Call, dict[str, float]]] = [
    (forces.vdw, VDW),
    (forces.vdw_derjaguin, VDW),
    (forces.vdw_tip, {**VDW, **CONE}),
    (
        forces.capillary,
        {"radius": 30e-9, "surface_tension": 0.072, "meniscus_radius": 20e-9, "film_thickness": 0.1e-9},
    ),
    (forces.electrostatic, {"radius": 30e-9, "potential": 1.0, "minimum_gap": 0.2e-9}),
    (forces.electrostatic_plate, {"area": 1e-16, "potential": 1.0, "minimum_gap": 0.2e-9}),
    (forces.electrostatic_tip, {**CONE, "potential": 1.0, "minimum_gap": 0.2e-9}),
    (
        forces.electrostatic_lever,
        {
            "length": 1e-4,
            "width": 3e-5,
            "tilt": 0.2,
            "tip_height": 1e-5,
            "potential": 1.0,
            "minimum_gap": 0.2e-9,
        },
    ),
    (
        forces.lennard_jones,
        {"radius": 30e-9, "work_of_adhesion": 0.1, "equilibrium_distance": 0.2e-9, "minimum_gap": 0.1e-9},
    ),
    (forces.double_layer, LAYER),
    (charge, LAYER),
    (
        forces.hydration,
        {
            "radius": 30e-9,
            "amplitude": 0.02,
            "decay_length": 1e-9,
            "second_amplitude": -0.004,
            "second_decay_length": 3e-9,
            "minimum_gap": 0.0,
        },
    ),
    (forces.steric, BRUSH),
    (exponential, BRUSH),
]
ALL = pytest.mark.parametrize(("law", "parameters"), LAWS, ids=[law.__name__ for law, _ in LAWS])


@ALL
@given(gap=st.floats(0.6e-9, 15e-9))
def test_force_and_stiffness_are_derivatives(law: Call, parameters: dict[str, float], gap: float) -> None:
    """F = -dU/dh, k = -dF/dh: central differences leave (1e-4)^2 times some ten of the terms, which may cancel."""
    step = 1e-4 * gap
    at = law(gap + step * np.array([-1.0, 0.0, 1.0]), **parameters)
    for value, slope in ((at.U, at.F), (at.F, at.k)):
        floor = np.abs(value).max() * (1e-15 / step + 1e-7 / gap)
        assert -(value[2] - value[0]) / (2 * step) == pytest.approx(slope[1], rel=1e-6, abs=floor)


@ALL
def test_every_parameter_goes_where_its_name_says(law: Call, parameters: dict[str, float]) -> None:
    """The C library names the field it finds the NaN in: the order of the struct."""
    for name in parameters:
        with pytest.raises(InvalidValue, match=rf"\b{name} = nan"):
            law(1e-9, **{**parameters, name: math.nan})


@ALL
def test_parameters_broadcast_against_gaps(law: Call, parameters: dict[str, float]) -> None:
    gaps = np.array([[1e-9], [5e-9]])
    radii = {name: np.array([1.0, 1.5, 2.0]) * value for name, value in parameters.items()}
    for name, values in radii.items():
        if name in ("minimum_gap", "half_angle", "tilt"):
            continue
        table = law(gaps, **{**parameters, name: values})
        assert table.F.shape == (2, 3)
        for i, j in np.ndindex(2, 3):
            one = law(gaps[i, 0], **{**parameters, name: values[j]})
            assert isinstance(one.F, float)
            assert (table.U[i, j], table.F[i, j], table.k[i, j]) == (one.U, one.F, one.k)


@ALL
def test_ends(law: Call, parameters: dict[str, float]) -> None:
    """NaN gives NaN and nothing else; infinity gives nothing; empty stays empty."""
    values = law([math.nan, math.inf, 1e-9], **parameters)
    assert np.isnan([values.U[0], values.F[0], values.k[0]]).all()
    assert values.U[1] == values.F[1] == values.k[1] == 0.0
    assert np.isfinite([values.U[2], values.F[2], values.k[2]]).all()
    assert law(np.empty((0, 3)), **parameters).F.shape == (0, 3)


def test_shapes_that_do_not_broadcast() -> None:
    with pytest.raises(ValueError, match="broadcast"):
        forces.vdw(np.ones(3), **{**VDW, "radius": np.full(2, 30e-9)})


def test_bad_row_is_found() -> None:
    with pytest.raises(InvalidValue, match=r"radius = -1 m"):
        forces.vdw(np.ones(3), **{**VDW, "radius": np.array([1e-9, -1.0, 1e-9])})


def test_debye_length() -> None:
    """Israelachvili: 0.304/sqrt(c) nm of a 1:1 salt, c in mol/l."""
    assert forces.debye_length(100.0) == pytest.approx(0.304e-9 / math.sqrt(0.1), rel=4e-3)
    for bad in (0.0, -1.0, math.nan):
        with pytest.raises(InvalidValue, match="ionic_strength"):
            forces.debye_length(bad)


def test_boundary_is_one_of_two() -> None:
    with pytest.raises(InvalidValue, match="potential, charge"):
        forces.double_layer(1e-9, **LAYER, boundary="regulated")  # type: ignore[arg-type]


@given(st.floats(0.3e-9, 100e-9))
def test_charge_repels_more_than_potential(gap: float) -> None:
    """The textbook order of both boundary conditions."""
    assert charge(gap, **LAYER).F >= forces.double_layer(gap, **LAYER).F


def test_capillary_path_there_and_back() -> None:
    parameters: dict[str, Any] = {"radius": 30e-9, "meniscus_radius": 1.06e-9, "film_thickness": 5e-9}
    there = np.linspace(14e-9, 9e-9, 501)
    approach = forces.capillary_path(there, **parameters)
    assert approach.bridged
    np.testing.assert_array_equal(approach.law.F == 0.0, there > 10e-9)
    back = forces.capillary_path(there[::-1], **parameters, bridged=approach.bridged)
    assert not back.bridged
    np.testing.assert_array_equal(back.law.F, forces.capillary(there[::-1], **parameters).F)


def test_meniscus_is_the_dugdale_zone_of_a_rigid_contact() -> None:
    """The scene's meniscus is Maugis-Dugdale with w = 2 gamma over 2 r1 (erratum E12): rigid, it is the capillary law.

    The elastic surface bulges: (8/3pi) lambda c for a force of (pi/2) lambda c^2, some 1e-4 of the range at 1e15 Pa.
    """
    gamma, r1 = 0.072, 1.06e-9
    rigid = contact.Contact(radius=30e-9, effective_modulus=9e14, work_of_adhesion=2 * gamma, cohesive_range=2 * r1)
    gaps = np.linspace(0.05, 0.95, 10) * 2 * r1
    expected = forces.capillary(gaps, radius=30e-9, surface_tension=gamma, meniscus_radius=r1).F
    np.testing.assert_allclose(contact.force("maugis", -gaps, rigid), expected, rtol=1e-3)


def test_lennard_jones_pulls_off_as_dmt() -> None:
    """Bradley's rigid spheres and DMT's soft ones: 2 pi w R."""
    soft = contact.Contact(radius=30e-9, effective_modulus=1e11, work_of_adhesion=0.1)
    law = forces.lennard_jones(np.linspace(0.15e-9, 1e-9, 100001), radius=30e-9, work_of_adhesion=0.1)
    assert -law.F.min() == pytest.approx(contact.pull_off_force("dmt", soft), rel=1e-9)


def test_materials() -> None:
    silicon = materials.find("Si")
    assert silicon is materials.find("silicon")
    assert len(materials.names()) == 15
    assert materials.hamaker_constant("gold", "gold") == pytest.approx(materials.find("Au").hamaker_constant, rel=1e-15)
    assert materials.hamaker_constant("Si", "PS", "water") < materials.hamaker_constant("Si", "PS")
    assert materials.work_of_adhesion("PMMA", "PMMA") == pytest.approx(2 * 0.0411)
    expected = contact.effective_modulus(silicon.youngs_modulus, silicon.poisson_ratio, 73e9, 0.17)
    assert materials.effective_modulus(silicon, "SiO2") == expected


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: materials.find("unobtainium"), "unobtainium.*known are silicon"),
        (lambda: materials.find(""), "known are"),
        (lambda: materials.hamaker_constant("Si", "graphite"), "hamaker_constant of graphite is not in the table"),
        (lambda: materials.effective_modulus("water", "Si"), "youngs_modulus of water"),
    ],
)
def test_materials_say_what_they_do_not_know(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        call()
