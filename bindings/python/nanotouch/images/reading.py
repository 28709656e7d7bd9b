# SPDX-License-Identifier: BSD-3-Clause
"""Read AFM images through SurfaceTopography, check that what they say is plausible, and turn them our way up.

SurfaceTopography returns ``heights[x, y]`` with y counted from the top of the picture (shown right by
``imshow(heights.T)``, as Gwyddion shows the file); ours is ``heights[y, x]`` with y counted from the bottom, hence
``heights.T[::-1]``. Two kinds of file differ, see :func:`_upright`.
"""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._files import checked_path, guarded
from ..errors import InvalidValue, ReadError, require
from .topography import Topography

#: What is believed of an AFM image; anything else is a damaged header or a wrong unit, and refused.
SIDE_RANGE = (1e-9, 1e-3)  # scan size [m]
HEIGHT_RANGE = (1e-12, 1e-4)  # highest minus lowest [m]; also never more than the longer side
PIXELS_PER_SIDE = (4, 16384)
MAX_PIXELS = 1 << 26  # 512 MiB of doubles
MAX_MISSING = 0.01  # fraction of pixels that may be filled from their neighbours

_LENGTHS = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "Å": 1e-10, "A": 1e-10, "pm": 1e-12,
}  # fmt: skip
#: Names of height channels, best first: a calibrated sensor before the voltage of a piezo.
_HEIGHT_NAMES = ("zsensor", "z sensor", "measured", "z height", "height", "topography", "z-axis", "zaxis")
_OTHER_NAMES = ("amplitude", "phase", "error", "deflection", "friction", "lateral", "potential", "current")
_BACKWARD_NAMES = ("retrace", "backward", "reverse")
#: Readers that recognise nothing in a file and take any bytes of a fitting number for an image (elevation maps, NMS).
_CREDULOUS = ("hgt", "nms")


@dataclass(frozen=True)
class Channel:
    """One channel of an image file.

    Attributes
    ----------
    name : str
        Unique in its file: repeated names are numbered, ``"Friction#2"``.
    shape : tuple of int or None
        ``(ny, nx)`` [pixel]; None where the file tells only with the data.
    size : tuple of float or None
        Scan size ``(Ly, Lx)`` [m]; None where the file states none, or no unit.
    unit : str or None
        Unit the values are stored in; None where the file states none.
    kind : str
        What it holds: ``"height"``, ``"phase"``, ``"deflection"``, ...
    default : bool
        True for the channel that :func:`read` takes when it is not told.
    """

    name: str
    shape: tuple[int, int] | None
    size: tuple[float, float] | None
    unit: str | None
    kind: str
    default: bool


def channels(path: str | PathLike[str]) -> list[Channel]:
    """List the two-dimensional channels of an image file.

    Raises
    ------
    ReadError
        If it is not an AFM image.
    """
    file = checked_path(path)
    with _opened(file) as reader, guarded(file, "SurfaceTopography"):
        found = _images_in(reader, file)
        default = _default_channel(found)
        return [_described(info, info is default) for info in found]


def read(
    path: str | PathLike[str],
    channel: str | None = None,
    *,
    pixel_size: float | tuple[float, float] | None = None,
    z_unit: str | None = None,
) -> Topography:
    """Read one channel of an AFM image, in any format SurfaceTopography reads, chosen by content.

    Parameters
    ----------
    path : str or path
        The image file.
    channel : str, optional
        Name as :func:`channels` lists it (case does not matter). Without it the height channel is taken: a measured
        height before a piezo voltage, trace before retrace.
    pixel_size : float or (float, float), optional
        ``(dy, dx)`` [m], 1e-12 .. 1e-3, in place of what the file states, or for files that state nothing.
    z_unit : str, optional
        Unit of the heights (``"m"``, ``"mm"``, ``"um"``, ``"nm"``, ``"A"``, ``"pm"``) for files that state none.

    Returns
    -------
    Topography
        Heights (ny, nx) [m]. Up to 1 % missing pixels are filled from their neighbours and masked.

    Raises
    ------
    ReadError
        If the file is missing, empty, damaged, not an image, has no height channel, has more than 1 % missing pixels,
        states no unit, or if its size or height is not that of an AFM image.
    InvalidValue
        If `pixel_size` or `z_unit` is not valid.
    """
    file = checked_path(path)
    stated_pixel = _checked_pixel_size(pixel_size)
    if z_unit is not None and z_unit not in _LENGTHS:
        raise InvalidValue(f"z_unit: {z_unit!r}, expected one of {', '.join(_LENGTHS)}")
    with _opened(file) as reader, guarded(file, "SurfaceTopography"):
        info = _chosen(_images_in(reader, file), channel, file)
        _check_shape(file, info.nb_grid_pts)
        sizes = None
        if info.physical_sizes is None:
            if stated_pixel is None:
                raise ReadError(f"{file}: channel {info.channel_id!r} states no scan size; give the pixel size")
            sizes = tuple(n * d for n, d in zip(info.nb_grid_pts, stated_pixel[::-1], strict=True))
        loaded = info.topography(physical_sizes=sizes)
        lateral, vertical = _units(loaded.unit if loaded.unit is not None else info.unit)
        values = _upright(np.ma.filled(np.ma.asarray(loaded.heights(), dtype=np.float64), np.nan), reader.format())
        lx, ly = (float(s) for s in loaded.physical_sizes)
        name, format_ = str(info.channel_id), str(reader.format())
    if stated_pixel is None:
        scale = _length_of(lateral, file, f"the lateral unit of channel {name!r}", "give the pixel size")
        stated_pixel = (ly * scale / values.shape[0], lx * scale / values.shape[1])
    values *= _height_scale(vertical, z_unit, file, name)
    heights, mask = _filled(values, file)
    topography = Topography(heights, stated_pixel, file.name, name, f"SurfaceTopography/{format_}", mask)
    _check_scale(topography, file)
    return topography


def _opened(file: Path) -> Any:
    with guarded(file, "SurfaceTopography"):
        io: ModuleType = require("SurfaceTopography.IO", "images")
        try:
            reader = io.open_topography(str(file))
        except io.CannotDetectFileFormat:
            reader = None
        if reader is None or reader.format() in _CREDULOUS:
            raise ReadError(f"{file}: not an AFM image in any format that SurfaceTopography recognises by content")
        return reader


def _images_in(reader: Any, file: Path) -> list[Any]:
    found = [info for info in reader.channels if info.dim == 2]
    if not found:
        raise ReadError(f"{file}: holds no image (no two-dimensional channel)")
    return found


def _chosen(found: list[Any], channel: str | None, file: Path) -> Any:
    names = ", ".join(str(info.channel_id) for info in found)
    if channel is None:
        default = _default_channel(found)
        if default is None:
            raise ReadError(f"{file}: no height channel; it holds {names}")
        return default
    wanted = channel.casefold()
    matches = [i for i in found if str(i.channel_id).casefold() == wanted]
    if len(matches) != 1:
        raise ReadError(f"{file}: no channel {channel!r}; it holds {names}")
    return matches[0]


def _default_channel(found: list[Any]) -> Any | None:
    """The height channel: by name if a name tells, else the only or first one of a length that no name excludes."""

    def rank(info: Any) -> tuple[int, bool]:
        name = str(info.name).casefold()
        known = [i for i, part in enumerate(_HEIGHT_NAMES) if part in name]
        return (known[0] if known else len(_HEIGHT_NAMES), any(part in name for part in _BACKWARD_NAMES))

    return min((info for info in found if _kind(info) == "height"), key=rank, default=None)


def _kind(info: Any) -> str:
    """What a channel holds; SurfaceTopography calls a height what has no unit, or the unit of an amplitude."""
    kind = str(info.data_kind.value)
    name = str(info.name).casefold()
    return next((part for part in _OTHER_NAMES if part in name), kind) if kind == "height" else kind


def _described(info: Any, default: bool) -> Channel:
    lateral, vertical = _units(info.unit)
    if not info.is_height_channel:
        vertical = info.data_unit
    size = None
    if info.physical_sizes is not None and lateral in _LENGTHS:
        lx, ly = (float(s) * _LENGTHS[lateral] for s in info.physical_sizes)
        size = (ly, lx)
    shape = None if info.nb_grid_pts is None else (info.nb_grid_pts[1], info.nb_grid_pts[0])
    return Channel(str(info.channel_id), shape, size, vertical, _kind(info), default)


def _units(unit: Any) -> tuple[str | None, str | None]:
    """SurfaceTopography's unit as (lateral, vertical): one string for both, or a pair."""
    return (unit[0], unit[1]) if isinstance(unit, tuple) else (unit, unit)


def _upright(values: NDArray[np.float64], format_: str) -> NDArray[np.float64]:
    """SurfaceTopography's array as a writable ``[y, x]`` with row 0 at the bottom.

    Bare arrays (numpy, HDF5) have no stated axes: they are taken as pictures, ``[row, column]`` from the top, where
    SurfaceTopography takes ``[x, y]``. Point lists (xyz) carry their own y, which rises upwards already.
    """
    if format_ in ("npy", "npz", "h5"):
        return np.array(values[::-1], order="C")
    if format_ == "xyz":
        return np.array(values.T, order="C")
    return np.array(values.T[::-1], order="C")


def _length_of(unit: str | None, file: Path, what: str, remedy: str) -> float:
    if unit is None:
        raise ReadError(f"{file}: {what} is not stated; {remedy}")
    if unit not in _LENGTHS:
        raise ReadError(f"{file}: {what} is {unit!r}, not a length; {remedy}")
    return _LENGTHS[unit]


def _height_scale(stated: str | None, given: str | None, file: Path, name: str) -> float:
    """Metres per stored height. A unit given against a stated one is refused, as one of the two must be wrong."""
    if given is None:
        return _length_of(stated, file, f"the height unit of channel {name!r}", "give the height unit (z unit)")
    if stated is not None and _LENGTHS.get(stated) != _LENGTHS[given]:
        raise ReadError(f"{file}: states {stated!r} for channel {name!r}, which contradicts the z unit {given!r} given")
    return _LENGTHS[given]


def _filled(values: NDArray[np.float64], file: Path) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Fill missing (not finite) pixels by the mean of their known neighbours, from the rim of each hole inwards."""
    missing = ~np.isfinite(values)
    count = int(np.count_nonzero(missing))
    if count > MAX_MISSING * values.size:
        raise ReadError(
            f"{file}: {100 * count / values.size:.3g} % of the pixels are missing (NaN); up to "
            f"{100 * MAX_MISSING:g} % are filled from their neighbours, crop the image instead"
        )
    if count:
        cv2 = require("cv2", "images")
        todo = missing.copy()
        values[todo] = 0.0  # OpenCV hides NaN, so none may reach it
        while todo.any():
            known = (~todo).astype(np.float64)
            border = cv2.BORDER_CONSTANT
            weight = cv2.boxFilter(known, -1, (3, 3), normalize=False, borderType=border)
            total = cv2.boxFilter(values * known, -1, (3, 3), normalize=False, borderType=border)
            rim = todo & (weight > 0.5)
            values[rim] = total[rim] / weight[rim]
            todo &= ~rim
    return values, missing


def _checked_pixel_size(pixel_size: float | tuple[float, float] | None) -> tuple[float, float] | None:
    if pixel_size is None:
        return None
    pair = np.atleast_1d(np.asarray(pixel_size, dtype=np.float64))
    if pair.shape not in ((1,), (2,)) or not ((pair >= 1e-12) & (pair <= 1e-3)).all():
        raise InvalidValue(f"pixel_size: {pixel_size!r} m, expected one or two lengths of 1e-12 .. 1e-3 m")
    return float(pair[0]), float(pair[-1])


def _check_shape(file: Path, shape: tuple[int, ...]) -> None:
    low, high = PIXELS_PER_SIDE
    if not (all(low <= n <= high for n in shape) and np.prod(shape, dtype=np.int64) <= MAX_PIXELS):
        raise ReadError(
            f"{file}: {shape[0]} x {shape[-1]} pixels; images of {low} .. {high} pixels per side and up to "
            f"{MAX_PIXELS >> 20} million in all are read"
        )


def _check_scale(topography: Topography, file: Path) -> None:
    for side, length in zip("yx", topography.size, strict=True):
        if not SIDE_RANGE[0] <= length <= SIDE_RANGE[1]:
            raise ReadError(
                f"{file}: a scan of {length:.3g} m along {side}; an AFM image measures {SIDE_RANGE[0]:g} .. "
                f"{SIDE_RANGE[1]:g} m (damaged header or wrong unit?)"
            )
    height, limit = topography.height_range, min(HEIGHT_RANGE[1], max(topography.size))
    if not HEIGHT_RANGE[0] <= height <= limit:
        raise ReadError(
            f"{file}: heights over a range of {height:.3g} m in channel {topography.channel!r}; expected "
            f"{HEIGHT_RANGE[0]:g} .. {limit:.3g} m (damaged data or wrong unit?)"
        )
