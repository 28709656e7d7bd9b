# SPDX-License-Identifier: BSD-3-Clause
"""The paper's work from scan to push, as one film: image three particles, touch one, push it between the others, and
scan again. What each step found is told beside the truth."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nanotouch import images, record
from nanotouch.awaiting import awaited
from nanotouch.errors import InvalidValue, require

from nanotouch_app.common import output, stop
from nanotouch_app.common.quantity import whole_number
from nanotouch_app.studies.workflow import film, steps
from nanotouch_app.touching.push import write_track

FILES = ("scan.gwy", "touch.mcap", "push.csv", "predicted.gwy", "again.gwy", "workflow.json", "workflow.gif")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("workflow", description=__doc__)
    parser.add_argument(
        "--pixels", type=int, default=96, metavar="N", help="of a line, and lines (default: %(default)s)"
    )
    parser.add_argument("--seed", type=whole_number(0, 2**32 - 2, "2^32 - 2"), default=1, metavar="N",
                        help="of all noise and of the drift (default: %(default)s)")  # fmt: skip
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if not 48 <= args.pixels <= 512:
        raise InvalidValue(f"--pixels {args.pixels}: valid is 48 .. 512")
    require("matplotlib", "app")
    with output.folder(args, FILES) as out:
        kept: list[str] = []

        def keep(name: str, found: Any) -> None:
            WRITERS[name](found, out / FILE_OF[name])
            kept.append(FILE_OF[name])

        try:
            with output.busy("scanning, touching, pushing, scanning again"):
                done = awaited(lambda: steps.work(args.pixels, args.seed, keep))
        except stop.Stopped as stopped:
            told = "nothing is kept"
            if kept:
                verb = "is" if len(kept) == 1 else "are"
                told = f"{', '.join(kept)}: {len(kept)} of {len(WRITERS)} files {verb} kept in {out}"
            raise stop.Stopped(stopped.number, told) from None
        facts = done.facts()
        output.write_json(out / "workflow.json", facts)
        with stop.keeping("all but the film is", out), output.progress_bar("filming") as progress:
            film.write(done, out / "workflow.gif", progress)
        args.answer = facts | {"folder": str(out), "files": list(FILES)}
        output.say(words(facts))
        output.say(f"written to {out}/: {', '.join(FILES)}")
    return 0


def _write_scan(found: steps.Scanned, path: Path) -> None:
    found.image.write(path, images.RoundedCone(steps.scene().tip.radius, steps.scene().tip.half_angle))


WRITERS: dict[str, Callable[[Any, Path], object]] = {
    "first": _write_scan,
    "touched": lambda found, path: record.write(path, found.recording),
    "pushed": write_track,
    "predicted": lambda found, path: images.write(path, found),
    "again": _write_scan,
}
"""what each step leaves for the next, and for other programs"""
FILE_OF = dict(zip(WRITERS, FILES, strict=False))


def words(facts: dict[str, float]) -> str:
    """What was found, beside what is true."""
    nm = {name: 1e9 * value for name, value in facts.items() if name.endswith(("_m", "_N"))}
    return "\n".join(
        (
            f"scan: the particle is shown {nm['map_error_m']:.2g} nm from where it lies, its height "
            f"{nm['height_error_m']:+.2g} nm off",
            f"touch: pressed with {nm['largest_force_N']:.3g} nN, pulled off at {nm['pull_off_N']:.2g} nN "
            f"(planned: {nm['planned_pull_off_N']:.2g} nN)",
            f"push: {facts['pushes']} pushes of {nm['largest_push_N']:.2g} nN at most, {facts['lines']} lines to look, "
            f"{facts['bench_time_s']:.0f} s; it lies {nm['error_m']:.2g} nm from the target",
            f"map: it followed the particle within {nm['predicted_error_m']:.2g} nm",
            f"scan again: the particle is shown {nm['map_error_again_m']:.2g} nm from where it lies, "
            f"{nm['shown_error_m']:.2g} nm from the target",
        )
    )
