# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes over the presets' neighbourhoods and the extremes, and how a plan stands to the reference there."""

from __future__ import annotations

from typing import Any, NamedTuple

import cycles
import numpy as np
from nanotouch import Interaction, Scene, Surface, presets, reference
from nanotouch.errors import Error
from nanotouch.plan import Plan

PRESETS = (
    "silicon_in_air", "silicon_on_gold", "mica_in_air", "polyester", "silicone_rubber", "inas_dots", "cell_in_liquid",
)  # fmt: skip


def near_preset(rng: np.random.Generator) -> Scene:
    """A preset with every length, modulus and energy changed by up to a factor of 3."""
    scene, _ = getattr(presets, str(rng.choice(PRESETS)))()
    for name, field in scene.fields.items():
        if field.choices or scene[name] == 0.0 or name.startswith("range.") or "ratio" in name:
            continue
        if field.unit in ("m", "Pa", "J/m^2", "J", "N/m", "V"):
            scene[name] = float(np.clip(scene[name] * 3.0 ** rng.uniform(-1, 1), field.minimum, field.maximum))
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
    """A plan beside the reference."""

    plan: Plan
    error: float
    """largest |dF| over max(|F|, scale), away from folds"""
    folds_hold: bool
    """whether the reference has its folds where the plan has, within the stated shift"""


def gaps_of(plan: Plan, scene: Scene, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """From 1 cm to the largest load, denser where the force changes."""
    facts = plan.explain()
    lowest = scene.range.minimum_gap
    near = max(abs(facts["release_gap"]), abs(facts["capture_gap"]), 1e-12)
    deepest = -max(facts["largest_indentation"], 1e-15)
    gaps = np.concatenate([
        np.geomspace(1e-2, 1e-3 * near, count),
        np.linspace(1.2 * near, -1.2 * near, count),
        np.geomspace(1e-3 * deepest, deepest, count),
    ])  # fmt: skip
    return gaps[(gaps >= lowest) & (gaps >= deepest)]


def compare(scene: Scene, rtol: float, count: int = 40) -> Outcome | Error:
    """Plan and measure; a refusal is an answer, too."""
    try:
        plan = scene.plan(rtol)
    except Error as refusal:
        return refusal
    gaps = gaps_of(plan, scene, count)
    worst = 0.0
    facts = plan.explain()
    if facts["yields"]:  # measured against its own truth, which is slow: test_yielding, tests/heavy/yielding.py
        return Outcome(plan, 0.0, True)
    folds = np.array([facts["capture_gap"], facts["release_gap"]])
    for history in ("approach", "retract"):
        # far from a fold by more than rounding and the stated shift: on its two sides the forces differ by all of it
        away = np.abs(gaps[:, None] - folds).min(axis=1) > 1e-9 * np.abs(folds).max() + plan.fold_shift_m
        truth = np.asarray(reference.force(scene, gaps, history=history))[away]
        planned = np.array([plan.force(gap, history) for gap in gaps[away]])
        error = np.abs(planned - truth)
        scale = np.maximum(np.abs(truth), plan.scale)
        if not np.isfinite(planned).all():
            return Outcome(plan, np.inf, False)
        share = np.divide(error, scale, out=np.zeros_like(error), where=error != 0)
        worst = float(np.maximum(worst, share.max(initial=0.0)))  # max() may lose a NaN
    return Outcome(plan, worst, _folds_hold(plan, scene))


def compare_over(scene: Scene, body: Surface, rtol: float, rng: np.random.Generator) -> Outcome | Error:
    """A plan over a surface, and its largest error against the reference with the radius of each place."""
    try:
        plan = scene.plan(rtol, surface=body)
    except Error as refusal:
        return refusal
    gaps = gaps_of(plan, scene, 12)
    width, worst = body.size[0], 0.0
    for _ in range(5):
        x, y = rng.uniform(0.1 * width, 0.8 * width, 2)
        radius = body.radius_map.radius(x, y).radius
        poses = np.column_stack([np.full_like(gaps, x), np.full_like(gaps, y), body.height(x, y) + gaps])
        release = cycles.release_gaps(plan, poses[:1] - [0.0, 0.0, gaps[0]])[0]
        folds = np.array([plan.explain()["capture_gap"], release])
        away = np.abs(gaps[:, None] - folds).min(axis=1) > 1e-6 * np.abs(folds).max() + plan.fold_shift_m
        # heights of a surface beside small gaps: the gap that is felt is rounded
        away &= np.abs(gaps) > 1e-5 * np.abs(folds).max()
        for history in ("approach", "retract"):
            value = Interaction(plan, history).eval(poses)  # type: ignore[arg-type]
            truth = np.asarray(reference.force(scene, value.gap, history=history, radius=radius))  # type: ignore[arg-type]
            error = np.abs(value.Fz - truth) / np.maximum(np.maximum(np.abs(truth), plan.scale), 1e-300)
            worst = float(np.maximum(worst, error[away].max(initial=0.0)))
    return Outcome(plan, worst, True)


def _folds_hold(plan: Plan, scene: Scene) -> bool:
    """The reference is in contact just inside the planned capture and release gaps, and not just outside."""
    facts = plan.explain()
    if not np.isfinite(facts["lambda"]) or facts["adhesion_source"] == "none":
        return True
    for history, name in (("approach", "capture_gap"), ("retract", "release_gap")):
        margin = plan.fold_shift_m + 1e-9 * abs(facts[name])
        inside, outside = reference.forces(scene, facts[name] + np.array([-margin, margin]), history=history).contact
        if inside == 0.0 or outside != 0.0:
            return False
    return True
