# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of a touch: named columns in SI units, written block by block to an MCAP file and read back.

The file describes itself: its schema record (encoding ``nanotouch.columns``) is JSON that names every column with its
type, unit and meaning, and says how a message holds them. Nothing is left under the final name before it is whole."""

from __future__ import annotations

import json
import math
import os
import struct
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch._control import Law
from nanotouch._files import checked_path
from nanotouch._writing import BLOCK_ROWS, naming, part_of
from nanotouch._writing import replacing as replacing
from nanotouch._writing import write_csv as write_csv
from nanotouch.columns import COLUMNS as COLUMNS
from nanotouch.columns import STATES as STATES
from nanotouch.columns import Column as Column
from nanotouch.errors import InvalidValue, ReadError, require

if TYPE_CHECKING:  # a recording is read without a reader of curves
    from nanotouch.curves import ForceCurve

MCAP_MAGIC = b"\x89MCAP0\r\n"
TOPIC = "nanotouch/touch"
ENCODING = "nanotouch.columns"
LAYOUT = "one message is one block of rows: the columns in the order listed, each contiguous and little-endian"
CHUNK_SIZE = 1 << 18  # what a killed process may lose [bytes]
HDF5_STORAGE = {"chunks": True, "compression": "gzip", "shuffle": True, "fletcher32": True}


class Recording:
    """Named columns of equal length, and what they were recorded with.

    Parameters
    ----------
    columns : mapping of str to array, shape (n,)
        Any of ``COLUMNS`` (``time`` always), in SI units; kept in the order and type of that table.
    metadata : mapping, optional
        JSON-able: ``alpha_p`` [m/m], ``alpha_f`` [N/N], ``spring_constant`` [N/m], ``start_height`` z_0 [m],
        ``master_start``, x_m where x_s = 0 [m], scene, rig, seed.

    Columns are attributes (``recording.time``). Indexing with a slice, mask or index array gives a Recording.
    """

    columns: dict[str, NDArray[Any]]
    metadata: dict[str, Any]

    def __init__(self, columns: Mapping[str, ArrayLike], metadata: Mapping[str, Any] | None = None) -> None:
        self.columns = _checked(columns)
        self.metadata = dict(metadata or {})

    def __getattr__(self, name: str) -> NDArray[Any]:
        columns = self.__dict__.get("columns", {})
        if name in columns:
            return columns[name]  # type: ignore[no-any-return]
        recorded = ", ".join(columns)
        raise AttributeError(f"the recording has no column {name!r}; recorded: {recorded}")

    def __len__(self) -> int:
        return len(self.columns["time"])

    def __getitem__(self, rows: slice | NDArray[Any]) -> Recording:
        if not isinstance(rows, slice) and np.ndim(rows) != 1:
            raise TypeError("a recording is indexed with a slice, a mask or an array of row numbers")
        return Recording({name: values[rows] for name, values in self.columns.items()}, self.metadata)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.columns]

    def __repr__(self) -> str:
        span = f"{self.time[0]:.6g} s to {self.time[-1]:.6g} s" if len(self) else "empty"
        return f"Recording({len(self)} rows, {span}, columns: {', '.join(self.columns)})"

    def parameter(self, name: str) -> float:
        """A number of the metadata that the recording cannot be read without, such as ``alpha_f``."""
        if name not in self.metadata:
            present = ", ".join(self.metadata) or "nothing"
            raise InvalidValue(f"the recording's metadata lacks {name!r}; it has: {present}")
        return float(self.metadata[name])

    @property
    def scaled_slave_force(self) -> NDArray[np.float64]:
        """alpha_f f_s [N], shape (n,): the slave's force at the operator's scale."""
        return self.parameter("alpha_f") * self.slave_force

    @property
    def scaled_stage_position(self) -> NDArray[np.float64]:
        """x_s / alpha_p [m], shape (n,), from where the master started: the stage's travel at the operator's scale."""
        return self.stage_position / self.parameter("alpha_p") + self.parameter("master_start")

    @property
    def tip_height(self) -> NDArray[np.float64]:
        """z_t = z_0 - x_s + zeta cos(tilt) [m], shape (n,), from measured quantities only."""
        tilt = float(self.metadata.get("rig", {}).get("probe", {}).get("tilt", 0.0))
        base: NDArray[np.float64] = self.parameter("start_height") - self.stage_position
        return base + math.cos(tilt) * self.deflection

    def replay(self, control: Law | None = None) -> Recording:
        """Feed what was measured to the touch step again: the same commands to the last bit, on the same machine.

        Parameters
        ----------
        control : callable, optional
            The law, where the recording was made with one's own.
        """
        from nanotouch.replay import replay  # the next layer, which needs this one: a method for convenience

        return replay(self, control)

    def curve(self) -> ForceCurve:
        """The force-distance curve of a recording in mode ``"curve"``, for :mod:`nanotouch.curves`."""
        from nanotouch.replay import curve  # as above

        return curve(self)

    def to_csv(self, path: str | os.PathLike[str], progress: Callable[[float], None] | None = None) -> None:
        """Write a text table: ``# key: value`` lines with the metadata, then ``name [unit],...``, then the rows."""
        comments = {key: json.dumps(value) for key, value in self.metadata.items()}
        headers = {_heading(name): values for name, values in self.columns.items()}
        write_csv(path, headers, comments, progress)

    def to_hdf5(self, path: str | os.PathLike[str]) -> None:
        """Write HDF5: a dataset per column with attributes ``unit`` and ``doc``; metadata as JSON root attributes."""
        h5py = require("h5py", "record")
        with replacing(path) as whole, h5py.File(whole, "w") as file:
            file.attrs.update({key: json.dumps(value) for key, value in self.metadata.items()})
            for name, values in self.columns.items():
                dataset = file.create_dataset(name, data=values, **HDF5_STORAGE)
                dataset.attrs["unit"] = COLUMNS[name].unit
                dataset.attrs["doc"] = COLUMNS[name].doc


class Writer:
    """Write a recording block by block; memory does not grow with its length. Use it in a ``with`` statement.

    Until :meth:`close` the file is called ``<name>.<process id>.part``; an exception in the ``with`` body removes it.
    What a killed process leaves there, :func:`read` still reads.
    """

    def __init__(self, path: str | os.PathLike[str], metadata: Mapping[str, Any] | None = None) -> None:
        mcap = require("mcap.writer", "record")
        texts = _texts(metadata or {})
        self._path, self._part = Path(path), part_of(path)
        with naming(self._path):
            self._file = open(self._part, "wb")  # noqa: SIM115 (close and discard close it)
            self._mcap = mcap.Writer(self._file, chunk_size=CHUNK_SIZE, compression=mcap.CompressionType.ZSTD)
            self._mcap.start(profile="nanotouch", library="nanotouch")
            self._mcap.add_metadata("nanotouch", texts)
        self._names: tuple[str, ...] = ()
        self._channel = 0
        self._blocks = 0
        self.rows = 0

    def append(self, columns: Mapping[str, ArrayLike]) -> None:
        """Write one block of rows; the first block decides which columns the file has."""
        block = _checked(columns)
        if not self._names:
            self._register(tuple(block))
        if tuple(block) != self._names:
            raise InvalidValue(f"a block has the columns {', '.join(block)}; the file has {', '.join(self._names)}")
        times = block["time"]
        if not np.isfinite(times).all():
            raise InvalidValue("a block has a time that is not finite; time [s] must be a number in every row")
        stamp = max(0, round(float(times[0]) * 1e9)) if times.size else 0
        data = b"".join(values.tobytes() for values in block.values())
        with naming(self._path):
            self._mcap.add_message(self._channel, log_time=stamp, data=data, publish_time=stamp, sequence=self._blocks)
        self._blocks += 1
        self.rows += times.size

    def update(self, metadata: Mapping[str, Any]) -> None:
        """Write the metadata anew: what is known only at the end, such as the requests of a session."""
        with naming(self._path):
            self._mcap.add_metadata("nanotouch", _texts(metadata))

    def close(self) -> None:
        """Finish the file and give it its name."""
        if self._file.closed:
            return
        try:
            if not self._names:
                self.append({name: np.empty(0) for name in COLUMNS})
            with naming(self._path):
                self._mcap.finish()
                self._file.flush()
                os.fsync(self._file.fileno())
                self._file.close()
                os.replace(self._part, self._path)
        except BaseException:
            self.discard()
            raise

    def discard(self) -> None:
        """Remove what was written; after :meth:`close` it does nothing."""
        with suppress(OSError):  # closing flushes, which fails on the full disk that brought us here
            self._file.close()
        self._part.unlink(missing_ok=True)

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: BaseException | TracebackType | None) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()

    def _register(self, names: tuple[str, ...]) -> None:
        schema = {"layout": LAYOUT, "columns": [{"name": name, **vars(COLUMNS[name])} for name in names]}
        number = self._mcap.register_schema("nanotouch.Touch", ENCODING, json.dumps(schema, indent=1).encode())
        self._channel = self._mcap.register_channel(TOPIC, ENCODING, number)
        self._names = names


def write(path: str | os.PathLike[str], recording: Recording) -> None:
    """Write a whole recording at once."""
    with Writer(path, recording.metadata) as writer:
        for start in range(0, len(recording), BLOCK_ROWS):
            writer.append(recording[start : start + BLOCK_ROWS].columns)


def is_recording(path: str | os.PathLike[str]) -> bool:
    """Whether the file begins as an MCAP file does."""
    with checked_path(path).open("rb") as file:
        return file.read(len(MCAP_MAGIC)) == MCAP_MAGIC


def read(path: str | os.PathLike[str]) -> Recording:
    """Read a recording. A damaged or truncated file gives the whole blocks before the damage, with a warning."""
    reader = require("mcap.stream_reader", "record")
    names: list[str] | None = None
    metadata: dict[str, Any] = {}
    blocks: list[bytes] = []
    damage = ""
    try:
        with open(path, "rb") as file:
            limit = os.fstat(file.fileno()).st_size
            records = reader.StreamReader(file, validate_crcs=True, record_size_limit=limit).records
            for record in _until_damage(records, file):
                if isinstance(record, str):
                    damage = record
                elif type(record).__name__ == "Metadata" and record.name == "nanotouch":
                    metadata = {key: json.loads(value) for key, value in record.metadata.items()}
                elif type(record).__name__ == "Schema" and record.encoding == ENCODING:
                    names = _schema_names(record.data)
                elif type(record).__name__ == "Message":
                    blocks.append(record.data)
    except OSError as error:
        raise ReadError(f"cannot read {path}: {error.strerror or error}") from error
    except ValueError as error:
        raise ReadError(f"{path} is not a recording of nanotouch: {error}") from error
    if names is None:
        raise ReadError(f"{path} is not a recording of nanotouch: {damage or f'it has no schema {ENCODING!r}'}")
    recording = Recording(_columns(path, names, blocks), metadata)
    if damage:
        warnings.warn(f"{path} is damaged ({damage}); {len(recording)} rows before the damage were read", stacklevel=2)
    return recording


def _heading(name: str) -> str:
    unit = COLUMNS[name].unit
    return f"{name} [{unit}]" if unit else name


def _texts(metadata: Mapping[str, Any]) -> dict[str, str]:
    try:
        return {key: json.dumps(value, allow_nan=False) for key, value in metadata.items()}
    except (TypeError, ValueError) as error:
        raise InvalidValue(f"the metadata of a recording must be JSON-able: {error}") from error


def _checked(columns: Mapping[str, ArrayLike]) -> dict[str, NDArray[Any]]:
    """The columns in the order and type of COLUMNS, or the first thing that is wrong with them."""
    unknown = set(columns) - set(COLUMNS)
    if unknown:
        raise InvalidValue(f"unknown column {min(unknown)!r}; a recording has: {', '.join(COLUMNS)}")
    if "time" not in columns:
        raise InvalidValue("a recording needs the column 'time' [s]")
    checked = {name: _converted(name, columns[name]) for name in COLUMNS if name in columns}
    rows = len(checked["time"])
    for name, values in checked.items():
        if len(values) != rows:
            raise InvalidValue(f"column {name!r} has {len(values)} rows, 'time' has {rows}")
    return checked


def _converted(name: str, values: ArrayLike) -> NDArray[Any]:
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "fiub" or isinstance(values, np.ma.MaskedArray):
        raise InvalidValue(f"column {name!r} must be an unmasked array of real numbers with one dimension")
    with np.errstate(invalid="ignore"):  # NaN in an integer column: caught by the comparison
        converted = np.ascontiguousarray(array, dtype=COLUMNS[name].dtype)
    if converted.dtype.kind == "u" and not np.array_equal(converted, array):
        raise InvalidValue(f"column {name!r} must hold integers from 0 to {np.iinfo(converted.dtype).max}")
    return converted


def _until_damage(records: Iterator[Any], file: IO[bytes]) -> Iterator[Any]:
    """The records of an MCAP file up to its end or to the first damage, which comes last as text."""
    exceptions = require("mcap.exceptions", "record")
    zstandard = require("zstandard", "record")
    try:
        yield from records
    except exceptions.EndOfFile:
        yield "it ends early" if file.tell() else "it is empty"
    except (exceptions.McapError, zstandard.ZstdError, ValueError, struct.error) as error:
        yield str(error) or type(error).__name__


def _schema_names(data: bytes) -> list[str]:
    """The names of the columns a schema lists, which must be of the type and unit of COLUMNS."""
    names = []
    for entry in json.loads(data)["columns"]:
        known = COLUMNS.get(entry["name"])
        if known is None or (known.dtype, known.unit) != (entry["dtype"], entry["unit"]):
            raise ValueError(f"this version does not know the column {entry['name']!r} [{entry['unit']}]")
        names.append(entry["name"])
    return names


def _columns(path: str | os.PathLike[str], names: Sequence[str], blocks: Sequence[bytes]) -> dict[str, NDArray[Any]]:
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
