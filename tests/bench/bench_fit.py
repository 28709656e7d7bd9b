# SPDX-License-Identifier: BSD-3-Clause
"""Time of fits of 2 000 points: ``python tests/bench/bench_fit.py [--nanite PYTHON]``.

Per model: the fit alone, with an uncertain baseline and calibration, and the whole way from a curve to its result.
With --nanite the Python of an environment that has nanite (GPL, hence a process of its own: ``python -m venv peers;
peers/bin/pip install nanite``): baseline and Hertz fit of the same approach, about the same contact point, over the
same points with the same weight, after one warm-up; and both values of E. Everywhere the median processor time.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import _fit

MODELS = ("hertz", "cone", "pyramid", "dmt", "jkr", "maugis")
POINTS, RUNS, NOISE, RADIUS = 2000, 40, 10e-12, 20e-9  # -, -, N, m
TRUTH = {"effective_modulus": 2e9, "work_of_adhesion": 0.05, "cohesive_range": 0.2e-9, "sensitivity": 1.0}
MODULUS, STIFFNESS, CONTACT = 2e6, 0.1, 3e-7  # of the curve for nanite: Pa, N/m, m

PEER = """
import json, sys, time, warnings
import numpy as np
warnings.filterwarnings("ignore")
from nanite.fit import IndentationFitter
from nanite.indent import Indentation

given = json.load(sys.stdin)
tip, force = np.array(given["tip"]), np.array(given["force"])
both = lambda x: np.concatenate([x, x[::-1]])
data = {"force": both(force), "tip position": both(tip), "height (measured)": both(tip),
        "time": np.arange(2 * tip.size) * 1e-3, "segment": np.repeat([0, 1], tip.size)}
about = {"spring constant": 0.1, "imaging mode": "force-distance", "enum": 0, "path": "-"}
curve = Indentation(data=data, metadata=about)
start = curve.get_initial_fit_parameters(model_key="hertz_para")
for name, value in (("R", given["radius"]), ("nu", 0.5), ("contact_point", given["contact"]), ("E", 3e3)):
    start[name].value = value
start["contact_point"].vary = False

def fit():
    fitter = IndentationFitter(curve, model_key="hertz_para", params_initial=start.copy(), weight_cp=False,
                               segment="approach", range_x=(0, 0), preprocessing=[])
    fitter.fit()
    return fitter.fp["params_fitted"]["E"].value

fit()
taken = []
for _ in range(given["runs"]):
    begin = time.process_time()
    E = fit()
    taken.append(time.process_time() - begin)
print(json.dumps({"ms": 1e3 * float(np.median(taken)), "E": E}))
"""


def median_ms(run: Callable[[], Any]) -> float:
    """Median processor time of a call, after one that is not counted."""
    run()
    taken = []
    for _ in range(RUNS):
        start = time.process_time()
        run()
        taken.append(time.process_time() - start)
    return 1e3 * float(np.median(taken))


def fit_of(model: str, jitter: float) -> Callable[[], Any]:
    """One fit of the C library; jitter: noise of the positions [m], as of a height sensor."""
    options = _fit.Options(model)
    options.radius, options.spring_constant, options.force_noise = RADIUS, 1.0, NOISE
    if model == "maugis":
        options.hold("cohesive_range", TRUTH["cohesive_range"])
    options.know("force_offset", 0.0, 1e-12)
    options.know("force_tilt", 0.0, 1e-6)
    options.know("sensitivity", 1.0, 0.03)
    values = [TRUTH.get(p[0], 0.0) if p else np.nan for p in options.parameters]
    rng = np.random.default_rng(1)
    first = _fit.tear_position(options, values) + 0.1e-9 if model in ("dmt", "jkr", "maugis") else -30e-9
    position = np.linspace(first, 20e-9, POINTS) + jitter * rng.standard_normal(POINTS)
    force = _fit.evaluate(options, values, position)[0] + NOISE * rng.standard_normal(POINTS)
    return lambda: _fit.run(options, position, force)


def curve_of(model: str) -> Any:
    contact = nt.Contact(RADIUS, 5e6, 0.05 if model in ("dmt", "jkr", "maugis") else 0.0, cohesive_range=2e-9)
    return nt.curves.synthesize(
        contact, model, spring_constant=0.5, noise=30e-12, offset=1e-9, tilt=1e-4, points=POINTS, half_angle=0.4
    )


def whole_way(model: str) -> Callable[[], Any]:
    """From a curve of 2 000 points in each branch to its result: analysis, fits, uncertainties."""
    curve = curve_of(model)
    return lambda: nt.fit.fit_curve(curve, model, radius=RADIUS, half_angle=0.4)


def against_nanite(python: str) -> None:
    """Baseline and Hertz fit of the same points over the indentation, about a given contact point."""
    rng = np.random.default_rng(5)
    tip = np.linspace(CONTACT + 2e-6, CONTACT - 100e-9, POINTS)
    hertz = 4 / 3 * MODULUS / 0.75 * np.sqrt(RADIUS) * np.clip(CONTACT - tip, 0.0, None) ** 1.5
    force = hertz + 0.7e-9 + 20e-12 * rng.standard_normal(POINTS)
    given = {"tip": tip.tolist(), "force": force.tolist(), "contact": CONTACT, "radius": RADIUS, "runs": RUNS}
    done = subprocess.run([python, "-c", PEER], input=json.dumps(given), capture_output=True, text=True, check=True)
    peer = json.loads(done.stdout)

    def ours() -> float:
        points = nt.fit.fit_points(-tip, force, "hertz", radius=RADIUS, contact_point=-CONTACT)
        return float(points.values["effective_modulus"]) * 0.75  # E of the sample with a Poisson ratio of 0.5

    taken, E = median_ms(ours), ours()
    print(f"\nbaseline and Hertz fit of {POINTS} points about a given contact point")
    print(f"nanite      {peer['ms']:8.3f} ms  E = {peer['E']:.8g} Pa")
    print(f"nanotouch   {taken:8.3f} ms  E = {E:.8g} Pa: {peer['ms'] / taken:.0f} times faster, "
          f"E differs by {100 * abs(E / peer['E'] - 1):.1g} %")  # fmt: skip


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nanite", metavar="PYTHON", help="interpreter of an environment with nanite")
    args = parser.parse_args()
    print(f"{'model':8} fit, even steps [ms]  0.2 nm of jitter [ms]  curve to result [ms]")
    for name in MODELS:
        print(f"{name:8} {median_ms(fit_of(name, 0.0)):20.2f} {median_ms(fit_of(name, 0.2e-9)):22.2f} "
              f"{median_ms(whole_way(name)):21.2f}")  # fmt: skip
    if args.nanite:
        against_nanite(args.nanite)


if __name__ == "__main__":
    main()
