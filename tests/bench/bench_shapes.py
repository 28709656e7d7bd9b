# SPDX-License-Identifier: BSD-3-Clause
"""Does the 95 % interval hold the truth for sphere, three-sided pyramid and layers, by laws of their own?

``python tests/bench/bench_shapes.py [--curves 400]``: the generator is ``tests/python/layer_oracle.py``, which solves
the layer's integral equation. White noise with a third of 1/f noise; sensitivity, spring constant, size and thickness
err as much as the fit is told.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import layer_oracle as oracle
from bench_coverage import record

E, K, R, T, ANGLE = 3e3, 0.05, 2.5e-6, 2e-6, 0.6
DEPTH = {"sphere": 0.5e-6, "pyramid3": 0.8e-6, "layer": 0.6e-6, "layer_cone": 1.0e-6}
KNOWN = nt.fit.Uncertainties(sensitivity=0.03, spring_constant=0.05, radius=0.04, half_angle=0.02, thickness=0.1)


def fitted(shape: str, seed: int, model: str | None = None) -> Any:
    """A fit of one curve, and its contact point."""
    rng = np.random.default_rng([seed, 5])
    sharp, is_layer = shape in ("pyramid3", "layer_cone"), shape.startswith("layer")
    error = rng.standard_normal(4) * [KNOWN.sensitivity, KNOWN.spring_constant, KNOWN.radius, KNOWN.thickness]
    size = ANGLE if sharp else R
    law = lambda depth: oracle.force(shape, depth, E, size, T)  # noqa: E731
    noise = 15e-12 * record("mixed", 3000, seed)
    curve = oracle.measured(law, K, DEPTH[shape], rng, (float(np.exp(error[0])), float(np.exp(error[1]))), noise)
    told: dict[str, Any] = {"radius": R * np.exp(error[2])}
    if sharp:
        told = {"half_angle": ANGLE + KNOWN.half_angle * error[2] / KNOWN.radius}
    if is_layer and model is None:
        told["thickness"] = T * np.exp(error[3])
    return nt.fit.fit_curve(curve, model or shape, uncertainties=KNOWN, **told), curve.meta["truth"]


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--curves", type=int, default=400)
    args = parser.parse_args()
    print("| model | E* held [%] | contact point held [%] | sigma of E* [%] | pulls of E* | by the other law [%] |")
    print("|---|---|---|---|---|---|")
    instead = {"sphere": "hertz", "pyramid3": "pyramid", "layer": "hertz", "layer_cone": "cone"}
    for shape, other in instead.items():
        held, pulls, spread, off = [], [], [], []
        for seed in range(args.curves):
            result, contact = fitted(shape, seed)
            ends = result.interval["effective_modulus"], result.interval["contact_point"]
            held.append([ends[0][0] <= E <= ends[0][1], ends[1][0] <= contact <= ends[1][1]])
            spread.append(result.sigma["effective_modulus"] / result.values["effective_modulus"])
            pulls.append(np.log(result.values["effective_modulus"] / E) / spread[-1])
            if seed < 20:
                off.append(fitted(shape, seed, other)[0].values["effective_modulus"] / E - 1.0)
        a, b = 100.0 * np.mean(held, axis=0)
        print(
            f"| `{shape}` | {a:.1f} | {b:.1f} | {100 * np.median(spread):.1f} | {np.mean(pulls):+.2f} ± "
            f"{np.std(pulls):.2f} | {100 * np.median(off):+.0f} |", flush=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
