# SPDX-License-Identifier: BSD-3-Clause
"""What a period of a session costs where a tip pushes: nothing, a ball, a rod; the mean of a push, and the dearest
millisecond of it.

Run: python bench_pushing.py
"""

from __future__ import annotations

import math
import time

import nanotouch as nt
import numpy as np
from nanotouch.manipulation import Rod, latex
from nanotouch.touch.operator import Hold

WAY, SECONDS = 2e-6, 1.0  # of the push, and its time
TICKS = 10  # a millisecond


def session(what: str, elements: int = 100) -> nt.Session:
    """A tip beside it, in the height of the push."""
    radius = 20e-9 if what == "rod" else 50e-9
    scene = nt.Scene(tip={"radius": radius, "half_angle": 0.26}, medium={"relative_humidity": 0.0},
                     range={"maximum_load": 100e-9})  # fmt: skip
    rig = nt.Rig(probe={"spring_constant": 10.0, "lateral_stiffness": 100.0})
    rod = Rod(2e-6, 100e-9, 50e9, 11e9, 0.075, 1.05e6, radius, 0.26, elements=elements)
    given = {"rod": rod} if what == "rod" else {"particles": nt.Particles(latex(500e-9, radius))}
    made = nt.Session(scene, rig, clearance=50e-9 if what == "rod" else 300e-9, minimum_margin=0.0,
                      mode="scan", path=[(0.0, 0.0), (0.0, WAY)], **given)  # fmt: skip
    if what == "rod":
        made.lay_rod((0.5e-6, 0.3e-6, 0.0))
    elif what == "ball":
        made.lay(0, (0.0, 0.9e-6))
    return made


def main() -> None:
    """One line each; processor time of this thread."""
    for what, elements in (("nothing", 0), ("ball", 0), ("rod", 25), ("rod", 100), ("rod", 400)):
        of = session(what, elements or 100)
        held = Hold(of.core.master_start, 0.0, WAY, SECONDS)
        of.core.aim(nt.touch.operator.core_input(held))
        costs = []
        for _ in range(round(SECONDS * of.rate / TICKS)):
            begun = time.process_time()
            of.advance(TICKS / of.rate)
            costs.append((time.process_time() - begun) / TICKS)
        moved = 0.0 if what == "nothing" else float(of.particles.positions[0, 1])
        name = f"{what}, {elements} elements" if elements else what
        assert what == "nothing" or moved > 0.5e-6
        print(f"{name:<20} mean {1e6 * math.fsum(costs) / len(costs):7.1f} us a tick; dearest millisecond "
              f"{1e6 * np.max(costs):7.1f} us a tick")  # fmt: skip


if __name__ == "__main__":
    main()
