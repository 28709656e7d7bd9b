# SPDX-License-Identifier: BSD-3-Clause
"""What a session refuses, and in which words: calls from its own halves, assignments, foreign snapshots, options that
nothing would heed."""

from __future__ import annotations

import copy
import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import DeviceError, Error, InvalidValue
from nanotouch.touch.operator import Hold

NO_MOTOR = {"motor": "no", "gauge": "no"}


class Still(nt.hal.Master):
    """Stays where it is, and calls something in its 200th read."""

    def __init__(self, call: Callable[[], object] | None = None) -> None:
        self.call, self.reads, self.said = call, 0, ""

    def describe(self) -> nt.hal.Capabilities:
        return nt.hal.Capabilities()

    def read(self) -> nt.hal.Reading:
        self.reads += 1
        if self.reads == 200 and self.call is not None:
            try:
                self.call()
            except Error as error:
                self.said = str(error)
        return nt.hal.Reading(position=(math.nan, math.nan, 0.0))

    def write(self, action: nt.hal.Action) -> None:
        """Nothing moves."""


CALLS: dict[str, Callable[[nt.Session], object]] = {
    "advance": lambda s: s.advance(0.01),
    "step": lambda s: s.step(),
    "change": lambda s: s.change("settings", "gains.force_gain", 1.0),
    "rescale": lambda s: s.rescale(alpha_f=1e6),
    "set_mode": lambda s: s.set_mode("curve"),
    "clutch": lambda s: s.clutch(),
    "arm": lambda s: s.arm(),
    "start": lambda s: s.start("free", 0.01),
    "halt": lambda s: s.halt(),
    "snapshot": lambda s: s.snapshot(),
    "metadata": lambda s: s.metadata(),
    "publish": lambda s: s.publish(),
}


@pytest.mark.parametrize("pace", ["", "free", "wall"])
@pytest.mark.parametrize("name", CALLS)
def test_a_half_cannot_ask_the_session_that_calls_it(name: str, pace: str) -> None:
    master = Still()
    session = nt.Session(rig=nt.Rig(master=NO_MOTOR), master=master, preflight=False)
    master.call = lambda: CALLS[name](session)
    if pace:
        session.start(pace, 0.06)  # type: ignore[arg-type]
        while session.progress.runs:
            pass
        session.halt()
    else:
        session.advance(0.06)
    assert "the session that is calling it" in master.said
    assert session.progress.ticks == 600


def test_margins_and_settings_are_those_that_run() -> None:
    session = nt.Session()
    alpha_f = session.settings.gains.alpha_f
    session.rescale(alpha_f=8.0 * alpha_f)
    assert session.settings.gains.alpha_f == 8.0 * alpha_f
    assert session.margins() == nt.Session(gains={"alpha_f": 8.0 * alpha_f}).margins()
    session.change("settings", "gains.force_gain", 2.5)
    assert session.margins() == nt.Session(gains={"alpha_f": 8.0 * alpha_f, "force_gain": 2.5}).margins()
    session = nt.Session()
    session.set_mode("topography")
    assert session.mode == "topography"
    assert session.stability_margin == nt.Session(mode="topography").stability_margin
    assert session.metadata()["mode"] == "point"  # what it was opened with


@pytest.mark.parametrize("rate", [1e-3, 1e-6, 1e-9])
def test_a_master_that_hardly_ever_measures_is_refused_at_once(rate: float) -> None:
    with pytest.raises(InvalidValue, match="stability margin"):
        nt.Session(rig=nt.Rig(master={"rate": rate}))


def test_snapshots_of_other_sessions_name_what_differs() -> None:
    kept = nt.Session(seed=1).snapshot()
    for options, words in (
        ({"seed": 2}, "seed = 1"),
        ({"relative_accuracy": 0.05}, "relative_accuracy"),
        ({"mode": "curve"}, "mode"),
    ):
        with pytest.raises(Error, match=words):
            nt.Session(**options).restore(kept)  # type: ignore[arg-type]


@pytest.mark.parametrize("bad", [math.nan, 1.0, 1e300])
def test_a_master_of_three_axes_is_judged_sideways(bad: float) -> None:
    class Jumps(Still):
        def describe(self) -> nt.hal.Capabilities:
            return nt.hal.Capabilities(axes=3)

        def read(self) -> nt.hal.Reading:
            self.reads += 1
            return nt.hal.Reading(position=(bad if self.reads > 3000 else 0.0, 0.0, 0.0))

    session = nt.Session(rig=nt.Rig(master={**NO_MOTOR, "axes": 3}), master=Jumps())
    columns = session.advance(0.2)
    first = int(np.argmax(columns["state"] != 0))
    assert list(columns["state"][first : first + 2]) == [1, 2]
    assert columns["reasons"][first] == 1
    assert np.ptp(columns["x"]) == 0.0


def test_a_pause_takes_back_steps_that_wait() -> None:
    session = nt.Session(recorded=False)
    session.start("wall")
    session.pause()
    session.step_on(10**8)
    while session.progress.ticks < 1000:
        pass
    session.pause()
    left = session.progress.ticks
    while session.progress.ticks == left and session.step_on(1) is None:
        pass
    assert session.progress.ticks < left + 10**6  # what was granted before is gone
    session.halt()


def test_an_open_session_is_changed_by_its_calls_alone() -> None:
    session = nt.Session()
    for name, words in {
        "scene": "session.change", "settings": "rescale", "mode": "set_mode", "seed": "another one", "path": "another",
        "minimum_margin": "another one",
    }.items():  # fmt: skip
        with pytest.raises(AttributeError, match=words):
            setattr(session, name, None)
    with pytest.raises(AttributeError):
        del session.scene.core
    with pytest.raises(AttributeError):
        session.path.append((1e-6, 1e-6))  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match="restore"):
        copy.deepcopy(session)
    session.change("scene", "sample.youngs_modulus", 5e9)
    assert session.scene.sample.youngs_modulus == 5e9


class Spring(nt.hal.Slave):
    """A stage in free air."""

    reads, travel = 0, (0.0, 0.0, 0.0)

    def read(self) -> nt.hal.Reading:
        self.reads += 1
        return nt.hal.Reading(position=self.travel, felt=(math.nan, math.nan, 1e-10 * math.sin(1.7 * self.reads)))

    def write(self, action: nt.hal.Action) -> None:
        self.travel = action.target


@pytest.mark.parametrize("hand", [None, nt.Input(-0.1, 0.0, 0.0, 1.0)])
def test_steps_that_nobody_reads_end_with_what_to_do(hand: nt.Input | None) -> None:
    session, steps = nt.Session(), 4096 if hand else 65536
    for _ in range(steps):
        session.step(hand)
    with pytest.raises(Error, match=r"read\(\) now and then, or open the session with recorded=False"):
        session.step(hand)
    assert len(session.read(100_000)["time"]) == steps  # none is lost
    session.step(hand)  # and it goes on
    assert session.progress.ticks == steps + 1
    unread = nt.Session(recorded=False)
    for _ in range(steps + 1000):
        unread.step(hand)


REFUSED: list[tuple[Callable[[], object], str]] = [
    (lambda: nt.Session(slave=Spring(), faults=nt.Faults().add("nan", "deflection", at=0.01)), "half that is not"),
    (lambda: nt.Session(slave=Spring()).inject(nt.Faults().add("nan", "deflection", at=0.01)), "half that is not"),
    (lambda: nt.Session(slave=Spring(), probe_model="dynamic"), "probe_model with a slave"),
    (lambda: nt.Session(slave=Spring(), substep=0.1), "substep where"),
    (lambda: nt.Session(substep=0.1, probe_model="quasi-static"), "substep where"),
    (lambda: nt.Session(substep=1e-9, probe_model="dynamic"), "substep = 1e-09 rad: valid is"),
    (lambda: nt.Session(recorded="x"), "recorded = 'x': valid are"),  # type: ignore[arg-type]
    (lambda: nt.Session(preflight="x"), "preflight = 'x': valid are"),  # type: ignore[arg-type]
    (lambda: nt.Session().aim(Hold((5e-3, 5e-3, 0.0), 0.0, 0.0, 0.0)), "input along x of a master of one axis = 0.005"),
    (lambda: nt.Session().aim(Hold((0.0, 1e-3), 0.0, 0.0, 0.0)), "three of them"),  # type: ignore[arg-type]
    (lambda: nt.Session().aim(nt.Input("a", 0.0, 0.0, 0.0)), "operator_force = 'a'"),  # type: ignore[arg-type]
    (lambda: nt.Session().step(nt.Input(math.nan, 0.0, 0.0, 0.0)), "operator_force = nan N"),
    (lambda: nt.Session().change("settings", "gains.rate", 5000.0), "gains.rate = 5000 Hz: valid is 10000 .. 10000 Hz"),
    (lambda: nt.Session().change("settings", "gains.alpha_p", 1e-5), "session.rescale"),
    (lambda: nt.Session().change("scene", "nope", 1.0), "no field 'nope'"),
    (lambda: nt.Session().rescale(alpha_f=0.0), "alpha_f = 0 N/N: valid is 0.001"),
    (lambda: nt.Session().rewind(0.1), "does not run"),
    (lambda: nt.Session().read(-1), "rows = -1: valid is 0 or more"),
    (lambda: nt.Session().advance(1e300), "duration = 1e"),
    (lambda: nt.Session().start("free", 1e300), "duration = 1e"),
    (lambda: nt.Session().publish("a b"), "letters, digits"),
    (lambda: nt.Session(faults=nt.Faults().add("emergency-stop", at=None)), "emergency stop before arming"),
    (lambda: nt.Session().publish("a\0b"), "letters, digits"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_refusals_say_what_is_valid(call: Callable[[], object], words: str) -> None:
    with pytest.raises(Error) as caught:
        call()
    assert words in str(caught.value)


def test_backends_are_judged_alike_by_session_and_rehearsal() -> None:
    class Wrong(Still):
        def __init__(self, channel: nt.hal.Channel) -> None:
            super().__init__()
            self.channel = channel

        def describe(self) -> nt.hal.Capabilities:
            return nt.hal.Capabilities(channels=[self.channel])

    wrong: list[dict[str, Any]] = [{"unit": "mm"}, {"name": ""}, {"axis": 7}, {"minimum": 1.0, "maximum": -1.0},
                                   {"latency": -1.0}, {"latency": math.inf}]  # fmt: skip
    for entries in wrong:
        channel = nt.hal.Channel(**{"name": "p", "unit": "m", **entries})
        said = []
        for judge in (lambda m: nt.Session(rig=nt.Rig(master=NO_MOTOR), master=m), nt.hal.rehearse):
            with pytest.raises(InvalidValue) as caught:
                judge(Wrong(channel))
            said.append(str(caught.value).split(": ", 1)[1])
        assert said[0] == said[1]
    with pytest.raises(TypeError, match="None is neither"):
        nt.hal.rehearse(None)  # type: ignore[arg-type]


def test_a_session_that_has_ended_is_not_attached_to() -> None:
    name = f"killed-{os.getpid()}"
    code = f"import nanotouch as nt, time; s = nt.Session(); s.publish({name!r}); print(flush=True); time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        child.stdout.readline()
        nt.frames.attach(name).close()
        child.kill()
    with pytest.raises(DeviceError):
        nt.frames.attach(name)
    session = nt.Session()
    session.publish(name)  # what was left over goes
    client = nt.commands.attach(name)
    del session
    with pytest.raises(Error):
        client.lease()


def test_requests_of_clients_are_numbers() -> None:
    name = f"clutch-{os.getpid()}"
    session = nt.Session()
    session.publish(name)
    with nt.commands.attach(name) as client:
        client.lease()
        asked = client.post(5, 0, (math.nan, 0.0, 0.0, 0.0))  # a clutch neither open nor closed
        session.advance(0.001)
        assert client.poll(asked).status != 0
    assert session.metadata()["events"] == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_forked_copy_cannot_write_what_its_parent_shows() -> None:
    name = f"forked-{os.getpid()}"
    code = f"""if True:
        import nanotouch as nt, os, gc
        s = nt.Session(); s.publish({name!r}); o = nt.frames.attach({name!r}); s.advance(0.01)
        child = os.fork()
        if child == 0:
            try: s.advance(0.05)
            except nt.errors.Error: code = 7
            else: code = 0
            del s; gc.collect(); os._exit(code)
        ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        print(ended, int(o.newest()["sequence"]), o.alive, os.path.exists("/dev/shm/nanotouch.frames." + {name!r}))
    """
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout.split() == ["7", "99", "True", "True"], done.stderr


def test_a_writer_keeps_up_with_what_is_asked(tmp_path: Path) -> None:
    session = nt.Session()
    with nt.record.Writer(tmp_path / "a.mcap", session.metadata()) as writer:
        writer.append(session.advance(0.2, nt.Input(1.0, 0.0, 0.0, 0.1)))
        session.change("settings", "gains.force_gain", 4.0)
        writer.append(session.advance(0.2))
    recording = nt.record.read(tmp_path / "a.mcap")
    assert [event[1] for event in recording.metadata["events"]] == ["aim", "setting"]
    assert np.array_equal(recording.replay().motor_force, recording.motor_force)
    moved = recording.metadata | {"events": [[-1, "clutch", [True]]]}
    with pytest.raises(InvalidValue, match="tick -1: valid is 0 or more"):
        nt.record.Recording(recording.columns, moved).replay()
