# SPDX-License-Identifier: BSD-3-Clause
"""Each haptic device's bridge against a mock of its maker's library: the same run for all of them."""

from __future__ import annotations

import importlib
import math
import os
import re
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from desks import KINDS, OnDesk, awaited, placed
from nanotouch_app.devices import bridge, calibration, guide, hand, launch, table
from nanotouch_app.live import device as live
from nanotouch_app.live.subject import of_preset
from nanotouch_app.main import main
from pages import MOTOR, visited

pytest.importorskip("aiohttp")


ALL = "NANOTOUCH_ALL_BRIDGES" in os.environ  # make heavy


@pytest.fixture(params=KINDS if ALL else KINDS[1:2], ids=lambda kind: kind.name)
def device(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[OnDesk]:
    with placed(request.param, tmp_path, monkeypatch) as found:
        yield found


def session_of(device: OnDesk, mailbox: str) -> nt.Session:
    return live.opened(of_preset("silicon_in_air"), table.named(device.kind.name), mailbox, recorded=False)


def test_the_whole_run(device: OnDesk) -> None:
    """Found, conforming, pressed and felt; silent, garbled and pulled out; killed: no force is left."""
    with launch.Launched(table.named(device.kind.name), device.option, timeout=0.5) as running:
        assert nt.hal.rehearse(nt.hal.Mailbox(running.name), period=0.05, duration=0.3).readings > 2
        session = session_of(device, running.name)
        session.start("wall")
        try:
            _is_felt(device, session)
            _garbage_and_silence(device, session)
            device.desk.present = 0.0  # pulled out, and in again
            awaited(lambda: session.state != "RUN", "HOLD without the device")
            device.desk.present = 1.0
            awaited(lambda: session.state == "RUN" and device.size > 0.3, "RUN with the device back")
            os.kill(running.process.pid, signal.SIGKILL)
            awaited(lambda: session.state == "LATCHED", "LATCHED without the bridge")
        finally:
            session.halt()
        assert "SIGKILL" in running.ended
    assert device.size == 0.0  # another bridge has let go of it


def _is_felt(device: OnDesk, session: nt.Session) -> None:
    """Down, and a force comes against the hand, along that axis."""
    awaited(lambda: session.state == "RUN", "RUN")
    assert device.size < 0.3
    distance = 0.0
    while device.pressed() > -0.5 and distance < 0.05:
        distance += 1e-4
        device.hold("down", distance)
        ticks = session.progress.ticks
        awaited(lambda ticks=ticks: session.progress.ticks > ticks + 200, "the session goes on")
        assert session.state in ("RUN", "HOLD"), session.reasons
    awaited(lambda: device.pressed() < -0.5, "a force against the hand")
    assert device.size <= table.named(device.kind.name).force + 0.01  # of the wheel: a step of its level


def _garbage_and_silence(device: OnDesk, session: nt.Session) -> None:
    """Neither moves anything: the force is gone, and comes back."""
    for what in ("garbage", "stall") if device.kind.name != "wheel" else ("stall",):
        if (what, device.kind.name) == ("stall", "forcedimension") or (what, device.kind.name) == ("stall", "wheel"):
            continue  # their libraries answer at once, whatever the device does
        setattr(device.desk, what, 1.0)
        awaited(lambda: session.state == "HOLD", f"HOLD with {what}")
        awaited(lambda: device.size == 0.0, f"no force with {what}")
        setattr(device.desk, what, 0.0)
        awaited(lambda: session.state == "RUN" and device.size > 0.3, f"RUN after {what}")


@pytest.fixture
def omega(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[OnDesk]:
    with placed(KINDS[1], tmp_path, monkeypatch) as found:
        yield found


def test_one_command_from_the_desk_to_a_recorded_force_watched_by_a_page(
    omega: OnDesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a display a page shows the force; Ctrl-C ends it, and the recording is whole."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    turned = calibration.Calibration(axes=((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), friction=0.1)
    monkeypatch.setattr(guide, "calibrate", lambda *_: turned)
    page, out = tmp_path / "page.html", tmp_path / "touch.mcap"
    page.write_bytes(b"<!doctype html><title>page</title>")
    said, seen, ended = [""], [], threading.Event()

    def links() -> list[str]:
        said[0] += capsys.readouterr().out
        return re.findall(r"http:\S+", said[0]) if "Ctrl-C ends the session.\n" in said[0] else []

    def hand() -> None:
        """Down by 1 cm/s until it is felt: the surface is 5 mm below where it was when the session began to push."""
        try:
            awaited(links, "the links")
            awaited(lambda: omega.size > 0.0, "the session runs")
            begun = time.monotonic()

            def taken(update: tuple[Any, ...]) -> bool:
                omega.hold("down", min(0.01 * (time.monotonic() - begun), 0.05))
                return bool(update[MOTOR] < -0.5)

            seen.extend(visited(links()[1], taken))
        finally:
            if not ended.wait(0.3):
                signal.raise_signal(signal.SIGINT)

    person = threading.Thread(target=hand)
    person.start()
    options = ["--record", str(out), "--calibrate", "--browser", "--page", str(page)]
    status = main(["live", "--hand", "forcedimension", *options])
    ended.set()
    person.join()
    captured = capsys.readouterr()
    told = said[0] + captured.out
    assert status == 128 + signal.SIGINT, captured.err
    assert "Force Dimension: leads the hand, at wall pace" in told
    assert "force on the hand at most 5 N" in told
    assert "below 0.10 N friction holds it" in told
    assert calibration.read(calibration.path_of("forcedimension")) == turned
    (seconds,) = re.findall(r"first force on the hand ([\d.]+) s after the command", told)
    assert float(seconds) < 60.0
    (world,) = [message for message in seen if message["tell"] == "world"]
    assert world["source"] == "watched: its program leads the hand"
    assert any(message["tell"] == "clock" and message["recorded"] for message in seen)
    recording = nt.record.read(out)
    assert "incomplete" not in recording.metadata
    assert recording.motor_force.min() < -0.3
    assert omega.size == 0.0


MISSING = [
    ("geomagic", None, "pyOpenHaptics is not installed .*pip install pyopenhaptics"),
    ("geomagic", "no SDK", "OpenHaptics is not found .libHD.so.* Touch Device Driver must be there"),
    ("geomagic", "unplugged", "no Touch opens under the name 'Default Device'"),
    ("forcedimension", None, "forcedimension_core is not installed .*pip install forcedimension-core"),
    ("forcedimension", "no SDK", "SDK is not found .*FDSDK names its folder"),
    ("forcedimension", "unplugged", "no Force Dimension device opens: no device found"),
    ("wheel", "unplugged", "no wheel, pad or joystick with constant forces is connected"),
    ("wheel", "denied", "Permission denied: is it yours to read and write .group input, or a udev rule"),
    ("inverse3", "no service", "nothing answers at ws://127.0.0.1:1. Haply's Inverse Service must run"),
]


@contextmanager
def _signals_kept() -> Iterator[None]:
    """A program's own answers to signals are not those of the tests that follow."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, answer in before.items():
            signal.signal(number, answer)


@pytest.mark.parametrize(("name", "what", "words"), MISSING, ids=lambda value: str(value)[:14])
def test_what_is_missing_is_said_in_words(
    name: str, what: str | None, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    row = table.named(name)
    for module in list(sys.modules):
        if module.split(".")[0] in ("pyOpenHaptics", "forcedimension_core", "evdev"):
            monkeypatch.delitem(sys.modules, module)
    if what is None:
        monkeypatch.setattr(bridge.importlib.util, "find_spec", lambda module: None)
    monkeypatch.setattr(bridge, "PATIENCE", 0.2)
    kind = next(kind for kind in KINDS if kind.name == ("wheel" if name == "inverse3" else name))
    with placed(kind, tmp_path, monkeypatch, present=float(what == "denied")):
        monkeypatch.setenv("NANOTOUCH_MOCK", what or "")
        with _signals_kept():
            option = "ws://127.0.0.1:1" * (name == "inverse3")
            assert bridge.main([name, f"missing-{os.getpid()}", "--option", option]) == 2
    said = capsys.readouterr().err.strip()
    assert "\n" not in said
    assert re.search(words, said), said
    assert row.title.split()[0] in said or what is None


def test_a_force_beyond_the_range_or_no_number_reaches_no_device() -> None:
    """Nor does a weight that is carried while nobody drives."""

    class Asks:
        is_armed, age = True, 0.0

        def now(self) -> int:
            return round(1e9 * self.age)

        def ask(self) -> nt.mailbox.Request:
            return nt.mailbox.Request(self.is_armed, "RUN", 0, 0, self.target, 0.0, 0.0, 0.0)

    asks = Asks()
    box = bridge.Box(asks, hand.capabilities(3, 1e-3, 0.2, 4.0))  # type: ignore[arg-type]
    for given, wanted in (
        ((1.0, -2.0, 3.0), (1.0, -2.0, 3.0)), ((1e9, -1e9, 0.0), (4.0, -4.0, 0.0)),
        ((math.nan, 1.0, 1.0), (0.0, 0.0, 0.0)), ((1.0, math.inf, 1.0), (0.0, 0.0, 0.0)),
    ):  # fmt: skip
        asks.target = given
        assert box.ask().target == wanted
    found = calibration.Calibration(weight=(0.0, 0.0, -0.9))
    heavy = bridge.Box(asks, hand.capabilities(3, 1e-3, 0.2, 4.0), found)  # type: ignore[arg-type]
    asks.target = (0.0, 0.0, -1.0)
    assert heavy.ask().target == (0.0, 0.0, -1.9)
    asks.target = (0.0, 0.0, -4.0)
    assert heavy.ask().target == (0.0, 0.0, -4.0)
    for age, share in ((0.03, 1.0), (0.055, 0.5), (0.08, 0.0), (10.0, 0.0)):  # a session that hangs
        asks.age, asks.target = age, (1.0, 0.0, -2.0)
        assert box.ask().target == pytest.approx((share, 0.0, -2.0 * share), abs=1e-6)
    asks.age = 0.0
    asks.is_armed, asks.target = False, (0.0, 0.0, 0.0)
    assert heavy.ask().target == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("has", [True, False])
def test_a_wheel_is_not_pulled_to_its_middle_and_plays_the_force_that_is_asked(
    has: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its driver begins with a spring of its own, and another program has left a gain."""
    with placed(KINDS[3], tmp_path, monkeypatch, autocenter=1.0, gain=0.4) as wheel:
        evdev = importlib.import_module("evdev")
        if not has:
            monkeypatch.setattr(evdev, "TUNED", [])
        found = importlib.import_module("nanotouch_app.devices.wheel").Wheel("")
        found.push((0.0, 0.0, 2.0))
        assert wheel.pressed() == pytest.approx(2.0 if has else 0.8, abs=0.01)
        assert wheel.desk.autocenter == (0.0 if has else 1.0)
        found.close()


def test_touch_says_what_a_script_leads_and_what_the_hand(
    omega: OnDesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It refused "operator_force = 0.2 N: valid is 0 .. 0 N"."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    options = ["--no-window", "--no-pictures", "--duration", "0.3s", "--out", str(tmp_path / "out")]
    assert main(["touch", "--hand", "forcedimension", *options]) == 0, capsys.readouterr().err
    said = capsys.readouterr().out
    assert "your hand leads the tip, down and up; the script leads nothing" in said
    rows = nt.record.read(tmp_path / "out" / "recording.mcap")
    assert len(rows.time) > 1000
    assert np.all(np.isnan(rows.operator_force))  # it has no gauge
    assert omega.size == 0.0


def test_a_script_that_pushes_a_device_is_refused_in_words(omega: OnDesk) -> None:
    with launch.Launched(table.named("forcedimension")) as running:
        session = session_of(omega, running.name)
        with pytest.raises(nt.Error, match=r"a device, which a hand leads .x and y of the tip may be scripted"):
            session.run(operator=[nt.Input(0.2, 0.0, 0.0, 0.1)])


@pytest.mark.skipif(not ALL, reason="make heavy runs it")
def test_a_bridge_that_hangs_is_ended_and_leaves_no_force(
    omega: OnDesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Stopped in the middle of a press, without the firmware's watchdog."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    begun: list[launch.Launched] = []
    plain = launch.Launched.__init__

    def noted(self: launch.Launched, *args: Any, **options: Any) -> None:
        plain(self, *args, **options)
        begun.append(self)

    monkeypatch.setattr(launch.Launched, "__init__", noted)

    def hand() -> None:
        start = time.monotonic()
        while omega.pressed() > -0.5 and (elapsed := time.monotonic() - start) < 20.0:
            omega.hold("down", 0.01 * elapsed)
            omega.desk.watchdog = 0.0
            time.sleep(0.01)
        os.kill(begun[0].process.pid, signal.SIGSTOP)

    person = threading.Timer(1.0, hand)
    person.start()
    assert main(["live", "--hand", "forcedimension"]) == 2
    person.join()
    assert "does not answer any more; its force is gone" in capsys.readouterr().err
    assert omega.size == 0.0
