# SPDX-License-Identifier: BSD-3-Clause
"""How a recording is written, and how it ends: whole, or marked as incomplete with its reason.

After every block the file has an ending that calls it incomplete; the next block takes its place, and gets a new one.
So a file is a finished one at any time but while a block is written, and on a full disk there is room for the reason.

No index is written: it would have to be kept in memory until the end. Readers of MCAP then begin at the start,
as they do where a recording was cut short.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from io import BytesIO
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike

from nanotouch._io.writing import naming, part_of
from nanotouch.errors import Error, InvalidValue, require
from nanotouch.touch import _recording_plots
from nanotouch.touch.columns import COLUMNS, checked

TOPIC = "nanotouch/touch"
ENCODING = "nanotouch.columns"
LAYOUT = "one message is one block of rows: the columns in the order listed, each contiguous and little-endian"
CHUNK_SIZE = 1  # [bytes]: every block is a chunk of its own, and on its way to the disk when append returns
CHUNKS_KEPT = 100  # a writer of the library remembers all its chunks: after so many another one goes on
INCOMPLETE = "incomplete"
"""key of the metadata with the reason"""
REWINDS_BEFORE = "rewinds_before"
"""key of the metadata: how many of the events are rewinds that came before the first row; none where it is missing"""
ROWS = "rows"
"""key of the metadata of a recording that is whole: how many rows it has"""
KILLED = "the program that recorded it was killed"
REASON_SIZE = 400  # [bytes]


def rewinds(events: Sequence[Sequence[Any]]) -> int:
    """How many of them are."""
    return sum(name == "rewind" for _, name, _ in events)


class Metadata(dict[str, Any]):
    """Of an open session: what is asked of it later is an event, which :class:`Writer` adds by itself."""

    def __init__(self, entries: Mapping[str, Any], events: Callable[[], list[Any]]) -> None:
        super().__init__(entries)
        self.events = events


class Writer:
    """Write a recording block by block; memory does not grow with its length. Use it in a ``with`` statement.

    Until :meth:`close` the file is called ``<name>.<process id>.part``. However the ``with`` body ends, it gets its
    name. After an exception or on a full disk it holds all blocks so far, and ``metadata["incomplete"]`` says why.
    Then it replaces no earlier file, but keeps the name with ``.part``; without any row it is removed. What a killed
    process leaves is read by :func:`nanotouch.touch.record.read`, and finished by
    :func:`nanotouch.touch.record.recover`.

    Attributes
    ----------
    path : Path
        Where the recording is once it has ended.
    rows : int
        Rows that the system has taken over: they outlive the process.
    """

    def __init__(self, path: str | os.PathLike[str], metadata: Mapping[str, Any] | None = None) -> None:
        require("mcap.writer", "record")
        texts = _texts(metadata or {})
        if isinstance(metadata, Metadata) and rewinds(metadata["events"]):
            texts |= _texts({REWINDS_BEFORE: rewinds(metadata["events"])})
        self._asked = metadata.events if isinstance(metadata, Metadata) else None
        self._told = len(metadata["events"]) if isinstance(metadata, Metadata) else 0
        self._rate = metadata["loop_rate"] if isinstance(metadata, Metadata) else 0.0
        self.path = Path(path)
        self.rows = 0
        self._names: tuple[str, ...] = ()
        self._channel = 0
        self._blocks = 0
        self._plots = _recording_plots.Plots()
        self._last = -math.inf  # time of the last row [s]
        self._ending = ending(KILLED)
        self._is_cut = False
        with naming(self.path):
            self._file = _new_part(self.path)
        self._part = Path(self._file.name)
        with self._growing():
            self._mcap = _new_writer(self._file)
            self._mcap.start(profile="nanotouch", library="nanotouch")
            self._mcap.add_metadata("nanotouch", texts)

    def append(self, columns: Mapping[str, ArrayLike]) -> None:
        """Write one block of rows, best some hundred; the first block decides which columns the file has."""
        self._check_open()
        block = checked(columns)
        if tuple(block) != (self._names or tuple(block)):
            raise InvalidValue(f"a block has the columns {', '.join(block)}; the file has {', '.join(self._names)}")
        times = block["time"]
        if not np.isfinite(times).all():
            raise InvalidValue("a block has a time that is not finite; time [s] must be a number in every row")
        stamp = max(0, round(float(times[0]) * 1e9)) if times.size else 0
        if self._blocks % CHUNKS_KEPT == 0:
            self._mcap, self._names = _new_writer(self._file), tuple(block)
            self._register(self._names)
            if not self._blocks:
                with self._growing():
                    self._file.write(_recording_plots.head(self._names))
        data = b"".join(values.tobytes() for values in block.values())
        with self._growing():
            self._mcap.add_message(self._channel, log_time=stamp, data=data, publish_time=stamp, sequence=self._blocks)
            self._file.write(self._plots.messages(block))
        self._blocks += 1
        self.rows += times.size
        self._last = float(times[-1]) if times.size else self._last
        self._keep_up()

    def _keep_up(self) -> None:
        """With what was asked of the session whose metadata they are: without it a replay would go another way."""
        if self._asked is None:
            return
        events = self._asked()
        if len(events) > self._told:
            self._told = len(events)
            self.update({"events": events})

    def _holds_all(self) -> bool:
        """The rows go as far as what was asked; one who closes while the session runs on may have left some unread."""
        end = round(self._last * self._rate) + 1 if self.rows else 0
        asked = self._asked() if self._asked is not None else []
        since = max((number for number, event in enumerate(asked) if event[1] == "rewind"), default=-1)
        return all(tick <= end for tick, _, _ in asked[since + 1 :])

    def update(self, metadata: Mapping[str, Any]) -> None:
        """Write metadata, new or anew: what is known only later, such as the requests of a session."""
        self._check_open()
        texts = _texts(metadata)
        with self._growing():
            self._mcap.add_metadata("nanotouch", texts)

    @property
    def saved(self) -> str:
        """What is in the file, in words."""
        if not self.rows:
            return "no rows were recorded"
        mark = ", marked as incomplete" if self._is_cut else ""
        return f"{self.rows} rows up to {self._last:.6g} s are in {self.path}{mark}"

    def close(self, incomplete: str | None = None) -> None:
        """Finish the file and give it its name; with a reason, marked as incomplete. Later calls do nothing."""
        if self._file.closed:
            return
        if incomplete is not None:
            self._keep(incomplete)
            return
        if not self._names:
            self.append({name: np.empty(0) for name in COLUMNS})
        if self._asked is not None and self._holds_all():
            self.update({ROWS: self.rows})
        with self._keeping():
            self._mcap.finish()
            self._file.truncate()
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()
            os.replace(self._part, self.path)

    def discard(self) -> None:
        """Remove what was written; after :meth:`close` it does nothing."""
        with suppress(OSError):  # closing flushes, which fails on the full disk that brought us here
            self._file.close()
        self._part.unlink(missing_ok=True)

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, _: type[BaseException] | None, error: BaseException | None, __: TracebackType | None) -> None:
        self.close(None if error is None else reason_of(error))

    def _check_open(self) -> None:
        if self._file.closed:
            raise Error(f"{self.path}: this recording has ended")

    @contextmanager
    def _growing(self) -> Iterator[None]:
        """What is written in here comes in place of the ending, and gets a new one."""
        with self._keeping():
            yield
            end = self._file.tell()
            self._file.write(self._ending)
            self._file.flush()
            self._end = self._file.seek(end)

    @contextmanager
    def _keeping(self) -> Iterator[None]:
        """What fails in here ends the recording, with what it has."""
        try:
            with naming(self.path):
                yield
        except BaseException as error:
            self._keep(reason_of(error))
            if isinstance(error, Error):
                raise Error(f"{error}; {self.saved}") from error
            raise

    def _keep(self, reason: str) -> None:
        """End with the last whole block."""
        if not self.rows:
            self.discard()
            return
        wanted, self.path, self._is_cut = self.path, self._part, True
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):  # even then all blocks can be read
            mark(self._part, self._end, reason)
            if not wanted.exists():
                self.path = self._part.replace(wanted)

    def _register(self, names: tuple[str, ...]) -> None:
        number = self._mcap.register_schema("nanotouch.Touch", ENCODING, _schema_of(names))
        self._channel = self._mcap.register_channel(TOPIC, ENCODING, number)


@cache
def _schema_of(names: tuple[str, ...]) -> bytes:
    """Made once: json leaves circular garbage, which would grow with a recording."""
    schema = {"layout": LAYOUT, "columns": [{"name": name, **vars(COLUMNS[name])} for name in names]}
    return json.dumps(schema, indent=1).encode()


def _new_writer(file: BinaryIO) -> Any:
    """A writer that goes on where the file ends."""
    mcap = require("mcap.writer", "record")
    return mcap.Writer(file, chunk_size=CHUNK_SIZE, index_types=mcap.IndexType.NONE, use_statistics=False)


def _new_part(path: Path) -> BinaryIO:
    """A new file beside this one; what a process of the same number left when it was killed stays."""
    part = part_of(path)
    for number in count(2):
        try:
            return open(part, "xb")
        except FileExistsError:
            part = path.with_name(f"{path.name}.{os.getpid()}-{number}.part")
    raise AssertionError


def ending(reason: str) -> bytes:
    """The end of an MCAP file with the reason in its metadata; of the same length whatever the reason."""
    mcap = require("mcap.writer", "record")
    while len(text := json.dumps(reason)) > REASON_SIZE:
        reason = reason[:-1]
    stream = BytesIO()
    writer = mcap.Writer(
        stream, index_types=mcap.IndexType.NONE, repeat_channels=False, repeat_schemas=False, use_chunking=False,
        use_statistics=False, use_summary_offsets=False, enable_crcs=False,
    )  # fmt: skip
    writer.add_metadata("nanotouch", {INCOMPLETE: text.ljust(REASON_SIZE)})
    writer.finish()
    return stream.getvalue()


def mark(path: Path, end: int, reason: str) -> None:
    """End a file at this byte, where its last whole block ends, with a reason."""
    with open(path, "r+b") as file:
        file.seek(end)
        file.write(ending(reason))
        file.truncate()
        file.flush()
        os.fsync(file.fileno())


def reason_of(error: BaseException) -> str:
    """Why a recording ended that this ended."""
    if isinstance(error, KeyboardInterrupt):
        return str(error) or "stopped by SIGINT"
    return str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"


def recovered_name(path: Path) -> Path:
    """The name that the recording was to have; where the file has it already, one beside it."""
    name = re.sub(r"\.\d+(-\d+)?\.part$", "", path.name)
    return path.with_name(name) if name != path.name else path.with_suffix(f".recovered{path.suffix}")


def _texts(metadata: Mapping[str, Any]) -> dict[str, str]:
    try:
        return {key: json.dumps(value, allow_nan=False) for key, value in metadata.items()}
    except (TypeError, ValueError) as error:
        raise InvalidValue(f"the metadata of a recording must be JSON-able: {error}") from error
