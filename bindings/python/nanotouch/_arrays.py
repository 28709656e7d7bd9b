# SPDX-License-Identifier: BSD-3-Clause
"""Arrays at the edge of the C library: scalar in, scalar out; masks and units are refused, not stripped."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from operator import index
from typing import Any, NamedTuple, SupportsFloat, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch.errors import InvalidValue

Floats = NDArray[np.float64]


def is_masked(values: Any) -> bool:
    """Whether it is a masked array of numpy's; their module takes as long to load as a header to read."""
    masked = sys.modules.get("numpy.ma")  # not there yet: nobody has made one
    return masked is not None and isinstance(values, masked.MaskedArray)


def refuse_dressed(values: Any, name: str) -> None:
    """Refuse what numpy would strip in silence: a mask, a unit."""
    if is_masked(values):
        raise TypeError(f"{name} is a masked array; fill or compress it first")
    if isinstance(values, np.matrix):
        raise TypeError(f"{name} is a numpy.matrix; pass numpy.asarray of it")
    if hasattr(values, "units") or hasattr(values, "unit"):
        raise TypeError(f"{name} carries a unit; convert it to SI and pass plain numbers")
    told = getattr(values, "attrs", None)  # of HDF5 datasets, xarray
    for key in ("units", "unit", "scale_factor", "add_offset"):
        if told is not None and key in told:
            raise TypeError(f"{name} states {key} = {told[key]}; convert it to SI and pass plain numbers")


def as_mask(values: ArrayLike, name: str) -> NDArray[np.bool_]:
    """An array of booleans."""
    refuse_dressed(values, name)
    return np.asarray(values, dtype=bool)


def as_floats(values: ArrayLike, name: str) -> Floats:
    """A float64 array of real numbers, of the same shape."""
    refuse_dressed(values, name)
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def is_foreign(values: Any) -> bool:
    """Whether an array of another library wants to be asked how a ufunc goes over it (xarray, dask, pandas)."""
    return hasattr(values, "__array_ufunc__") and not isinstance(values, np.ndarray | np.generic)


def as_operand(values: Any, name: str) -> Any:
    """What goes to a ufunc: a float, an array of real numbers as it is, or an array of another library."""
    if type(values) is float:
        return values
    refuse_dressed(values, name)
    return values if is_foreign(values) else as_floats(values, name)


def law_over(ufuncs: Callable[[str], np.ufunc], operands: Sequence[Any]) -> LawValue:
    """A law over operands, by its ufunc of all four values; arrays of other libraries take one value at a time."""
    if any(map(is_foreign, operands)):
        return LawValue(*(ufuncs(value)(*operands) for value in ("energy", "force", "stiffness", "radius")))
    return as_law(ufuncs("")(*operands))


def value_over(ufunc: np.ufunc, operands: Sequence[Any], out: Any, where: Any) -> Any:
    """One value of a law over operands. Where ``where`` is false and nothing is given to write to, it is NaN."""
    if where is True:
        return plain(ufunc(*operands) if out is None else ufunc(*operands, out=out))
    if out is None and not any(map(is_foreign, (*operands, where))):
        out = np.full(np.broadcast_shapes(*map(np.shape, operands), np.shape(where)), np.nan)
    return plain(ufunc(*operands, out=out, where=where))


def check_between(name: str, value: float, unit: str, *, above: float, up_to: float = np.inf) -> None:
    """Raise :class:`~nanotouch.errors.InvalidValue` unless ``above`` < value <= ``up_to``."""
    if not above < as_number(name, value, unit) <= up_to:
        span = f"above {above:g}" + (f", up to {up_to:g}" if up_to < np.inf else "")
        raise InvalidValue(f"{name} = {value:g} {unit}".rstrip() + f": it must be {span} {unit}".rstrip())


def as_number(name: str, value: Any, unit: str) -> float:
    """One real number; text, truth values and what has parts are none."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, SupportsFloat) or getattr(value, "ndim", 0) != 0:
        raise InvalidValue(f"{name} = {value!r:.80}: it must be a number {f'[{unit}]' if unit else ''}".rstrip())
    return float(value)


def as_count(name: str, value: Any, least: int) -> int:
    """A whole number from `least` on."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, SupportsIndex) or index(value) < least:
        raise InvalidValue(f"{name} = {value!r:.80}: valid is a whole number from {least} on")
    return index(value)


class LawValue(NamedTuple):
    """What every law returns; each an array of the input's shape, or a float for a scalar.

    ``F = dU/d(indentation)``, ``k = dF/d(indentation)``; force + repulsive.
    """

    U: Any
    """energy [J]"""
    F: Any
    """force on the tip [N]"""
    k: Any
    """stiffness [N/m]"""
    a: Any
    """contact radius [m]"""


def as_law(columns: Sequence[Any]) -> LawValue:
    """Arrays of the C library as a :class:`LawValue`; 0-d becomes float."""
    return LawValue(*map(plain, columns))


def plain(values: Any) -> Any:
    """numpy's scalars and 0-d arrays become floats."""
    return float(values) if isinstance(values, np.ndarray | np.generic) and values.ndim == 0 else values
