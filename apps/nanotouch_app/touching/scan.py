# SPDX-License-Identifier: BSD-3-Clause
"""Scan a surface on the simulated rig, in contact or tapping mode: what the scan will do is told first, then the image
is taken, there and back, with all channels. `nanotouch touch` and `live` go on from surface.gwy, its heights without
the tip. A scene that is a rig file scans with its real slave."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import images, scan
from nanotouch.awaiting import awaited
from nanotouch.errors import DeviceError, InvalidValue, MissingExtra, require
from nanotouch.plots import new_figure, saved
from nanotouch.units import in_words

from nanotouch_app.common import output, properties, scenes, stop, surfaces
from nanotouch_app.common.quantity import parse_quantity, whole_number
from nanotouch_app.touching import scan_rig

FILES = ("scan.gwy", "surface.gwy", "scan.json", "scan.png")
MODES = ("contact", "tapping", "phase")
FLIGHT = 0.03  # of the width after a step down by the whole height, where no line rate is given
TICKS_OF_STAGE = 20.0  # per period of the stage's resonance, where no rate is given
ACCURACIES = (0.01, 0.03, 0.1, 0.3)  # of forces, the first that the surface allows
MOST_TICKS = 2e9
FLAT = 6e-6  # side of a scan on a real rig, where nobody names an area or a surface [m]
LEAST, MOST = 4, 8192  # pixels and lines of an image


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("scan", description=__doc__)
    parser.add_argument("what", nargs="?", metavar="IMAGE|SURFACE|PRESET", help="AFM image; built-in surface: "
                        f"{', '.join(surfaces.BUILT_IN)}; or a preset, over its surface (default: dots)")  # fmt: skip
    properties.add_reading(parser.add_argument_group("how IMAGE is read"))
    how = parser.add_argument_group("how it is scanned")
    tables = "scene, rig, [drive], [zloop], [raster], [readout]"
    how.add_argument("--scene", metavar="SCENE", help=scenes.HELP.format(what=tables)
                     + " (default: silicon in humid air)")  # fmt: skip
    scenes.add_allow_code(how)
    how.add_argument("--mode", choices=MODES, help="keep the deflection, or tap and keep amplitude or phase "
                     "(default: tapping)")  # fmt: skip
    how.add_argument("--set-point", metavar="VALUE", help="contact: a force, as 20nN; tapping: amplitude over the free "
                     "one, as 0.7; phase: an angle, as 0.8rad")  # fmt: skip
    how.add_argument("--free-amplitude", metavar="LENGTH", help="of tapping, as 20nm")
    how.add_argument("--area", metavar="X,Y,W,H", help="lower left corner and size, as 1um,1um,2um,2um (default: all)")
    count = whole_number(LEAST, MOST)
    how.add_argument("--pixels", type=count, metavar="N", help="of a line, and lines (default: 256)")
    how.add_argument("--lines", type=count, metavar="N", help="another number of lines")
    how.add_argument("--line-rate", metavar="RATE", help="lines per second, as 0.5Hz (default: so slow that the tip "
                     "flies no more than 3 %% of the width after a step down)")  # fmt: skip
    how.add_argument("--gain", metavar="RATE", help="K_I of the z loop, as 50Hz (default: as advised)")
    how.add_argument("--steady", metavar="ACCURACY", nargs="?", const="5%", help="the image of an infinitely slow "
                     "scan: the loop has settled at each pixel; forces within 5%%, or as told")  # fmt: skip
    how.add_argument("--seed", type=whole_number(0, 2**64 - 1, "2^64 - 1"), default=1, metavar="N",
                     help="of the noise (default: %(default)s)")  # fmt: skip
    how.add_argument("--forecast", action="store_true", help="tell what the scan would do, and end")
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    scene, rig, tables = scenes.read(args.scene if args.scene else _preset(args.what))
    is_real = scan_rig.is_named(args) and not args.forecast
    with output.busy("reading the surface"):
        surface = awaited(lambda: _surface(args, scene, tables))
    print("".join(f"{note}\n" for note in (() if surface is None else surface.notes)), end="")
    if is_real:
        return _on_rig(args, scene, tables, surface)
    with output.busy("planning"):
        plan = awaited(lambda: _plan(scene, surface, tables))
        scanner = awaited(lambda: _scanner(args, plan, rig, tables, surface))
    with output.busy("forecasting"):
        told = awaited(lambda: scan.forecast(scanner, scene, surface))
    accuracy = _accuracy(args.steady, scanner)
    duration = scanner.scan["raster.lines"] / scanner.scan["raster.line_rate"]
    output.say(told)
    if plan.bound > ACCURACIES[0]:
        output.say(
            f"forces of the scan are within {100 * plan.bound:.2g} %: the surface has edges sharper than the tip"
        )
    print(f"the scan takes {_time(duration)} on an instrument")
    args.answer = {"forecast": told._asdict() | {"motions": [one._asdict() for one in told.motions]},
                   "duration": duration}  # fmt: skip
    if args.forecast:
        return 0
    if accuracy is None:
        _check(scanner, duration)
    with output.folder(args, FILES) as out:
        image, signals = _taken(scanner, args.seed, accuracy)
        _keep(args, image, scanner.scan, signals, scene, out, plan.friction.form != "off")
    return 0


def _on_rig(args: argparse.Namespace, scene: nt.Scene, tables: dict[str, Any], surface: nt.Surface | None) -> int:
    """With the real slave of a rig file, which moves by the clock."""
    args.mode = scan_rig.mode(args, tables)
    settings, drive = nt.Scan.from_tables(tables), nt.Drive.from_tables(tables)
    _set_loop(args, settings, drive)
    _set_raster(args, settings, surface, "raster" in tables)
    rate = None if args.line_rate is None else parse_quantity(args.line_rate, "Hz")
    if rate is None and any(key.startswith("line_rate") for key in tables.get("raster", {})):
        rate = settings["raster.line_rate"]
    with output.folder(args, FILES) as out:
        session = scan_rig.opened(args, settings, drive, surface, rate)
        duration = settings["raster.lines"] / settings["raster.line_rate"]
        print(f"the scan takes {_time(duration)}")
        args.answer = {"duration": duration, "guarantee": session.guarantee().force}
        slides = session.plan.friction.form != "off"
        try:
            image, signals = scan_rig.taken(session, settings)
        except nt.raster.Ended as ended:
            raise DeviceError(f"{ended}; {_kept(args, ended.image, settings, scene, out)}") from ended
        _keep(args, image, settings, signals, scene, out, slides)
    return 0


def _keep(
    args: argparse.Namespace, image: scan.Image, settings: nt.Scan, signals: list[int], scene: nt.Scene, out: Path,
    slides: bool,
) -> None:  # fmt: skip
    """Write what was scanned, then say by which signal it ended."""
    if not signals:
        _write(args, image, settings, scene, out, slides)
        return
    raise stop.Stopped(signals[0], _kept(args, image, settings, scene, out))


def _kept(args: argparse.Namespace, image: scan.Image, settings: nt.Scan, scene: nt.Scene, out: Path) -> str:
    """Write the lines of a scan that has ended early, without their picture, and say how many there are."""
    lines, wanted = len(image.trace.height), int(settings["raster.lines"])
    if lines < LEAST:
        return f"{lines} of {wanted} lines were scanned, an image has at least {LEAST}: nothing is kept"
    _write_data(args, image, settings, scene, out, args.answer | _facts(image))
    return f"{lines} of {wanted} lines are kept in {out}: nanotouch touch {out}/surface.gwy"


def _accuracy(steady: str | None, scanner: nt.Scanner) -> float | None:
    if steady is None:
        return None
    if scanner.scan.zloop.mode == "contact":
        raise InvalidValue("--steady: an image of tapping or phase; in contact mode a slow scan is one")
    accuracy = parse_quantity(steady, "")
    if not 1e-6 <= accuracy <= 0.5:
        raise InvalidValue(f"--steady {steady}: valid is 0.0001% .. 50%")
    return accuracy


def _write(
    args: argparse.Namespace, image: scan.Image, settings: nt.Scan, scene: nt.Scene, out: Path, slides: bool
) -> None:  # fmt: skip
    """Files, picture and what there is to say."""
    facts = args.answer | _facts(image)
    with stop.asked() as signals, output.busy("undoing the tip"):
        _write_data(args, image, settings, scene, out, facts)
    if signals:
        raise stop.Stopped(signals[0], f"all but the picture is in {out}")
    try:
        draw(image, out / "scan.png")
    except MissingExtra as missing:
        print(f"picture left out: {missing}")
    written = [name for name in FILES if (out / name).exists()]
    args.answer = facts | {"folder": str(out), "files": written}
    force = _force(facts["peak_force"])
    output.say(
        f"image: heights over {facts['height_range'] * 1e9:.4g} nm, {force}trace and retrace differ by "
        f"{facts['difference'] * 1e9:.3g} nm rms"
    )
    if slides and image.mode == "contact":
        output.say(f"friction: {facts['friction'] * 1e9:.3g} nN, half the mean difference of the lateral forces")
    print(f"written to {out}/: {', '.join(written)}\ngo on: nanotouch touch {out}/surface.gwy")


def _write_data(
    args: argparse.Namespace, image: scan.Image, settings: nt.Scan, scene: nt.Scene, out: Path, facts: dict[str, Any]
) -> None:  # fmt: skip
    """What was measured, and the surface without the tip."""
    tip = images.RoundedCone(scene.tip.radius, scene.tip.half_angle)
    image.write(out / "scan.gwy", tip)
    surface, reports = image.without_tip(tip), []
    if scan_rig.is_named(args) or any(settings[f"raster.{name}"] for name in ("tilt_x", "tilt_y", "drift")):
        surface, told = images.prepare(surface)
        reports = [f"surface.gwy: {report if args.verbose else output.in_short(report)}\n" for report in told]
    images.write(out / "surface.gwy", replace(surface, channel=images.READY))
    output.write_json(out / "scan.json", facts)
    print("".join(reports), end="")


def _force(peak: float | None) -> str:
    if peak is None:
        return ""
    return f"max force {in_words(peak, 'N', 3)}, " if peak > 0.0 else "no tap pushes on the sample, "


def _preset(what: str | None) -> str | None:
    return what if what in scenes.PRESETS + scenes.PAPER else None


def _surface(args: argparse.Namespace, scene: nt.Scene, tables: dict[str, Any]) -> nt.Surface | None:
    """None: a flat without end, for what lies under a real probe is not known yet."""
    named = nt.SurfaceFile.from_tables(tables)
    preset = _preset(args.what)
    if args.what is None or preset is not None or args.what in surfaces.BUILT_IN:
        properties.refuse_reading(args)
    if args.what is None and named is None and scan_rig.is_named(args):
        return None
    if args.what is None or preset is not None:
        if named is not None:
            return named.touched_by(scene)
        return nt.Surface.touched_by(scene, surfaces.of_scene(preset) if preset else nt.surface.dots())
    if named is not None:
        raise InvalidValue(f"{args.scene} names a surface ([surface]): give it or {args.what}, not both")
    if args.what in surfaces.BUILT_IN:
        return nt.Surface.touched_by(scene, surfaces.BUILT_IN[args.what]())
    return nt.SurfaceFile(image=args.what, **properties.reading(args)).touched_by(scene)


def _plan(scene: nt.Scene, surface: nt.Surface | None, tables: dict[str, Any]) -> nt.Plan:
    """As the file demands, else within 1 %, or what can be kept on sharp edges."""
    if "demand" in tables:
        return nt.Plan.make(scene, nt.Demand.from_tables(tables), surface=surface)
    for accuracy in ACCURACIES[:-1]:
        try:
            return scene.plan(accuracy, surface=surface)
        except InvalidValue as refusal:
            if "relative_accuracy" not in str(refusal):
                raise
    return scene.plan(ACCURACIES[-1], surface=surface)


def _scanner(
    args: argparse.Namespace, plan: nt.Plan, rig: nt.Rig, tables: dict[str, Any], surface: nt.Surface | None
) -> nt.Scanner:
    """What file and options say; what neither says follows from the surface, the rig and the rules."""
    settings, drive = nt.Scan.from_tables(tables), nt.Drive.from_tables(tables)
    told = {f"{section}.{key}" for section in ("zloop", "raster") for key in tables.get(section, {})}
    _set_loop(args, settings, drive)
    if not any(name.startswith("zloop.rate") for name in told):
        swings = rig["probe.resonance"] / math.sqrt(max(rig["probe.quality"], 1.0))
        settings["zloop.rate"] = min(50e3, max(TICKS_OF_STAGE * rig["stage.resonance"], swings))
    _set_raster(args, settings, surface, "raster" in tables)
    if args.line_rate is not None:
        settings["raster.line_rate"] = parse_quantity(args.line_rate, "Hz")
    elif not any(name.startswith("raster.line_rate") for name in told):
        settings["raster.line_rate"] = 1e-3
        trial = nt.Scanner(plan, settings, rig, drive)
        height = 0.0 if surface is None else scan.steepest(trial, surface)[1]
        flight = trial.parachute(height, 1.0)
        fastest = min(0.25 * settings["zloop.rate"] / settings["raster.pixels"], 1.0)
        rate = min(FLIGHT / (2.0 * flight), fastest) if flight > 0.0 else fastest
        settings["raster.line_rate"] = max(float(f"{rate:.2g}"), 1e-3)
    return nt.Scanner(plan, settings, rig, drive)


def _set_loop(args: argparse.Namespace, settings: nt.Scan, drive: nt.Drive) -> None:
    if args.mode is not None:
        settings.zloop.mode = args.mode
    mode = settings.zloop.mode
    if args.set_point is not None:
        unit, field = {"contact": ("N", "set_force"), "tapping": ("", "set_amplitude"), "phase": ("rad", "set_phase")}[
            mode
        ]
        settings[f"zloop.{field}"] = parse_quantity(args.set_point, unit)
    if args.gain is not None:
        settings["zloop.integral"] = parse_quantity(args.gain, "Hz")
    if args.free_amplitude is not None:
        if mode == "contact":
            raise InvalidValue("--free-amplitude goes with tapping")
        drive["drive.free_amplitude"] = parse_quantity(args.free_amplitude, "m")


def _set_raster(args: argparse.Namespace, settings: nt.Scan, surface: nt.Surface | None, is_told: bool) -> None:
    raster = settings.raster
    if args.area is not None:
        parts = args.area.split(",")
        if len(parts) != 4:
            raise InvalidValue(f"--area {args.area}: write it like 1um,1um,2um,2um")
        raster.x, raster.y, raster.width, raster.height = (parse_quantity(part, "m") for part in parts)
    elif not is_told:
        raster.x, raster.y = 0.0, 0.0
        raster.width, raster.height = (FLAT, FLAT) if surface is None else surface.size
    if args.pixels is not None:
        raster.pixels = raster.lines = float(args.pixels)
    if args.lines is not None:
        raster.lines = float(args.lines)
    if min(raster.pixels, raster.lines) < LEAST:  # before the scan: the file of an image needs them
        raise InvalidValue(f"{raster.pixels:g} pixels, {raster.lines:g} lines: an image has at least {LEAST} of each")
    if surface is None:  # the range of the slave counts
        return
    for axis, first, length, whole in zip(
        "xy", (raster.x, raster.y), (raster.width, raster.height), surface.size, strict=True
    ):
        if first < 0.0 or first + length > whole * (1.0 + 1e-9):
            raise InvalidValue(
                f"the scan goes from {axis} = {first * 1e6:.4g} to {(first + length) * 1e6:.4g} um: the surface has 0 "
                f".. {whole * 1e6:.4g} um"
            )


def _check(scanner: nt.Scanner, duration: float) -> None:
    ticks = duration * scanner.scan["zloop.rate"]
    if ticks > MOST_TICKS:
        raise InvalidValue(
            f"{_time(duration)} at {scanner.scan['zloop.rate'] / 1e3:.3g} kHz are {ticks:.2g} ticks of the loop, valid "
            f"is up to {MOST_TICKS:.0e}: fewer --lines, a higher --line-rate, or a lower [zloop] rate"
        )


def _taken(scanner: nt.Scanner, seed: int, accuracy: float | None) -> tuple[scan.Image, list[int]]:
    """The image, steady to an accuracy or in time; Ctrl-C ends it after the lines in hand. And what signals came."""
    with stop.asked() as signals, output.progress_bar("scanning") as progress:

        def after_strip(done: float) -> bool:
            progress(done)
            return not signals

        image = scanner.run(seed, after_strip) if accuracy is None else scanner.steady(accuracy, progress=after_strip)
    return image, signals


def _facts(image: scan.Image) -> dict[str, Any]:
    there, back = image.trace, image.retrace
    difference = there.height - back.height
    peak = float(max(there.peak_force.max(), back.peak_force.max()))
    return {
        "height_range": float(np.ptp(there.height)),
        "peak_force": None if math.isnan(peak) else peak,  # of tapping nothing measures it on a rig
        "largest_error": float(np.abs(there.error).max()),
        "difference": float(np.sqrt(np.mean((difference - difference.mean()) ** 2))),
        "friction": float(0.5 * np.mean(there.lateral - back.lateral)),
    }


def _time(seconds: float) -> str:
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.3g} {unit}"
    return f"{seconds:.3g} s"


def draw(image: scan.Image, path: Any) -> None:
    """The channels of the trace, and trace and retrace of the middle line."""
    require("matplotlib", "app")
    figure = new_figure(13.0, 7.4)
    panels = figure.subplots(2, 3).ravel()
    (dy, dx), taps = image.pixel_size, image.mode != "contact"
    ny, nx = image.trace.height.shape
    extent = (0.0, nx * dx * 1e6, 0.0, ny * dy * 1e6)
    shown = [
        ("Height (nm)", image.trace.height * 1e9),
        ("Height, retrace (nm)", image.retrace.height * 1e9),
        ("Error (nm)", image.trace.error * 1e9),
        ("Phase (degrees)", np.degrees(image.trace.phase)) if taps else ("Deflection (nm)", image.trace.signal * 1e9),
        ("Lateral force (nN)", image.trace.lateral * 1e9)
        if image.trace.lateral.any()
        else ("Max force (nN)", image.trace.peak_force * 1e9)
        if not np.isnan(image.trace.peak_force).any()
        else ("Amplitude (nm)", image.trace.signal * 1e9),
    ]
    for panel, (title, values) in zip(panels, shown, strict=False):
        low, high = np.percentile(values, (0.5, 99.5))
        drawn = panel.imshow(
            values, origin="lower", extent=extent, aspect="auto", vmin=low, vmax=high if high > low else low + 1.0
        )
        figure.colorbar(drawn, ax=panel)
        panel.set_title(title, loc="left", fontsize="medium")
        panel.set_xlabel("x (um)")
        panel.set_ylabel("y (um)")
    x = (np.arange(nx) + 0.5) * dx * 1e6
    panels[5].plot(x, image.trace.height[ny // 2] * 1e9, label="trace")
    panels[5].plot(x, image.retrace.height[ny // 2] * 1e9, "--", label="retrace")
    panels[5].set_title("Middle line: height (nm)", loc="left", fontsize="medium")
    panels[5].set_xlabel("x (um)")
    panels[5].legend(frameon=False, fontsize="small")
    saved(figure, path, dpi=120)
