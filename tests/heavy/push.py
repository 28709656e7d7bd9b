# SPDX-License-Identifier: BSD-3-Clause
"""100 seeds of one task: a particle of 500 nm goes 5 um under a drift of 1 nm/s. ``make heavy``

At least 95 must end within 100 nm. Prints the share, the worst and the median error, pushes, lines and time.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

from nanotouch.manipulation import push
from test_manipulation_push import latex

SEEDS = 100


def main() -> int:
    done = [push(latex(), (5e-6, 0.0), seed=seed) for seed in range(SEEDS)]
    errors = np.array([one.error for one in done])
    within = int(np.count_nonzero(errors < 100e-9))
    print(
        f"{within} of {SEEDS} within 100 nm; worst {1e9 * errors.max():.1f} nm, "
        f"median {1e9 * np.median(errors):.1f} nm; "
        f"{np.mean([one.pushes for one in done]):.1f} pushes, {np.mean([one.lines for one in done]):.0f} lines, "
        f"{np.mean([one.duration for one in done]):.0f} s"
    )
    return int(within < 95)


if __name__ == "__main__":
    sys.exit(main())
