# SPDX-License-Identifier: BSD-3-Clause
"""Every file under a folder, ours against every other reader that is installed: ``make corpus DIR=...``.

Compared are, of images, shape, scan size, range of the heights and orientation; of curves, number and points, range of
height and force. A file is

* **read** where we read it and most of those who read it too agree;
* **refused** where we do not (with our reason, and who does read it);
* **wrong** where most of those who read it disagree (with what about).

What its reader asks for (a calibration, a pixel size) is given and told. Files that no reader takes for data are left
out.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import itertools
import logging
import os
import sys
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import corpus_peers
import numpy as np
from corpus_peers import Curves, Image
from nanotouch import curves, images
from nanotouch.errors import Error, ReadError
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIZE, RANGE = 0.006, 2e-3  # relative differences that are none: scan size (N against N - 1), heights and forces
TABLE = "<!-- made by make corpus -->\n"  # in the documentation; the table follows it
LIKE = 0.999  # correlation above which two pictures are the same


@dataclass(frozen=True)
class Row:
    """What became of one file."""

    file: Path
    verdict: str
    kind: str
    reader: str
    told: str
    others: tuple[str, ...]


def judged(file: Path) -> Row | None:
    """The verdict on one file; None where nobody takes it for data."""
    reasons = []
    for kind, ours, peers, compare in (
        ("image", _our_image, corpus_peers.IMAGES, _images_differ),
        ("curves", _our_curves, corpus_peers.CURVES, _curves_differ),
        ("thermal", _our_spectrum, {}, None),
    ):
        others = _asked(peers, file)
        try:
            with _silence():
                mine, reader, notes = ours(file)  # type: ignore[operator]
        except Error as error:
            reasons.append((kind, " ".join(str(error).split()).removeprefix(f"{file}: "), others))
            continue
        wrong = [f"{name} has {text}" for name, theirs in others.items() if (text := compare(mine, theirs))]  # type: ignore[operator]
        if wrong and kind == "image" and _another_agrees(file, others):
            wrong, notes = [], [*notes, "compared in another of its channels of heights"]
        verdict = "wrong" if 2 * len(wrong) > len(others) else "read"
        return Row(file, verdict, kind, reader, "; ".join([*wrong, *notes]), tuple(others))
    kind, told, others = next((found for found in reasons if found[2]), reasons[0])
    if "; read that" in reasons[1][1]:
        return Row(file, "read", "curves", "nanotouch/asylum-pair", reasons[1][1], ())
    if not others and "not an AFM image" in reasons[0][1] and _unknown(reasons[1][1]):
        return None
    if (
        "not an AFM image" in told and not others and not _unknown(reasons[1][1])
    ):  # the reader of curves knows more of it
        told = reasons[1][1]
    return Row(file, "refused", kind if others else "", "", told, tuple(others))


def _unknown(reason: str) -> bool:
    return "not a force curve file" in reason or "its content is not" in reason


def _our_image(file: Path) -> tuple[Image, str, list[str]]:
    read, told = _read(images.read, file, pixel_size=1e-8, z_unit="nm")
    return (
        Image(read.channel, np.where(read.mask, np.nan, read.heights), read.size),
        read.source,
        [*told, *getattr(read, "notes", ())],
    )


def _read(reader: Callable[..., Any], file: Path, **given: Any) -> tuple[Any, list[str]]:
    """What the file holds; with these values where its reader asks for them, which is told."""
    told, options = "", {}
    for _ in range(3):
        try:
            return reader(file, **options), [f"given, as it {told}"] if told else []
        except ReadError as error:
            text = str(error)
            asked = {"give the pixel size": ["pixel_size"], "give the height unit": ["z_unit"]}
            names = next(
                (n for phrase, n in asked.items() if phrase in text), list(given) if "; give it" in text else []
            )
            names = [name for name in names if name in given and name not in options]
            if not names:
                raise
            told += (" and " if told else "") + text.removeprefix(f"{file}: ").partition(";")[0]
            options |= {name: given[name] for name in names}
            if "sensitivity" in names and "in m/A" in text:
                options["sensitivity"] = 1e9 * given["sensitivity"]  # m/V become m/nA
    raise AssertionError("asked three times")


def _our_curves(file: Path) -> tuple[Curves, str, list[str]]:
    read, told = _read(curves.read, file, spring_constant=1.0, sensitivity=1e-7)
    points = [sum(len(s) for s in curve.segments) for curve in read]
    first = read[0].segments
    notes = [*told, *(str(note) for note in read[0].meta.get("notes", ()))]
    force = [float(np.ptp(np.concatenate([s.force for s in first])))] if all(s.force is not None for s in first) else []
    travel = float(np.ptp(np.concatenate([s.z for s in first])))
    return Curves(points, travel, force[0] if force else None), str(read[0].meta.get("format", "")), notes


def _our_spectrum(file: Path) -> tuple[None, str, list[str]]:
    curves.thermal_spectrum(file)
    return None, "nanotouch/thermal-file", []


def _asked(
    peers: dict[str, Callable[[Path], list[Image] | Curves | None]], file: Path
) -> dict[str, list[Image] | Curves]:
    found = {}
    for name, peer in peers.items():
        with _silence(), contextlib.suppress(BaseException):  # afmformats derives its errors from BaseException
            theirs = peer(file)
            if theirs:
                found[name] = theirs
    return found


@contextlib.contextmanager
def _silence():  # type: ignore[no-untyped-def]
    with (
        warnings.catch_warnings(),
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(io.StringIO()),
    ):
        warnings.simplefilter("ignore")
        before = logging.root.manager.disable
        logging.disable()
        try:
            yield
        finally:
            logging.disable(before)


def _images_differ(ours: Image, theirs: list[Image]) -> str:
    """What the channel of theirs that is most like ours has otherwise; empty if it is the same."""
    return min((_image_differs(ours, one) for one in theirs), key=len)


def _another_agrees(file: Path, others: dict[str, list[Image]]) -> bool:
    """Whether all have one of our other channels of heights as we have it: they may not know the best one."""
    heights = [channel.name for channel in images.channels(file) if channel.kind == "height" and not channel.default]
    for name in heights[:8]:
        read = images.read(file, name)
        if not any(_images_differ(Image(name, read.heights, read.size), theirs) for theirs in others.values()):
            return True
    return False


def _image_differs(ours: Image, theirs: Image) -> str:
    if ours.heights.shape not in (theirs.heights.shape, theirs.heights.shape[::-1]):
        return f"{theirs.heights.shape[1]} x {theirs.heights.shape[0]} pixels in {theirs.name!r} instead of ours"
    told = []
    turned = _turned(ours.heights, theirs.heights)
    if turned:
        told.append(turned)
    if theirs.size is not None and not np.allclose(ours.size, theirs.size, rtol=SIZE + 1 / min(ours.heights.shape)):
        told.append(f"scan {theirs.size[1]:.4g} x {theirs.size[0]:.4g} m, ours {ours.size[1]:.4g} x {ours.size[0]:.4g}")
    if not turned:
        known = np.isfinite(theirs.heights) & np.isfinite(ours.heights)
        mine, others = float(np.ptp(ours.heights[known])), float(np.ptp(theirs.heights[known]))
        if not abs(mine - others) <= RANGE * max(mine, others):
            told.append(f"heights over {others:.4g} m, ours {mine:.4g}")
    return ", ".join(told)


def _turned(ours: Array, theirs: Array) -> str:
    """How theirs is turned against ours; empty if it is not."""
    best, how = -2.0, ""
    for transpose, flip_y, flip_x in itertools.product((False, True), (False, True), (False, True)):
        picture = (theirs.T if transpose else theirs)[:: -1 if flip_y else 1, :: -1 if flip_x else 1]
        if picture.shape == ours.shape:
            like = _correlation(ours, picture)
            if like > best + 1e-6:  # the first of several that serve, as it stands
                best = like
                ways = (("transposed", transpose), ("upside down", flip_y), ("mirrored", flip_x))
                how = " ".join(word for word, yes in ways if yes)
    return how if best > LIKE else f"another picture (correlation {best:.3f})"


def _correlation(one: Array, other: Array) -> float:
    """Over what both know; of two that are constant 1."""
    known = np.isfinite(one) & np.isfinite(other)
    if not known.any():
        return 0.0
    a, b = one[known] - one[known].mean(), other[known] - other[known].mean()
    if np.ptp(a) == 0.0 and np.ptp(b) <= 1e-9 * np.abs(other[known]).max():
        return 1.0
    return float((a * b).sum() / max(np.sqrt((a**2).sum() * (b**2).sum()), 1e-300))


def _curves_differ(ours: Curves, theirs: Curves) -> str:
    told = []
    if len(ours.points) != len(theirs.points):
        told.append(f"{len(theirs.points)} curves, ours {len(ours.points)}")
    elif theirs.points[0] not in (0, ours.points[0]):
        told.append(f"{theirs.points[0]} points, ours {ours.points[0]}")
    for what, mine, others in (("travel", ours.travel, theirs.travel), ("force over", ours.force, theirs.force)):
        if mine is not None and others is not None and not abs(mine - others) <= RANGE * max(mine, others):
            told.append(f"{what} {others:.4g}, ours {mine:.4g}")
    return ", ".join(told)


def markdown(rows: list[Row]) -> str:
    """The table, by ending and name."""
    lines = ["| file | verdict | as | by | also read by | note, or reason |", "|---|---|---|---|---|---|"]
    for row in rows:
        name = row.file.name
        told = row.told.replace("|", "\\|")
        lines.append(
            f"| `{name}` | {row.verdict} | {row.kind} | {row.reader} | {', '.join(row.others) or 'nobody'} | {told} |"
        )
    return "\n".join(lines)


def main() -> int:
    """Print the table and the counts; 1 if a file is read wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", type=Path, metavar="PAGE", help="put the table into this page of the documentation")
    args = parser.parse_args()
    if not args.folder.is_dir():
        parser.error(f"{args.folder} is no folder")
    files = sorted(path for path in args.folder.rglob("*") if path.is_file() and not path.name.startswith("."))
    rows = [row for file in files if (row := judged(file)) is not None]
    rows.sort(key=lambda row: (row.file.suffix, row.file.name))
    counts = Counter(row.verdict for row in rows)
    text = f"{len(rows)} files: " + ", ".join(f"{counts[v]} {v}" for v in ("read", "refused", "wrong"))
    text += f". Beside ours: {', '.join(corpus_peers.installed()) or 'no other reader is installed'}.\n"
    text = f"{text}\n{markdown(rows)}\n"
    print(text)
    if args.write is not None:
        page, mark, _ = args.write.read_text(encoding="utf-8").partition(TABLE)
        args.write.write_text(f"{page}{mark}\n{text}", encoding="utf-8")
    sys.stdout.flush()
    os._exit(1 if counts["wrong"] else 0)  # some readers leave threads behind


if __name__ == "__main__":
    main()
