# SPDX-License-Identifier: BSD-3-Clause
"""Random soft scenes, two of three with adhesion, dry or in a liquid: is a planned force, stiffness or contact radius
ever farther from the self-consistent half-space or layer than the plan says, whether its sample deforms or adds on the
undeformed gap? Where the surface jumps and where contact lets go is compared, too.

``--relief``: over random bumps, each place against a flat of its effective radius.

Resumable: ``--first SEED``; with OPENBLAS_NUM_THREADS=1 the truth is many times faster.

A violation prints the seed that makes the scene again; what is refused is counted by its reason.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import cycles
import nanotouch as nt
import numpy as np
from nanotouch import reference
from nanotouch.errors import Error, SolverError


def scene_of(rng: np.random.Generator) -> nt.Scene:
    """In a liquid, from 100 Pa to 100 GPa, with one to three laws that push."""
    scene = nt.Scene(medium={"kind": "liquid"}, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0})
    scene.tip.radius = 10.0 ** rng.uniform(-8, -5)
    scene.sample.youngs_modulus = 10.0 ** rng.uniform(2, 11)
    scene.sample.poisson_ratio = rng.uniform(0.2, 0.5)
    scene.medium.ionic_strength = 0.0
    which = rng.integers(1, 8)
    if which & 1:
        debye = scene.tip.radius * 10.0 ** rng.uniform(-3, -1)  # Derjaguin's
        scene.medium.ionic_strength = min((0.304e-9 / debye) ** 2 * 1e3, 1e3)
        scene.tip.surface_potential = scene.sample.surface_potential = -rng.uniform(0.005, 0.06)
    if which & 2:
        scene.medium.hydration_energy = 10.0 ** rng.uniform(-4, -2)
        scene.medium.hydration_length = 10.0 ** rng.uniform(-9.6, -9)
    if which & 4:
        scene.medium.brush_thickness = min(10.0 ** rng.uniform(-8.5, -6.5), 0.5 * scene.tip.radius)
        scene.medium.brush_spacing = 10.0 ** rng.uniform(-8.5, -7)
    if rng.random() < 0.3 and scene.sample.youngs_modulus < 1e6:
        scene.sample.thickness = scene.tip.radius * 10.0 ** rng.uniform(0.3, 1.5)
    width = scene.tip.radius * 10.0 ** rng.uniform(-2.0, -0.5)
    modulus = scene.sample.youngs_modulus / (1.0 - scene.sample.poisson_ratio**2)
    scene.range.maximum_load = max(4.0 / 3.0 * modulus * width**3 / scene.tip.radius, 1e-14)
    return scene


def sticky_scene_of(rng: np.random.Generator) -> nt.Scene:
    """In dry air, from 10 kPa to 100 GPa, with van der Waals that is a part of w."""
    distance, work = 10.0 ** rng.uniform(-9.8, -9.4), 10.0 ** rng.uniform(-3, -1)
    scene = nt.Scene(medium={"relative_humidity": 0.0})
    scene.tip.radius = 10.0 ** rng.uniform(-8, -5)
    scene.sample.youngs_modulus = 10.0 ** rng.uniform(4, 11)
    scene.sample.poisson_ratio = rng.uniform(0.2, 0.5)
    scene.adhesion.equilibrium_distance, scene.adhesion.work_of_adhesion = distance, work
    scene.adhesion.hamaker_constant = 12.0 * np.pi * work * distance**2 * 10.0 ** rng.uniform(-1.0, 0.2)
    scene.range.maximum_load = 5.0 * work * scene.tip.radius
    return scene


def compare_sticky(rng: np.random.Generator) -> tuple[str, float, float]:
    """The same of a scene with adhesion; a jump that is not where the plan says is an infinite error."""
    scene, demand = sticky_scene_of(rng), 10.0 ** rng.uniform(-3.0, -1.0)
    try:
        plan = scene.plan(demand)
    except Error as refusal:
        return f"sticky, refused: {str(refusal).split(' = ')[0]}", 0.0, 0.0
    facts = plan.explain()
    try:
        truth = reference.deformed_scene(scene, 1e-5)
        capture, release = truth.capture_gap, facts["release_gap"]
        near = np.array([8.0, 3.0, 1.5, 1.1]) * capture
        error = 0.0
        for history in ("approach", "retract"):
            gaps = np.sort(np.concatenate([near if history == "approach" else [0.9 * release], [0.9 * capture, 0.0]]))[
                ::-1
            ]
            true = reference.deformed_scene(scene, 1e-5).force(gaps, history) if facts["deforms"] else None
            if true is None:  # contact of stiff samples is a law of its own: beside it alone
                gaps = gaps[gaps > capture] if history == "approach" else gaps[:0]
                true = truth.force(gaps, history)
            found = nt.Interaction(plan, history).eval(np.column_stack([0.0 * gaps, 0.0 * gaps, gaps])).Fz
            share = np.abs(found - true) / np.maximum(np.abs(true), plan.scale)
            error = float(np.maximum(error, np.max(share, initial=0.0)))
    except (SolverError, np.linalg.LinAlgError):
        return "sticky: reference failed", 0.0, plan.bound
    if facts["deforms"] and abs(facts["capture_gap"] - capture) > plan.fold_shift_m + 1e-9 * capture:
        error = np.inf
    kind = "rigid" if not facts["deforms"] else "jumps" if truth.jumps else "deforms"
    return f"sticky, {kind}", error, plan.bound


def wet_scene_of(rng: np.random.Generator) -> nt.Scene:
    """Adhesive contact in a liquid, with a double layer or hydration around it, from 10 kPa to 10 GPa."""
    scene = nt.Scene(medium={"kind": "liquid"}, adhesion={"hamaker_constant": 0.0})
    scene.tip.radius = 10.0 ** rng.uniform(-8, -5.5)
    scene.sample.youngs_modulus = 10.0 ** rng.uniform(4, 9)
    scene.sample.poisson_ratio = rng.uniform(0.2, 0.5)
    scene.adhesion.work_of_adhesion = 10.0 ** rng.uniform(-4, -1.5)
    debye = min(scene.tip.radius * 10.0 ** rng.uniform(-2.5, -1), 1e-7)
    scene.medium.ionic_strength = min((0.304e-9 / debye) ** 2 * 1e3, 1e3)
    scene.tip.surface_potential = scene.sample.surface_potential = -rng.uniform(0.005, 0.025)
    if rng.random() < 0.4:
        scene.medium.hydration_energy = scene.adhesion.work_of_adhesion * 10.0 ** rng.uniform(-2, -0.7)
        scene.medium.hydration_length = 10.0 ** rng.uniform(-9.6, -9)
    scene.range.maximum_load = 5.0 * scene.adhesion.work_of_adhesion * scene.tip.radius
    return scene


def charged_scene_of(rng: np.random.Generator) -> nt.Scene:
    """Adhesive contact in vacuum at a potential, with or without van der Waals, from 10 MPa to 10 GPa."""
    scene = nt.Scene(medium={"kind": "vacuum"}, adhesion={"hamaker_constant": 0.0})
    scene.tip.radius = 10.0 ** rng.uniform(-8, -5.5)
    scene.sample.youngs_modulus = 10.0 ** rng.uniform(7, 10)
    scene.sample.poisson_ratio = rng.uniform(0.2, 0.5)
    work = scene.adhesion.work_of_adhesion = 10.0 ** rng.uniform(-2.5, -1)
    if rng.random() < 0.5:
        distance = scene.adhesion.equilibrium_distance
        scene.adhesion.hamaker_constant = 12.0 * np.pi * work * distance**2 * rng.uniform(0.1, 0.9)
    scene.adhesion.contact_potential = 10.0 ** rng.uniform(-1.3, 0.3)
    scene.range.maximum_load = 5.0 * work * scene.tip.radius
    return scene


def compare_wet(rng: np.random.Generator, made: Callable[[np.random.Generator], nt.Scene]) -> tuple[str, float, float]:
    """Contact with what acts around it: force or contact radius on the way out, and both folds."""
    scene, demand = made(rng), 10.0 ** rng.uniform(-3.0, -1.0)
    quantity = str(rng.choice(["force", "radius", "folds"]))
    try:
        plan = scene.plan(demand, quantity=quantity)  # type: ignore[arg-type]
    except Error as refusal:
        return f"around, refused: {str(refusal).split(' = ')[0]}", 0.0, 0.0
    facts = plan.explain()
    alone = facts["deforms"] and facts["terms"][0]["form"] != "deformed" and scene.adhesion.hamaker_constant > 0.0
    if alone and facts["capture_gap"] <= 1.001 * 9.0 * np.sqrt(3.0) / 16.0 * scene.adhesion.equilibrium_distance:
        return "around: tail goes on into contact, which the reference does not know", 0.0, plan.bound
    if facts["lambda"] < 1.0:  # is let go with no radius of contact, which the reference does not know
        return "around: too hard for the reference", 0.0, plan.bound
    try:
        truth = reference.deformed_scene(scene, 1e-5)
        around = truth.surrounded
        assert around is not None
        assert around.release is not None
        release, deepest = around.release.gap, -0.9 * facts["largest_indentation"]
        off = max(abs(facts["release_gap"] - release), abs(facts["capture_gap"] - truth.capture_gap))
        kind = "around, deforms" if facts["deforms"] else "around, rigid"
        if off > plan.fold_shift_m + 1e-9 * abs(release):
            return f"{kind}, folds", np.inf, plan.bound
        if quantity == "folds":
            return f"{kind}, folds", off / plan.scale, plan.bound
        first = release - 1.1 * plan.fold_distance_m - 1e-3 * abs(release - deepest)
        gaps = np.linspace(first, deepest, 5)
        true = [around.at(gap) for gap in gaps]
    except (SolverError, np.linalg.LinAlgError, ValueError):
        return "around: reference failed", 0.0, plan.bound
    value = nt.Interaction(plan, "retract").eval(np.column_stack([0.0 * gaps, 0.0 * gaps, gaps]))
    planned = value.Fz if quantity == "force" else value.a
    exact = np.array([t.force if quantity == "force" else t.contact_radius for t in true])
    error = np.abs(planned - exact) / np.maximum(np.abs(exact), plan.scale)
    return f"{kind}, {quantity}", float(error.max()) if np.isfinite(error).all() else np.inf, plan.bound


def compare(seed: int, count: int = 6) -> tuple[str, float, float]:
    """What came of a seed, the error and the bound."""
    rng = np.random.default_rng(seed)
    if seed % 3 == 2:
        return compare_sticky(rng)
    if seed % 3 == 1:
        return compare_wet(rng, charged_scene_of if seed % 6 == 4 else wet_scene_of)
    scene, demand = scene_of(rng), 10.0 ** rng.uniform(-4.0, -1.0)
    quantity = str(rng.choice(["force", "stiffness", "radius"]))
    try:
        plan = scene.plan(demand, quantity=quantity)  # type: ignore[arg-type]
    except Error as refusal:
        return f"refused: {str(refusal).split(' = ')[0]}", 0.0, 0.0
    facts = plan.explain()
    kind = "deforms" if facts["deforms"] else "rigid"
    gaps = gaps_of(plan, scene, rng, count)
    try:
        truth, touch = reference.deformed(scene, gaps)
    except (SolverError, np.linalg.LinAlgError):
        return f"{kind}: reference failed", 0.0, plan.bound
    value = plan.run(gaps)
    name = {"force": ("F", "force"), "stiffness": ("k", "stiffness"), "radius": ("a", "contact_radius")}[quantity]
    exact = np.array([getattr(here, name[1]) for here in truth])
    error = np.abs(getattr(value, name[0]) - exact) / np.maximum(np.abs(exact), plan.scale)
    error[np.array([here.force for here in truth]) > 1.02 * scene.range.maximum_load] = 0.0
    if touch is not None:
        error = error[np.abs(gaps - touch) > plan.fold_distance_m]
    worst = float(error.max(initial=0.0)) if np.isfinite(error).all() else np.inf
    return f"{kind}, {quantity}", worst, plan.bound


def compare_over(seed: int) -> tuple[str, float, float]:
    """The force over relief, of a dry scene or one of laws that push: at two places, beside their own flats."""
    rng = np.random.default_rng(seed)
    sticks = seed % 2 == 0
    scene, demand = (sticky_scene_of if sticks else scene_of)(rng), 10.0 ** rng.uniform(-3.0, -1.0)
    scene.sample.thickness = 0.0
    body = cycles.bumpy(scene, seed)
    try:
        plan = scene.plan(demand, surface=body)
    except Error as refusal:
        try:
            flat = "flat, too" if scene.plan(demand).bound > demand else "over relief alone"
        except Error:
            flat = "flat, too"
        return f"refused {flat}: {str(refusal).split(' = ')[0][:60]}", 0.0, 0.0
    if not plan.explain()["deforms"]:
        return "rigid over relief: refused no more", 0.0, plan.bound
    error, kind = 0.0, "dry relief" if sticks else "relief"
    for _ in range(2):
        x, y = rng.uniform(0.1, 0.8, 2) * body.size[0]
        flat_scene = scene.copy()
        flat_scene.tip.radius = float(body.radius_map.radius(x, y).radius)
        try:
            there = error_at(plan, flat_scene, rng, (x, y, float(body.height(x, y))))
        except (SolverError, np.linalg.LinAlgError):
            return f"{kind}: reference failed", 0.0, plan.bound
        error = float(np.maximum(error, there))
    return kind, error, plan.bound


def error_at(plan: nt.Plan, scene: nt.Scene, rng: np.random.Generator, place: tuple[float, float, float]) -> float:
    """Of the force at a place (x, y, height), whose flat is `scene`."""
    x, y, z = place
    if scene.adhesion.work_of_adhesion > 0.0:
        capture = reference.deformed_scene(scene, 1e-5).capture_gap
        gaps = capture * np.array([8.0, 3.0, 1.5, 1.1, 0.9, 0.0])
        true = reference.deformed_scene(scene, 1e-5).force(gaps, "approach")
    else:
        gaps = gaps_of(scene.plan(0.1), scene, rng, 4)
        true = np.array([here.force for here in reference.deformed(scene, gaps)[0]])
        true[true > scene.range.maximum_load] = np.nan  # beyond what is planned
    found = nt.Interaction(plan, "approach").eval(np.column_stack([0.0 * gaps + x, 0.0 * gaps + y, z + gaps])).Fz
    error = np.abs(found - true) / np.maximum(np.abs(true), plan.scale)
    return float(np.nanmax(error, initial=0.0))


def gaps_of(plan: nt.Plan, scene: nt.Scene, rng: np.random.Generator, count: int) -> np.ndarray:
    """Gaps in falling order at which the force is between a hundredth of the scale and the largest load."""
    load = scene.range.maximum_load
    forces = np.sort(load * 10.0 ** rng.uniform(-5.0, 0.0, count))
    found = []
    for force in forces:
        low, high = -1e-4, 1e-4
        for _ in range(80):
            middle = (low + high) / 2.0
            low, high = (middle, high) if plan.force(middle) > force else (low, middle)
        found.append(high)
    return np.array(found)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--relief", action="store_true")
    wanted = parser.parse_args()
    kinds: Counter[str] = Counter()
    shares, broken, start = [], 0, time.monotonic()
    for seed in range(wanted.first, wanted.first + wanted.count):
        kind, error, bound = compare_over(seed) if wanted.relief else compare(seed)
        kinds[kind] += 1
        if not any(word in kind for word in ("refused", "failed", "too hard", "not know")):
            shares.append(error / bound)
        if error > bound:
            broken += 1
            print(f"  VIOLATION: seed {seed}: {kind}, error {error:.3g}, bound {bound:.3g}", flush=True)
    print(f"{wanted.count} scenes from seed {wanted.first} in {time.monotonic() - start:.0f} s: {dict(kinds)}")
    told = f"median {np.median(shares):.2f}, largest {np.max(shares):.2f}" if shares else "none was compared"
    print(f"violations: {broken}; error over bound: {told}")
    return broken


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
