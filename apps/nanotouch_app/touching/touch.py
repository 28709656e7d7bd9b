# SPDX-License-Identifier: BSD-3-Clause
"""Touch a surface on the simulated rig: the probe comes down on it, and what the operator felt is recorded, summarised
and drawn. A scene that is a rig file moves its real halves, by the same script."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, get_args

import nanotouch as nt
import numpy as np
from nanotouch import margins, plots, record
from nanotouch.errors import InvalidValue, MissingExtra
from nanotouch.touch.columns import STATES
from nanotouch.touch.operator import script_for
from nanotouch.touch.session import MODES, ProbeModel
from nanotouch.units import in_words

from nanotouch_app import view
from nanotouch_app.common import output, properties, scenes, stop, surfaces
from nanotouch_app.common.quantity import number, parse_points, parse_quantity, whole_number
from nanotouch_app.devices import launch
from nanotouch_app.devices.table import DEVICES
from nanotouch_app.touching import loop, report, summary

FILES = ("recording.mcap", "summary.json", "time.png", "force_gap.png", "line.png", "view.png")
MOVING = ("scan", "topography")
ALONE = ("topography", "approach", "curve")  # modes in which the stage goes by itself
LONGEST = 600.0  # [s]
MOST_STEPS = 6_000_000  # 1 GB of memory


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "touch",
        description=__doc__,
    )
    where = parser.add_argument_group("what is touched, and where")
    where.add_argument("image", nargs="?", metavar="IMAGE", help="AFM image; without it a built-in surface")
    where.add_argument(
        "--surface",
        choices=surfaces.BUILT_IN,
        help="built-in surface (default: that of the preset, as in nanotouch live; of a real probe flat; else grating)",
    )
    where.add_argument("--mode", choices=MODES, default="point", help="press at a point, feel the forces along a line, "
                       "follow it at constant force and feel the height, find the surface and stay on it, or record a "
                       "force-distance curve (default: %(default)s)")  # fmt: skip
    where.add_argument("--at", metavar="X,Y", help="point to touch, as 2.5um,3um (default: the middle)")
    where.add_argument(
        "--line", metavar="X,Y,X,Y", help="line to follow, as 0um,2um,6um,2um (default: across the middle)"
    )
    properties.add_reading(where)
    how = parser.add_argument_group("how it is touched")
    how.add_argument(
        "--scene",
        metavar="SCENE",
        help=scenes.HELP.format(what="scene, rig and gains") + " (default: silicon in humid air)",
    )
    scenes.add_allow_code(how)
    how.add_argument("--hand", metavar="DEVICE", help="a haptic device leads the hand in place of the script: "
                     f"{', '.join(DEVICES)} (docs/devices.md)")  # fmt: skip
    loop.add_options(how)
    how.add_argument("--probe-model", choices=get_args(ProbeModel), default="auto", help="how the cantilever is "
                     "simulated (default: %(default)s)")  # fmt: skip
    how.add_argument("--minimum-margin", type=number(0.0, 1e6), default=margins.MINIMUM, metavar="NUMBER",
                     help="refuse to touch closer to the stability limit, 1, than this; 0: never "
                     "(default: %(default)s)")  # fmt: skip
    how.add_argument("--duration", metavar="TIME", help="stretch the operator's script to this, as 20s")
    how.add_argument("--seed", type=whole_number(0, 2**64 - 1, "2^64 - 1"), default=1, metavar="N",
                     help="of the sensors' noise (default: %(default)s)")  # fmt: skip
    results = parser.add_argument_group("results")
    output.add_options(results)
    results.add_argument("--no-pictures", action="store_true", help="record and tell, but draw nothing")
    results.add_argument("--no-window", action="store_true", help="do not open the 3-D view where there is a display")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.hand is None:
        return _run(args, None)
    with launch.of_hand(args.hand) as bridge:  # ends with the touch
        return _run(args, bridge)


def _run(args: argparse.Namespace, bridge: launch.Launched | None) -> int:
    session = _session(args, bridge)
    assert session.surface is not None
    topography = session.surface.topography
    duration = None if args.duration is None else _duration(args.duration)
    _check_steps(session, duration)
    with output.folder(args, FILES) as out:
        _say_before(session, args)
        recording = _record(session, duration, out)
        facts = summary.summarise(session, recording)
        output.write_json(out / "summary.json", facts)
        with output.busy("drawing"):
            missing = [] if args.no_pictures else _draw(session, topography, recording, out)
        written = [name for name in FILES if (out / name).exists()]
        args.answer = facts | {"folder": str(out), "files": written}
        if session.halves.slave.real:
            output.say(_measured(session, recording))
        else:
            if args.verbose:
                output.say(summary.words(facts))
            output.say(report.report(session, facts, describe(topography), args))
        print("".join(f"picture left out: {reason}\n" for reason in missing), end="")
        output.say(f"written to {out}/: {', '.join(written)}")
    if not args.no_window and view.has_display() and not session.halves.slave.real:
        view.open_window(topography, recording, session.scene.tip.radius)
    return 0


def _measured(session: nt.Session, recording: nt.Recording) -> str:
    """What the sensors of a real probe said; nobody knows the true force."""
    states, lost = recording.state, session.progress.dropped
    seen = [state for number, state in enumerate(STATES) if np.any(states == number)]
    forces = recording.slave_force
    most, least, down = (
        in_words(float(number), unit, 4)
        for number, unit in (
            (np.nanmax(forces), "N"),
            (np.nanmin(forces), "N"),
            (np.nanmax(recording.stage_position), "m"),
        )
    )
    return (
        f"measured {most} at most, {least} at least; the stage went to {down}\n"
        f"states   {', '.join(seen)}; {len(states)} periods are recorded, {lost} were lost by a full ring\n"
        f"promised {in_words(session.guarantee().force, 'N', 4)} at most, whatever the hand does"
    )


def _say_before(session: nt.Session, args: argparse.Namespace) -> None:
    """What is known before anything moves: notes of the image, and with ``--verbose`` margins and limits."""
    surface = session.surface
    assert surface is not None
    if session.is_led:
        output.say(_led(session))
    print("".join(f"{note if args.verbose else output.in_short(note)}\n" for note in surface.notes), end="")
    if args.verbose:
        output.say(f"surface: {describe(surface.topography)}\n{summary.before(session)}")


def _led(session: nt.Session) -> str:
    """Who leads what, where a device is the master."""
    alone = session.mode in ALONE
    is_along = session.mode == "scan" and session.rig.master.axes == 1.0
    hand = "nothing, for this mode needs no hand" if alone else "z, up and down" if is_along else "the tip, down and up"
    script = "x and y along the path" if is_along or alone else "nothing"
    return (f"the master is a device: your hand leads {hand}; the script leads {script}, and pushes nothing. "
            "--duration says how long")  # fmt: skip


def describe(topography: nt.Topography) -> str:
    """The surface in a line."""
    (ny, nx), (height, width) = topography.shape, topography.size
    return (
        f"{topography.name}, {width * 1e6:.4g} x {height * 1e6:.4g} um, {nx} x {ny} pixels, "
        f"heights over {topography.height_range * 1e9:.4g} nm"
    )


def _surface(args: argparse.Namespace, scene: nt.Scene, tables: dict[str, Any], is_real: bool) -> nt.Surface:
    if args.image is None:
        properties.refuse_reading(args)
    elif args.surface is not None:
        raise InvalidValue(f"give an IMAGE or --surface {args.surface}, not both")
    named = properties.surface_file(args, args.image, tables, args.scene)
    if named is None:
        chosen = args.surface or ("flat" if is_real else None)
        topography = surfaces.BUILT_IN[chosen]() if chosen else surfaces.of_scene(args.scene)
        return nt.Surface.touched_by(scene, topography)
    if args.surface is not None:
        raise InvalidValue(f"{args.scene} names a surface ([surface]): give it or --surface {args.surface}, not both")
    surface: nt.Surface = named.touched_by(scene)
    return surface


def _session(args: argparse.Namespace, bridge: launch.Launched | None) -> nt.Session:
    scene, rig, tables = scenes.read(args.scene)
    real = scenes.real_halves(args.scene, args.allow_code)
    if bridge is not None:
        if "master" in real:
            raise InvalidValue(f"{args.scene} names a master ([master]): give it or --hand {args.hand}, not both")
        gains = bridge.device.lead(rig)
        real["master"] = nt.hal.Mailbox(bridge.name)
    with output.busy("reading the surface"):
        surface = _surface(args, scene, tables, "slave" in real)
    what: dict[str, Any] = {
        "surface": surface, "mode": args.mode, "path": _path(args), "seed": args.seed,
        "control": args.control, "probe_model": args.probe_model,
    }  # fmt: skip
    if bridge is not None and "gains" not in tables:
        what["gains"] = gains
    with output.busy("planning"):
        session = nt.Session(
            scene, rig, settings=_settings(args, tables, scene, rig, what), rate=loop.rate_of(args.rate),
            delay=loop.delay_of(args.delay), minimum_margin=0.0, **what, **real,
        )  # fmt: skip
    found = session.margins()
    if not found.least >= args.minimum_margin:
        raise InvalidValue(
            f"not armed: stability margin {found.least:.3g} ({found.rule}), at least {args.minimum_margin:g} is needed"
            "; nanotouch margins shows all of them, --minimum-margin overrides"
        )
    return session


def _settings(
    args: argparse.Namespace, tables: dict[str, Any], scene: nt.Scene, rig: nt.Rig, what: dict[str, Any]
) -> nt.Settings | None:
    """What file and options say of the loop, beside what follows from the relief on the path; None: nothing."""
    if args.force_range is None and not tables.keys() & set(nt.Settings.sections()):
        return None
    scaled = nt.Session(scene, rig, minimum_margin=0.0, **what)
    settings = scaled.settings.copy()
    loop.scale_force(args.force_range, scaled.plan, rig, settings)
    settings.update_from_tables(tables)
    if not loop.says_scale(tables, args.force_range):
        closed = settings.copy()
        closed.gains.alpha_f = nt.Settings.for_rig(rig).gains.alpha_f
        loop.close(closed, args)
        settings.gains.alpha_f = margins.felt_alpha_f(rig, closed, scaled.plan, load=scene.range.maximum_load)
    return settings


def _path(args: argparse.Namespace) -> list[tuple[float, float]] | None:
    if args.mode == "point":
        if args.line is not None:
            raise InvalidValue("--line goes with --mode scan or topography; --mode point takes --at X,Y")
        return None if args.at is None else parse_points(args.at, 1)
    if args.at is not None:
        raise InvalidValue(f"--at goes with --mode point; --mode {args.mode} takes --line X,Y,X,Y")
    return None if args.line is None else parse_points(args.line, 2)


def _duration(text: str) -> float:
    duration = parse_quantity(text, "s")
    if not 0.0 < duration <= LONGEST:
        raise InvalidValue(f"--duration {text}: valid is above 0 s, up to {LONGEST:g} s")
    return duration


def _check_steps(session: nt.Session, duration: float | None) -> None:
    lasts = sum(step.duration for step in script_for(session)) if duration is None else duration
    if lasts * session.rate > MOST_STEPS:
        raise InvalidValue(
            f"{lasts:.3g} s at {session.rate / 1e3:g} kHz are {lasts * session.rate:.3g} steps; valid is up to "
            f"{MOST_STEPS:.0e}: a shorter --duration, or a lower --rate"
        )


def _record(session: nt.Session, duration: float | None, out: Path) -> nt.Recording:
    """Play the script; after Ctrl-C the block in hand is finished, and the summary is that of the rows so far."""
    writer = record.Writer(out / "recording.mcap", session.metadata())
    try:
        with stop.between_blocks() as check, writer, output.progress_bar("touching") as progress:

            def after_block(done: float) -> None:
                progress(done)
                if done < 1.0:
                    check()

            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                recording = session.run(duration, writer=writer, progress=after_block)
        print("".join(f"WARNING: {warning.message}\n" for warning in caught), end="")
        return recording
    except stop.Stopped as stopped:
        with suppress(nt.Error):  # what counts is told
            if writer.rows:
                output.write_json(out / "summary.json", summary.summarise(session, record.read(writer.path)))
        raise stop.Stopped(stopped.number, writer.saved) from None


def _draw(session: nt.Session, topography: nt.Topography, recording: nt.Recording, out: Path) -> list[str]:
    """The pictures; what is missing for some of them is told, for the touch itself needs none."""
    drawn: list[Callable[[], Any]] = [lambda: plots.time(recording, save=out / "time.png")]
    if session.halves.slave.real:
        return [*_drawn(drawn), "force over the gap, line and view need the true gap, which a real probe does not say"]
    drawn += [
        lambda: plots.force_gap(recording, save=out / "force_gap.png"),
        lambda: view.render_png(topography, recording, out / "view.png", tip_radius=session.scene.tip.radius),
    ]
    if session.mode in MOVING:
        drawn.append(lambda: plots.line(recording, topography, save=out / "line.png"))
    return _drawn(drawn)


def _drawn(drawn: list[Callable[[], Any]]) -> list[str]:
    missing = []
    for draw in drawn:
        try:
            draw()
        except MissingExtra as error:
            missing.append(str(error))
    return list(dict.fromkeys(missing))
