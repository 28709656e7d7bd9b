# SPDX-License-Identifier: BSD-3-Clause
"""Random soft scenes without adhesion: is a planned force ever farther from the self-consistent half-space or layer
than the plan says, whether its sample yields or adds on the undeformed gap? Resumable: ``--first SEED``.

A violation prints the seed that makes the scene again; what is refused is counted by its reason.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter

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


def compare(seed: int, count: int = 6) -> tuple[str, float, float]:
    """What came of a seed, the error and the bound."""
    rng = np.random.default_rng(seed)
    scene, demand = scene_of(rng), 10.0 ** rng.uniform(-4.0, -1.0)
    try:
        plan = scene.plan(demand)
    except Error as refusal:
        return f"refused: {str(refusal).split(' = ')[0]}", 0.0, 0.0
    facts = plan.explain()
    kind = "yields" if facts["yields"] else "rigid"
    gaps = gaps_of(plan, scene, rng, count)
    try:
        truth = reference.yielded_force(scene, gaps)
    except (SolverError, np.linalg.LinAlgError):
        return f"{kind}: reference failed", 0.0, plan.bound
    planned = np.array([plan.force(gap) for gap in gaps])
    error = np.abs(planned - truth) / np.maximum(np.abs(truth), plan.scale)
    return kind, float(error.max()) if np.isfinite(error).all() else np.inf, plan.bound


def gaps_of(plan: nt.Plan, scene: nt.Scene, rng: np.random.Generator, count: int) -> np.ndarray:
    """Gaps in falling order at which the force is between a hundredth of the scale and the largest load."""
    forces = np.sort(plan.scale * 10.0 ** rng.uniform(-2.0, np.log10(scene.range.maximum_load / plan.scale), count))
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
    wanted = parser.parse_args()
    kinds: Counter[str] = Counter()
    shares, broken, start = [], 0, time.monotonic()
    for seed in range(wanted.first, wanted.first + wanted.count):
        kind, error, bound = compare(seed)
        kinds[kind] += 1
        if kind in ("yields", "rigid"):
            shares.append(error / bound)
        if error > bound:
            broken += 1
            print(f"  VIOLATION: seed {seed}: {kind}, error {error:.3g}, bound {bound:.3g}", flush=True)
    print(f"{wanted.count} scenes from seed {wanted.first} in {time.monotonic() - start:.0f} s: {dict(kinds)}")
    print(f"violations: {broken}; error over bound: median {np.median(shares):.2f}, largest {np.max(shares):.2f}")
    return broken


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
