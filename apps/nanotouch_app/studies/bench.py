# SPDX-License-Identifier: BSD-3-Clause
"""Measure what every contact and force law costs on this machine, in nanoseconds and in multiples of Hertz."""

from __future__ import annotations

import argparse
import math
import platform
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import nanotouch as nt
import numpy as np
from nanotouch import contact, forces, geometry
from nanotouch.contact import reduced
from nanotouch.errors import Error, InvalidValue

from nanotouch_app.common import output
from nanotouch_app.studies.tradeoff.solvers import EXACT, SOLVERS, pull_off, unit
from nanotouch_app.studies.tradeoff.timing import ELEMENTS, nanoseconds

LAM = 1.0
HIGHEST_LOAD = 10.0
"""in pull-off forces; indentations reach from -0.95 pull-off forces to here"""
RUNS, QUICK_RUNS = 40, 3
YARDSTICKS = {"F": "Hertz", "U, F, k, a": "hertz"}
"""by what a call computes: the law whose cost is 1"""

Calls = Mapping[str, Callable[[], Any]]


class Cost(NamedTuple):
    """What a law costs per element of an array."""

    law: str
    computes: str
    nanoseconds: float
    hertz: float
    """multiples of Hertz where Hertz computes the same"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("bench", description=__doc__)
    parser.add_argument("--out", type=Path, metavar="FILE.json", help="also write the figures as JSON")
    output.takes_overwrite(parser)
    parser.add_argument("--quick", action="store_true", help="few repetitions: rough figures")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.out and args.out.suffix.lower() != ".json":
        raise InvalidValue(f"--out {args.out}: the ending must be .json")
    if args.out and not args.out.parent.is_dir():
        raise Error(f"cannot write {args.out}: {args.out.parent} is not a folder")
    if args.out:
        output.check_free(args.out, args)
    runs = QUICK_RUNS if args.quick else RUNS
    with output.progress_bar("timing") as progress:
        costs = measure(runs, progress)
    args.answer = as_dict(costs, runs)
    print(table(costs))
    if args.out:
        output.write_json(args.out, args.answer)
        print(f"\nwritten to {args.out}")
    return 0


def measure(runs: int, progress: Callable[[float], None]) -> list[Cost]:
    """The cost of every law."""
    groups = {"F": force_calls(), "U, F, k, a": law_calls()}
    calls = {f"{computes}|{name}": call for computes, group in groups.items() for name, call in group.items()}
    least = nanoseconds(calls, runs, progress)
    costs = []
    for key, cost in least.items():
        computes, name = key.split("|")
        costs.append(Cost(name, computes, cost, cost / least[f"{computes}|{YARDSTICKS[computes]}"]))
    return costs


def indentations() -> Any:
    """Reduced indentations from near pull-off to pressing, as many as are timed."""
    low, high = EXACT.indentation(LAM, np.array([-0.95, HIGHEST_LOAD]) * pull_off(LAM))
    return np.linspace(low, high, ELEMENTS)


def force_calls() -> Calls:
    """Forces alone, as ``nanotouch tradeoff`` times them."""
    d = indentations()
    return {solver.name: solver.prepare(LAM, d) for solver in SOLVERS if solver.name != "JKR"}  # which has no such call


def law_calls() -> Calls:
    """Energy, force, stiffness and radius, of contact laws and of forces without contact."""
    d = indentations()
    gap, depth = np.linspace(0.2e-9, 20e-9, ELEMENTS), np.linspace(0.0, 20e-9, ELEMENTS)
    R, modulus, angle = 30e-9, 1e9, math.radians(30.0)
    shapes = {
        "sphere": geometry.Shape("sphere", radius=R),
        "cone": geometry.Shape("cone", half_angle=angle),
        "pyramid": geometry.Shape("cone", half_angle=angle, sides=4),
        "blunted cone": geometry.Shape("blunted", radius=R, half_angle=angle),
        "punch": geometry.Shape("punch", radius=R),
    }
    return {
        **{model: partial(contact.evaluate, model, d, unit(LAM)) for model in contact.MODELS},
        **{f"maugis {tier}": partial(reduced.evaluate, LAM, d, tier=tier) for tier in reduced.TIERS},
        **{name: partial(geometry.evaluate, shape, depth, modulus) for name, shape in shapes.items()},
        "van der Waals": partial(forces.vdw, gap, radius=R, hamaker_constant=2e-19),
        "capillary": partial(forces.capillary, gap, radius=R, meniscus_radius=1e-9),
        "electrostatic": partial(forces.electrostatic, gap, radius=R, potential=0.25),
        "double layer": partial(
            forces.double_layer, gap, radius=R, debye_length=3e-9, tip_potential=0.02, sample_potential=0.02
        ),
        "hydration": partial(forces.hydration, gap, radius=R, amplitude=1e-3, decay_length=0.3e-9),
    }


def table(costs: list[Cost]) -> str:
    """The figures for a reader."""
    parts = []
    for computes, yardstick in YARDSTICKS.items():
        parts.append(f"{computes}: ns per element of an array of {ELEMENTS}, and multiples of {yardstick}")
        parts += [f"  {c.law:18}{c.nanoseconds:10.2f}{c.hertz:10.2f}" for c in costs if c.computes == computes]
    return "\n".join(parts)


def as_dict(costs: list[Cost], runs: int) -> dict[str, Any]:
    """The figures for a program."""
    return {
        "version": nt.__version__,
        "machine": platform.machine(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "elements": ELEMENTS,
        "runs": runs,
        "lambda": LAM,
        "unit": "least ns per element of an array, whole Python call",
        "yardsticks": YARDSTICKS,
        "laws": [cost._asdict() for cost in costs],
    }
