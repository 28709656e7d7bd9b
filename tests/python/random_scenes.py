# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes over the presets' neighbourhoods and the extremes, and how a plan stands to the oracle there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import cycles
import numpy as np
from nanotouch import Interaction, Scene, Surface, presets
from nanotouch._arrays import Floats
from nanotouch.errors import Error
from nanotouch.scene.plan import Plan
from oracle import Oracle

PRESETS = (
    "silicon_in_air", "silicon_on_gold", "mica_in_air", "polyester", "silicone_rubber", "inas_dots", "cell_in_liquid",
)  # fmt: skip


def near_preset(rng: np.random.Generator) -> Scene:
    """A preset with every length, modulus and energy changed by up to a factor of 3."""
    scene, _ = getattr(presets, str(rng.choice(PRESETS)))()
    for name, field in scene.fields.items():
        if field.choices or scene[name] == 0.0 or name.startswith("range.") or "ratio" in name or "yield" in name:
            continue
        if field.unit in ("m", "Pa", "J/m^2", "J", "N/m", "V"):
            scene[name] = float(np.clip(scene[name] * 3.0 ** rng.uniform(-1, 1), field.minimum, field.maximum))
    scene.tip.yield_strength = scene.sample.yield_strength = 0.0  # not known: nothing is refused as plastic
    return scene


def extreme(rng: np.random.Generator) -> Scene:
    """R 1 nm .. 1 mm, E 100 Pa .. 1 TPa, w 0 .. 1 J/m2, humidity 0 .. 100 %, charges, liquids, all shapes."""
    scene = Scene()
    scene.tip.radius = 10.0 ** rng.uniform(-9, -3)
    scene.tip.youngs_modulus, scene.sample.youngs_modulus = 10.0 ** rng.uniform(2, 12, 2)
    scene.adhesion.work_of_adhesion = float(rng.choice([0.0, 10.0 ** rng.uniform(-6, 0)]))
    scene.adhesion.hamaker_constant = float(rng.choice([0.0, 10.0 ** rng.uniform(-22, -18)]))
    scene.adhesion.contact_potential = float(rng.choice([0.0, rng.uniform(-10, 10)]))
    scene.sample.charge = float(rng.choice([0.0, 10.0 ** rng.uniform(-21, -17)]))
    scene.sample.roughness = float(rng.choice([0.0, 10.0 ** rng.uniform(-11, -8)]))
    scene.medium.relative_humidity = float(rng.choice([0.0, 1.0, rng.uniform(0, 1)]))
    scene.medium.film_thickness = 10.0 ** rng.uniform(-11, -8)
    if scene.medium.relative_humidity == 1.0 or rng.random() < 0.2:
        scene.medium.meniscus_radius = 10.0 ** rng.uniform(-10, -6)
    if rng.random() < 0.2:
        scene.adhesion.given = str(rng.choice(["surface_energies", "pull_off_force"]))
        scene.adhesion.tip_surface_energy, scene.adhesion.sample_surface_energy = rng.uniform(0, 1, 2)
        scene.adhesion.pull_off_force = 10.0 ** rng.uniform(-1, 1) * scene.tip.radius
    scene.range.maximum_load = 10.0 ** rng.uniform(-12, -2)
    if rng.random() < 0.3:
        scene.tip.height = min(10.0 ** rng.uniform(0.4, 4) * scene.tip.radius, 1e-3)
    if rng.random() < 0.3:
        _fill(scene, rng)
    if rng.random() < 0.2:
        scene.tip.shape = str(rng.choice(["sphere", "cone", "punch", "blunted"]))
    if rng.random() < 0.2:
        scene.range.minimum_gap = 10.0 ** rng.uniform(-9, -3)
    return scene


def _fill(scene: Scene, rng: np.random.Generator) -> None:
    """With a liquid."""
    scene.medium.kind = "liquid"
    scene.medium.ionic_strength = 10.0 ** rng.uniform(-3, 3)
    scene.tip.surface_potential, scene.sample.surface_potential = rng.uniform(-0.1, 0.1, 2)
    scene.medium.hydration_energy = float(rng.choice([0.0, rng.uniform(-0.01, 0.01)]))
    scene.medium.brush_thickness = float(rng.choice([0.0, 10.0 ** rng.uniform(-9, -6)]))


class Outcome(NamedTuple):
    """A plan beside the oracle."""

    plan: Plan
    error: float
    """largest error of the demanded quantity over max(|it|, scale), as far from folds as the plan says"""
    folds_hold: bool
    """whether the folds are where the oracle has them, within the stated shift"""


QUANTITIES = ("force", "stiffness", "radius", "folds")


def oracle_of(scene: Scene, plan: Plan) -> Oracle:
    """With the w of the plan where that is to be found for a measured pull-off force, which it has to pull off with."""
    truth = Oracle(scene)
    if scene.adhesion.given == "pull_off_force" and truth.adhesion.work == 0.0 and plan.explain()["release_gap"] != 0.0:
        planned = plan.explain()["work_of_adhesion"]
        truth = Oracle(scene, planned)
        truth = Oracle(scene, planned + truth.tail)
        if not plan.explain()["deforms"]:  # else it is that of the deforming sample
            np.testing.assert_allclose(truth.pull_off(), scene.adhesion.pull_off_force, rtol=1e-8)
    return truth


def gaps_of(plan: Plan, scene: Scene, count: int, roots: Sequence[float] = ()) -> Floats:
    """From 1 cm to the largest load, denser where the force changes; as near to the roots as the bound holds."""
    facts = plan.explain()
    lowest = scene.range.minimum_gap
    near = max(abs(facts["release_gap"]), abs(facts["capture_gap"]), 1e-12)
    deepest = -max(facts["largest_indentation"], 1e-15)
    begins = plan.fold_distance_m if math.isfinite(plan.fold_distance_m) else near
    beside = np.geomspace(max(1.001 * begins, 1e-15), max(near, 1e-14), count // 3)
    gaps = np.concatenate([
        np.geomspace(1e-2, 1e-3 * near, count),
        np.linspace(1.2 * near, -1.2 * near, count),
        np.geomspace(1e-3 * deepest, deepest, count),
        *(root + sign * beside for root in roots for sign in (-1.0, 1.0)),
        *(edge * (1.0 + np.array([1e-9, 1e-3])) for edge in (near, scene.adhesion.equilibrium_distance)),
    ])  # fmt: skip
    return np.asarray(gaps[(gaps >= lowest) & (gaps >= deepest)])


def largest_error(value: Any, truth: Any, quantity: str, scale: float) -> float:
    """Over max(|truth|, scale); infinite for what is no number."""
    name = {"force": ("Fz", "F"), "stiffness": ("k", "k"), "radius": ("a", "a")}[quantity]
    planned, true = getattr(value, name[0]), getattr(truth, name[1])
    share = np.abs(planned - true) / np.maximum(np.maximum(np.abs(true), scale), 1e-300)
    return float(share.max(initial=0.0)) if np.isfinite(share).all() else math.inf


def keeps(plan: Plan, accuracy: float) -> bool:
    """Its bound is inside the demand; or what the rigid sum errs by is beyond it, is warned of, and the rest is; or the
    finest table of a sample that deforms, which is warned of, errs by less than the rigid sum.

    Where the sample jumps there is no bound, and a warning says so.
    """
    facts = plan.explain()
    if math.isinf(plan.bound):
        return any("jumps to the tip" in warning.text for warning in plan.warnings)
    warned = any("more than demanded" in warning.text for warning in plan.warnings)
    rigid = max(facts["rigid_error"], facts["around_error"]) if warned else 0.0
    if facts["deforms"]:
        return bool(plan.bound <= max(accuracy, rigid))
    return bool(plan.bound <= accuracy + rigid * (1.0 + 1e-12))


def compare(scene: Scene, accuracy: float, quantity: str = "force", count: int = 40) -> Outcome | Error:
    """Plan and measure; a refusal is an answer, too."""
    try:
        plan = scene.plan(accuracy, quantity=quantity)  # type: ignore[arg-type]
    except Error as refusal:
        return refusal
    if plan.explain()["deforms"]:  # has a truth of its own, which is slow: test_deformation, tests/heavy/deformation.py
        return Outcome(plan, 0.0, True)
    truth = oracle_of(scene, plan)
    return _compare_at(Place(0.0, 0.0, 0.0, None), plan, truth, gaps_of(plan, scene, count, truth.roots()))


def compare_over(
    scene: Scene, body: Surface, accuracy: float, rng: np.random.Generator, quantity: str = "force"
) -> Any:
    """A plan over a surface, and its largest error against the oracle with the radius of each place."""
    try:
        plan = scene.plan(accuracy, surface=body, quantity=quantity)  # type: ignore[arg-type]
    except Error as refusal:
        return refusal
    worst, hold = 0.0, True
    own = oracle_of(scene, plan) if body.work_of_adhesion is None else Oracle(_least_sticky(scene, body))
    for _ in range(5):
        x, y = rng.uniform(0.1 * body.size[0], 0.8 * body.size[0], 2)
        place = Place(x, y, float(body.height(x, y)), float(body.radius_map.radius(x, y).radius))
        modulus, work = (mean_at(pixels, body, x, y) for pixels in (body.youngs_modulus, body.work_of_adhesion))
        truth = own if modulus is None and work is None else own.over(modulus, work)
        outcome = _compare_at(place, plan, truth, gaps_of(plan, scene, 12, truth.roots(place.radius)))
        worst, hold = float(np.maximum(worst, outcome.error)), hold and outcome.folds_hold
    return Outcome(plan, worst, hold)


def _least_sticky(scene: Scene, body: Surface) -> Scene:
    """With the least w of a surface, which says how far apart its atoms are."""
    made = scene.copy()
    made.adhesion.given, made.adhesion.work_of_adhesion = "work_of_adhesion", float(np.min(body.work_of_adhesion))
    return made


def mean_at(pixels: Floats | None, body: Surface, x: float, y: float) -> float | None:
    """A property at a place: the mean of its pixels by the weights of the cubic B-spline; None where not given."""
    if pixels is None:
        return None
    dy, dx = body.topography.pixel_size
    weights = (_spline(place / pixel - np.arange(count)) for place, pixel, count in
               zip((y, x), (dy, dx), pixels.shape, strict=True))  # fmt: skip
    return float(next(weights) @ pixels @ next(weights))


def _spline(u: Floats) -> Floats:
    """B(u) of Unser (1999), 0 from two pixels on."""
    a = np.abs(u)
    return np.where(a < 1.0, 2.0 / 3.0 - a**2 + a**3 / 2.0, np.clip(2.0 - a, 0.0, None) ** 3 / 6.0)


class Place(NamedTuple):
    """Of a surface [m]; no radius: the tip's own."""

    x: float
    y: float
    z: float
    radius: float | None


def _compare_at(place: Place, plan: Plan, truth: Oracle, gaps: Floats) -> Outcome:
    roots, worst = np.array(truth.roots(place.radius)), 0.0
    poses = np.column_stack([np.full_like(gaps, place.x), np.full_like(gaps, place.y), place.z + gaps])
    shift, hold = _shift_of_folds(place, plan, truth)
    if plan.quantity == "folds":
        return Outcome(plan, shift / plan.scale if shift > 0.0 else 0.0, hold)
    for history in ("approach", "retract"):
        value = Interaction(plan, history).eval(poses)  # type: ignore[arg-type]
        away = np.abs(value.gap[:, None] - roots).min(axis=1) > plan.fold_distance_m
        value = type(value)(*(column[away] for column in value))
        exact = truth.values(value.gap, history, place.radius)
        worst = float(np.maximum(worst, largest_error(value, exact, plan.quantity, plan.scale)))
    return Outcome(plan, worst, hold)


def _shift_of_folds(place: Place, plan: Plan, truth: Oracle) -> tuple[float, bool]:
    """How far capture and release are off [m], but for rounding; whether the plan says so."""
    facts = plan.explain()
    if truth.left == 0.0 or facts["terms"][0]["form"] == "off":
        return 0.0, True
    release, capture = -max(truth.contact(place.radius).roots(), key=abs), truth.adhesion.capture
    planned = facts["release_gap"]
    if place.radius is not None:
        ground = np.array([[place.x, place.y, place.z]])
        planned = float(cycles.release_gaps(plan, ground)[0])
    shift = max(abs(planned - release), abs(facts["capture_gap"] - capture))
    rounding = 1e-9 * max(abs(release), capture)
    return max(shift - rounding, 0.0), shift <= plan.fold_shift_m + rounding
