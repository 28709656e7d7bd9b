# SPDX-License-Identifier: BSD-3-Clause
"""How often two sigma of a fit of Sokolov's model hold the truth, and how long a fit takes."""

import argparse
import sys
import time
from pathlib import Path

import nanotouch as nt
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import test_fit_sokolov as given

TRUTH = {"effective_modulus": given.MODULUS, "brush_thickness": given.THICKNESS, "contact_point": given.CONTACT}
parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--curves", type=int, default=60)
parser.add_argument("--points", type=int, default=150, help="of each branch")
asked = parser.parse_args()
off: dict[str, list[float]] = {name: [] for name in TRUTH}
begun = time.process_time()
for seed in range(asked.curves):
    result = nt.fit.fit_curve(
        given.curve_of(given.series, 5e-12, seed, asked.points), given.UNTOLD, radius=given.RADIUS,
        uncertainties=nt.fit.Uncertainties(sensitivity=1e-6), fixed={"brush_pressure": given.PRESSURE},
    )  # fmt: skip
    for name, value in TRUTH.items():
        off[name].append((result.values[name] - value) / result.sigma[name])
print(f"{(time.process_time() - begun) / asked.curves:.2f} s of CPU a curve")
for name, values in off.items():
    held = np.mean(np.abs(values) < 2.0)
    print(f"{name}: 2 sigma hold {held:.0%}; off by {np.mean(values):.2f} +- {np.std(values):.2f} sigma")
