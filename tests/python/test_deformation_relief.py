# SPDX-License-Identifier: BSD-3-Clause
"""Soft samples that deform over relief: each place against a flat of its radius by solvers that share nothing with
plans, one potential, and what is refused."""

from __future__ import annotations

from typing import Any

import cycles
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import reference, surface
from nanotouch.errors import InvalidValue
from rings_oracle import Rings

TIP = 135e9 / (1 - 0.35**2)
RADIUS = 20e-9


def dry(young: float, work: float = 0.05, radius: float = RADIUS) -> nt.Scene:
    return nt.Scene(tip={"radius": radius}, sample={"youngs_modulus": young}, medium={"relative_humidity": 0.0},
                    adhesion={"work_of_adhesion": work}, range={"maximum_load": 20.0 * work * radius})  # fmt: skip


def soft(young: float, **medium: Any) -> nt.Scene:
    """Without adhesion, in a liquid."""
    return nt.Scene(tip={"radius": RADIUS}, sample={"youngs_modulus": young, "poisson_ratio": 0.3},
                    medium={"kind": "liquid", **medium},
                    adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
                    range={"maximum_load": 0.02 * young * RADIUS**2})  # fmt: skip


def places_of(body: nt.Surface, rng: np.random.Generator, count: int) -> list[tuple[float, float, float, float]]:
    """x, y, height and effective radius [m]."""
    found = rng.uniform(0.1, 0.8, (count, 2)) * body.size[0]
    return [(x, y, float(body.height(x, y)), float(body.radius_map.radius(x, y).radius)) for x, y in found]


def at(contact: nt.Interaction, place: tuple[float, float, float, float], gaps: np.ndarray) -> Any:
    x, y, z, _ = place
    return contact.eval(np.column_stack([0.0 * gaps + x, 0.0 * gaps + y, z + gaps]))


@pytest.mark.parametrize("young", [1e6, 1e9])
def test_a_dry_sample_is_that_of_each_radius(young: float) -> None:
    """Approach and retraction, to both sides of the jump."""
    scene, rng = dry(young), np.random.default_rng(1)
    body = cycles.bumpy(scene, 3)
    plan = scene.plan(0.01, surface=body)
    assert plan.explain()["deforms"]
    assert plan.bound <= 0.01
    for place in places_of(body, rng, 2):
        flat = scene.copy()
        flat.tip.radius = place[3]
        truth = reference.deformed_scene(flat, 1e-5)
        gaps = truth.capture_gap * np.array([8.0, 3.0, 1.5, 1.05, 0.95, 0.3, 0.0])
        for history in ("approach", "retract"):
            true = truth.force(gaps, history)
            found = at(nt.Interaction(plan, history), place, gaps).Fz
            assert np.all(np.abs(found - true) <= plan.bound * np.maximum(np.abs(true), plan.scale))


@pytest.mark.parametrize(("young", "accuracy"), [(1e7, 1e-2), (3e7, 3e-3)])
def test_a_law_that_pushes_is_that_of_each_radius(young: float, accuracy: float) -> None:
    """An exponential, by elliptic rings."""
    energy, length, rings = 1e-3, 2e-9, Rings()
    scene = soft(young, hydration_energy=energy, hydration_length=length)
    scene.adhesion.equilibrium_distance = 1e-11
    scene.range.maximum_load = 1e-10
    body = cycles.bumpy(scene, 4)
    quantities: tuple[Any, ...] = ("force", "stiffness")
    plans = {quantity: scene.plan(accuracy, quantity=quantity, surface=body) for quantity in quantities}
    assert all(plan.explain()["deforms"] for plan in plans.values())

    def law(g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p = energy / length * np.exp(-g / length)
        return p, -p / length

    for place in places_of(body, np.random.default_rng(2), 3):
        modulus = 1 / ((1 - 0.3**2) / young + 1 / TIP)
        states = [rings.state(law, place[3], modulus, length, g) for g in np.array([12.0, 5.0, 2.0, 1.0]) * length]
        states = [state for state in states if state.force < scene.range.maximum_load]
        assert states
        for quantity, plan in plans.items():
            value = at(nt.Interaction(plan, "approach"), place, np.array([state.gap for state in states]))
            true = np.array([getattr(state, quantity) for state in states])
            found = value.Fz if quantity == "force" else value.k
            assert np.all(np.abs(found - true) <= plan.bound * np.maximum(np.abs(true), plan.scale)), quantity


def test_a_brush_that_is_touched_is_that_of_each_radius() -> None:
    scene = soft(1e8, ionic_strength=10.0)
    scene.tip.surface_potential = scene.sample.surface_potential = -0.02
    body = cycles.bumpy(scene, 3)
    plan = scene.plan(0.01, quantity="radius", surface=body)
    for place in places_of(body, np.random.default_rng(3), 2):
        flat = scene.copy()
        flat.tip.radius = place[3]
        gaps = np.array([3e-9, 1e-9, 0.1e-9, -0.2e-9, -0.5e-9])
        found, touch = reference.deformed(flat, gaps)
        value = at(nt.Interaction(plan, "approach"), place, gaps)
        true = np.array([here.contact_radius for here in found])
        away = np.abs(gaps - (touch or 1.0)) > plan.fold_distance_m
        away &= np.array([here.force for here in found]) < scene.range.maximum_load
        assert np.all((np.abs(value.a - true) <= plan.bound * np.maximum(true, plan.scale))[away])
        assert np.any(true[away] > 0.0)


@pytest.mark.parametrize(
    "scene", [dry(1e7), dry(1e10, radius=10e-9), soft(1e7, hydration_energy=1e-3, hydration_length=2e-9)]
)
def test_the_force_is_minus_the_gradient_of_one_potential(scene: nt.Scene) -> None:
    """By differences of fourth order over a ten-thousandth of the radius; 1e10 is a sample that does not jump."""
    body = cycles.bumpy(scene, 3) if scene.sample.youngs_modulus < 1e9 else gentle(scene)
    plan, radius, rng = scene.plan(0.01, surface=body), scene.tip.radius, np.random.default_rng(4)
    assert plan.explain()["deforms"]
    for history in ("approach", "retract"):
        contact = nt.Interaction(plan, history)
        for gap in (4e-9, 1e-9, -0.05e-9, -0.2e-9):
            x, y = rng.uniform(0.1, 0.8, 2) * body.size[0]
            pose, step = np.array([x, y, float(body.height(x, y)) + gap]), 1e-4 * radius
            value = contact.eval(pose[None])
            for axis, force in enumerate((value.Fx[0], value.Fy[0], value.Fz[0])):
                h = step if axis < 2 else 0.01 * step
                U = contact.eval(pose + np.outer([-2.0, -1.0, 1.0, 2.0], np.eye(3)[axis]) * h).U
                slope = (8.0 * (U[2] - U[1]) - (U[3] - U[0])) / (12.0 * h)
                assert -slope == pytest.approx(force, abs=1e-6 * (abs(value.Fz[0]) + plan.pull_off_force))


def gentle(scene: nt.Scene) -> nt.Surface:
    """Waves that change the radius by a seventh."""
    bumps = cycles.bumpy(scene, 3)
    heights = 0.15 * np.asarray(bumps.topography.heights)
    return nt.Surface(nt.Topography(heights, bumps.topography.pixel_size), scene.tip.radius, scene.tip.half_angle)


def test_no_lap_gives_out_energy() -> None:
    """Laps in x, y, z that jump in at one place and let go at another; quadrature feels the seams of the cubics."""
    scene = dry(1e7)
    body = cycles.bumpy(scene, 1)
    plan = scene.plan(1e-3, surface=body)
    balance = cycles.random_laps(plan, scene, body, np.random.default_rng(2), 60)
    assert balance.net_out < 1e-5
    assert balance.imbalance < 1e-4


@pytest.mark.parametrize("young", [1e6, 1e8, 1e9])
def test_what_is_planned_flat_is_planned_over_relief(young: float) -> None:
    for scene in (dry(young), soft(young, ionic_strength=10.0, brush_thickness=5e-9)):
        assert scene.plan(0.01).bound <= 0.01
        for body in (surface.grating(pixels=64), surface.dots(pixels=64)):
            plan = scene.plan(0.01, surface=nt.Surface.touched_by(scene, body))
            assert plan.bound <= 0.01
            assert not any("deforms" in warning.text for warning in plan.warnings)


def test_the_refusal_names_the_spread_of_radii() -> None:
    """At 3.25 GPa blunt places jump to the tip and sharp ones do not; on gentle waves all do."""
    scene = dry(3.25e9)
    with pytest.raises(
        InvalidValue, match=r"surface \(the soft sample deforms otherwise at the effective radius"
    ) as said:
        scene.plan(0.01, surface=cycles.bumpy(scene, 3))
    assert "youngs_modulus" not in str(said.value)
    assert scene.plan(0.01, surface=gentle(scene)).bound <= 0.01
