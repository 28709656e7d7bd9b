# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope force files: ramps, force volumes, PeakForce captures; deflection over the way of the piezo.

The data of a force image are int16, from version 9.2 on int32: for each curve the approach and then the retraction,
both from the deepest point outwards. ``Samps/line`` counts the retraction first. Where the branches differ in length,
both are stored as long as the longer one, and what follows in the shorter one is no data. Samples of a ramp stand its
size over the points of the retraction apart; where no ramp is stated, the height sensor's channel is z. Samples that
were never taken, at the end of a branch, are 0 or the lowest integer: no data, and left out.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io import nanoscope_header as header
from .._io.nanoscope_header import Section
from .._io.words import counted, printable
from ..errors import ReadError
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/nanoscope"
SIGNATURES = header.SIGNATURES
_VERSION_32BIT = 0x09200000  # from here on integers take 4 bytes, whatever "Bytes/pixel" says of their scale
_DEFLECTION = ("DeflectionError", "Deflection")
_LEADS_UP = 5.0  # steps from the last reading to a zero that was read
_FAR = 0.125  # of a period; how far the largest deflection of a capture may lie from its turn without a note
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class _Way:
    """Of the base: one for all curves, or one for each."""

    near: int  # samples of the approach, which comes first
    z: Floats  # [m], shape (1 or curves, samples)
    time: Floats  # [s], shape (samples,)
    channel: str
    meta: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def read(file: Path, calibration: Calibration | None = None) -> list[ForceCurve]:
    """All curves with the file's own calibration; `calibration` only where the file states none."""
    found = header.sections(file)
    image = _deflection_image(file, found)
    meta, notes = _meta(found, image, calibration or Calibration())
    near, far = _points(found, image)
    raw = _raw(found, image, near, far)
    known, raw = _in_time(~_fillers(raw, near), near), _in_time(raw, near)
    deflection = raw * (_volts(image) * meta["sensitivity"])
    if _is_capture(found):
        first, way = _period(found, deflection)
        deflection, known = np.roll(deflection, -first, axis=1), np.roll(known, -first, axis=1)
    else:
        way = _ramp(found, image, near, far) or _sensor(found, near, far)
    enough = [int(n) for n in np.flatnonzero(_enough(known, way.near))]
    if never := int(np.count_nonzero(~known[enough])):
        notes += (f"{counted(never, 'sample')} that were never taken (0 or the lowest integer) left out",)
    if len(enough) < len(raw):
        notes += (f"{counted(len(raw) - len(enough), 'curve')} of {len(raw)} without data left out",)
    if len(raw) > 1 and not _is_capture(found):
        _check_single(found, image, len(raw))
        notes += _check_count(found, len(raw))
    meta |= way.meta | ({"notes": notes + way.notes} if notes + way.notes else {})
    line = _line(found, len(raw)) if len(raw) > 1 else 1
    size = header.scan_size(found)
    return [
        ForceCurve(
            _segments(way, way.z[min(n, len(way.z) - 1)], deflection[n], known[n], meta.get("spring constant")),
            meta | _place(n, line, len(raw), size),
            printable(file.name),
        )
        for n in enough
    ]


def _segments(way: _Way, z: Floats, deflection: Floats, known: Bools, stiffness: float | None) -> tuple[Segment, ...]:
    parts: tuple[tuple[Role, slice], ...] = (("approach", slice(0, way.near)), ("retract", slice(way.near, z.size)))
    found = []
    for role, part in parts:
        keep = known[part]
        bent = deflection[part][keep]
        force = None if stiffness is None else bent * stiffness
        found.append(Segment(role, way.time[part][keep], z[part][keep], way.channel, force, bent))
    return tuple(found)


# --- header -----------------------------------------------------------------------------------------------------------


def _deflection_image(file: Path, found: list[Section]) -> Section:
    listed = [one for one in found if one.name == "Ciao force image list"]
    if not listed:
        raise ReadError(f"{file}: a Bruker NanoScope file without force curves; images.read reads pictures")
    for image in listed:
        if any(f"[{kind}]" in image.channel for kind in _DEFLECTION):
            return image
    raise ReadError(f"{file}: no deflection among its channels ({', '.join(one.channel for one in listed)})")


def _volts(image: Section) -> float:
    """Of one digit of the deflection [V]."""
    name, volts, _ = image.must_be_scaled(":Z scale")
    if not volts > 0.0:
        raise ReadError(f"{image.file}: 'Z scale' of {image.channel!r} is {volts:g} V/LSB ({name}), expected above 0")
    return volts


def _meta(found: list[Section], image: Section, given: Calibration) -> tuple[dict[str, Any], tuple[str, ...]]:
    """What the header says, and what has to be told of it."""
    first, name = found[0], image.must_be_scaled(":Z scale")[0]
    known = header.sensitivity(found, name)
    if known is None and given.sensitivity is None:
        raise ReadError(f"{first.file}: {header.no_sensitivity(found, name)}; give it")
    sensitivity, note = (given.sensitivity, "") if known is None else known
    stiffness = image.spring_constant() if "spring constant" in image else given.spring_constant
    meta = {
        "format": "Bruker NanoScope",
        "sensitivity": sensitivity,
        "instrument": "Bruker NanoScope",
        "software version": first.get("version", ""),
        "date": first.get("date", ""),
        "path": first.file,
    }
    notes = (note,) if note and given.sensitivity is None else ()
    if stiffness is None:
        return meta, (*notes, "states no spring constant: deflections alone; give it for forces")
    return meta | {"spring constant": stiffness}, notes


def _is_capture(found: list[Section]) -> bool:
    scan = next((one for one in found if one.name == "Ciao scan list"), Section(found[0].file, ""))
    ramps = scan.get("operating mode", "Force") in ("Force", "Force Volume")
    return not ramps and scan.get("peakforce capture") == "Allow"


def _points(found: list[Section], image: Section) -> tuple[int, int]:
    """Of approach and retraction; in a capture both are half a period, whatever is said of the approach."""
    points = image.counts("Samps/line")
    points = points * 2 if len(points) == 1 else points
    if len(points) != 2 or min(points) == 0:
        raise ReadError(f"{image.file}: 'Samps/line' is {image.text('Samps/line')!r}, expected both directions' points")
    far, near = points
    return (far, far) if _is_capture(found) else (near, far)


def _line(found: list[Section], count: int) -> int:
    """Curves per line of a map: as its picture has them, or what the header says of its lines."""
    for one in found:
        if one.name == "Ciao image list" and {"samps/line", "number of lines"} <= set(one):
            samples, lines = one.counts("Samps/line")[0], one.counts("Number of lines")[0]
            if samples * lines == count:
                return samples
    said = [("Ciao scan list", "Samps/line"), ("Ciao force list", "force/line")]
    for name, key in said if _is_capture(found) else said[::-1]:
        line = header.section(found, name).counts(key)[0]
        if line > 1 and count % line == 0:
            return line
    return 1


def _check_single(found: list[Section], image: Section, count: int) -> None:
    """A file of one ramp has no picture of the places of its curves."""
    mode = next((one.get("operating mode", "") for one in found if one.name == "Ciao scan list"), "")
    if mode == "Force" and not any(one.name == "Ciao image list" for one in found):
        raise ReadError(
            f"{image.file}: its data are {count} curves of 'Samps/line: {image.text('Samps/line')}', but its header is "
            "that of one ramp (operating mode Force, no picture of places): 'Samps/line' or 'Data length' is wrong"
        )


def _check_count(found: list[Section], count: int) -> tuple[str, ...]:
    """Of the curves of a map, against the picture that has one point for each: more are refused, fewer are noted."""
    line = header.section(found, "Ciao force list").counts("force/line")[0]
    listed = [one for one in found if one.name == "Ciao image list" and {"samps/line", "number of lines"} <= set(one)]
    shapes = [(one.counts("Samps/line")[0], one.counts("Number of lines")[0]) for one in listed]
    places = [samples * lines for samples, lines in shapes if samples == line]
    if not places or any(samples * lines == count for samples, lines in shapes):
        return ()
    if count > max(places):
        raise ReadError(
            f"{found[0].file}: its data are {count} curves, but its picture has {max(places)} points: "
            "'Samps/line' or 'Data length' is wrong"
        )
    return (f"{count} curves of a map of {max(places)}: it was stopped",)


def _place(number: int, line: int, count: int, size: tuple[float, float] | None) -> dict[str, Any]:
    """In the map. Its size is left out where the pixels would not be square: a scan that was stopped, for one."""
    place: dict[str, Any] = {"enum": number}
    if line > 0 and count > 1 and count % line == 0:
        place |= {"grid index x": number % line, "grid index y": number // line}
        place |= {"grid shape x": line, "grid shape y": count // line}
        if size is not None and count // line == round(line * size[1] / size[0]):
            place |= {"grid size x": size[0], "grid size y": size[1]}
    return place


# --- data -------------------------------------------------------------------------------------------------------------


def _raw(found: list[Section], image: Section, near: int, far: int) -> NDArray[np.signedinteger[Any]]:
    """The integers as stored, shape (curves, approach + retraction)."""
    points, blocks = near + far, 2 * max(near, far)
    file, width = image.file, image.counts("Bytes/pixel")[0]
    if header.version(found) >= _VERSION_32BIT:
        width = 4
    if width not in (2, 4):
        raise ReadError(f"{file}: {width} bytes per value; NanoScope force files of 2 or 4 are read, export it as text")
    offset, length = image.counts("Data offset")[0], image.counts("Data length")[0]
    held = file.stat().st_size
    if offset + length > held:
        raise ReadError(f"{file}: {held} bytes long, but its data end at {offset + length}: it is cut off")
    stored = points if length % (width * points) == 0 else blocks
    if length == 0 or length % (width * stored):
        raise ReadError(f"{file}: {length} bytes of data are no whole number of curves of {points} points")
    if length // width > MAX_POINTS:
        raise ReadError(f"{file}: {length // width} points in all; up to {MAX_POINTS} are read")
    raw = np.fromfile(file, f"<i{width}", length // width, offset=offset).reshape(-1, stored)
    if stored == points:
        return raw
    return np.concatenate([raw[:, :near], raw[:, blocks // 2 : blocks // 2 + far]], axis=1)


def _in_time(stored: NDArray[Any], near: int) -> NDArray[Any]:
    """The approach is stored backwards."""
    return np.concatenate([stored[:, :near][:, ::-1], stored[:, near:]], axis=1)


def _fillers(raw: NDArray[np.signedinteger[Any]], near: int) -> Bools:
    """Samples at the ends of a branch that were never taken.

    Zeros over more than half of both branches are a free cantilever on a coarse digitiser, not fillers; nor is a single
    one beside values of about 0.
    """
    lowest, zero = raw == np.iinfo(raw.dtype).min, raw == 0
    found, runs = np.zeros(raw.shape, bool), []
    for part in (slice(0, near), slice(near, raw.shape[1])):
        filler = zero[:, part] | lowest[:, part]
        before = np.logical_and.accumulate(filler, axis=1)
        after = np.logical_and.accumulate(filler[:, ::-1], axis=1)[:, ::-1]
        found[:, part] = (before | after) & ~_read_as_zero(raw[:, part], zero[:, part], before | after)
        runs.append(after.mean(axis=1) > 0.5)
    free = runs[0] & runs[1] & ~zero.all(axis=1)
    found[free] = lowest[free]
    return found


def _read_as_zero(raw: NDArray[Any], zero: Bools, filler: Bools) -> Bools:
    """Single zeros at the end of a branch that its readings lead up to."""
    single = zero & filler
    single[:, 1:] &= ~filler[:, :-1]
    single[:, :-1] &= ~filler[:, 1:]
    steps = np.median(np.abs(np.diff(raw.astype(np.float64), axis=1)), axis=1)
    beside = np.zeros(raw.shape)
    beside[:, 0], beside[:, -1] = np.abs(raw[:, 1].astype(np.float64)), np.abs(raw[:, -2].astype(np.float64))
    return np.asarray(single & (beside <= _LEADS_UP * steps[:, None]))


def _enough(known: Bools, near: int) -> Bools:
    if len(known) == 1:
        return np.ones(1, bool)
    points = known[:, :near].sum(axis=1), known[:, near:].sum(axis=1)
    return np.asarray(np.minimum(*points) >= MIN_POINTS)


# --- the way of the base ----------------------------------------------------------------------------------------------


def _ramp(found: list[Section], image: Section, near: int, far: int) -> _Way | None:
    """In time order; None where no size is stated. Of a ramp that rests without recording, the time is NaN."""
    stated = image.scaled(":Ramp size") or image.scaled(":Z scan size")
    if stated is None:
        return None
    settings = header.section(found, "Ciao force list")
    name, _, volts = stated
    if not volts > 0.0:
        raise ReadError(f"{image.file}: a ramp of {volts:g} V in {image.name!r}, expected a positive one")
    size = volts * header.piezo(found, name)
    z = np.concatenate([np.arange(near)[::-1], np.arange(far)]) * (size / far)
    durations = [volts / settings.positive(key) for key in ("Forward vel.", "Reverse vel.")]
    time = np.concatenate([np.arange(near) * durations[0], near * durations[0] + np.arange(far) * durations[1]]) / far
    if any(float(settings.get(key, "0") or 0) for key in ("ramp delay", "reverse delay")):
        time = np.full(time.size, np.nan)
    speeds = {"speed approach": size / durations[0], "speed retract": size / durations[1]}
    return _Way(near, z[None, :], time, "height (piezo)", speeds)


def _sensor(found: list[Section], near: int, far: int) -> _Way:
    """The height sensor's channel of every curve; its deepest sample, stored first, is its lowest z."""
    image = next((one for one in found if one.name == "Ciao force image list" and "Height Sensor" in one.channel), None)
    if image is None:
        raise ReadError(f"{found[0].file}: its header lacks ':Ramp size' with a scale, and it has no height sensor")
    name, volts_per_lsb, _ = image.must_be_scaled(":Z scale")
    stored = _raw(found, image, near, far) * (volts_per_lsb * header.piezo(found, name))
    outwards = np.median(stored[:, near - 1] - stored[:, 0]) > 0
    z = _in_time(stored if outwards else -stored, near)
    return _Way(near, z - z.min(), np.full(near + far, np.nan), "height (measured)")


def _period(found: list[Section], deflection: Floats) -> tuple[int, _Way]:
    """A PeakForce capture: one period of a sine from its highest point on, and the sample at which that stands.

    ``Sync Distance`` counts the samples of the driving sine, ``Sample Points`` a period, to its deepest point.
    """
    scan, n = header.section(found, "Ciao scan list"), deflection.shape[1]
    amplitude = scan.positive("Peak Force Amplitude") * 1e-9
    frequency = scan.positive("PFT Freq") * 1e3
    name = next((k for k in ("Sync Distance QNM", "Sync Distance") if scan.get(k.lower(), "0").split()[0] != "0"), "")
    if not name:
        raise ReadError(f"{found[0].file}: its header states no 'Sync Distance', so its z is not known")
    turn = scan.positive(name) * n / scan.positive("Sample Points") % n
    first = int(np.ceil(turn - n / 2))
    steps = first + np.arange(n)
    z = -amplitude * np.cos(2 * np.pi * (steps - turn) / n)
    near = int(np.count_nonzero(steps <= turn))
    off = (int(deflection.mean(axis=0).argmax()) - turn + n / 2) % n - n / 2
    notes = () if abs(off) <= _FAR * n else (
        f"the largest deflection lies {off:+.3g} of {n} samples from the turn that {name!r} states",)  # fmt: skip
    meta = {"speed approach": 4 * amplitude * frequency, "speed retract": 4 * amplitude * frequency}
    return first % n, _Way(near, z[None, :], np.arange(n) / (n * frequency), "height (piezo)", meta, notes)
