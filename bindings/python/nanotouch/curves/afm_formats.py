# SPDX-License-Identifier: BSD-3-Clause
"""The reader of most force curve formats but JPK and NanoScope, afmformats, with segments where it marks none.

afmformats' heights ("height (measured)", "height (piezo)") already grow away from the sample, for Asylum too (it
negates ZSnsr and Raw there): they are z without a change of sign. A file where the base would rise during its
approach is refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice, pairwise
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io import text
from .._io.readers import head_of
from .._io.words import printable
from ..errors import ReadError, require
from . import hdf5
from .calibration import Calibration
from .checks import FEWEST, MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "afmformats"
_HEADER_LINES = 100  # of a Chiaro file, at most
PAUSE_TRAVEL = 0.1  # a segment over which the base moves less than this, of the whole travel, is a pause
_CHIARO = ("Time (s)", "Load (uN)", "Indentation (nm)", "Cantilever (nm)", "Piezo (nm)")
_ROWS = {".csv": ",", ".tab": "\t", ".txt": "\t"}  # what stands between the numbers of a line
_END = 4096  # of a file of rows, to see whether it is whole [byte]
_SPELLINGS = {".hdf5": ".h5"}
_Z_CHANNELS = ("height (measured)", "height (piezo)")  # a sensor before a voltage times a constant


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """All curves with the file's own calibration; `calibration` only where the file states none."""
    if hdf5.recognises(file, head_of(file)):
        with hdf5.opened(file) as found:
            return [_converted(data, file, number) for number, data in enumerate(found)]
    known = sorted(require("afmformats", "curves").formats.supported_extensions)
    ending = _SPELLINGS.get(file.suffix.lower(), file.suffix.lower())
    if ending not in known:
        raise ReadError(f"{file}: not a force curve file that afmformats reads ({', '.join(known)}){_other(file)}")
    if ending in _ROWS:
        _refuse_cut(file, _ROWS[ending])
    with _under(file, ending) as link:
        return [_converted(data, file, number) for number, data in enumerate(_loaded(file, link, calibration))]


def _refuse_cut(file: Path, separator: str) -> None:
    """A last line that lacks digits is read by afmformats as another number."""
    with file.open("rb") as stream:
        stream.seek(max(0, file.stat().st_size - _END))
        rows = stream.read().decode("latin-1").replace(separator, ";")
    if text.ends_cut(rows):
        raise ReadError(f"{file}: its last line is cut off: {rows.splitlines()[-1].replace(';', separator)!r}")


@contextmanager
def _under(file: Path, ending: str) -> Iterator[Path]:
    """A name for the file with this ending: afmformats knows small letters alone."""
    if file.suffix == ending:
        yield file
        return
    with TemporaryDirectory() as folder:
        link = Path(folder) / (file.stem + ending)
        try:
            link.symlink_to(file.resolve())
        except OSError:  # Windows lets not everybody make links
            copyfile(file, link)
        yield link


def _loaded(file: Path, link: Path, calibration: Calibration) -> list[Any]:
    afmformats = require("afmformats", "curves")
    given = calibration.given
    try:
        return list(afmformats.load_data(link))
    except (afmformats.errors.FileFormatNotSupportedError, UnicodeDecodeError):
        raise ReadError(f"{file}: its content is not that of a {file.suffix} force curve file") from None
    except afmformats.errors.MissingMetaDataError as error:
        missing = [key for key in error.meta_keys if given.get(key) is None]
        if missing:
            raise ReadError(f"{file}: states no {' and no '.join(missing)}; give it") from None
        return list(afmformats.load_data(link, meta_override={key: given[key] for key in error.meta_keys}))


def _other(file: Path) -> str:
    return ", but of thermal spectra: curves.thermal_spectrum reads it" if file.suffix.lower() == ".tnd" else ""


def _converted(data: Any, file: Path, number: int) -> ForceCurve:
    meta = dict(data.metadata.items()) | {"enum": number}  # counted from 0
    channels: tuple[str, ...] = _Z_CHANNELS
    if str(meta.get("format", "")).startswith("Optics11"):
        _check_chiaro(file)
        meta, channels = _in_si(meta) | _tip(file), _Z_CHANNELS[1:]  # what afmformats calls measured is the indentation
    z_channel = next((c for c in channels if c in data.columns), None)
    if z_channel is None or "force" not in data.columns:
        raise ReadError(f"{file}: curve {data.enum} lacks a height or a force; it has {', '.join(data.columns)}")
    z, force = np.asarray(data[z_channel], np.float64), np.asarray(data["force"], np.float64)
    if z.ndim != 1 or z.shape != force.shape or not FEWEST <= z.size <= MAX_POINTS:
        raise ReadError(f"{file}: curve {data.enum} has {z.size} heights and {force.size} forces")
    # Without a time column none is invented: the sampling rates in the headers do not always hold (Asylum's do not).
    time = np.asarray(data["time"], np.float64) if "time" in data.columns else np.full(z.size, np.nan)
    segments = tuple(Segment(role, time[part], z[part], z_channel, force[part]) for role, part in _parts(data, z))
    return ForceCurve(segments, meta, printable(file.name))


def _in_si(meta: dict[str, Any]) -> dict[str, Any]:
    """Chiaro states µN and µm/s, which afmformats hands on as they are."""
    micro = ("setpoint", "speed approach", "speed retract")
    return meta | {key: 1e-6 * meta[key] for key in micro if isinstance(meta.get(key), float)}


def _check_chiaro(file: Path) -> None:
    """afmformats takes the columns by their order, whatever their names and units."""
    with file.open(encoding="latin-1") as lines:
        head = next((line for line in islice(lines, _HEADER_LINES) if line.startswith("Time (s)\tLoad")), "")
    stated = tuple(name.strip() for name in head.split("\t"))[: len(_CHIARO)]
    for name, expected in zip(stated, _CHIARO, strict=False):
        if name.replace("\xb5", "u") != expected:
            raise ReadError(f"{file}: a column {name!r} of a Chiaro file, expected {expected!r}")


def _tip(file: Path) -> dict[str, float]:
    """The radius that a Chiaro file states [m], which afmformats leaves out."""
    with file.open(encoding="latin-1") as lines:
        for line in islice(lines, _HEADER_LINES):
            name, _, text = line.partition("\t")
            if name.strip() != "Tip radius (um)":
                continue
            try:
                radius = 1e-6 * float(text)
            except ValueError:
                return {}
            return {"tip radius": radius} if 0.0 < radius < 1.0 else {}
    return {}


def _parts(data: Any, z: NDArray[np.float64]) -> list[tuple[Role, slice]]:
    """The segments as (role, run of points): as marked in the file, or cut at the deepest point where it marks one."""
    marks = np.asarray(data["segment"]).astype(int) if "segment" in data.columns else np.zeros(z.size, int)
    edges = [0, *(np.flatnonzero(np.diff(marks)) + 1).tolist(), z.size]
    runs = [slice(a, b) for a, b in pairwise(edges)]
    return _cut_at_deepest(z) if len(runs) == 1 else list(zip(_roles(runs, z), runs, strict=True))


def _roles(runs: list[slice], z: NDArray[np.float64]) -> list[Role]:
    """afmformats numbers the runs but does not say what they are. Those that hardly move are pauses; of the others the
    first is the approach and the last the retraction, by order, so that a reversed sign of z is noticed."""
    rises = [float(z[run][-1] - z[run][0]) for run in runs]
    moving = [i for i, rise in enumerate(rises) if abs(rise) > PAUSE_TRAVEL * float(np.ptp(z))]
    roles: list[Role] = ["pause"] * len(runs)
    for i in moving:
        roles[i] = "approach" if rises[i] < 0.0 else "retract"
    if len(moving) > 1:
        roles[moving[0]], roles[moving[-1]] = "approach", "retract"
    elif moving:
        roles[moving[0]] = "approach" if moving[0] == 0 else "retract"
    return roles


def _cut_at_deepest(z: NDArray[np.float64]) -> list[tuple[Role, slice]]:
    """Cut a run that goes in and out at its lowest z; a run without a turn is one segment."""
    deepest = int(np.argmin(z)) + 1
    if deepest < MIN_POINTS:
        return [("retract", slice(0, z.size))]
    if z.size - deepest < MIN_POINTS:
        return [("approach", slice(0, z.size))]
    return [("approach", slice(0, deepest)), ("retract", slice(deepest, z.size))]
