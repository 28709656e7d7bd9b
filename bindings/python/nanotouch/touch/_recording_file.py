# SPDX-License-Identifier: BSD-3-Clause
"""The bytes of a recording: records of an MCAP file up to its end or its first damage, of bounded size."""

from __future__ import annotations

import io
import json
import os
import struct
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import ReadError, require
from nanotouch.touch._recorder import ENCODING
from nanotouch.touch.columns import COLUMNS

MAX_CHUNK = 1 << 28  # unpacked [byte]; ours have some 3 MB
FREE, RATIO = 1 << 28, 200  # all of it: so many bytes [byte], and so many for each of the file's; ours have some 5


def parts_of(path: Path) -> dict[str, Any]:
    """``columns`` (arrays by name), ``metadata`` and ``damage`` ("" where there is none)."""
    names: list[str] | None = None
    metadata: dict[str, Any] = {}
    blocks: list[bytes] = []
    damage = ""
    try:
        with open(path, "rb") as file:
            for record in _until_damage(file):
                if isinstance(record, str):
                    damage = record
                elif type(record).__name__ == "Metadata" and record.name == "nanotouch":
                    metadata |= {key: json.loads(value) for key, value in record.metadata.items()}
                elif type(record).__name__ == "Schema" and record.encoding == ENCODING:
                    names = _schema_names(record.data)
                elif type(record).__name__ == "Message":
                    blocks.append(record.data)
    except OSError as error:
        raise ReadError(f"cannot read {path}: {error.strerror or error}") from error
    except RecursionError as error:
        raise ReadError(f"{path} is not a recording of nanotouch: it is nested too deep") from error
    except (ValueError, KeyError, TypeError) as error:
        raise ReadError(f"{path} is not a recording of nanotouch: {error}") from error
    if names is None:
        raise ReadError(f"{path} is not a recording of nanotouch: {damage or f'it has no schema {ENCODING!r}'}")
    _check_metadata(path, metadata)
    return {"columns": _columns(path, names, blocks), "metadata": metadata, "damage": damage}


def _until_damage(file: IO[bytes]) -> Iterator[Any]:
    """The records up to the end or to the first damage, which comes last as text."""
    reader = require("mcap.stream_reader", "record")
    exceptions = require("mcap.exceptions", "record")
    zstandard = require("zstandard", "record")
    size = os.fstat(file.fileno()).st_size
    left = FREE + RATIO * size
    try:
        records = reader.StreamReader(file, validate_crcs=True, record_size_limit=size, emit_chunks=True).records
        for record in records:
            if type(record).__name__ != "Chunk":
                yield record
                continue
            data = _unpacked(record, min(left, MAX_CHUNK), zstandard)
            left -= len(data)
            record.compression, record.data = "", data
            yield from reader.breakup_chunk(record, validate_crc=True)
    except exceptions.EndOfFile:
        yield "it ends early" if file.tell() else "it is empty"
    except (MemoryError, OverflowError):
        yield "a record is larger than the memory"
    except (exceptions.McapError, zstandard.ZstdError, ValueError, struct.error) as error:
        yield str(error) or type(error).__name__


def _unpacked(chunk: Any, most: int, zstandard: Any) -> bytes:
    """The content of a chunk; ValueError where it is larger than it says, or than is read."""
    stated = int(chunk.uncompressed_size)
    if stated > most:
        raise ValueError(f"a chunk of {len(chunk.data)} bytes unpacks to {stated}; up to {most} are read")
    if not chunk.compression:
        return bytes(chunk.data)
    if chunk.compression != "zstd":
        raise ValueError(f"a chunk is packed by {chunk.compression[:20]!r}; zstd is read")
    with zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK).stream_reader(io.BytesIO(chunk.data)) as stream:
        data: bytes = stream.read(stated + 1)
    if len(data) != stated:
        raise ValueError(f"a chunk does not unpack to the {stated} bytes that it states")
    return data


def _schema_names(data: bytes) -> list[str]:
    """The names of the columns a schema lists, which must be of the type and unit of COLUMNS."""
    told = json.loads(data)
    entries = told.get("columns") if isinstance(told, dict) else None
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise ValueError("its schema lists no columns")
    names: list[str] = []
    for entry in entries:
        name, dtype, unit = (entry.get(key) for key in ("name", "dtype", "unit"))
        known = COLUMNS.get(name) if isinstance(name, str) else None
        if known is None or (known.dtype, known.unit) != (dtype, unit):
            raise ValueError(f"this version does not know the column {name!r:.60} [{unit!s:.20}]")
        if name in names:
            raise ValueError(f"its schema lists the column {name!r} twice")
        names.append(str(name))
    if "time" not in names:
        raise ValueError("its schema lists no column 'time'")
    return names


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _are_numbers(value: Any) -> bool:
    return isinstance(value, list) and all(map(_is_number, value))


def _is_event(value: Any) -> bool:
    if not isinstance(value, list) or len(value) != 3:
        return False
    return _is_number(value[0]) and isinstance(value[1], str) and isinstance(value[2], list)


MAY_LACK = ("start_height", "spring_constant", "alpha_p", "alpha_f", "master_start", "loop_rate", "rows",
            "relative_accuracy", "stability_margin", "surface_size")  # fmt: skip
"""null where it is not known"""
_KINDS: dict[str, tuple[tuple[str, ...], Callable[[Any], bool]]] = {
    "a number": (("alpha_p", "alpha_f", "spring_constant", "start_height", "master_start", "loop_rate", "rows",
                  "relative_accuracy", "stability_margin", "rewinds_before"), _is_number),
    "a text": (("mode", "control", "probe_model", "clock", "version", "incomplete"), lambda v: isinstance(v, str)),
    "tables": (("scene", "rig", "settings"),
               lambda v: isinstance(v, dict) and all(isinstance(one, dict) for one in v.values())),
    "two numbers": (("surface_size",), lambda v: _are_numbers(v) and len(v) in (0, 2)),
    "points": (("path",), lambda v: isinstance(v, list) and all(_are_numbers(one) and len(one) == 2 for one in v)),
    "events": (("events",), lambda v: isinstance(v, list) and all(map(_is_event, v))),
}  # fmt: skip
"""what the library reads of the metadata, and of what kind it wrote it"""


def _check_metadata(path: Path, metadata: dict[str, Any]) -> None:
    """What is not of the kind that the library wrote is refused, by its name."""
    for kind, (names, holds) in _KINDS.items():
        for name in names:
            if name in metadata and not (holds(metadata[name]) or (metadata[name] is None and name in MAY_LACK)):
                raise ReadError(f"{path}: its metadata state {name} = {metadata[name]!r:.60}, expected {kind}")


def _columns(path: Path, names: Sequence[str], blocks: Sequence[bytes]) -> dict[str, NDArray[Any]]:
    """Take the blocks apart and join each column."""
    types = [np.dtype(COLUMNS[name].dtype) for name in names]
    row = sum(kind.itemsize for kind in types)
    wrong = next((len(block) for block in blocks if len(block) % row), None)
    if wrong is not None:
        raise ReadError(f"{path}: a block has {wrong} bytes, which is no multiple of the {row} bytes of a row")
    rows = [len(block) // row for block in blocks]
    columns = {}
    offset = 0  # bytes of the columns before this one, per row
    for name, kind in zip(names, types, strict=True):
        pieces = [np.frombuffer(b, kind, n, offset * n) for b, n in zip(blocks, rows, strict=True)]
        columns[name] = np.concatenate([np.empty(0, kind), *pieces])
        offset += kind.itemsize
    return columns
