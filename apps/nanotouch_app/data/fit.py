# SPDX-License-Identifier: BSD-3-Clause
"""Read a force curve, find baseline, contact point, snap-in and pull-off, fit a contact model."""

from __future__ import annotations

import argparse
import csv
import math
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch import curves
from nanotouch import fit as fitting
from nanotouch.awaiting import awaited
from nanotouch.errors import InvalidValue

from nanotouch_app.common import output, scenes
from nanotouch_app.common.quantity import number, parse_quantity, whole_number
from nanotouch_app.data import fit_many

FILES = ("fit.json", "fit.png", "stability.png", "ruptures.csv", "pauses.csv")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser("fit", description=__doc__)
    parser.add_argument(
        "curve",
        nargs="+",
        metavar="CURVE",
        help="force curve file (JPK, Asylum .ibw, ...); or files, folders, patterns",
    )
    add_knowledge(parser, auto=True)
    parser.add_argument(
        "--compare",
        action="store_true",
        help="also fit the other laws to the same points, and say which one the curve prefers",
    )
    parser.add_argument(
        "--stability", action="store_true", help="also draw the modulus over the depth to which the curve is fitted"
    )
    parser.add_argument(
        "--index",
        type=whole_number(0, 10**9),
        default=0,
        metavar="N",
        help="which curve of a map (default: %(default)s)",
    )
    parser.add_argument(
        "--persistence", metavar="LENGTH|free", help="of the chains that ruptures end, held (default: 0.4nm), or fitted"
    )
    add_table(parser)
    output.add_options(parser, "DIR|FILE.csv", "folder for the results, or a table with a row for each curve")


def add_table(parser: argparse.ArgumentParser) -> None:
    """The options of all that makes a table of many curves."""
    parser.add_argument(
        "--sidecar", metavar="FILE", help="TOML file: exclusions, contact points and baselines by hand, for a table"
    )
    parser.add_argument(
        "--groups", metavar="folder|FILE.csv", help="groups of a table: by folder, or by a CSV table: file,group"
    )
    parser.add_argument("--long", action="store_true", help="every column in the table, in place of 15")


def add_knowledge(parser: argparse.ArgumentParser, auto: bool = False) -> None:
    """What is known of tip, sample and cantilever, and the law: the options of all that fits.

    `auto`: the law may be left to what the curve shows.
    """
    if auto:
        parser.add_argument(
            "--model", choices=("auto", *fitting.models()), default="auto", help="default: by what the curve shows"
        )
    else:
        parser.add_argument("--model", choices=fitting.models(), default="maugis", help="default: %(default)s")
    parser.add_argument("--branch", choices=("retract", "approach"), help="default: retract for adhesive models")
    parser.add_argument("--radius", metavar="LENGTH", help="tip radius, as 20nm")
    parser.add_argument("--half-angle", metavar="ANGLE", help="of cone (flank) and pyramid (face), as 20deg")
    parser.add_argument("--thickness", metavar="LENGTH", help="of a layer on rigid ground (layer, layer_cone), as 5um")
    parser.add_argument(
        "--known-to", action="append", default=[], metavar="WHAT=PERCENT", type=_uncertainty,
        help="standard uncertainty of sensitivity (3 without this), spring_constant, radius or thickness, as "
        "spring_constant=10; or correlation of the first two; or half_angle=1deg",
    )  # fmt: skip
    parser.add_argument("--spring-constant", metavar="STIFFNESS", help="in place of the file's, as 8N/m")
    parser.add_argument(
        "--sensitivity",
        metavar="SENSITIVITY",
        help="deflection sensitivity in place of the file's, as 40nm/V, or of NT-MDT's text as 40nm/nA",
    )
    parser.add_argument(
        "--calibration", metavar="FILE", help="CSV table of both for many files: file,spring_constant,sensitivity"
    )
    parser.add_argument(
        "--poisson-ratio", type=number(-0.99, 0.5), metavar="NU", help="of the sample: also gives its Young's modulus"
    )
    parser.add_argument("--scene", metavar="SCENE", help=scenes.HELP.format(what="tip, sample and adhesion"))
    parser.add_argument("--window", metavar="LOW,HIGH", help="fit only forces between these, as 0.1nN,2nN")
    parser.add_argument(
        "--baseline", choices=("auto", "line", "wave", "constant"), help="which is taken off (default: auto)"
    )


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.stability and args.window is not None:
        raise InvalidValue("--stability fits ever deeper windows of its own: leave out --window")
    if args.model in fitting.OVER_TIME and (args.compare or args.stability):
        raise InvalidValue(f"--model {args.model} is fitted to the whole curve: leave out --compare and --stability")
    if fit_many.is_meant(args):
        if args.compare:
            raise InvalidValue("--compare looks at one curve: name one file")
        return fit_many.run(args, reading(args), knowledge(args))
    for name in ("sidecar", "groups", "long"):
        if getattr(args, name):
            raise InvalidValue(f"--{name} goes with a table: --out results.csv")
    file = args.curve[0]
    with output.busy("reading"):
        found = curves.read(file, **reading(args))
    if not 0 <= args.index < len(found):
        raise InvalidValue(f"--index {args.index}: {file} holds the curves 0 .. {len(found) - 1}")
    curve = found[args.index]
    known = knowledge(args)
    with output.busy("fitting"):
        result = awaited(lambda: fitting.fit_curve(curve, args.model, branch=args.branch, **known))
    with output.folder(args, FILES) as out:
        args.answer = as_json(result)
        output.write_json(out / "fit.json", args.answer)
        fitting.draw(curve, result, save=out / "fit.png")
        if result.report.ruptures:
            write_ruptures(
                out / "ruptures.csv", curves.chains(curve, result.report, segment_length=fit_many.persistence(args))
            )
        if result.time is not None:
            write_pauses(out / "pauses.csv", fitting.pauses(curve, result))
        if args.stability:
            fitting.stability(curve, result.model, branch=result.branch, **known).draw(save=out / "stability.png")
        if len(found) > 1:
            print(f"curve {args.index} of {len(found)}; --index N picks another")
        print(result if args.verbose else _in_short(result))
        if args.compare:
            print(fitting.choose_model(curve, _rivals(result.model), branch=result.branch, **known))
        print(f"written to {out}/: {', '.join(name for name in FILES if (out / name).exists())}")
    return 0


def _in_short(result: nt.fit.FitResult) -> str:
    """The answer, and what speaks against it; all parameters, residuals and assumptions are told by ``--verbose``."""
    lines = str(result).splitlines()
    title = next(number for number, line in enumerate(lines) if line.startswith(f"{result.name}: "))
    doubts = [line for line in lines[title + 1 :] if line.startswith("  note:") or "not determined" in line]
    return "\n".join((*lines[: title + 1], *doubts))


def _rivals(model: str) -> tuple[str, ...]:
    return (*fitting.PARABOLOIDS, *(() if model in fitting.PARABOLOIDS else (model,)))


def _uncertainty(text: str) -> tuple[str, float]:
    name, _, size = text.partition("=")
    valid = ("sensitivity", "spring_constant", "radius", "thickness", "half_angle", "correlation")
    if name not in valid:
        raise argparse.ArgumentTypeError(f"{name!r}: valid are {', '.join(valid)}")
    try:
        value = parse_quantity(size, "rad") if name == "half_angle" else float(size) / 100.0
    except (InvalidValue, ValueError):
        raise argparse.ArgumentTypeError(
            f"{text!r}: write it as {name}={'1deg' if name == 'half_angle' else '10'}"
        ) from None
    if name == "correlation" and 0.0 < abs(value) <= 0.01:  # surely meant as a fraction
        raise argparse.ArgumentTypeError(f"{text!r} [%]: valid are 0, and what lies beyond 1, as -80 for -0.8")
    return name, value


def reading(args: argparse.Namespace) -> dict[str, Any]:
    """How files are read, as arguments of :func:`nanotouch.curves.read`."""
    return {
        "spring_constant": _quantity(args.spring_constant, "N/m"),
        "sensitivity": None if args.sensitivity is None else nt.curves.parse_sensitivity(args.sensitivity),
        "calibration": args.calibration,
    }


def write_ruptures(path: Path, found: tuple[curves.Chain, ...]) -> None:
    """A row for each rupture, with the worm-like chain that it ended where the curve determines one."""
    columns = ("z [m]", "force [N]", "slope [N/m]", "step [N]", "contour_length [m]", "contour_length sigma [m]",
               "persistence_length [m]", "persistence_length sigma [m]")  # fmt: skip
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(columns)
        for chain in found:
            lengths = (chain.contour_length, chain.contour_length_sigma,
                       chain.segment_length, chain.segment_length_sigma)  # fmt: skip
            table.writerow([*chain.rupture, *("" if math.isnan(length) else length for length in lengths)])


def write_pauses(path: Path, found: tuple[fitting.Pause, ...]) -> None:
    """A row for each mean of each pause; no file without pauses."""
    if not found:
        return
    columns = ("pause", "kind", "time [s]", "E [Pa]", "E sigma [Pa]", "J [1/Pa]", "J sigma [1/Pa]")
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(columns)
        for number, pause in enumerate(found):
            for row in zip(*pause[1:], strict=True):
                table.writerow([number, pause.kind, *row])


def as_json(result: nt.fit.FitResult) -> dict[str, Any]:
    """The numbers of a fit, SI; null for what is infinite or not a number."""
    return {
        "curve": result.name,
        "answer": result.answer.as_json(),
        "model": result.model,
        "branch": result.branch,
        "points": int(result.z.size),
        "values": {key: _finite(value) for key, value in result.values.items()},
        "sigma": {key: _finite(value) for key, value in result.sigma.items()},
        "sigma_statistical": {key: _finite(value) for key, value in result.sigma_statistical.items()},
        "sigma_calibration": {key: _finite(value) for key, value in result.sigma_calibration.items()},
        "interval_95": {key: [_finite(low), _finite(high)] for key, (low, high) in result.interval.items()},
        "units": {key: result.units[key] for key in result.values},
        "identifiable": dict(result.identifiable),
        "bounds_95": {key: [_finite(low), _finite(high)] for key, (low, high) in result.bounds.items()},
        "covariance": {
            "parameters": list(result.free),
            "matrix": [[_finite(value) for value in row] for row in result.covariance.tolist()],
        },
        "pull_off_force_N": _finite(result.measured_pull_off_force),
        "snap_in_force_N": _finite(result.measured_snap_in_force),
        "fitted_pull_off_force_N": _finite(result.pull_off_force),
        "contact_radius_m": _finite(result.contact_radius),
        "contact_stiffness_N_per_m": _finite(result.contact_stiffness),
        "transition_parameter": _finite(result.transition_parameter),
        "residual_rms_N": result.residual_rms,
        "noise_N": result.report.noise,
        "tip_radius_m": result.radius,
        "half_angle_rad": result.half_angle,
        "spring_constant_N_per_m": result.spring_constant,
        "converged": result.converged,
        "assumptions": list(result.assumptions),
        "notes": list(result.notes),
        "version": nt.__version__,
    }


def _quantity(text: str | None, unit: str) -> float | None:
    return None if text is None else parse_quantity(text, unit)


def knowledge(args: argparse.Namespace) -> dict[str, Any]:
    """What the scene and the options say about tip and sample, as arguments of the fit."""
    radius = _quantity(args.radius, "m")
    tools: dict[str, Any] = {"uncertainties": fitting.Uncertainties(**dict(args.known_to))}
    if args.window is not None:
        tools["window"] = _window(args.window)
    if args.baseline is not None:
        tools["baseline"] = args.baseline
    if args.half_angle is not None:
        tools["half_angle"] = parse_quantity(args.half_angle, "rad")
    if args.thickness is not None:
        tools["thickness"] = parse_quantity(args.thickness, "m")
    if args.scene is None:
        return tools | {"radius": radius, "poisson_ratio": args.poisson_ratio}
    scene = scenes.read(args.scene).scene
    if radius is not None:
        scene.tip.radius = radius
    facts = scene.plan().explain()
    known = tools | {"tip": scene.tip, "poisson_ratio": scene.sample.poisson_ratio}
    if args.poisson_ratio is not None:
        known["poisson_ratio"] = args.poisson_ratio
    if args.model in ("auto", "maugis") and facts["cohesive_stress"] > 0.0:
        known["cohesive_range"] = facts["work_of_adhesion"] / facts["cohesive_stress"]
    return known


def _window(text: str) -> tuple[float, float]:
    """``"0.1nN,2nN"`` to forces [N]."""
    parts = text.split(",")
    if len(parts) != 2:
        raise InvalidValue(f"--window {text!r}: two forces, as 0.1nN,2nN")
    low, high = (parse_quantity(part, "N") for part in parts)
    if not low < high:
        raise InvalidValue(f"--window {text!r}: the first force is not below the second")
    return low, high


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
