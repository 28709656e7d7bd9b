# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of sessions that went back: what was not taken back is replayed to the last bit."""

from __future__ import annotations

import time
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.touch.record import Recording, Writer

PUSH = nt.Input(1.0, 0.0, 0.0, 0.2)


def same(one: Recording, other: Recording) -> bool:
    return list(one.columns) == list(other.columns) and all(
        np.array_equal(values, other.columns[name], equal_nan=values.dtype.kind == "f")
        for name, values in one.columns.items()
    )


def recorded(path: Path, session: nt.Session) -> Writer:
    return Writer(path, session.metadata())


def test_what_was_not_taken_back_is_replayed(tmp_path: Path) -> None:
    """Requests at the very tick of the snapshot hold when they came before it, and do not when they came after."""
    session = nt.Session()
    with recorded(tmp_path / "a.mcap", session) as writer:
        writer.append(session.advance(0.3, PUSH))
        session.rescale(alpha_f=0.5 * session.settings.gains.alpha_f)
        kept = session.snapshot()
        session.clutch(True)
        writer.append(session.advance(0.2))
        session.restore(kept)
        writer.append(session.advance(0.1))
        session.set_mode("approach")
        writer.append(session.advance(0.1))
        session.restore(kept)
        writer.append(session.advance(0.4))
    recording = nt.record.read(tmp_path / "a.mcap")
    assert len(recording) == 11_000
    assert (np.diff(recording.time) < 0).sum() == 2
    assert [name for _, name, _ in recording.metadata["events"]].count("rewind") == 2
    line = recording.without_rewinds()
    assert [name for _, name, _ in line.metadata["events"]] == ["aim", "rescale"]
    assert np.array_equal(line.columns["time"], np.concatenate([recording.time[:3000], recording.time[7000:]]))
    again = recording.replay()
    assert same(again, line)
    assert same(line.replay(), line)
    other = line.metadata | {"events": line.metadata["events"][:1]}
    assert not same(Recording(line.columns, other).replay(), line)  # the rescale is felt


def test_a_session_goes_to_and_fro(tmp_path: Path) -> None:
    """Forwards, too: to a moment of a line that had been left."""
    session = nt.Session()
    begun = session.snapshot()
    with recorded(tmp_path / "a.mcap", session) as writer:
        writer.append(session.advance(0.2, PUSH))
        session.rescale(alpha_f=0.5 * session.settings.gains.alpha_f)
        writer.append(session.advance(0.1))
        far = session.snapshot()
        session.clutch(True)
        session.restore(begun)
        writer.append(session.advance(0.1, nt.Input(-0.2, 0.0, 0.0, 0.1)))
        session.restore(far)
        writer.append(session.advance(0.2))
    recording = nt.record.read(tmp_path / "a.mcap")
    line = recording.without_rewinds()
    assert np.array_equal(line.time, np.concatenate([recording.time[:3000], recording.time[4000:]]))
    assert [name for _, name, _ in line.metadata["events"]] == ["aim", "rescale"]
    assert same(recording.replay(), line)


def test_a_rewind_of_a_running_session_is_replayed() -> None:
    session = nt.Session()
    session.aim(PUSH)
    session.start("wall", 1.0)
    session.pause()
    session.step_on(6000)
    while session.progress.ticks < 6000:
        time.sleep(0.001)
    session.rewind(0.3)
    session.set_speed(1000.0)
    session.pause(False)
    while session.progress.runs:
        time.sleep(0.01)
    session.halt()
    blocks = []
    while len((block := session.read())["time"]):
        blocks.append(block)
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    recording = Recording(columns, session.metadata())
    assert len(recording) > 10_000
    assert (np.diff(recording.time) < 0).sum() == 1
    line = recording.without_rewinds()
    assert len(line) == 10_000
    assert same(recording.replay(), line)


def test_a_reset_begins_anew() -> None:
    """A run after it is replayed as the first one; the events of the life before it do not count."""
    session = nt.Session()
    first = session.run(1.0)
    session.clutch(True)
    session.reset()
    second = session.run(1.0)
    assert second.metadata["rewinds_before"] == 1
    assert same(second, first)
    assert same(second.replay(), second)
    assert same(first.replay(), first)


def test_a_snapshot_of_another_session_is_no_past() -> None:
    one, other = nt.Session(), nt.Session()
    one.advance(0.2, PUSH)
    other.restore(one.snapshot())
    with pytest.raises(InvalidValue, match="snapshot of another session"):
        other.run(1.0).replay()


@pytest.mark.parametrize(
    ("numbers", "words"),
    [([5.0], "older version"), ([5.0, 0.0, 1.0], "holds a rewind"), ([5.0, 2.0], r"number of events, 0 \.\. 1"),
     ([5.0, "x"], "holds a rewind"), ([5000.0, 0.0], "needs every tick")],
)  # fmt: skip
def test_rewinds_that_cannot_be_are_refused(numbers: list[object], words: str) -> None:
    recording = nt.Session().run(1.0)
    events = [*recording.metadata["events"][:1], [1000, "rewind", numbers]]
    with pytest.raises(InvalidValue, match=words):
        Recording(recording.columns, recording.metadata | {"events": events}).replay()


def test_requests_beyond_the_end_of_a_whole_recording_are_refused(tmp_path: Path) -> None:
    session = nt.Session()
    with recorded(tmp_path / "a.mcap", session) as writer:
        recording = session.run(1.0, writer=writer)
    for whole in (recording, nt.record.read(tmp_path / "a.mcap")):
        assert whole.metadata["rows"] == len(whole)
        late = whole.metadata | {"events": [*whole.metadata["events"], [len(whole) + 1, "clutch", [True]]]}
        with pytest.raises(InvalidValue, match=rf"tick {len(whole) + 1}, beyond its end"):
            Recording(whole.columns, late).replay()
        part = Recording(whole.columns, late)[: len(whole) // 2]
        assert same(part.replay(), part)  # a part may hold them
        at_end = whole.metadata | {"events": [*whole.metadata["events"], [len(whole), "clutch", [True]]]}
        assert same(Recording(whole.columns, at_end).replay(), whole)


def test_a_writer_that_leaves_rows_unread_calls_nothing_whole(tmp_path: Path) -> None:
    session = nt.Session()
    with recorded(tmp_path / "a.mcap", session) as writer:
        writer.append(session.advance(0.1, PUSH))
        session.core.advance(500)
        session.clutch(True)
    recording = nt.record.read(tmp_path / "a.mcap")
    assert "rows" not in recording.metadata
    assert same(recording.replay(), recording)


def test_a_python_half_has_no_hard_pace() -> None:
    class Still(nt.hal.Master):
        def read(self) -> nt.hal.Reading:
            return nt.hal.Reading(position=(np.nan, np.nan, 0.0))

    session = nt.Session(rig=nt.Rig(master={"motor": "no", "gauge": "no"}), master=Still(), preflight=False)
    with pytest.raises(nt.errors.Error, match="in Python runs at 'free' and 'wall' only"):
        session.start("hard")


def test_halves_describe_their_channels() -> None:
    session = nt.Session()
    master, slave = session.halves
    assert master.pushes
    assert master.feels
    assert slave.feels
    assert not (master.real)
    assert not (slave.real)
    assert not (slave.leads)
    deflection, motor = slave.channel("deflection"), master.channel("motor force z")
    assert (deflection.unit, deflection.driven, deflection.axis) == ("m", False, 2)
    rig = session.rig
    assert deflection.noise == pytest.approx(rig.probe.sensitivity * rig.probe.noise / 6.0)
    assert (motor.unit, motor.driven, motor.maximum, motor.safe) == ("N", True, rig.master.max_force, 0.0)
    with pytest.raises(InvalidValue, match=r"channel 'x': valid are deflection|stage"):
        slave.channel("x")
