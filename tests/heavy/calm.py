# SPDX-License-Identifier: BSD-3-Clause
"""Random rigs that are armed at a stability margin of 1.52: what does the hand feel of the loop itself?

Each seed draws probe, stage, master, converters, a hand or none, rate, delay and K_f, and turns alpha_p, alpha_f or K_f
until the margin is 1.52. The hand lands on the default scene and presses with half of what the force limit allows, at
most 1 N. Counted apart for those that ``margins.calm`` calls calm and for the rest: the force at the hand ripples by
more than 0.3 N, the tip leaves the surface again, a stop lifts it, the passivity observer takes gain away. The
last line is the ripple over what was predicted.

``python tests/heavy/calm.py 0 200`` takes some minutes. ``--border`` turns only as far as the rig is just called calm;
``--stage LOW HIGH`` draws the stage's resonance from there [Hz].
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from itertools import accumulate
from typing import Any, NamedTuple

import nanotouch as nt
import numpy as np
from nanotouch import margins
from nanotouch.touch.operator import Input
from nanotouch.touch.session import settings_for_path

MARGIN = 1.52
BORDER = 1.03  # least number of a rig that is just called calm
STAGE = (200.0, 3000.0)  # resonance [Hz]
KNOBS = ("alpha_p", "alpha_f", "force_gain")
BACKED_OFF = 1 << 15  # the observer's flag among the reasons of a record
LONGEST = 30.0  # an approach may take this [s]


class Rig(NamedTuple):
    """One of them, and what the library says of it."""

    rig: nt.Rig
    settings: nt.Settings
    calm: margins.Calm


class Run(NamedTuple):
    """What it did."""

    ripple: float
    """of the force at the hand, detrended, 99.7 % of the readings, as a hand that holds still feels it [N]"""
    bounced: bool
    stopped: bool
    tripped: bool


def drawn(seed: int, stage: Sequence[float] = STAGE, border: bool = False) -> Rig | None:
    """A rig and gains at the margin, or at the border of calm; None where no value of the knob comes there."""
    random = np.random.default_rng(seed)

    def log(low: float, high: float) -> float:
        return float(np.exp(random.uniform(math.log(low), math.log(high))))

    rig = nt.Rig(
        probe={"spring_constant": log(0.5, 40.0), "noise": log(1e-3, 0.1), "resonance": log(50e3, 400e3)},
        stage={"resonance": log(*stage), "quality": log(3.0, 50.0), "resolution": log(1e-11, 3e-9),
               "command_resolution": log(1e-11, 1e-9), "travel": log(20e-6, 200e-6)},
        master={"mass": log(0.03, 0.5), "damping": log(5.0, 200.0), "resolution": log(1e-7, 1e-4),
                "gauge_resolution": log(2e-3, 0.05), "gauge_noise": log(5e-4, 1e-2)},
        hand={} if random.random() < 0.4 else {"mass": log(0.005, 0.05), "damping": log(0.3, 5.0),
                                                "stiffness": log(50.0, 1000.0), "relaxation": 0.3},
    )  # fmt: skip
    scene = nt.Scene()
    settings = settings_for_path(rig, load=scene.range.maximum_load)
    settings["gains.force_gain"], settings["gains.delay"] = log(0.3, 10.0), float(random.integers(0, 4))
    settings["gains.rate"] = log(1e3, 30e3)
    knob, stiffness = f"gains.{KNOBS[random.integers(3)]}", scene.plan().maximum_stiffness
    own = float(settings[knob])

    def inside(share: float) -> bool:
        settings[knob] = own * share
        if margins.compute(rig, settings, stiffness).least <= MARGIN:
            return False
        return not border or margins.calm(rig, settings, stiffness).least > BORDER

    low, high = 1e-3, 1e3
    if not inside(low) or inside(high):
        return None
    while high > 1.0001 * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if inside(middle) else (low, middle)
    inside(low)
    return Rig(rig, settings, margins.calm(rig, settings, stiffness))


def touched(one: Rig, seed: int = 1) -> Run:
    """Land, press for two seconds; the ripple is that of the last half second."""
    rig, settings = one.rig, one.settings
    session = nt.Session(rig=rig, settings=settings, seed=seed)
    gains = settings.gains
    push = min(1.0, 0.5 * gains.alpha_f * settings.limits.force, 0.5 * rig.master.gauge_range)
    x, y = session.path[0]
    session.aim(Input(push, x, y, 0.5))
    blocks: list[dict[str, Any]] = []
    landed = 0
    while landed < 4 and len(blocks) < 2 * LONGEST and session.state == "RUN":
        blocks.append(dict(session.advance(0.5)))
        landed += landed > 0 or bool(np.any(blocks[-1]["contact_radius"] > 0.0))
    column = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    force = gains.alpha_f * column["slave_force"]
    pressed = int(np.argmax(gains.alpha_f * column["tip_force"] > 0.5 * push))  # 0 where it never was
    return Run(
        ripple=_ripple(force[-round(0.5 * gains.rate) :], settings) if landed == 4 else math.nan,
        bounced=pressed > 0 and bool(np.any(column["contact_radius"][pressed:] <= 0.0)),
        stopped=session.state != "RUN",
        tripped=bool(np.any(column["reasons"] & BACKED_OFF)),
    )


def _ripple(force: Any, settings: nt.Settings) -> float:
    """About its slow drift, behind the low-pass of the hand's force."""
    gains, time = settings.gains, np.arange(len(force))
    rest = force - np.polyval(np.polyfit(time, force, 2), time)
    share = min(1.0, -math.expm1(-2.0 * math.pi * gains.force_filter / gains.rate) * (1.0 + gains.force_gain))
    felt = np.array(list(accumulate(rest, lambda last, now: last + share * (now - last), initial=0.0)))
    low, high = np.percentile(felt, [0.15, 99.85])
    return float(high - low)


def report(name: str, runs: list[Run]) -> int:
    """One line; how many were not calm."""
    counts = {
        f"ripple above {margins.CLEARLY_FELT:g} N": sum(run.ripple > margins.CLEARLY_FELT for run in runs),
        "bounce": sum(run.bounced for run in runs),
        "stopped": sum(run.stopped for run in runs),
        "trip the observer": sum(run.tripped for run in runs),
    }
    print(f"{len(runs)} {name}: " + ", ".join(f"{count} {words}" for words, count in counts.items()))
    return sum(counts.values())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", type=int)
    parser.add_argument("beyond", type=int)
    parser.add_argument("--border", action="store_true", help="rigs that are just called calm")
    parser.add_argument("--stage", type=float, nargs=2, default=STAGE, help="its resonance from .. to [Hz]")
    options = parser.parse_args()
    seeds = range(options.first, options.beyond)
    found = [one for seed in seeds if (one := drawn(seed, options.stage, options.border)) is not None]
    runs = [touched(one) for one in found]
    report("armed in all", runs)
    failed = report("called calm", [run for one, run in zip(found, runs, strict=True) if one.calm.is_calm])
    report("called not calm", [run for one, run in zip(found, runs, strict=True) if not one.calm.is_calm])
    ratio = [run.ripple / one.calm.ripple for one, run in zip(found, runs, strict=True)
             if one.calm.ringing < margins.RINGING_MOST and math.isfinite(run.ripple)]  # fmt: skip
    low, middle, high = np.percentile(ratio, [5, 50, 95])
    print(f"ripple over that predicted, where nothing rings: median {middle:.2f}, 5 % {low:.2f}, 95 % {high:.2f}")
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
