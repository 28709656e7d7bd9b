# SPDX-License-Identifier: BSD-3-Clause
"""PyFMRheo's Ting model beside the closed form, per branch, and what its fit gives back.

In an environment of its own: pip install pyfmrheo==0.1.3 "numpy<2", then python tests/bench/ting_peers.py
"""

from __future__ import annotations

import time
import warnings

import numpy as np
from pyfmrheo.models.ting import TingModel
from scipy.special import beta as beta_function
from scipy.special import betainc

RADIUS, SPEED, DEPTH, MODULUS, POINTS = 2.5e-6, 1e-6, 1e-6, 2e3, 1000


def closed_form(exponent: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, indentation, force (Efremov et al. 2017), with free parts; time 0 is first touch."""
    top = DEPTH / SPEED
    t = np.arange(1 - POINTS, 3 * POINTS + 1) * top / POINTS
    inside = np.clip(t, 1e-12, None)
    last = inside - 2 ** (1 / (1 - exponent)) * np.clip(t - top, 0, None)
    whole = 4 / 3 * np.sqrt(RADIUS) / 0.75 * MODULUS * 1.5 * SPEED**1.5 * beta_function(1.5, 1 - exponent)
    force = whole * inside ** (1.5 - exponent) * betainc(1.5, 1 - exponent, np.clip(last / inside, 0, 1))
    return t, DEPTH - np.abs(t - top) * SPEED, np.where(t > 0, force, 0.0)


def model(kind: str) -> TingModel:
    """Under the same paraboloid."""
    made = TingModel("paraboloid", RADIUS, kind)
    made.poisson_ratio, made.tc_min, made.tc_max, made.E0_init = 0.5, -0.05, 0.05, 1500.0
    return made


def main() -> None:
    """A line for each exponent."""
    warnings.simplefilter("ignore")
    print("beta  analytical: approach, retraction [% of F_max]  numerical: the same  fit: E_1 [%], beta, s")
    for exponent in (0.05, 0.1, 0.2, 0.35, 0.5):
        t, depth, force = closed_form(exponent)
        top, said = int(np.argmax(force)), []
        for kind in ("analytical", "numerical"):
            found = model(kind).model(
                t, MODULUS, 0.0, exponent, 0.0, 1.0, force, depth, kind, 0.0, idx_tm=top, smooth_w=5
            )
            found = np.asarray(found, float)[: t.size]
            error = 100 * np.abs(found - force[: found.size]) / force.max()
            said.append(f"{np.nanmax(error[: top + 1]):8.3f} {np.nanmax(error[top + 1 :]):8.3f}")
        noisy = force + 1e-11 * np.random.default_rng(0).normal(size=force.size)
        begun, fitted = time.process_time(), model("analytical")
        try:
            fitted.fit(t, noisy, depth, 1.0, idx_tm=top)
            taken = time.process_time() - begun
            said.append(f"{100 * (fitted.E0 / MODULUS - 1):+.2f} {fitted.betaE - exponent:+.4f} {taken:.2f}")
        except ValueError as error_:
            said.append(str(error_).split("!")[0])
        print(f"{exponent:4}  " + "   ".join(said))


if __name__ == "__main__":
    main()
