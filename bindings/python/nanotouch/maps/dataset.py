# SPDX-License-Identifier: BSD-3-Clause
"""The results of a map as an xarray Dataset, with what a reader needs to know in its attributes; HDF5 (netCDF-4)."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import guard
from .._io import worker
from .._io.files import checked_path, guarded, refuse_traps
from .._io.readers import head_of
from .._io.writing import replacing
from ..errors import InvalidValue, ReadError, require
from .block import MEASURED, PLAIN, flag_names, status_names
from .settings import Settings
from .store import Columns
from .volume import Volume

_MEANINGS = {
    "effective_modulus": "E*, 1/E* = sum of (1 - nu^2)/E",
    "youngs_modulus": "E of the sample",
    "work_of_adhesion": "w",
    "effective_modulus_least": "95 % lower bound of E* where a stiff contact does not determine it",
    "effective_modulus_most": "95 % upper bound of E* where a soft contact does not determine it",
    "cohesive_range": "h0 = w/sigma0",
    "exponent": "beta of the power law: E goes as time to the minus beta",
    "exponent_low": "lower end of the 95 % interval of beta",
    "exponent_high": "upper end of the 95 % interval of beta",
    "drag": "force on the lever over its speed",
    "contact_point": "height of the base where the undeformed bodies touch: the sample's topography at no force",
}
_BOUNDS = ("effective_modulus_least", "effective_modulus_most")
_KINDS = {"": ", all together", "_statistical": ", of noise and sampling", "_calibration": ", of the calibration"}


def put(columns: Columns, first: int, curves: int, table: Columns) -> int:
    """Put a block into the table of all curves, whose rows are made with the first one; returns how many."""
    count = 0
    for key, values in columns.items():
        if key not in table:
            table[key] = np.empty(curves, object if key == "reason" else values.dtype)
        count = len(values)
        table[key][first : first + count] = values
    return count


def assemble(volume: Volume, settings: Settings, table: Columns, made_of: dict[str, Any]) -> Any:
    """The Dataset of a table."""
    xarray = require("xarray", "maps")
    units = _units(settings)
    variables = {
        key: (("y", "x"), values.reshape(volume.shape), _attributes(key, units, settings.model))
        for key, values in table.items()
    }
    data = xarray.Dataset(variables, _coordinates(volume))
    status = data["status"].values
    data.attrs = {
        "title": f"{settings.model} fit of {volume.name}",
        "model": settings.model,
        "input_name": volume.name,
        "input_sha256": made_of["input"]["sha256"],
        "settings": json.dumps(made_of["settings"]),
        "calibration": json.dumps(made_of["calibration"]),
        "assumptions": "; ".join(settings.assumptions()),
        "versions": json.dumps(
            {"nanotouch": made_of["version"], "numpy": np.__version__, "xarray": xarray.__version__}
        ),
        "curves": int(status.size),
        "curves_without_result": int(np.count_nonzero(status)),
        "curves_flagged": int(np.count_nonzero(doubtful(data))),
    }
    return data


def write(path: str | os.PathLike[str], data: Any) -> Path:
    """Write a Dataset as HDF5 that netCDF tools open, whole or not at all; the path first, as in all that writes."""
    if not isinstance(path, str | os.PathLike):
        raise InvalidValue(f"path: a {type(path).__name__} is none; maps.write(path, data)")
    require("h5netcdf", "maps")
    with replacing(path) as part:
        data.to_netcdf(part, engine="h5netcdf")
    return Path(path)


def read(path: str | os.PathLike[str], *, untrusted: bool | None = None) -> Any:
    """What :func:`write` wrote, in memory.

    Parameters
    ----------
    path : path
        The file.
    untrusted : bool, optional
        True: read it in a confined process (Linux only). By default the ``nanotouch`` command does so, Python does not.
    """
    xarray = require("xarray", "maps")
    file = Path(path)
    if not guard.wanted(untrusted):
        return _opened(file)
    parts = worker.ask("maps.read", file, {}, dict)
    with guarded(file, "worker"):
        data = xarray.Dataset(*({name: _variable(xarray, one) for name, one in parts[kind].items()}
                                for kind in ("variables", "coordinates")))  # fmt: skip
        data.attrs.update({key: _attribute(value) for key, value in parts["attributes"].items()})
    return data


def parts_of(file: Path) -> dict[str, Any]:
    """The same as plain data."""
    data = _opened(file)
    return {
        "variables": {str(name): _plain(one) for name, one in data.data_vars.items()},
        "coordinates": {str(name): _plain(one) for name, one in data.coords.items()},
        "attributes": {str(key): value for key, value in data.attrs.items()},
    }


def _opened(file: Path) -> Any:
    xarray = require("xarray", "maps")
    require("h5netcdf", "maps")
    checked_path(file)
    refuse_traps(file, head_of(file))
    try:
        with guarded(file, "h5netcdf"), xarray.open_dataset(file, engine="h5netcdf") as data:
            return data.load()
    except ReadError as error:
        raise ReadError(f"{file}: not a map that can be read: {error}", error.reader) from error


def _plain(one: Any) -> dict[str, Any]:
    return {"dims": list(map(str, one.dims)), "shape": list(one.shape), "values": np.asarray(one.values),
            "attributes": {str(key): value for key, value in one.attrs.items()}}  # fmt: skip


def _variable(xarray: Any, told: Mapping[str, Any]) -> Any:
    values = told["values"]
    if isinstance(values, list):  # texts
        values = np.array(values, object).reshape([int(n) for n in told["shape"]])
    return xarray.Variable(told["dims"], values, {key: _attribute(one) for key, one in told["attributes"].items()})


def _attribute(value: Any) -> Any:
    """Plain data alone."""
    return value if isinstance(value, str | int | float | np.ndarray | list) else str(value)


def determined(data: Any, name: str) -> NDArray[np.bool_]:
    """Where the curves determine a quantity of a map, shape (y, x); measured quantities wherever there is a result."""
    bit = _bits(data).get(f"{'effective_modulus' if name == 'youngs_modulus' else name}_undetermined", 0)
    return np.asarray(np.isfinite(data[name].values) & ((data["flags"].values & bit) == 0))


def flag_counts(data: Any) -> dict[str, int]:
    """How many curves carry each flag, without those that none carries."""
    flags = data["flags"].values
    counts = {name: int(np.count_nonzero(flags & bit)) for name, bit in _bits(data).items()}
    return {name: count for name, count in counts.items() if count}


def doubtful(data: Any) -> NDArray[np.bool_]:
    """Where a curve has a flag that speaks against its result, shape (y, x).

    A wave that was taken off does not, nor do halves of a contact that differ, as sigma covers that.
    """
    told = sum(_bits(data).get(name, 0) for name in ("waves", "uneven"))
    return np.asarray((data["flags"].values & ~np.uint32(told)) != 0)


def _bits(data: Any) -> dict[str, int]:
    attributes = data["flags"].attrs
    return {
        name: int(bit) for name, bit in zip(attributes["flag_meanings"].split(), attributes["flag_masks"], strict=True)
    }


def _units(settings: Settings) -> dict[str, str]:
    known = {name: unit for name, (_, unit) in settings.parameters().items()} | dict.fromkeys(
        ("youngs_modulus", *_BOUNDS), "Pa"
    )
    known |= {"exponent_low": "", "exponent_high": ""}
    return known | {name: unit for name, (unit, _) in (MEASURED | PLAIN).items()}


def _attributes(key: str, units: dict[str, str], model: str) -> dict[str, Any]:
    """As the CF conventions have it."""
    if key == "status":
        names = status_names()
        values = np.array(list(names.values()), np.int8)
        return {"long_name": "why there is no result", "flag_values": values, "flag_meanings": " ".join(names)}
    if key == "flags":
        bits = flag_names(model)
        masks = np.array(list(bits.values()), np.uint32)
        return {"long_name": "what to know before use", "flag_masks": masks, "flag_meanings": " ".join(bits)}
    if key == "reason":
        return {"long_name": "why there is no result, in words"}
    name, _, kind = key.partition("_sigma")
    said = _MEANINGS.get(name) or (MEASURED | PLAIN).get(name, ("", name.replace("_", " ")))[1]
    if key != name:
        said = f"standard uncertainty of {name}{_KINDS[kind] if name not in MEASURED else _KINDS['_statistical']}"
    return {"units": units[name] or "1", "long_name": said}


def _coordinates(volume: Volume) -> dict[str, Any]:
    if volume.coordinates:
        return {axis: (axis, values, {"units": "m"}) for axis, values in volume.coordinates.items()}
    return {axis: (axis, np.arange(count), {"long_name": f"{what} (pixel size unknown)"})
            for axis, count, what in zip("yx", volume.shape, ("row", "column"), strict=True)}  # fmt: skip
