# SPDX-License-Identifier: BSD-3-Clause
"""Results over a pipe from a process that is not trusted: JSON and plain arrays, nothing that could run (no pickle).

A frame is the length of the JSON in eight bytes, the JSON, and the arrays' bytes. Only types that are asked for come
out, and they check themselves on the way.
"""

from __future__ import annotations

import dataclasses
import json
import struct
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from nanotouch.errors import Error

MAX_JSON = 1 << 28  # of 65536 curves with what their file says of them: 1 << 27 [byte]
MAX_ARRAYS = 1 << 30  # of all arrays of an answer, where nobody says how many may come [byte]
_DTYPES = ("|b1", "|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8", "<f4", "<f8")
_Arrays = dict[tuple[int, tuple[int, ...], str], tuple[int, np.ndarray[Any, Any]]]  # by where they lie


class BadAnswer(Error):
    """What came over the pipe is not an answer."""


def packed(value: Any) -> list[bytes | memoryview]:
    """The frame, in pieces, without a copy of the arrays; one that several objects share is sent once."""
    arrays: _Arrays = {}
    tree = _flattened(value, arrays)
    listed = [[a.dtype.str, list(a.shape)] for _, a in arrays.values()]
    text = json.dumps({"tree": tree, "arrays": listed}).encode()
    return [struct.pack("<Q", len(text)), text, *(a.data.cast("B") for _, a in arrays.values() if a.size)]


def _flattened(value: Any, arrays: _Arrays) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "biuf":
            return value.astype(str).tolist()
        flat = np.ascontiguousarray(value).reshape(value.shape)
        flat = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
        place = (flat.__array_interface__["data"][0], flat.shape, flat.dtype.str)
        number, _ = arrays.setdefault(place, (len(arrays), flat))
        return {"array": number}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {f.name: _flattened(getattr(value, f.name), arrays) for f in dataclasses.fields(value)}
        return {"type": type(value).__name__, "fields": fields}
    if isinstance(value, Mapping):
        return {"map": [[str(key), _flattened(item, arrays)] for key, item in value.items()]}
    if isinstance(value, (list, tuple)):
        items = [_flattened(item, arrays) for item in value]
        return {"tuple": items} if isinstance(value, tuple) else items
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return str(value)  # paths, dates


def unpacked(read: Callable[[int], bytes], file: Path, types: Sequence[type], most: int = MAX_ARRAYS) -> Any:
    """The value, made of these types, of a frame whose bytes `read` gives; :class:`BadAnswer` if it is none within the
    limits."""
    (length,) = struct.unpack("<Q", read(8))
    if length > MAX_JSON:
        raise BadAnswer(f"{file}: an answer of {length} bytes")
    try:
        frame = json.loads(read(length))
        sizes = [(np.dtype(_known(dtype)), tuple(int(n) for n in shape)) for dtype, shape in frame["arrays"]]
        if any(n < 0 for _, shape in sizes for n in shape):
            raise ValueError("a negative size")
        counts = [int(np.prod(shape, dtype=object)) if shape else 1 for _, shape in sizes]
        total = sum(dtype.itemsize * count for (dtype, _), count in zip(sizes, counts, strict=True))
        if total > most:
            raise ValueError(f"arrays of {total} bytes")
        arrays = [
            np.frombuffer(read(dtype.itemsize * count), dtype).reshape(shape)
            for (dtype, shape), count in zip(sizes, counts, strict=True)
        ]
        return _restored(frame["tree"], arrays, {kind.__name__: kind for kind in types})
    except (KeyError, IndexError, TypeError, ValueError, RecursionError) as error:
        raise BadAnswer(f"{file}: the answer is not valid: {error}") from error


def _known(dtype: Any) -> str:
    if dtype not in _DTYPES:
        raise ValueError(f"an array of {dtype!r}")
    return str(dtype)


def _restored(tree: Any, arrays: list[np.ndarray[Any, Any]], types: Mapping[str, type]) -> Any:
    if isinstance(tree, list):
        return [_restored(item, arrays, types) for item in tree]
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    if "map" in tree:
        return {str(key): _restored(item, arrays, types) for key, item in tree["map"]}
    if "tuple" in tree:
        return tuple(_restored(item, arrays, types) for item in tree["tuple"])
    fields = {str(key): _restored(item, arrays, types) for key, item in tree["fields"].items()}
    return types[tree["type"]](**fields)
