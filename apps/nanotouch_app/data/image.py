# SPDX-License-Identifier: BSD-3-Clause
"""Prepare and measure an AFM image: level, repair, undo the tip, find particles; say what each step took away."""

from __future__ import annotations

import argparse
import math
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import images
from nanotouch.errors import InvalidValue
from nanotouch.images.words import length, lengths, prefixed
from numpy.typing import NDArray

from nanotouch_app.common import output
from nanotouch_app.common.quantity import parse_quantity
from nanotouch_app.data import image_many

FILES = (
    "image.json", "image.png", "image.gwy", "grains.csv", "tip.csv", "spectrum.csv", "spectrum.png", "line.csv",
    "line.png", "histogram.csv", "histogram.png",
)  # fmt: skip
LISTED = 10  # particles printed; the table holds all


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "image",
        description=__doc__,
    )
    what = parser.add_argument_group("what is read")
    what.add_argument("image", nargs="+", metavar="FILE", help="AFM image; or several, folders, patterns")
    what.add_argument("--config", metavar="FILE", help='TOML file of these options, as level = "plane", scars = true')
    what.add_argument("--channel", metavar="NAME", help="channel of the image (nanotouch info lists them)")
    what.add_argument("--pixel-size", metavar="LENGTH", help="pixel size of an image that does not state it, as 10nm")
    what.add_argument("--z-unit", metavar="UNIT", help="height unit of an image that does not state it: nm, um, ...")
    steps = parser.add_argument_group("what is done, in this order")
    steps.add_argument(
        "--level", metavar="METHOD",
        help="auto, or plane, poly2 .. poly6, lines, rows, medians, terraces, joined by +; none (default: auto)",
    )  # fmt: skip
    steps.add_argument(
        "--mask", metavar="WHAT",
        help="leave out of levelling and roughness: what is higher than this, as 2nm, or lower, as -2nm; grains; or "
        "what is white in a picture of as many pixels, as mask.png",
    )  # fmt: skip
    steps.add_argument("--scars", action="store_true", help="repair streaks along the fast axis")
    steps.add_argument("--despeckle", action="store_true", help="repair isolated wrong pixels")
    steps.add_argument("--smooth", metavar="LENGTH", help="Gaussian of this standard deviation, as 5nm")
    steps.add_argument(
        "--tip", metavar="TIP",
        help="undo a tip: its radius, as 10nm; with a cone, as 10nm,0.3rad; or estimate it from the image: blind",
    )  # fmt: skip
    steps.add_argument(
        "--grains", nargs="?", const="auto", metavar="THRESHOLD",
        help="find particles: higher than this, as 2nm; flat, otsu or auto (default: auto)",
    )  # fmt: skip
    steps.add_argument("--pits", action="store_true", help="with --grains: find pits instead")
    steps.add_argument(
        "--spectrum", action="store_true", help="also the power spectral density and the autocorrelation"
    )
    steps.add_argument("--histogram", action="store_true", help="also how often each height occurs")
    steps.add_argument(
        "--line", metavar="X,Y,X,Y[,WIDTH]",
        help="also the heights along a line, counted from the lower left, as 1um,2um,8um,2um; mean over a width",
    )  # fmt: skip
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    image_many.configured(args)
    args.level = args.level or "auto"
    if args.pits and args.grains is None:
        raise InvalidValue("--pits goes with --grains")
    _tip(args.tip), _smooth(args), _threshold(args), _line(args)  # refused before anything is read
    if image_many.is_meant(args.image):
        return image_many.run(args, _one)
    with output.folder(args, FILES) as out:
        facts = _one(args, Path(args.image[0]), out)
        args.answer = facts | {"folder": str(out), "files": [name for name in FILES if (out / name).exists()]}
    return 0


def _smooth(args: argparse.Namespace) -> float | None:
    return None if args.smooth is None else parse_quantity(args.smooth, "m")


def _threshold(args: argparse.Namespace) -> float | str | None:
    threshold = args.grains if args.grains in (None, "auto", "flat", "otsu") else parse_quantity(args.grains, "m")
    if isinstance(threshold, float) and not threshold > 0.0:
        raise InvalidValue(f"--grains {args.grains}: valid is a height above 0, as 2nm; --pits finds what is lower")
    return threshold


def _one(args: argparse.Namespace, file: Path, out: Path) -> dict[str, Any]:
    """All of one image: told, and written into `out`."""
    tip, smooth, threshold = _tip(args.tip), _smooth(args), _threshold(args)
    with output.busy("reading"):
        raw = _read(args, file)
    print(_described(raw))
    with output.busy("preparing the image"):
        facts: dict[str, Any] = {"file": str(file), "channel": raw.channel, "reader": raw.source}
        mask = _mask(raw, args, facts)
        clean = _repaired(raw, args, facts, mask)
        if smooth is not None:
            clean = images.gaussian(clean, smooth)
            print(f"smoothed by a Gaussian of {length(smooth)}")
        if args.tip is not None:
            clean = _without_tip(clean, tip, out, facts)
        rough = images.roughness(clean, mask)
        facts["roughness"] = {"Sa_m": rough.arithmetic, "Sq_m": rough.rms, "Sz_m": rough.peak_to_peak}
        sa, sq, sz = map(length, (rough.arithmetic, rough.rms, rough.peak_to_peak))
        print(f"roughness: Sa {sa}, Sq {sq}, peak to peak {sz}")
        _tell_parameters(images.parameters(clean, mask), facts, args.verbose)
        _curves(args, clean, out)
        table = None if threshold is None else _grains(clean, threshold, args.pits)
        if table is not None:
            _tell(table, out, facts)
        output.write_json(out / "image.json", facts)
        images.write(out / "image.gwy", clean)
        images.draw({"as read": raw, "processed": clean}, grains=table, save=out / "image.png")
        print(f"written to {out}/: {', '.join(name for name in FILES if (out / name).exists())}")
    return facts


def _curves(args: argparse.Namespace, image: images.Topography, out: Path) -> None:
    """What was asked for beside the numbers, as table and picture each."""
    wanted: dict[str, images.Spectrum | images.Section] = {}
    if args.spectrum:
        wanted["spectrum"] = images.spectrum(image)
    if args.histogram:
        wanted["histogram"] = images.histogram(image)
    line = _line(args)
    if line is not None:
        wanted["line"] = images.section(image, (line[0], line[1]), (line[2], line[3]), width=line[4])
    for name, found in wanted.items():
        found.to_csv(out / f"{name}.csv")
        found.draw(save=out / f"{name}.png")


def _line(args: argparse.Namespace) -> tuple[float, ...] | None:
    """Both ends and the width that ``--line`` names [m]."""
    if args.line is None:
        return None
    parts = args.line.split(",")
    if len(parts) not in (4, 5):
        raise InvalidValue(f"--line {args.line}: write it like 1um,2um,8um,2um, and with a width 1um,2um,8um,2um,50nm")
    return tuple(parse_quantity(part, "m") for part in (*parts, "0nm")[:5])


def _tell_parameters(found: dict[str, images.Parameter], facts: dict[str, Any], verbose: bool) -> None:
    """All into the facts; with ``--verbose`` those beyond the line of the roughness are printed, five to a line."""
    facts["parameters"] = {
        symbol: {"value": parameter.value if math.isfinite(parameter.value) else None, "unit": parameter.unit}
        for symbol, parameter in found.items()
    }
    if not verbose:
        return
    shown = [f"{symbol} {_shown(parameter)}" for symbol, parameter in found.items() if symbol not in ("Sa", "Sq", "Sz")]
    for first in range(0, len(shown), 5):
        print("  " + "".join(f"{text:23}" for text in shown[first : first + 5]).rstrip())


def _shown(parameter: images.Parameter) -> str:
    if not math.isfinite(parameter.value):
        return "unknown"
    if not parameter.unit:
        return f"{parameter.value:.4g}"
    if parameter.unit == "m":
        return length(parameter.value)
    unit, scale = prefixed([parameter.value])
    return f"{parameter.value * scale:.4g} {unit}^3/{unit}^2"


def _read(args: argparse.Namespace, file: Path) -> images.Topography:
    pixel_size = None if args.pixel_size is None else parse_quantity(args.pixel_size, "m")
    return images.read(file, args.channel, pixel_size=pixel_size, z_unit=args.z_unit)


def _described(image: images.Topography) -> str:
    (ny, nx), (height, width) = image.shape, image.size
    lines = [
        f"{image.name}: channel {image.channel!r} by {image.source}, {nx} x {ny} pixels, "
        f"{lengths((width, height))}, heights over {length(image.height_range)}"
    ]
    if image.masked_pixels:
        lines.append(f"missing pixels filled from their neighbours: {image.masked_pixels}")
    return "\n".join(lines + [f"note: {note}" for note in image.notes])


def _mask(image: images.Topography, args: argparse.Namespace, facts: dict[str, Any]) -> NDArray[np.bool_] | None:
    """What ``--mask`` leaves out. Heights and grains are those of the image levelled once before."""
    if args.mask is None:
        return None
    if Path(args.mask).suffix.lower() in (".png", ".tif", ".tiff"):
        mask = images.mask_image(args.mask, image)
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            flat = image if args.level == "none" else images.level(image, args.level)[0]
            if args.mask == "grains":
                mask = images.mask_grains(images.grains(flat))
            else:
                height = parse_quantity(args.mask, "m")
                mask = images.mask_above(flat, abs(height), below=height < 0.0)
    facts["masked_share"] = float(mask.mean())
    print(f"masked: {100 * mask.mean():.3g} % of the pixels")
    return mask


def _repaired(
    image: images.Topography, args: argparse.Namespace, facts: dict[str, Any], mask: NDArray[np.bool_] | None
) -> images.Topography:
    """Levelling, scars, speckles; each prints its report, which holds the warnings too."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        if args.level != "none":
            image, levelled = images.level(image, args.level, mask)
            print(levelled if args.verbose else output.in_short(levelled))
            facts["removed"] = {f"{n}_{step.method}_m": step.removed_range for n, step in enumerate(levelled.steps, 1)}
            facts["tilt"] = {"dz_dy": levelled.tilt[0], "dz_dx": levelled.tilt[1]}
            facts["terraces"] = [{"height_m": t.height, "share": t.share} for t in levelled.terraces]
            facts["warnings"] = list(levelled.warnings)
            facts["levelling"] = [asdict(candidate) for candidate in levelled.candidates]
        if args.scars:
            image, scars = images.repair_scars(image)
            print(scars)
            facts["scars"] = {"scars": scars.scars, "pixels": scars.pixels, "largest_m": scars.largest}
        if args.despeckle:
            image, speckles = images.despeckle(image)
            print(speckles)
            facts["speckles"] = {"pixels": speckles.pixels, "largest_m": speckles.largest}
    return image


def _tip(text: str | None) -> images.Paraboloid | images.RoundedCone | None:
    """The shape that ``--tip`` names; None for none, and for the one that the image shows."""
    if text is None or text == "blind":
        return None
    radius, *angle = text.split(",")
    if len(angle) > 1:
        raise InvalidValue(f"--tip {text}: write it like 10nm, 10nm,0.3rad or blind")
    if angle:
        return images.RoundedCone(parse_quantity(radius, "m"), parse_quantity(angle[0], "rad"))
    return images.Paraboloid(parse_quantity(radius, "m"))


def _without_tip(
    image: images.Topography, tip: images.Paraboloid | images.RoundedCone | None, out: Path, facts: dict[str, Any]
) -> images.Topography:
    shape: Any = tip
    if tip is None:
        size = min(31, (min(image.shape) // 2 - 1) | 1)
        estimate = images.estimate_tip(image, size)
        shape = estimate.heights
        np.savetxt(out / "tip.csv", shape, delimiter=",", fmt="%s", header="height above the apex [m]")
        height = 0.25 * float(shape.max())
        flat = not (shape > 0).any()
        radius = float("inf") if flat else estimate.radius(max(height, float(shape[shape > 0].min())))
        state = "" if estimate.converged else ", not settled"
        print(
            f"tip from the image: radius of the apex at most {length(radius)}, from {estimate.points} points over "
            f"{length(estimate.threshold)} of noise{state}"
        )
        facts["tip"] = {"radius_at_most_m": None if flat else radius, "threshold_m": estimate.threshold}
        facts["tip"] |= _apex(image)
    clean, certain = images.erode(image, shape)
    lowered = float((image.heights - clean.heights).max())
    print(f"tip undone: up to {length(lowered)} lower; {100 * certain.mean():.3g} % of the surface is certain")
    facts["certain_share"] = float(certain.mean())
    return clean


def _apex(image: images.Topography) -> dict[str, Any]:
    """The radius as an interval, where the image holds spikes."""
    try:
        apex = images.apex_radius(image)
    except InvalidValue as reason:
        print(f"no interval of the tip's radius: {reason}")
        return {}
    print(apex)
    return {"apex_radius_m": [apex.low, apex.radius, apex.high], "spikes": apex.spikes}


def _grains(image: images.Topography, threshold: float | str, pits: bool) -> images.GrainTable:
    """The particles; what speaks against them is told with the table."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return images.grains(image, threshold, pits=pits)


def _tell(table: images.GrainTable, out: Path, facts: dict[str, Any]) -> None:
    print(table)
    if len(table):
        _list(table)
    if len(table) > LISTED:
        print(f"  and {len(table) - LISTED} more in grains.csv")
    table.to_csv(out / "grains.csv")
    facts["grains"] = {"count": len(table), "coverage": table.coverage, "threshold_m": table.threshold,
                       "warnings": list(table.warnings)}  # fmt: skip


def _list(table: images.GrainTable) -> None:
    """The first particles, each length in the prefix that suits it."""
    lengths = {"height": table.height, "diameter": table.diameter, "x": table.x, "y": table.y}
    units = {name: prefixed(values) for name, values in lengths.items()}
    cube, scale = units["diameter"]
    headers = [f"{name} ({unit})" for name, (unit, _) in units.items()]
    print("  number" + "".join(f"{header:>15}" for header in (*headers[:2], f"volume ({cube}^3)", *headers[2:])))
    for k in range(min(len(table), LISTED)):
        height, diameter, x, y = (f"{values[k] * units[name][1]:15.4g}" for name, values in lengths.items())
        border = "  border" if table.border[k] else ""
        print(f"  {k + 1:6d}{height}{diameter}{table.volume[k] * scale**3:15.4g}{x}{y}{border}")
