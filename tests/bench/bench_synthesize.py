# SPDX-License-Identifier: BSD-3-Clause
"""Processor time of a synthetic force curve of 2 x 256 points with noise, drift and errors of k, s and R."""

from __future__ import annotations

import time

import nanotouch as nt
import numpy as np

CURVES = 20_000

for model in nt.contact.MODELS:
    rng = np.random.default_rng(1)
    start = time.process_time()
    nt.curves.synthesize_batch(
        CURVES,
        model,
        radius=20e-9 * rng.lognormal(0.0, 0.1, CURVES),
        effective_modulus=1e9 * rng.lognormal(0.0, 1.0, CURVES),
        work_of_adhesion=0.05 * rng.lognormal(0.0, 0.3, CURVES),
        spring_constant=rng.lognormal(0.0, 0.1, CURVES),
        noise=20e-12,
        drift=1e-9 * rng.standard_normal(CURVES),
        sensitivity_error=rng.lognormal(0.0, 0.03, CURVES),
    )
    print(f"{model:7} {1e6 * (time.process_time() - start) / CURVES:5.1f} us a curve")
