# SPDX-License-Identifier: BSD-3-Clause
"""Write files to try the other commands on: an image, a force curve, a force map, a scene, a recording cut short.

They are simulated, with noise, so that what comes out can be compared with what is known. The image shows quantum dots
with a tilt. Curve and map are those of a tip of 20 nm on a lever of 2 N/m, over 3 GPa (effective) and 50 mJ/m2; one
half of the map is twice as stiff. gel.h5 is that of a bead of 2.5 um on a gel of 1.2 kPa at 1 s and exponent 0.2.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import images, record
from nanotouch.contact.geometry import Shape
from nanotouch.curves.curve import Role
from nanotouch.errors import require

from nanotouch_app.common import output

FILES = (
    "scan.gwy", "curve.h5", "gel.h5", "map.h5", "scene.toml", "rig.toml", "cut.mcap",
    *(f"curves/{n}.h5" for n in (1, 2, 3)),
)  # fmt: skip
RADIUS, SPRING, MODULUS, WORK = 20e-9, 2.0, 3e9, 0.05  # [m], [N/m], [Pa], [J/m^2]
SENSITIVITY = 40e-9  # [m/V]
BEAD, SOFT, GEL_MODULUS, GEL_EXPONENT = 2.5e-6, 0.06, 1.2e3, 0.2  # [m], [N/m], [Pa] at 1 s, [-]
ROWS, PIXEL, DEPTH = 6, 50e-9, 20e-9
SCENE = """# a silicon tip on gold, in a rig with a lever of 8 N/m; what is not named keeps its default
[tip]
radius_nm = 20
[sample]
material = "gold"
[medium]
relative_humidity_percent = 40
[probe]
spring_constant_N_per_m = 8
"""

RIG = """# a rig of two simulated halves; [master] and [slave] would name real ones (docs/hardware.md)
[probe]
spring_constant_N_per_m = 8
[stage]
axes = 1
"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("samples", description=__doc__)
    parser.add_argument("--out", metavar="DIR", default=".", help="folder for the files (default: here)")
    output.takes_overwrite(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    require("gwyfile", "images")
    require("mcap", "record")
    with output.folder(args, FILES) as out, output.busy("writing"):
        images.write(out / "scan.gwy", _image(), title="Height")
        nt.curves.write(out / "curve.h5", [_curve(1)])
        nt.curves.write(out / "gel.h5", [_gel()])
        nt.curves.write(out / "map.h5", _map())
        (out / "curves").mkdir(exist_ok=True)
        for number in (1, 2, 3):
            nt.curves.write(out / f"curves/{number}.h5", [_curve(number)])
        (out / "scene.toml").write_text(SCENE, encoding="utf-8")
        (out / "rig.toml").write_text(RIG, encoding="utf-8")
        _cut(out / "cut.mcap")
        args.answer = {"folder": str(out), "files": list(FILES)}
        print(f"written to {out}/: {', '.join(FILES)}")
    return 0


def _image() -> images.Topography:
    """Quantum dots with a tilt of 2 nm and a noise of 0.1 nm."""
    dots = nt.surface.dots()
    y, x = np.indices(dots.heights.shape) / dots.heights.shape[0]
    noise = 0.1e-9 * np.random.default_rng(1).standard_normal(dots.heights.shape)
    return images.Topography(dots.heights + 2e-9 * (x - 0.5 * y) + noise, dots.pixel_size)


def _cut(path: Path) -> None:
    """Half a second of a touch, without its last third: what is left when power fails."""
    session = nt.Session()
    with record.Writer(path, session.metadata()) as writer:
        session.run(0.5, writer=writer)
    path.write_bytes(path.read_bytes()[: 2 * path.stat().st_size // 3])


def _curve(seed: int) -> nt.curves.ForceCurve:
    contact = nt.Contact(RADIUS, MODULUS, WORK, cohesive_range=0.2e-9)
    made = nt.curves.synthesize(contact, spring_constant=SPRING, noise=50e-12, depth=DEPTH, seed=seed)
    return replace(made, meta={**made.meta, "sensitivity": SENSITIVITY})


def _gel() -> nt.curves.ForceCurve:
    """Down by 2 um in a second, half a second at rest, and back."""
    time = np.arange(2500, dtype=np.float64) / 1000.0
    base = np.interp(time, [0.0, 1.0, 1.5, 2.5], [-1e-6, 1e-6, 1e-6, -1e-6])
    gel = nt.Rheology.power_law(GEL_MODULUS, GEL_EXPONENT)
    force = gel.force(time, base, Shape("paraboloid", radius=BEAD), spring_constant=SOFT).force
    force = force + 10e-12 * np.random.default_rng(7).standard_normal(time.size)
    parts: tuple[tuple[Role, int, int], ...] = (("approach", 0, 1000), ("pause", 1000, 1500), ("retract", 1500, 2500))
    segments = tuple(
        nt.curves.Segment(role, time[a:b], -base[a:b], "height (measured)", force[a:b], force[a:b] / SOFT)
        for role, a, b in parts
    )
    return nt.curves.ForceCurve(segments, {"spring constant": SOFT, "sensitivity": SENSITIVITY}, "gel")


def _map() -> list[nt.curves.ForceCurve]:
    """A force volume, each curve with its place."""
    stiff = np.where(np.arange(ROWS) < ROWS // 2, 1.0, 2.0) * MODULUS
    grid = {f"grid {name} {axis}": value for axis in "xy" for name, value in (
        ("shape", ROWS), ("size", ROWS * PIXEL), ("center", 0.0))}  # fmt: skip
    return [
        replace(
            nt.curves.synthesize(
                nt.Contact(RADIUS, float(stiff[x]), WORK, cohesive_range=0.2e-9), spring_constant=SPRING, noise=50e-12,
                depth=DEPTH, clearance=240e-9, points=600, seed=1 + ROWS * y + x,
            ),
            meta={"spring constant": SPRING, "enum": ROWS * y + x, "grid index x": x, "grid index y": y, **grid},
        )
        for y, x in np.ndindex(ROWS, ROWS)
    ]  # fmt: skip
