# SPDX-License-Identifier: BSD-3-Clause
"""The same touch for programs that plot any MCAP file, as Foxglove and PlotJuggler do: beside the blocks, which hold
every row, a hundred rows per second as JSON messages with a JSON schema.

They lie between the blocks, outside their chunks, and nothing here reads them: what is lost of them costs no row.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import require
from nanotouch.touch.columns import COLUMNS

TOPIC, SCHEMA, ENCODING, SCHEMA_ENCODING = "nanotouch/plot", "nanotouch.Plot", "json", "jsonschema"
NUMBER = 2
"""of schema and channel; those of the blocks have 1"""
RATE = 100.0
"""[Hz]"""
DIGITS = 7


def head(names: Sequence[str]) -> bytes:
    """The records that announce the messages."""
    properties = {
        name: {
            "type": "number",
            "description": COLUMNS[name].doc + (f" [{unit}]" if (unit := COLUMNS[name].unit) else ""),
        }
        for name in names
    }
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": SCHEMA, "type": "object",
              "properties": properties, "required": ["time"]}  # fmt: skip
    records = require("mcap.records", "record")
    described = records.Schema(id=NUMBER, data=json.dumps(schema).encode(), encoding=SCHEMA_ENCODING, name=SCHEMA)
    channel = records.Channel(id=NUMBER, topic=TOPIC, message_encoding=ENCODING, metadata={}, schema_id=NUMBER)
    return _written(described, channel)


def _written(*records: Any) -> bytes:
    builder = require("mcap.data_stream", "record").RecordBuilder()
    for record in records:
        record.write(builder)
    return bytes(builder.end())


class Plots:
    """What of a recording is plotted, block by block."""

    def __init__(self) -> None:
        self._last = -math.inf  # hundredth second of the last message
        self._number = 0

    def messages(self, block: Mapping[str, NDArray[Any]]) -> bytes:
        """The records of a block: its first row of each hundredth of a second. What is no number is left out."""
        hundredth = np.floor(block["time"] * RATE)
        is_first = np.diff(hundredth, prepend=self._last) != 0.0
        rows = np.flatnonzero(is_first)
        if not len(rows):
            return b""
        self._last = float(hundredth[-1])
        taken = {name: values[rows].tolist() for name, values in block.items()}
        return _written(*(self._message({name: values[i] for name, values in taken.items()}) for i in range(len(rows))))

    def _message(self, row: Mapping[str, float]) -> Any:
        numbers = {name: float(f"{value:.{DIGITS}g}") for name, value in row.items() if math.isfinite(value)}
        stamp = max(0, round(row["time"] * 1e9))
        self._number += 1
        return require("mcap.records", "record").Message(
            channel_id=NUMBER, log_time=stamp, data=json.dumps(numbers).encode(), publish_time=stamp,
            sequence=self._number,
        )  # fmt: skip
