# SPDX-License-Identifier: BSD-3-Clause
"""Push a particle over a substrate, under drift and noise: a scripted operator looks by scan lines, pushes, and looks
again until the particle lies where it shall. What it believes is told beside the truth."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import manipulation
from nanotouch.awaiting import awaited
from nanotouch.errors import InvalidValue, require
from nanotouch.manipulation.lever import give
from nanotouch.plots import new_figure, saved
from nanotouch.touch.record import write_csv
from nanotouch.units import in_words

from nanotouch_app.common import output, stop
from nanotouch_app.common.quantity import parse_point, parse_quantity, whole_number

FILES = ("push.csv", "push.json", "push.png")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("push", description=__doc__)
    parser.add_argument("--to", default="5um,0um", metavar="X,Y", help="from where it lies (default: %(default)s)")
    parser.add_argument("--radius", default="500nm", metavar="LENGTH",
                        help="of the particle, polystyrene on glass, 50nm .. 20um (default: %(default)s)")  # fmt: skip
    parser.add_argument("--drift", default="1nm/s", metavar="SPEED", help="of the sample (default: %(default)s)")
    parser.add_argument("--tolerance", default="30nm", metavar="LENGTH",
                        help="distance that the operator is content with (default: %(default)s)")  # fmt: skip
    parser.add_argument("--lever", metavar="X,Y,Z",
                        help="stiffness of the lever, as 20N/m,20N/m,2N/m (default: the tip is held)")  # fmt: skip
    parser.add_argument("--seed", type=whole_number(0, 2**32 - 1, "2^32 - 1"), default=1, metavar="N",
                        help="of noise and drift (default: %(default)s)")  # fmt: skip
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command. Status 1: it did not come within the tolerance."""
    target, radius = parse_point(args.to), parse_quantity(args.radius, "m")
    drift, tolerance = parse_quantity(args.drift, "m/s"), parse_quantity(args.tolerance, "m")
    if not 50e-9 <= radius <= 20e-6:
        raise InvalidValue(f"--radius {args.radius}: valid is 50nm .. 20um")
    if not 0.0 < np.hypot(*target) <= 1e3 * radius:
        raise InvalidValue(
            f"--to {args.to}: valid is a way above 0, up to {in_words(1e3 * radius, 'm')}, 1000 radii of the particle"
        )
    particle, lever = manipulation.latex(radius), None if args.lever is None else parse_lever(args.lever)
    with output.folder(args, FILES) as out:
        so_far: list[manipulation.Pushed] = []
        try:
            with output.busy("pushing"):
                done = awaited(lambda: manipulation.push(
                    particle, target, bench=manipulation.Bench(drift=drift), tolerance=tolerance, lever=lever,
                    seed=args.seed, progress=so_far.append,
                ))  # fmt: skip
        except stop.Stopped as stopped:
            raise stop.Stopped(stopped.number, _kept(so_far, out / "push.csv")) from None
        facts = facts_of(done) | {"tolerance_m": tolerance}
        facts["lever_give_m"] = None if lever is None else give(lever, particle)
        write_track(done, out / "push.csv")
        output.write_json(out / "push.json", facts)
        with stop.keeping("all but the picture is", out), output.picture():
            draw(done, target, out / "push.png")
        args.answer = output.answered(out, FILES, facts, words(facts))
    return int(done.believed > tolerance)


def _kept(so_far: list[manipulation.Pushed], path: Path) -> str:
    """Write the way of a task that has ended early, and say how far it came."""
    if not so_far:
        return "before the end of the first push: nothing is kept"
    write_track(so_far[-1], path)
    pushes, left = so_far[-1].pushes, in_words(so_far[-1].believed, "m", 3)
    return f"{pushes} {'push is' if pushes == 1 else 'pushes are'} kept in {path}, {left} from the target"


def parse_lever(text: str) -> manipulation.Lever:
    """``"20N/m,20N/m,2N/m"`` to the springs along x, y, z."""
    parts = text.split(",")
    if len(parts) != 3:
        raise InvalidValue(f"--lever {text}: valid are three stiffnesses, as 20N/m,20N/m,2N/m")
    x, y, z = (parse_quantity(part, "N/m") for part in parts)
    return manipulation.Lever((x, y, z))


def facts_of(done: manipulation.Pushed) -> dict[str, float | None]:
    """The numbers, SI."""
    return {
        "error_m": done.error,
        "believed_m": done.believed,
        "pushes": done.pushes,
        "lines": done.lines,
        "bench_time_s": done.duration,
        "largest_push_N": float(np.abs(done.track.force[:, :2]).max(initial=0.0)),
        "x_m": float(done.position[0]),
        "y_m": float(done.position[1]),
    }


def words(facts: dict[str, Any]) -> str:
    """The same in words."""
    told = (
        f"it lies {in_words(facts['error_m'], 'm', 3)} from the target; the last look showed "
        f"{in_words(facts['believed_m'], 'm', 3)}\n{facts['pushes']} pushes of "
        f"{in_words(facts['largest_push_N'], 'N', 3)} at most, {facts['lines']} lines to look, "
        f"{facts['bench_time_s']:.0f} s"
    )
    if (gives := facts["lever_give_m"]) is not None:
        told += f"\nthe lever gives way by {in_words(gives, 'm', 3)} under a push, at most"
    if facts["believed_m"] > facts["tolerance_m"]:
        told += f"\nit did not arrive: given up after {facts['pushes']} pushes, without a look within "
        told += f"{in_words(facts['tolerance_m'], 'm', 3)} of the target"
    return told


def write_track(done: manipulation.Pushed, path: Path) -> None:
    """Tip and particle over time, with the force on the tip."""
    track = done.track
    columns = {"time [s]": track.time}
    for name, values, unit in (("tip", track.tip, "m"), ("particle", track.particle, "m"), ("force", track.force, "N")):
        columns |= {f"{name} {axis} [{unit}]": values[:, k] for k, axis in enumerate("xyz")}
    write_csv(path, columns, {"what": "tip and particle on the sample; force on the tip"})


def draw(done: manipulation.Pushed, target: tuple[float, float], path: Path) -> None:
    """The way from above, and what the tip felt."""
    require("matplotlib", "app")
    figure = new_figure(9.6, 4.0)
    way, felt = figure.subplots(1, 2)
    track, um = done.track, 1e6
    way.plot(um * track.particle[:, 0], um * track.particle[:, 1], label="particle")
    way.plot(um * done.looks[:, 0], um * done.looks[:, 1], ".", label="looks")
    way.plot(um * target[0], um * target[1], "+", markersize=12, label="target")
    way.set(xlabel="x (µm)", ylabel="y (µm)")
    way.legend(frameon=False)
    for axis, name in enumerate("xyz"):
        felt.plot(track.time, 1e9 * track.force[:, axis], label=f"along {name}")
    felt.set(xlabel="time (s)", ylabel="force on the tip (nN)")
    felt.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    saved(figure, path)
