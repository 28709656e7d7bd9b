# SPDX-License-Identifier: BSD-3-Clause
"""The bridge to a controller that owns its z servo, against a mock that speaks Nanonis' TCP protocol: set points,
garbage, silence, losses. A touch: test_nanonis_touch.py."""

from __future__ import annotations

import io
import math
import threading
import time
from collections.abc import Iterator
from typing import Any

import nanotouch as nt
import pytest
from mock_nanonis import MANGLES, PIEZO, SURFACE, Controller
from nanotouch.errors import InvalidValue
from nanotouch_app.devices import nanonis, nanonis_watcher
from nanotouch_app.devices.nanonis_link import LinkError

PATIENCE = 20.0  # with a machine that is busy [s]
GUARD = 100e-9
NOBODY = nt.mailbox.Request(False, "RUN", 0, 0, (math.nan,) * 3, 0.0, 0.0, 0.0)


@pytest.fixture
def controller() -> Iterator[Controller]:
    made = Controller()
    yield made
    made.stop()


class Box:
    """A mailbox without a session: a test says what is asked."""

    def __init__(self) -> None:
        self.request = NOBODY
        self.readings: list[nt.hal.Reading] = []

    def ask(self) -> nt.mailbox.Request:
        return self.request

    def publish(self, reading: nt.hal.Reading) -> None:
        self.readings.append(reading)

    def now(self) -> int:
        return time.monotonic_ns()

    def want(self, travel: float, x: float = math.nan, y: float = math.nan) -> None:
        self.request = NOBODY._replace(is_armed=True, target=(x, y, travel))


def until(condition: Any) -> None:
    due = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < due
        time.sleep(2e-3)


class Running:
    """A bridge in a thread. `error` is what it ended with."""

    def __init__(self, controller: Controller, **more: Any) -> None:
        setup = {"guard": GUARD, "ports": (controller.port,), "patience": 0.3} | more
        self.bridge, self.box, self.error = nanonis.Bridge(nanonis.Setup(**setup)), Box(), ""
        self.bridge.connect()
        self.thread = threading.Thread(target=self._run)

    def _run(self) -> None:
        try:
            self.bridge.serve(self.box)  # type: ignore[arg-type]
        except LinkError as error:
            self.error = str(error)
        finally:
            self.bridge.rescue()

    def __enter__(self) -> Running:
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.bridge.stopped.set()
        self.thread.join(PATIENCE)
        assert not self.thread.is_alive()


def test_the_servo_goes_on_after_its_set_points_are_read_back(controller: Controller) -> None:
    with Running(controller) as run:
        run.box.want(50e-9)
        until(lambda: controller.tip.z == pytest.approx(-50e-9, abs=1e-12))
        told = [name for name, _ in controller.log if name.endswith(("Set", "LimitsGet", "SetpntGet"))][1:]
        assert told[:6] == ["ZCtrl.LimitsSet", "ZCtrl.SetpntSet", "ZCtrl.LimitsGet", "ZCtrl.SetpntGet",
                            "ZCtrl.OnOffSet", "ZCtrl.LimitsSet"]  # fmt: skip
        assert controller.tip.set_point == pytest.approx(GUARD)
        until(lambda: run.box.readings and run.box.readings[-1].position[2] == pytest.approx(50e-9, abs=1e-12))
    assert controller.count("ZCtrl.Withdraw") == 1  # at its end
    assert (controller.tip.high, controller.tip.low) == pytest.approx((0.9e-6, -0.9e-6))  # as the user had them


def test_the_guard_is_held_by_the_controller_and_its_range_by_us(controller: Controller) -> None:
    with Running(controller) as run:
        run.box.want(1.0)  # far beyond sample and range
        until(lambda: run.box.readings and run.box.readings[-1].felt[2] == pytest.approx(GUARD, rel=1e-3))
        time.sleep(0.05)
        assert min(values[1] for name, values in controller.log if name == "ZCtrl.LimitsSet") >= -0.9001e-6
        assert run.box.readings[-1].felt[2] <= GUARD + 10e-12


def test_three_axes(controller: Controller) -> None:
    with Running(controller, axes=3) as run:
        run.box.want(0.0, 1e-6, -2e-6)
        until(lambda: run.box.readings and run.box.readings[-1].position[:2] == (1e-6, -2e-6))


def test_a_session_that_ends_withdraws_once_and_another_may_come(controller: Controller) -> None:
    with Running(controller) as run:
        for number in (1, 2):
            run.box.want(10e-9)
            until(lambda: controller.tip.status == nanonis.ON)
            run.box.request = NOBODY
            until(lambda number=number: controller.count("ZCtrl.Withdraw") == number)
            until(
                lambda: controller.tip.z == PIEZO
            )  # above the limits: the next one comes down, to where it can draw back
    assert controller.count("ZCtrl.Withdraw") == 2
    assert max(values[1] for name, values in controller.log if name == "ZCtrl.LimitsSet") == pytest.approx(0.72e-6)


def test_travel_begins_where_the_tip_stands(controller: Controller) -> None:
    """Wherever that is: arming moves nothing."""
    controller.tip.z = 0.3e-6
    with Running(controller) as run:
        until(lambda: run.box.readings)
        run.box.want(0.0)
        until(lambda: controller.count("ZCtrl.OnOffSet"))
        until(lambda: controller.count("ZCtrl.StatusGet") > 3)
        assert controller.tip.z == pytest.approx(0.3e-6)
        assert max(abs(reading.position[2]) for reading in run.box.readings) < 1e-13
        run.box.want(20e-9)
        until(lambda: controller.tip.z == pytest.approx(0.28e-6))


@pytest.mark.parametrize(("what", "value"), [("limited", 0), ("low", -0.9e-6), ("set_point", 5e-6)])
def test_set_points_that_somebody_else_changes_withdraw(controller: Controller, what: str, value: float) -> None:
    with Running(controller) as run:
        run.box.want(10e-9)
        until(lambda: controller.tip.z == pytest.approx(-10e-9))
        controller.tip.move = lambda: setattr(controller.tip, what, value)  # type: ignore[method-assign]
        run.thread.join(PATIENCE)
        assert "the controller has z limits of" in run.error
    assert controller.count("ZCtrl.Withdraw") > 0


def test_what_was_asked_before_a_hang_is_not_done_after_it(controller: Controller) -> None:
    """The bridge stands still in a round, and the watcher withdraws and gives the limits back. The old request neither
    counts as somebody else's doing nor switches the servo on again."""
    with Running(controller, patience=0.1) as run:
        run.box.want(10e-9)
        until(lambda: controller.tip.z == pytest.approx(-10e-9))
        stale, asked = run.box.request, threading.Event()

        def hang() -> nt.mailbox.Request:
            asked.set()
            time.sleep(1.2 * nanonis.SILENCE * run.bridge.setup.patience)
            run.box.ask = lambda: NOBODY  # type: ignore[method-assign]
            return stale

        run.box.ask = hang  # type: ignore[method-assign]
        assert asked.wait(PATIENCE)
        controller.tip.low = -0.9e-6  # as a watcher does
        switched = controller.count("ZCtrl.OnOffSet")
        until(lambda: not run.bridge.is_ours)
        assert run.thread.is_alive()
        assert run.error == ""
        assert controller.count("ZCtrl.OnOffSet") == switched
        assert controller.count("ZCtrl.Withdraw") == 1


@pytest.mark.parametrize(("lag", "flags"), [(0.05, []), (60.0, ["emergency_stop"])])
def test_the_status_may_lag_behind_a_servo_that_goes_on(
    controller: Controller, lag: float, flags: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """But not for long."""
    monkeypatch.setattr(nanonis, "SETTLING", 1.0 if not flags else 0.02)
    controller.tip.lag = lag
    with Running(controller) as run:
        run.box.want(10e-9)
        until(lambda: flags or (controller.tip.z == pytest.approx(-10e-9) and run.bridge.settled == 0.0))
        until(lambda: run.box.readings and run.box.readings[-1].flags == flags)
    assert flags or not any(reading.flags for reading in run.box.readings)


def test_a_servo_that_somebody_else_switches_off_is_an_emergency_stop(controller: Controller) -> None:
    with Running(controller) as run:
        run.box.want(10e-9)
        until(lambda: controller.tip.status == nanonis.ON)
        controller.tip.status = 5  # safe tip
        until(lambda: run.box.readings and run.box.readings[-1].flags == ["emergency_stop"])


def test_no_number_is_no_zero(controller: Controller) -> None:
    with Running(controller) as run:
        controller.tip.z = math.inf
        until(lambda: run.box.readings and math.isnan(run.box.readings[-1].position[2]))
        assert math.isnan(run.box.readings[-1].felt[2]) or run.box.readings[-1].felt[2] >= 0.0


LOSSES = {"silent": ("mangle", MANGLES["silent"]), "half": ("mangle", MANGLES["half"]),
          "garbage": ("mangle", MANGLES["garbage"]), "closed": ("mangle", MANGLES["closed"]),
          "refused": ("refuse", {"ZCtrl.LimitsSet"}), "blind": ("refuse", {"Signals.ValGet"}),
          "dead": ("delay", 0.6)}  # fmt: skip


@pytest.mark.parametrize("loss", LOSSES)
def test_each_loss_in_a_touch_withdraws_until_it_is_acknowledged(controller: Controller, loss: str) -> None:
    with Running(controller) as run:
        run.box.want(150e-9)
        until(lambda: controller.tip.z < SURFACE)
        what, value = LOSSES[loss]
        before = getattr(controller, what)
        setattr(controller, what, value)
        until(lambda: controller.count("ZCtrl.Withdraw") > 0)  # blindly, or by a new connection
        until(lambda: run.bridge.counts["attempts"] > 0)
        published = len(run.box.readings)
        time.sleep(0.05)
        assert len(run.box.readings) == published  # nothing is made up
        setattr(controller, what, before)
        until(lambda: not run.bridge.is_ours)
        run.thread.join(PATIENCE)
    assert run.error
    assert run.bridge.counts["withdrawals"] == 1


def test_set_points_that_are_not_kept_switch_nothing_on(controller: Controller) -> None:
    controller.tip.move = lambda: setattr(controller.tip, "set_point", 0.0)  # type: ignore[method-assign]
    with Running(controller) as run:
        run.box.want(10e-9)
        run.thread.join(PATIENCE)
        assert "the controller has z limits of" in run.error
    assert controller.count("ZCtrl.OnOffSet") == 0
    assert controller.count("ZCtrl.Withdraw") > 0


def test_what_cannot_begin_is_told(controller: Controller, capsys: pytest.CaptureFixture[str]) -> None:
    port = ["--port", str(controller.port), "6502"]
    for arguments, words in [
        (["--signal", "Height (m)"], "this controller has Current (A)"),
        (["--signal", "Bias (V)"], "is not in m"),
        (["--guard-nm", "nan"], "guard-nm = nan: valid is 0.001 .. 100000"),
        (["--guard-nm", "-5"], "guard-nm = -5"),
        (["--period-ms", "0"], "period-ms = 0"),
        (["--timeout", "-1"], "timeout = -1: valid is 0.01 .. 60"),
        (["--scale", "1e-60"], "scale = 1e-60: valid is 1e-12 .. 1"),
        (["--port", "1", "2"], "no controller at 127.0.0.1:1"),
        (["--port", "1"], "port = 1: two are needed"),
    ]:
        assert nanonis.main(["a", "--guard-nm", "100", *port, *arguments]) == 2
        assert words in capsys.readouterr().err
    for what, value in (("low", 2e-6), ("limited", 0)):
        setattr(controller.tip, what, value)
        with pytest.raises(InvalidValue, match="z limits"):
            nanonis.Bridge(nanonis.Setup(GUARD, ports=(controller.port,))).connect()


def test_a_watcher_gives_up_after_a_while(
    controller: Controller, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(nanonis_watcher, "LONGEST", 0.3)
    monkeypatch.setattr(nanonis_watcher, "PAUSE", 0.01)
    controller.refuse = {"ZCtrl.Withdraw"}
    monkeypatch.setattr("sys.stdin", io.StringIO("free\nheld 1e-06 -1e-06\n"))
    nanonis_watcher.watch("127.0.0.1", [controller.port], 0.3)
    assert controller.count("ZCtrl.Withdraw") > 1
    assert "the tip may still touch" in capsys.readouterr().err
