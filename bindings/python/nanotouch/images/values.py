# SPDX-License-Identifier: BSD-3-Clause
"""What a sample is made of: modulus or adhesion at each pixel, from a channel of an image or a fitted map.

The unit is the file's, and has to be one of the quantity. Pixels without a value (not finite, not above 0, masked, not
determined by their curve) are refused, or filled by the mean of the logarithms around them or by the median.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from .. import guard
from .._arrays import Floats
from .._io import worker
from .._io.digest import file_digest
from .._io.files import checked_path, guarded
from .._io.words import printable
from ..errors import InvalidValue, ReadError, require
from ..units import UNITS
from .channel import Plane
from .checks import MAX_MISSING, PIXELS_PER_SIDE, check_shape
from .filling import fill
from .reading import checked_pixel_size, reader_of
from .topography import Topography

Quantity = Literal["youngs_modulus", "effective_modulus", "work_of_adhesion", "pull_off_force"]
Fill = Literal["neighbours", "median"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
#: of a fitted map whose w is no number that a surface can carry, over the largest
LEAST_SHARE = 1e-3
SIZES_AGREE = 0.02
"""scan sizes of heights and values, relative; beyond it they are not of one place"""


class _Valid(NamedTuple):
    unit: str
    low: float
    high: float
    factors: dict[str, float]


_ENERGY = UNITS["J/m^2"] | UNITS["N/m"]
_KNOWN: dict[Quantity, _Valid] = {
    "youngs_modulus": _Valid("Pa", 1e2, 1e13, UNITS["Pa"]),
    "effective_modulus": _Valid("Pa", 1e2, 1e13, UNITS["Pa"]),
    "work_of_adhesion": _Valid("J/m^2", 0.0, 10.0, _ENERGY),
    "pull_off_force": _Valid("N", 0.0, 1e-3, UNITS["N"]),
}


@dataclass(frozen=True, eq=False)
class ValueMap:
    """One quantity over a rectangle, in SI, above 0 everywhere.

    Attributes
    ----------
    quantity : str
        ``"youngs_modulus"`` [Pa], ``"effective_modulus"`` [Pa], ``"work_of_adhesion"`` [J/m^2], ``"pull_off_force"``
        [N].
    values : ndarray, shape (ny, nx)
        Row 0 is the lower edge, as of a Topography.
    pixel_size : (float, float)
        ``(dy, dx)`` [m].
    name, channel, source, digest : str
        File, channel, reader, and SHA-256 of the file.
    mask : ndarray, shape (ny, nx), bool
        True where it was filled.
    notes : tuple of str
        What reading did.
    """

    quantity: Quantity
    values: Floats
    pixel_size: tuple[float, float]
    name: str = ""
    channel: str = ""
    source: str = ""
    digest: str = ""
    mask: NDArray[np.bool_] = field(default_factory=lambda: np.zeros((0, 0), bool))
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> tuple[float, float]:
        """Scan size ``(Ly, Lx)`` [m]."""
        return self.values.shape[0] * self.pixel_size[0], self.values.shape[1] * self.pixel_size[1]

    def on(self, topography: Topography) -> Floats:
        """The values at the pixels of these heights, which have to be of the same place.

        Between pixels the logarithm goes linearly; where the heights' pixels are wider, it is averaged over one of
        theirs. No value leaves the range of its neighbours.
        """
        for axis, mine, theirs in zip("yx", self.size, topography.size, strict=True):
            if abs(mine - theirs) > SIZES_AGREE * theirs:
                raise InvalidValue(
                    f"{self.quantity}: {self.name} measures {mine * 1e6:.4g} um along {axis}, the heights "
                    f"{theirs * 1e6:.4g} um: they are not of one place (up to {100 * SIZES_AGREE:g} % are let pass)"
                )
        if self.values.shape == topography.shape:
            return self.values
        logs = np.log(self.values)
        down, across = (
            _weights(ours, its)
            for ours, its in zip(topography.shape, self.values.shape, strict=True)
        )  # fmt: skip
        return np.asarray(np.exp((across @ (down @ logs).T).T))


def read_values(
    path: str | PathLike[str],
    channel: str,
    quantity: Quantity,
    *,
    unit: str | None = None,
    pixel_size: float | tuple[float, float] | None = None,
    fill_by: Fill | None = None,
    untrusted: bool | None = None,
) -> ValueMap:
    """Read a quantity of each pixel from a channel of an image, or from a variable of a map.nc (`nanotouch map`).

    Parameters
    ----------
    path : str or path
        The file.
    channel : str
        Its name, whatever its case (``nanotouch info`` lists them).
    quantity : str
        What it is: see :class:`ValueMap`.
    unit : str, optional
        For a file that states none, as ``"GPa"``. Against a stated one it is refused.
    pixel_size : float or (float, float), optional
        ``(dy, dx)`` [m] in place of what the file states.
    fill_by : {"neighbours", "median"}, optional
        What pixels without a value get; without it they are refused.
    untrusted : bool, optional
        Open it in a guarded worker process, see :func:`nanotouch.images.read`.
    """
    if quantity not in QUANTITIES:
        raise InvalidValue(f"quantity {quantity!r}: valid are {', '.join(QUANTITIES)}")
    if fill_by is not None and fill_by not in get_args(Fill):
        raise InvalidValue(f"fill_by {fill_by!r}: valid are {', '.join(get_args(Fill))}")
    file = checked_path(path)
    given = checked_pixel_size(pixel_size)
    plane = (
        worker.ask("images.plane", file, {"channel": channel}, Plane)
        if guard.wanted(untrusted)
        else plane_of(file, channel)
    )
    with guarded(file, plane.source):
        return _checked(plane, file, quantity, unit, given, fill_by)


def plane_of(file: Path, channel: str) -> Plane:
    """As the reader of the file hands it over."""
    if file.suffix.lower() == ".nc":
        return _of_map(file, channel)
    name, reader = reader_of(file)
    with guarded(file, name):
        plane: Plane = reader.read(file, channel)
        return plane


def _of_map(file: Path, variable: str) -> Plane:
    from .. import maps  # the next layer: it needs this one
    from ..maps.touched import pixel_size_of

    data = maps.read(file)
    if variable not in data or data[variable].dims != ("y", "x"):
        valid = ", ".join(str(name) for name in data if f"{name}_sigma" in data)
        raise ReadError(f"{file}: no quantity {variable!r} of each place; it holds {valid}")
    values = np.array(data[variable].values, np.float64)
    if f"{variable}_sigma" in data:
        values[~np.asarray(maps.determined(data, variable))] = np.nan
    try:
        sides: tuple[float, float] | None = pixel_size_of(data)
    except InvalidValue:
        sides = None
    return Plane(variable, values, data[variable].attrs.get("units") or None, sides, "nanotouch.maps")


def _checked(
    plane: Plane, file: Path, quantity: Quantity, unit: str | None, pixel: tuple[float, float] | None, by: Fill | None
) -> ValueMap:
    check_shape(file, plane.values.shape)
    pixel_size = plane.pixel_size if pixel is None else pixel
    if pixel_size is None:
        raise ReadError(f"{file}: channel {plane.name!r} {plane.no_size}; give the pixel size")
    known = _KNOWN[quantity]
    values = np.asarray(plane.values * _factor(plane, unit, quantity, file), np.float64)
    missing = ~(np.isfinite(values) & (values > 0.0))
    missing |= False if plane.mask is None else plane.mask
    if quantity in ("work_of_adhesion", "pull_off_force"):
        missing |= ~(values >= LEAST_SHARE * np.max(values, where=~missing, initial=0.0))
    if by is None and missing.any():
        row, column = (int(i) for i in np.argwhere(missing)[0])
        raise ReadError(
            f"{file}: {missing.sum()} of {missing.size} pixels of {plane.name!r} have no {quantity} (the first at "
            f"[{row}, {column}]: {values[row, column]:g} {known.unit}): give fill_by neighbours or median, or crop it"
        )
    if missing.sum() > MAX_MISSING * missing.size:
        raise ReadError(f"{file}: {100 * missing.mean():.3g} % of {plane.name!r} have no {quantity}; up to "
                        f"{100 * MAX_MISSING:g} % are filled")  # fmt: skip
    values = _filled(values, missing, by)
    if not (known.low <= values.min() and values.max() <= known.high):
        raise ReadError(
            f"{file}: {quantity} of {values.min():.3g} .. {values.max():.3g} {known.unit} in channel {plane.name!r}: "
            f"valid is {known.low:g} .. {known.high:g} {known.unit} (wrong channel or unit?)"
        )
    told = (f"{int(missing.sum())} of {missing.size} pixels filled by {by}",) if missing.any() else ()
    return ValueMap(quantity, values, pixel_size, printable(file.name), plane.name, plane.source, file_digest(file),
                    missing, tuple(map(printable, plane.notes)) + told)  # fmt: skip


def _filled(values: Floats, missing: NDArray[np.bool_], by: Fill | None) -> Floats:
    if not missing.any():
        return values
    logs = np.where(missing, np.nan, np.log(np.where(missing, 1.0, values)))
    if by == "median":
        return np.asarray(np.exp(np.where(missing, np.nanmedian(logs), logs)))
    return np.asarray(np.exp(fill(logs)[0]))


def _factor(plane: Plane, given: str | None, quantity: Quantity, file: Path) -> float:
    """SI per stored value. A unit given against a stated one is refused, as one of the two must be wrong."""
    factors, stated = _KNOWN[quantity].factors, plane.unit
    spelt = {None if one is None else _spelling(one): one for one in (stated, given)}
    if stated is None and given is None:
        raise ReadError(f"{file}: the unit of channel {plane.name!r} is not stated; give it, as {_example(quantity)}")
    if stated is not None and given is not None and len(spelt) > 1:
        raise ReadError(f"{file}: states {stated!r} for channel {plane.name!r}, which contradicts the unit {given!r}")
    for one in spelt:
        if one is not None and one not in factors:
            hint = "; a force is a pull_off_force" if quantity == "work_of_adhesion" and one in UNITS["N"] else ""
            raise ReadError(f"{file}: {quantity} in {spelt[one]!r} (channel {plane.name!r}): valid units are "
                            f"{', '.join(factors)}{hint}")  # fmt: skip
    return next(factors[one] for one in spelt if one is not None)


def _example(quantity: Quantity) -> str:
    return {"Pa": "GPa", "J/m^2": "mJ/m2", "N": "nN"}[_KNOWN[quantity].unit]


def _spelling(unit: str) -> str:
    """``J m^-2``, ``J/m²`` and ``J/m^2`` are ``J/m2``."""
    other: dict[str, str | int | None] = {"µ": "u", "μ": "u", "²": "2", "^": None, "⁻": "-", "¹": "1"}
    plain = unit.strip().translate(str.maketrans(other))
    return plain.replace(" m-2", "/m2").replace(" m-1", "/m").replace(" ", "")


def _weights(wanted: int, given: int) -> Any:
    """From pixels over a length to others over the same: triangles as wide as the wider pixel, which add up to one."""
    sparse = require("scipy.sparse", "images")
    low, _ = PIXELS_PER_SIDE
    assert wanted >= low
    step = given / wanted  # of theirs in a pixel of ours
    width = max(1.0, step)
    at = np.arange(wanted) * step
    reach = int(np.ceil(width))
    columns = np.floor(at).astype(int)[:, None] + np.arange(-reach, reach + 1)
    weights = np.maximum(0.0, 1.0 - np.abs(columns - at[:, None]) / width) * ((columns >= 0) & (columns < given))
    weights /= weights.sum(axis=1, keepdims=True)
    rows = np.broadcast_to(np.arange(wanted)[:, None], columns.shape)
    here = weights > 0.0
    return sparse.csr_array((weights[here], (rows[here], columns[here])), shape=(wanted, given))
