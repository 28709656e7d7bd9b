# SPDX-License-Identifier: BSD-3-Clause
"""What of a recording other programs plot: JSON messages with a JSON schema, read by the mcap package alone."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import record

reader = pytest.importorskip("mcap.reader")


def messages_of(path: Path) -> list[Any]:
    with open(path, "rb") as file:
        return list(reader.make_reader(file, validate_crcs=True).iter_messages(topics=["nanotouch/plot"]))


def test_a_touch_can_be_plotted_by_others(tmp_path: Path) -> None:
    """One message per hundredth of a second, with the numbers of that row, in units that the schema states."""
    path, session = tmp_path / "touch.mcap", nt.Session(seed=3)
    with record.Writer(path, session.metadata()) as writer:
        recording = session.run(operator=[nt.Input(0.2, 0.0, 0.0, 0.5)], writer=writer)
    found = messages_of(path)
    assert len(found) == 50
    schema, channel, _ = found[0]
    assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
    described = json.loads(schema.data)
    assert described["properties"]["tip_force"]["description"].endswith("[N]")
    for number, (_, _, message) in enumerate(found):
        told = json.loads(message.data, parse_constant=pytest.fail)  # NaN is no JSON
        assert set(told) <= set(described["properties"])
        assert set(described["required"]) <= set(told)
        row = int(np.searchsorted(recording.time, 0.01 * number - 1e-9))
        assert message.log_time == round(recording.time[row] * 1e9)
        for name, value in told.items():
            assert value == pytest.approx(float(getattr(recording, name)[row]), rel=1e-6)
        assert all(not math.isfinite(getattr(recording, name)[row]) for name in recording.columns if name not in told)


def test_its_messages_hold_their_schema(tmp_path: Path) -> None:
    """By the validator of JSON schemas, which Foxglove's own package for Python wants, too."""
    jsonschema = pytest.importorskip("jsonschema")
    path = tmp_path / "touch.mcap"
    record.write(path, nt.Session().run(operator=[nt.Input(0.2, 0.0, 0.0, 0.1)]))
    found = messages_of(path)
    validator = jsonschema.Draft202012Validator(json.loads(found[0][0].data))
    validator.check_schema(validator.schema)
    for _, _, message in found:
        validator.validate(json.loads(message.data))


def test_they_cost_no_row_and_are_few(tmp_path: Path) -> None:
    """A recording reads as it was written, whatever stands between its blocks; they take less than a tenth of it."""
    path, session = tmp_path / "touch.mcap", nt.Session()
    recording = session.run(operator=[nt.Input(0.2, 0.0, 0.0, 0.5)])
    record.write(path, recording)
    again = record.read(path)
    assert all(np.array_equal(again.columns[name], recording.columns[name], equal_nan=True) for name in again.columns)
    assert sum(len(message.data) for _, _, message in messages_of(path)) < 0.1 * path.stat().st_size
