# SPDX-License-Identifier: BSD-3-Clause
"""Two plans of one scene never differ by more than both of their bounds. ``make heavy``

Each seed makes a scene, a quantity and two demands. The plans are compared where both bounds hold: farther than the
larger stated distance from the folds of both and from first touch. Half of the gaps crowd there, down to 1.0001 of that
distance. Folds themselves differ by no more than both stated shifts. ``--rows FILE`` keeps each row when it is
measured, and does not measure again what is there already.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from nanotouch import Interaction, Scene
from nanotouch.errors import Error

QUANTITIES = ("force", "stiffness", "radius", "folds")
#: what rounding may add to a gap, and to a force
_ROUNDING = 1e-12
#: distances from a fold or from first touch at which plans are compared, over the larger stated one
_CROWDED = 1.0 + np.geomspace(1e-4, 300.0, 40)


class Pair(NamedTuple):
    """What came of a seed; ``ratio``: the largest difference over both bounds together."""

    seed: int
    kind: str
    quantity: str = "force"
    refused: int = 0  # of two plans
    ratio: float = 0.0
    folds: float = 0.0  # of the folds, over both shifts
    deforms: int = 0
    demands: tuple[float, float] = (0.0, 0.0)  # 0: exact

    @property
    def violated(self) -> bool:
        return not (self.ratio <= 1.0 and self.folds <= 1.0)


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))


def _dry(rng: np.random.Generator) -> dict[str, Any]:
    """A tip on a solid in dry air: polymers to ceramics."""
    work = _log(rng, 0.02, 0.2)
    return {
        "tip": {"radius": _log(rng, 3e-9, 1e-7)},
        "sample": {"youngs_modulus": _log(rng, 1e9, 1.6e11), "poisson_ratio": rng.uniform(0.1, 0.45)},
        "medium": {"relative_humidity": 0.0, "film_thickness": 0.0},
        "adhesion": {"work_of_adhesion": work, "hamaker_constant": _log(rng, 1e-20, 2e-19)},
        "range": {"maximum_load": _log(rng, 5e-9, 2e-7)},
    }


def _soft(rng: np.random.Generator) -> dict[str, Any]:
    """The same on gels and rubbers."""
    scene = _dry(rng)
    scene["sample"]["youngs_modulus"] = _log(rng, 1e6, 1e9)
    return scene


def _humid(rng: np.random.Generator) -> dict[str, Any]:
    scene = _dry(rng)
    scene["medium"] = {"relative_humidity": rng.uniform(0.1, 0.9)}
    return scene


def _liquid(rng: np.random.Generator) -> dict[str, Any]:
    """With or without adhesion, under a double layer, with van der Waals; sometimes with hydration."""
    adhesive = bool(rng.random() < 0.5)
    return {
        "tip": {"radius": _log(rng, 5e-9, 1e-6), "surface_potential": rng.uniform(-0.08, 0.02)},
        "sample": {
            "youngs_modulus": _log(rng, 1e7, 1e11),
            "poisson_ratio": rng.uniform(0.2, 0.5),
            "surface_potential": rng.uniform(-0.08, 0.02),
        },
        "medium": {
            "kind": "liquid",
            "ionic_strength": _log(rng, 0.1, 300.0),
            "hydration_energy": float(rng.choice([0.0, _log(rng, 1e-4, 1e-2)])),
        },
        "adhesion": {
            "work_of_adhesion": _log(rng, 5e-4, 2e-2) if adhesive else 0.0,
            "hamaker_constant": _log(rng, 1e-21, 1e-20) if rng.random() < 0.7 else 0.0,
        },
        "range": {"maximum_load": _log(rng, 1e-9, 5e-8)},
    }


def _apart(rng: np.random.Generator) -> dict[str, Any]:
    """Any of them that never comes nearer than some gap."""
    scene = (_dry, _liquid, _humid)[int(rng.integers(3))](rng)
    scene["range"]["minimum_gap"] = _log(rng, 3e-10, 5e-8)
    return scene


KINDS = {"dry": _dry, "soft": _soft, "humid": _humid, "liquid": _liquid, "apart": _apart}
_WEIGHTS = (0.5, 0.1, 0.1, 0.2, 0.1)


def _away(plans: list[Any]) -> tuple[np.ndarray, float]:
    """Folds and first touch of both plans, and from how far the bounds of both hold [m]."""
    roots = [0.0]
    for plan in plans:
        facts = plan.explain()
        roots += [facts["capture_gap"], facts["release_gap"], *_touch(plan)]
    return np.array(sorted(set(roots))), max(plan.fold_distance_m for plan in plans)


def _touch(plan: Any) -> list[float]:
    """Where contact begins, by its radius: between nothing and something; as far as the release gap."""
    facts = plan.explain()
    low, high = -abs(facts["release_gap"]) - facts["length"], facts["release_gap"]
    held = Interaction(plan, "retract")
    if plan.explain()["terms"][0]["form"] == "off" or not held.eval([0.0, 0.0, low]).a > 0.0:
        return []
    if held.eval([0.0, 0.0, high * (1.0 - 1e-12)]).a > 0.0:
        return []
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if held.eval([0.0, 0.0, middle]).a > 0.0 else (low, middle)
    return [high]


def _gaps(plans: list[Any], scene: Scene, rng: np.random.Generator) -> np.ndarray:
    """Crowding at folds and first touch, over the contact, and far from it."""
    roots, away = _away(plans)
    facts = plans[0].explain()
    crowded = (roots[:, None] + away * np.concatenate([_CROWDED, -_CROWDED])).ravel()
    depth = facts["largest_indentation"]
    inside = -depth * rng.random(30) ** 3
    apart = max(abs(facts["capture_gap"]), 1e-11) * 10.0 ** rng.uniform(-1.0, 3.0, 30)
    gaps = np.concatenate([crowded, inside, apart])
    gaps = gaps[(gaps >= scene.range.minimum_gap) & (gaps >= -depth)]
    return np.sort(gaps[np.abs(gaps[:, None] - roots).min(axis=1) > away])


def _difference(plans: list[Any], gaps: np.ndarray, quantity: str, load: float) -> float:
    """The largest difference over both bounds; of forces up to the load."""
    if gaps.size == 0:
        return 0.0
    pick = {"force": "Fz", "stiffness": "k", "radius": "a"}[quantity]
    worst = 0.0
    poses = np.column_stack([0.0 * gaps, 0.0 * gaps, gaps])
    for history in ("approach", "retract"):
        values = [Interaction(plan, history).eval(poses) for plan in plans]
        one, other = (np.asarray(getattr(value, pick)) for value in values)
        within = (values[0].Fz <= load) & (values[1].Fz <= load)
        allowed = sum(plan.bound * np.maximum(np.maximum(np.abs(one), np.abs(other)), plan.scale) for plan in plans)
        allowed = allowed + _ROUNDING * np.maximum(np.abs(one), np.abs(other))
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = np.where(one == other, 0.0, np.abs(one - other) / allowed)
        worst = float(np.maximum(worst, np.max(ratio[within], initial=0.0)))
    return worst


def _folds(plans: list[Any]) -> float:
    """By how much the folds differ, over both shifts and rounding."""
    if any(plan.explain()["adhesion_source"] == "none" or plan.contact_law == "off" for plan in plans):
        return 0.0
    allowed = sum(plan.fold_shift_m for plan in plans)
    if plans[0].quantity == "folds":
        allowed = np.minimum(allowed, sum(plan.bound * plan.scale for plan in plans))
    worst = 0.0
    for which in ("capture_gap", "release_gap"):
        one, other = (plan.explain()[which] for plan in plans)
        size = np.maximum(np.maximum(abs(one), abs(other)), 1e-12)
        worst = float(np.maximum(worst, abs(one - other) / (allowed + 1e-9 * size)))
    return worst


def measure(seed: int) -> Pair:
    """Draw, plan twice, compare."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(KINDS), p=_WEIGHTS))
    scene = Scene(**KINDS[kind](rng))
    quantity = str(rng.choice(QUANTITIES, p=(0.55, 0.15, 0.2, 0.1)))
    demands = tuple(0.0 if rng.random() < 0.1 else _log(rng, 1e-6, 0.3) for _ in range(2))
    plans = []
    for demand in demands:
        try:
            bound = "kept" if demand else "exact"
            plans.append(scene.plan(demand, quantity=quantity, bound=bound))  # type: ignore[arg-type]
        except Error:
            continue
    deforms = sum(bool(plan.explain().get("deforms", plan.explain().get("yields"))) for plan in plans)
    if len(plans) < 2:
        return Pair(seed, kind, quantity, 2 - len(plans), 0.0, 0.0, deforms, demands)
    ratio = 0.0
    if quantity != "folds":
        ratio = _difference(plans, _gaps(plans, scene, rng), quantity, scene.range.maximum_load)
    return Pair(seed, kind, quantity, 0, ratio, _folds(plans), deforms, demands)


def report(rows: list[Pair]) -> int:
    """Print what was found; how many pairs contradict each other."""
    compared = [row for row in rows if row.refused == 0]
    violations = [row for row in compared if row.violated]
    mixed = sum(row.deforms == 1 for row in compared)
    print(f"{len(rows)} pairs, {len(compared)} compared ({mixed} of a rigid and a deforming plan)")
    for kind in KINDS:
        own = [row for row in rows if row.kind == kind]
        print(f"  {kind}: {len(own)} pairs, {sum(row.refused > 0 for row in own)} with a refusal")
    for row in violations[:40]:
        print(f"  CONTRADICTION: {row}")
    print(f"contradictions: {len(violations)} {dict(Counter((row.kind, row.quantity) for row in violations))}")
    for quantity in QUANTITIES:
        ratios = [max(row.ratio, row.folds) for row in compared if row.quantity == quantity]
        if ratios:
            text = " ".join(f"{q:.3g}" for q in np.quantile(ratios, [0.5, 0.9, 0.99, 1.0]))
            print(f"{quantity}, {len(ratios)}: difference over both bounds, 50 90 99 100 %: {text}")
    return len(violations)


def kind_of(seed: int) -> str:
    """The kind of scene that a seed makes."""
    return str(np.random.default_rng(seed).choice(list(KINDS), p=_WEIGHTS))


def run(seeds: Sequence[int], jobs: int, path: Path | None) -> int:
    known: dict[int, Pair] = {}
    if path is not None and path.exists():
        for line in path.read_text().splitlines(keepends=True):
            if line.endswith("\n"):
                row = Pair(*json.loads(line))
                known[row.seed] = row
    rows = [known[seed] for seed in seeds if seed in known]
    with ProcessPoolExecutor(jobs) as pool:
        for row in pool.map(measure, [seed for seed in seeds if seed not in known], chunksize=10):
            rows.append(row)
            if path is not None:
                with path.open("a") as stream:
                    print(json.dumps(row), file=stream)
    return report(rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first pair")
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rows", type=Path, help="file that keeps each row")
    args = parser.parse_args()
    seeds = [seed for seed in range(args.first, args.first + args.pairs) if kind_of(seed) in args.kinds]
    return int(run(seeds, args.jobs, args.rows) > 0)


if __name__ == "__main__":
    sys.exit(main())
