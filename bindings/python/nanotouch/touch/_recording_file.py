# SPDX-License-Identifier: BSD-3-Clause
"""The bytes of a recording: all sound blocks of an MCAP file, and what is missing between them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import ReadError
from nanotouch.touch._recorder import ENCODING, ROWS
from nanotouch.touch._recording_plots import NUMBER as PLOTS
from nanotouch.touch._recording_records import Damage, records
from nanotouch.touch.columns import COLUMNS

MOST_NAMED = 5  # parts that are lost, in a message
LOST_AFTER = "lost_after"
"""key of the metadata: times [s] of the last rows before those that are lost; null: the first ones are"""


class _Losses:
    """The blocks that are missing, by their numbers, which the file has counted from 0."""

    def __init__(self) -> None:
        self.damages: list[tuple[Damage, int]] = []  # and how many blocks come before
        self._gaps: list[tuple[int, int, int]] = []  # first number, the one after the last, how many blocks come before
        self._next = self._found = 0

    def damaged(self, damage: Damage) -> None:
        """Here something is."""
        self.damages.append((damage, self._found))

    def block(self, number: int) -> None:
        """This one is there."""
        if number > self._next:
            self._gaps.append((self._next, number, self._found))
        self._next, self._found = number + 1, self._found + 1

    def told(self, times: Sequence[NDArray[np.float64]], rows: int | None) -> tuple[str, list[float | None]]:
        """In words, "" where there is none, and the times after which rows are missing [s]; of so many rows in all."""
        if not self.damages and not self._gaps:
            return "", []
        found = sum(map(len, times))
        missing = 0 if rows is None else max(0, int(rows) - found)
        ends_early = bool(self.damages) and self.damages[-1][0].is_end
        if not self._gaps:
            damage, before = self.damages[0]
            if damage.is_end and not missing:
                return damage.reason, []
            at = _time_before(times, before)
            size = f"; {missing} of {rows} rows are lost" if missing else ""
            return f"{_after(at)}: {damage.reason}{size}", [at]
        after = [_time_before(times, before) for *_, before in self._gaps]
        size = f"{missing} of {rows} rows" if missing else self._estimated(times)
        numbers = _some([str(a + 1) if b == a + 1 else f"{a + 1} to {b}" for a, b, _ in self._gaps])
        lost = sum(b - a for a, b, _ in self._gaps)
        what = f"block{'s' * (lost > 1)}" if ends_early else f"of {self._next} blocks"
        is_lost = f"{lost} {what} {'are' if lost > 1 else 'is'} lost"
        text = f"{is_lost}, number {numbers}: {size}, {_some([_after(time) for time in after])}"
        return text + "; it ends early" * ends_early, after

    def _estimated(self, times: Sequence[NDArray[np.float64]]) -> str:
        """How many rows are missing, by the time they would have taken."""
        steps = [float(np.median(np.diff(block))) for block in times if len(block) > 1]
        step, rows = float(np.median(steps)) if steps else 0.0, 0
        for *_, before in self._gaps:
            begin, until = _time_before(times, before), next((b[0] for b in times[before:] if len(b)), None)
            if until is None or not step > 0.0:
                return "their rows"
            rows += round(until / step) if begin is None else round((until - begin) / step) - 1
        return f"some {rows} rows" if rows > 0 else "their rows"


def _time_before(times: Sequence[NDArray[np.float64]], count: int) -> float | None:
    return next((float(block[-1]) for block in reversed(times[:count]) if len(block)), None)


def _after(time: float | None) -> str:
    return "before the first row" if time is None else f"after {time:.6g} s"


def _some(parts: list[str]) -> str:
    more = len(parts) - MOST_NAMED
    return ", ".join(parts[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")


def parts_of(path: Path) -> dict[str, Any]:
    """``columns`` (arrays by name), ``metadata`` and ``damage`` ("" where there is none)."""
    names: list[str] | None = None
    metadata: dict[str, Any] = {}
    blocks: list[bytes] = []
    losses = _Losses()
    try:
        with open(path, "rb") as file:
            for record in records(file):
                if isinstance(record, Damage):
                    losses.damaged(record)
                elif type(record).__name__ == "Metadata" and record.name == "nanotouch":
                    metadata |= _decoded(record.metadata, losses)
                elif type(record).__name__ == "Schema" and record.encoding == ENCODING:
                    names = _schema_names(record.data)
                elif type(record).__name__ == "Message" and record.channel_id != PLOTS:
                    losses.block(record.sequence)
                    blocks.append(record.data)
    except OSError as error:
        raise ReadError(f"cannot read {path}: {error.strerror or error}") from error
    except RecursionError as error:
        raise ReadError(f"{path} is not a recording of nanotouch: it is nested too deep") from error
    except (ValueError, KeyError, TypeError) as error:
        raise ReadError(f"{path} is not a recording of nanotouch: {error}") from error
    if names is None:
        why = losses.damages[0][0].reason if losses.damages else f"it has no schema {ENCODING!r}"
        raise ReadError(f"{path} is not a recording of nanotouch: {why}")
    _check_metadata(path, metadata)
    if metadata.get("relative_accuracy") == 0:  # older files: that is how everything exact was asked for
        metadata.setdefault("bound", "exact")
    columns, starts = _columns(path, names, blocks)
    times = np.split(columns["time"], starts)
    damage, lost = losses.told(times, metadata.get(ROWS))
    if lost:
        metadata[LOST_AFTER] = lost
        metadata.pop(ROWS, None)
    return {"columns": columns, "metadata": metadata, "damage": damage}


def _decoded(texts: Mapping[str, str], losses: _Losses) -> dict[str, Any]:
    """The metadata of one record; what is no JSON is damaged."""
    try:
        return {key: json.loads(value) for key, value in texts.items()}
    except ValueError as error:
        losses.damaged(Damage(f"its metadata are damaged ({error})", is_end=False))
        return {}


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
    "a text": (("mode", "control", "probe_model", "clock", "version", "incomplete", "bound"),
               lambda v: isinstance(v, str)),
    "tables": (("scene", "rig", "settings"),
               lambda v: isinstance(v, dict) and all(isinstance(one, dict) for one in v.values())),
    "two numbers": (("surface_size",), lambda v: _are_numbers(v) and len(v) in (0, 2)),
    "points": (("path",), lambda v: isinstance(v, list) and all(_are_numbers(one) and len(one) == 2 for one in v)),
    "times": ((LOST_AFTER,), lambda v: isinstance(v, list) and all(one is None or _is_number(one) for one in v)),
    "events": (("events",), lambda v: isinstance(v, list) and all(map(_is_event, v))),
}  # fmt: skip
"""what the library reads of the metadata, and of what kind it wrote it"""


def _check_metadata(path: Path, metadata: dict[str, Any]) -> None:
    """What is not of the kind that the library wrote is refused, by its name."""
    for kind, (names, holds) in _KINDS.items():
        for name in names:
            if name in metadata and not (holds(metadata[name]) or (metadata[name] is None and name in MAY_LACK)):
                raise ReadError(f"{path}: its metadata state {name} = {metadata[name]!r:.60}, expected {kind}")


def _columns(path: Path, names: Sequence[str], blocks: Sequence[bytes]) -> tuple[dict[str, NDArray[Any]], list[int]]:
    """Take the blocks apart and join each column; and where the second block and the later ones begin."""
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
    return columns, np.cumsum(rows, dtype=int)[:-1].tolist()
