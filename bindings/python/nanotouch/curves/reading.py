# SPDX-License-Identifier: BSD-3-Clause
"""Read force curves through afmformats, with segments where it marks none, and calibration that can be corrected;
Bruker's NanoScope files through :mod:`.nanoscope`.

afmformats' heights ("height (measured)", "height (piezo)") already grow away from the sample, for Asylum (it negates
ZSnsr and Raw there) as for JPK: they are z without a change of sign. :func:`_check_direction` refuses a file where
the base would rise during its approach.
"""

from __future__ import annotations

import logging
import sys
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._files import checked_path, guarded
from ..errors import InvalidValue, ReadError, require
from . import nanoscope
from .curve import ForceCurve, Role, Segment

#: What is believed of a force curve; anything else is a damaged header or a wrong unit, and refused.
Z_RANGE = (1e-10, 1e-3)  # travel of the base [m]
FORCE_LIMIT = 1e-2  # [N]
SPRING_CONSTANT_RANGE = (1e-4, 1e4)  # [N/m]
SENSITIVITY_RANGE = (1e-10, 1e-4)  # [m/V]
MIN_POINTS = 16  # per segment that is analysed
MAX_UNPACKED = 1 << 31  # of a zip container [byte]

_Z_CHANNELS = ("height (measured)", "height (piezo)")  # a sensor before a voltage times a constant
_PLACEHOLDERS = (0.999, 1.0)  # spring constants that instruments write where nobody calibrated [N/m]


def read(
    path: str | PathLike[str], *, spring_constant: float | None = None, sensitivity: float | None = None
) -> list[ForceCurve]:
    """Read every curve of a file in a format that afmformats reads, or of a Bruker NanoScope force file.

    Parameters
    ----------
    path : str or path
        JPK ``.jpk-force``, ``.jpk-force-map``, ``.jpk-qi-data``, ``.jpk-qi-series``; Asylum ``.ibw``; NT-MDT and
        Optics11 ``.txt``; AFM Workshop ``.csv``, ``.zip``; afmformats ``.h5``, ``.tab``. NanoScope ramps and force
        volumes (``.000``, ``.spm``, any name; known by how they begin).
    spring_constant : float, optional
        k_c [N/m], 1e-4 .. 1e4, in place of the file's; forces are rescaled, deflections stay.
    sensitivity : float, optional
        Deflection sensitivity [m/V], 1e-10 .. 1e-4, in place of the file's; forces and deflections are rescaled.

    Returns
    -------
    list of ForceCurve
        In the order of the file; a map is one list. ``meta["placeholders"]`` names what the file states without
        anybody having measured it (a spring constant of exactly 1 N/m, Bruker's 0.999 N/m).

    Raises
    ------
    ReadError
        If the file is missing, empty, damaged, of another kind, lacks a calibration that was not given, or holds
        implausible values.
    InvalidValue
        If `spring_constant` or `sensitivity` is out of range.
    """
    given = {"spring constant": spring_constant, "sensitivity": sensitivity}
    _check_range("spring_constant", spring_constant, SPRING_CONSTANT_RANGE, "N/m")
    _check_range("sensitivity", sensitivity, SENSITIVITY_RANGE, "m/V")
    file = checked_path(path)
    _refuse_hopeless(file)
    if _is_nanoscope(file):
        with guarded(file, "nanoscope"):
            return [_from_ramp(ramp, given, file) for ramp in nanoscope.load(file)]
    with guarded(file, "afmformats"), _quiet_and_closed(file):
        curves = [_converted(data, given, file) for data in _loaded(file, given)]
    if not curves:
        raise ReadError(f"{file}: holds no force curve")
    return curves


def _check_range(name: str, value: float | None, valid: tuple[float, float], unit: str) -> None:
    if value is not None and not valid[0] <= value <= valid[1]:
        raise InvalidValue(f"{name}: {value!r} {unit}, expected {valid[0]:g} .. {valid[1]:g} {unit}")


def _is_nanoscope(file: Path) -> bool:
    with file.open("rb") as stream:
        return stream.read(32).startswith(nanoscope.SIGNATURES)


def _refuse_hopeless(file: Path) -> None:
    with file.open("rb") as stream:
        start = stream.read(4)
    if start.startswith(b"PK\3\4"):
        with guarded(file, "zipfile"), zipfile.ZipFile(file) as archive:
            unpacked = sum(item.file_size for item in archive.infolist())
        if unpacked > MAX_UNPACKED:
            raise ReadError(f"{file}: unpacks to {unpacked / 2**20:.0f} MiB; up to {MAX_UNPACKED >> 20} MiB are read")


def _loaded(file: Path, given: Mapping[str, float | None]) -> list[Any]:
    afmformats = require("afmformats", "curves")
    known = sorted(afmformats.formats.supported_extensions)
    if file.suffix not in known:
        raise ReadError(f"{file}: not a force curve file that afmformats reads ({', '.join(known)})")
    try:
        return list(afmformats.load_data(file))
    except afmformats.errors.FileFormatNotSupportedError:
        raise ReadError(f"{file}: its content is not that of a {file.suffix} force curve file") from None
    except afmformats.errors.MissingMetaDataError as error:
        missing = [key for key in error.meta_keys if given.get(key) is None]
        if missing:
            raise ReadError(f"{file}: states no {' and no '.join(missing)}; give it") from None
        return list(afmformats.load_data(file, meta_override={key: given[key] for key in error.meta_keys}))


@contextmanager
def _quiet_and_closed(file: Path) -> Iterator[None]:
    """Around afmformats: it logs the traceback of whatever it raises, and keeps JPK archives open by their path, so
    that a file replaced under the same name would be read with the old contents."""
    logger = logging.getLogger("afmformats.formats")
    was_disabled, logger.disabled = logger.disabled, True
    try:
        yield
    finally:
        logger.disabled = was_disabled
        jpk = sys.modules.get("afmformats.formats.fmt_jpk.jpk_reader")
        archive = None if jpk is None else jpk.ArchiveCache.open_archives.pop(file, None)
        if archive is not None:
            archive.close()


def _converted(data: Any, given: Mapping[str, float | None], file: Path) -> ForceCurve:
    meta = dict(data.metadata.items())
    z_channel = next((c for c in _Z_CHANNELS if c in data.columns), None)
    if z_channel is None or "force" not in data.columns:
        raise ReadError(f"{file}: curve {data.enum} lacks a height or a force; it has {', '.join(data.columns)}")
    columns = {"z": np.asarray(data[z_channel], np.float64), "force": np.asarray(data["force"], np.float64)}
    columns["force"] = columns["force"] * _corrected_scale(meta, given, file)
    # Without a time column none is invented: the sampling rates in the headers do not always hold (Asylum's do not).
    has_time = "time" in data.columns
    columns["time"] = np.asarray(data["time"], np.float64) if has_time else np.full(columns["z"].size, np.nan)
    _check_values(columns, file, data.enum)
    return _assembled(columns, _parts(data, columns["z"]), z_channel, meta, file)


def _from_ramp(ramp: nanoscope.Ramp, given: Mapping[str, float | None], file: Path) -> ForceCurve:
    meta = dict(ramp.meta)
    per_volt = meta["spring constant"] * meta["sensitivity"]
    columns = {"z": ramp.z, "time": ramp.time, "force": ramp.volts * per_volt * _corrected_scale(meta, given, file)}
    low, high = SENSITIVITY_RANGE
    if not low <= meta["sensitivity"] <= high:
        raise ReadError(f"{file}: sensitivity {meta['sensitivity']:g} m/V, expected {low:g} .. {high:g} m/V; give it")
    _check_values(columns, file, meta["enum"])
    parts: list[tuple[Role, slice]] = [
        ("approach", slice(0, ramp.approach)),
        ("retract", slice(ramp.approach, ramp.z.size)),
    ]
    return _assembled(columns, parts, _Z_CHANNELS[1], meta, file)


def _assembled(
    columns: dict[str, NDArray[np.float64]],
    parts: list[tuple[Role, slice]],
    z_channel: str,
    meta: dict[str, Any],
    file: Path,
) -> ForceCurve:
    stiffness = meta.get("spring constant")
    if stiffness is not None:
        columns["deflection"] = columns["force"] / stiffness
    segments = tuple(
        Segment(role, z_channel=z_channel, **{key: column[part] for key, column in columns.items()})
        for role, part in parts
    )
    _check_direction(segments, file, meta.get("enum", 0))
    return ForceCurve(segments, meta, file.name)


def _corrected_scale(meta: dict[str, Any], given: Mapping[str, float | None], file: Path) -> float:
    """Factor on the stored force for a corrected calibration (force = k_c x sensitivity x volts); updates `meta`."""
    scale = 1.0
    if given["spring constant"] is None and meta.get("spring constant") in _PLACEHOLDERS:
        meta["placeholders"] = ("spring constant",)
    for key, value in given.items():
        if value is None:
            continue
        if meta.get(key) is None and key == "sensitivity":
            raise ReadError(f"{file}: states no {key}, so its forces cannot be corrected for it")
        if meta.get(key):
            scale *= value / meta[key]
        meta[key] = value
    stiffness = meta.get("spring constant")
    low, high = SPRING_CONSTANT_RANGE
    if stiffness is not None and not low <= stiffness <= high:
        raise ReadError(f"{file}: spring constant {stiffness:g} N/m, expected {low:g} .. {high:g} N/m; give it")
    return scale


def _check_values(columns: Mapping[str, NDArray[np.float64]], file: Path, number: int) -> None:
    for key in ("z", "force"):
        bad = int(np.count_nonzero(~np.isfinite(columns[key])))
        if bad:
            raise ReadError(f"{file}: curve {number}: {bad} of {columns[key].size} values of {key} are not finite")
    if columns["z"].size < MIN_POINTS:
        raise ReadError(f"{file}: curve {number} has {columns['z'].size} points, expected at least {MIN_POINTS}")
    travel, force = float(np.ptp(columns["z"])), float(np.abs(columns["force"]).max())
    if not Z_RANGE[0] <= travel <= Z_RANGE[1]:
        raise ReadError(
            f"{file}: curve {number}: the base travels {travel:.3g} m, expected {Z_RANGE[0]:g} .. {Z_RANGE[1]:g} m"
        )
    if not force <= FORCE_LIMIT:
        raise ReadError(f"{file}: curve {number}: force of {force:.3g} N, expected up to {FORCE_LIMIT:g} N")


def _parts(data: Any, z: NDArray[np.float64]) -> list[tuple[Role, slice]]:
    """The segments as (role, run of points): as marked in the file, or cut at the deepest point where it marks one.

    afmformats numbers them from 0: the first is the approach, the last the retraction, those between are pauses.
    """
    marks = np.asarray(data["segment"]).astype(int) if "segment" in data.columns else np.zeros(z.size, int)
    edges = [0, *(np.flatnonzero(np.diff(marks)) + 1).tolist(), z.size]
    runs = [slice(a, b) for a, b in pairwise(edges)]
    if len(runs) == 1:
        return _cut_at_deepest(z)
    roles: list[Role] = ["approach", *["pause"] * (len(runs) - 2), "retract"]  # type: ignore[list-item]
    return list(zip(roles, runs, strict=True))


def _cut_at_deepest(z: NDArray[np.float64]) -> list[tuple[Role, slice]]:
    """Cut a run that goes in and out at its lowest z; a run without a turn is one segment."""
    deepest = int(np.argmin(z)) + 1
    if deepest < MIN_POINTS:
        return [("retract", slice(0, z.size))]
    if z.size - deepest < MIN_POINTS:
        return [("approach", slice(0, z.size))]
    return [("approach", slice(0, deepest)), ("retract", slice(deepest, z.size))]


def _check_direction(segments: tuple[Segment, ...], file: Path, number: int) -> None:
    for segment in segments:
        rise = segment.z[-1] - segment.z[0]
        if (segment.role == "approach" and rise > 0) or (segment.role == "retract" and rise < 0):
            raise ReadError(
                f"{file}: curve {number}: the base moves {rise:+.3g} m during the {segment.role} "
                "(z away from the sample): the sign of its height is reversed"
            )
