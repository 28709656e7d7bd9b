# SPDX-License-Identifier: BSD-3-Clause
"""Other programs' results beside ours, on real files: ``python tests/bench/bench_peers.py --data DIR ...``.

``--nanite PYTHON`` and ``--topostats PYTHON`` are interpreters of environments that have them (``python -m venv peers;
peers/bin/pip install nanite``). Both are GPL, hence processes of their own. PyJibe is a window around nanite and has no
figures of its own. Curves: Hertz on the approach, R = 1 um, Poisson's ratio 0.5, each program's own contact point and
baseline; of a map the first. Images: each program's own default levelling, TopoStats' before its blur.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import warnings
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np

CURVES = ("*.jpk-force", "*.jpk-force-map", "*.jpk-qi-series")
IMAGES = ("sample_0.stp", "sample_0.jpk-qi-image")
RADIUS, POISSON = 1e-6, 0.5  # m

NANITE = """
import json, sys, warnings
warnings.filterwarnings("ignore")
import nanite

def result(path):
    opened = nanite.load_group(path)
    if not len(opened):
        return "opens no curve"
    curve = opened[0]
    curve.apply_preprocessing(["compute_tip_position", "correct_force_offset", "correct_tip_offset"])
    start = curve.get_initial_fit_parameters(model_key="hertz_para")
    start["R"].value, start["nu"].value = 1e-6, 0.5
    curve.fit_model(model_key="hertz_para", params_initial=start, weight_cp=False)
    if "params_fitted" not in curve.fit_properties:
        return "no fit"
    return [curve.fit_properties["params_fitted"]["E"].value, float(curve.rate_quality())]

found = {}
for path in json.load(sys.stdin):
    try:
        found[path] = result(path)
    except Exception as error:
        found[path] = type(error).__name__
print(json.dumps(found))
"""

TOPOSTATS = """
import copy, json, sys, warnings
from pathlib import Path
warnings.filterwarnings("ignore")
import numpy as np, topostats, yaml
from AFMReader.jpk import load_jpk
from AFMReader.stp import load_stp
from topostats.classes import TopoStats
from topostats.filters import Filters

settings = yaml.safe_load((Path(topostats.__file__).parent / "default_config.yaml").read_text())["filter"]
settings.pop("run")
found = {}
for name in json.load(sys.stdin):
    path = Path(name)
    image, pixel = load_stp(path) if path.suffix == ".stp" else load_jpk(path, "height_trace")
    job = Filters(TopoStats(filename=path.name, image_original=image, pixel_to_nm_scaling=pixel, img_path=path),
                  **copy.deepcopy(settings))
    job.filter_image()
    found[name] = (job.images["final_zero_average_background"] * 1e-9).tolist()
print("RESULT" + json.dumps(found))
"""


def asked(python: str, program: str, files: list[Path]) -> dict[str, Any]:
    """What the other program says of each file."""
    given = json.dumps([str(file) for file in files])
    with tempfile.TemporaryDirectory() as away:  # TopoStats writes a log where it runs
        done = subprocess.run(
            [python, "-c", program], input=given, capture_output=True, text=True, check=True, cwd=away
        )
    answer: dict[str, Any] = json.loads(done.stdout[done.stdout.rindex("RESULT") + 6 :] if "RESULT" in done.stdout
                                        else done.stdout.splitlines()[-1])  # fmt: skip
    return answer


def ours(file: Path) -> str:
    """Young's modulus with its standard uncertainty, status and rating."""
    try:
        curve = nt.curves.read(file)[0]
        result = nt.fit.fit_curve(curve, "hertz", radius=RADIUS, poisson_ratio=POISSON)
    except nt.errors.Error as error:
        return f"{type(error).__name__} | - | -"
    modulus, sigma = result.values["youngs_modulus"], result.sigma["youngs_modulus"]
    return f"{modulus:.4g} ± {sigma:.2g} | {result.status} | {result.rating:.1f}"


def curves(data: Path, python: str) -> None:
    """One row for each file; of a map its first curve."""
    files = sorted({file for pattern in CURVES for file in data.rglob(pattern)}, key=lambda file: file.name)
    peer = asked(python, NANITE, files)
    print("| curve | nanite: E [Pa] | rating | here: E [Pa] | status | rating |\n|---|---|---|---|---|---|")
    for file in files:
        said = peer[str(file)]
        theirs = f"{said[0]:.4g} | {said[1]:.1f}" if isinstance(said, list) else f"{said} | -"
        print(f"| `{file.name}` | {theirs} | {ours(file)} |", flush=True)


def spread(heights: Any) -> str:
    """Root mean square of all pixels, and the robust one of the background [nm]."""
    values = np.asarray(heights) * 1e9
    background = 1.4826 * np.median(np.abs(values - np.median(values)))
    return f"{values.std():.3g} | {background:.3g}"


def images(data: Path, python: str) -> None:
    """One row for each file."""
    files = [file for name in IMAGES for file in sorted(data.rglob(name))[:1]]
    peer = asked(python, TOPOSTATS, files)
    print("\n| image | TopoStats: rms [nm] | of the background | here: rms [nm] | of the background |\n"
          "|---|---|---|---|---|")  # fmt: skip
    for file in files:
        levelled, _ = nt.images.level(nt.images.read(file))
        print(f"| `{file.name}` | {spread(peer[str(file)])} | {spread(levelled.heights)} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="folder with the files, searched whole")
    parser.add_argument("--nanite", metavar="PYTHON")
    parser.add_argument("--topostats", metavar="PYTHON")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    folder = args.data.resolve()
    if args.nanite:
        curves(folder, args.nanite)
    if args.topostats:
        images(folder, args.topostats)
