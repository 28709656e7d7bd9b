# SPDX-License-Identifier: BSD-3-Clause
"""The guided calibration of a haptic device, led by a test in place of a person: it finds what the mock was given."""

from __future__ import annotations

import json
import math
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from desks import KINDS, OnDesk, placed
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch_app.devices import calibration, guide, table

SHORT = {"STILL_TIME": 0.05, "SETTLES": 0.6, "SWING": 4e-3, "SPEED": 16e-3, "WAITS": 5.0}
MIDDLE = {"right": 0.01, "away": -0.02, "down": 0.015}  # where the person wants to work [m]


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in SHORT.items():
        monkeypatch.setattr(guide, name, value)


@pytest.fixture
def omega(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[OnDesk]:
    """A handle of 0.9 N, with 0.12 N of friction; it stands askew by 10 degrees about its vertical."""
    monkeypatch.delitem(__import__("sys").modules, "forcedimension_core", raising=False)
    for module in [name for name in __import__("sys").modules if name.startswith("forcedimension_core")]:
        monkeypatch.delitem(__import__("sys").modules, module)
    with placed(KINDS[1], tmp_path, monkeypatch, gz=-0.9, friction=0.12, stiffness=2000.0, damping=30.0) as found:
        yield found


def person(device: OnDesk, turned: float = 0.0, wrong: str = "") -> Callable[[str], None]:
    """Does what is said, ``turned`` by an angle about the vertical."""
    c, s = math.cos(turned), math.sin(turned)

    def to(right: float, away: float, down: float) -> None:
        places = {"right": c * right - s * away, "away": s * right + c * away, "down": down}
        for axis, distance in places.items():
            device.hold(axis, MIDDLE[axis] + distance)

    def follow(said: str) -> None:
        device.desk.stiffness = 0.0 if "let go" in said else 2000.0
        device.desk.damping = 0.5 if "let go" in said else 30.0
        if "to the right" in said:
            to(0.03 * (1 - 2 * (wrong == "mirrored")), 0.0, 0.0)
        elif "away from you" in said:
            to(0.03 * (wrong == "skew"), 0.03, 0.0)
        elif "down, towards" in said:
            to(0.0, 0.0, 0.03)
        elif "let go" in said:
            device.desk.stiffness = 0.0
        else:
            to(0.0, 0.0, 0.0)
        if "let go" not in said:
            time.sleep(0.15)

    return follow


def test_it_finds_what_there_is(omega: OnDesk, tmp_path: Path) -> None:
    """Centre and axes from where it was held, to what friction hides of it; weight and friction to 0.05 N."""
    turned = math.radians(10.0)
    found = guide.calibrate(table.named("forcedimension"), "", person(omega, turned))
    assert found.centre == pytest.approx([MIDDLE["right"], MIDDLE["away"], MIDDLE["down"]], abs=7e-4)
    right = found.axes[0]
    assert math.degrees(math.atan2(right[1], right[0])) == pytest.approx(10.0, abs=2.0)
    assert found.weight == pytest.approx([0.0, 0.0, -0.9], abs=0.13)  # x and y stick anywhere within the friction
    assert found.weight[2] == pytest.approx(-0.9, abs=0.05)
    assert found.friction == pytest.approx(0.12, abs=0.05)
    path = tmp_path / "hand.json"
    calibration.write(path, found)
    assert calibration.read(path) == found
    assert omega.size == 0.0


@pytest.mark.parametrize(
    ("wrong", "words"), [("mirrored", "are mirrored"), ("skew", "not perpendicular: .* degrees off")]
)
def test_wrong_movements_are_refused(omega: OnDesk, wrong: str, words: str) -> None:
    with pytest.raises(DeviceError, match=words):
        guide.calibrate(table.named("forcedimension"), "", person(omega, wrong=wrong))
    assert omega.size == 0.0


def test_a_device_that_pushes_by_itself_is_let_go(omega: OnDesk) -> None:
    def push(said: str) -> None:
        person(omega)(said)
        omega.desk.px = 4.0 * ("let go" in said)

    with pytest.raises(DeviceError, match=r"ran away|N are needed to carry"):
        guide.calibrate(table.named("forcedimension"), "", push)
    assert omega.size == 0.0


def test_a_place_and_a_force_are_turned_the_same_way() -> None:
    """Power is the same on both sides: f . v, but for the weight that is carried."""
    angle = 0.3
    c, s = math.cos(angle), math.sin(angle)
    found = calibration.Calibration((0.1, 0.2, 0.3), ((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0)), (0.0, 0.0, -0.5))
    rng = np.random.default_rng(1)
    for _ in range(20):
        place, step, force = rng.normal(size=(3, 3))
        moved = np.subtract(found.place(place + step), found.place(place))
        given = np.subtract(found.force(force), found.weight)
        assert np.dot(moved, force) == pytest.approx(np.dot(step, given))
    assert found.place(found.centre) == pytest.approx((0.0, 0.0, 0.0))
    x, y, z = calibration.Calibration((0.0, 0.0, 0.1)).place((math.nan, math.nan, 0.3))
    assert math.isnan(x)
    assert math.isnan(y)
    assert z == pytest.approx(0.2)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[1]",
        '{"centre": [0, 0], "axes": []}',
        json.dumps(
            {
                "centre": [0, 0, 0],
                "axes": [[1, 1, 0], [0, 1, 0], [0, 0, 1]],
                "weight": [0, 0, 0],
                "friction": 0,
                "noise": 0,
            }
        ),
    ],
)
def test_a_file_that_is_no_calibration_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "hand.json"
    path.write_text(text)
    with pytest.raises(InvalidValue, match=re.escape(str(path))):
        calibration.read(path)
