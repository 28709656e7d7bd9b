# SPDX-License-Identifier: BSD-3-Clause
"""A guided calibration of a haptic device, some 30 s: keep it still in the middle, move it right, away and down, let
go. Then the device carries the handle and moves it slowly down and up; what that takes is weight and friction."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from nanotouch.errors import DeviceError
from nanotouch.touch import mailbox
from nanotouch.touch.hal import Reading
from numpy.typing import NDArray

from nanotouch_app.devices.bridge import PATIENCE, module_of
from nanotouch_app.devices.calibration import Calibration
from nanotouch_app.devices.table import Device

WAITS = 30.0  # for the person, at each step [s]
STILL, STILL_TIME = 1e-3, 0.6  # a handle is still that moves less than this, for so long [m], [s]
FAR = 0.02  # that the handle is to be moved [m]
SKEW = 15.0  # between a movement and the axis that is taken for it, at most [degree]
STIFFNESS, DAMPING, INTEGRAL = 80.0, 4.0, 160.0  # of what carries the handle [N/m], [N s/m], [N/(m s)]
CARRIES = 2.5  # at most [N]
RAN_AWAY = 0.03  # from where it was let go [m]
SWING, SPEED, SETTLES = 8e-3, 8e-3, 1.5  # of the movement down and up [m], [m/s], [s]
Floats = NDArray[np.float64]
Tell = Callable[[str], None]


class Bench:
    """The mailbox as a device sees it, with a law in place of a session."""

    def __init__(self, device: Device, option: str) -> None:
        module = module_of(device)
        self.title, self.trouble, self.error = device.title, "", ""
        self.axes = [2] if device.axes == 1 else [0, 1, 2]
        self.seen: deque[tuple[float, Floats]] = deque(maxlen=4096)
        self.law: Callable[[float, Floats], Floats] | None = None
        self.applied = np.zeros(3)
        self._stopped = threading.Event()

        def run() -> None:
            try:
                module.serve(self, option, self._stopped)
            except DeviceError as error:
                self.error = f"{device.title}: {error}. {device.needs}"

        self._thread = threading.Thread(target=run, daemon=True)
        self._thread.start()

    def publish(self, reading: Reading) -> None:
        """In the device's thread."""
        now, place = time.monotonic(), np.nan_to_num(np.asarray(reading.position, dtype=float))
        self.seen.append((now, place))
        self.applied = np.zeros(3) if self.law is None else self.law(now, place)

    def beat(self) -> None:
        """No reading: no force."""
        self.applied = np.zeros(3)

    def ask(self) -> mailbox.Request:
        """What the law wants."""
        x, y, z = self.applied
        return mailbox.Request(True, "RUN", 0, 0, (float(x), float(y), float(z)), 0.0, 0.0, 0.0)

    def check(self) -> None:
        """An error if the device is gone."""
        if self.error:
            raise DeviceError(self.error)

    def close(self) -> None:
        """No force any more."""
        self.law = None
        self._stopped.set()
        self._thread.join(PATIENCE)

    def still(self, condition: Callable[[Floats], bool], what: str) -> Floats:
        """The places of the last moment in which the handle was still, where it was wanted."""
        due = time.monotonic() + WAITS
        while True:
            self.check()
            now = time.monotonic()
            seen = list(self.seen)
            recent = np.array([place for moment, place in seen if now - moment < STILL_TIME])
            is_long = bool(seen) and now - seen[0][0] > STILL_TIME and len(recent) > 10
            if is_long and np.all(np.ptp(recent, axis=0) < STILL) and condition(recent.mean(axis=0)):
                return recent
            if now > due:
                raise DeviceError(f"{self.title}: {self.trouble or f'{WAITS:g} s have passed, and {what}'}")
            time.sleep(0.02)


def calibrate(device: Device, option: str, tell: Tell) -> Calibration:
    """Lead a person through it; :class:`DeviceError` in words where it comes to nothing."""
    bench = Bench(device, option)
    try:
        tell("hold the handle in the middle of where you want to work, and keep still")
        rest = bench.still(lambda _: True, "the handle was not still")
        centre = rest.mean(axis=0)
        axes = _axes(bench, centre, tell)
        tell("put it back to the middle, let go and keep your hands off: it moves down and up by itself")
        bench.still(lambda place: bool(np.linalg.norm(place - centre) < FAR), "the handle was not back in the middle")
        weight, friction = _carried(bench)
    finally:
        bench.close()
    noise = float(rest.std(axis=0).max())
    return Calibration(_vector(centre), tuple(_vector(row) for row in axes), _vector(weight), friction, noise)  # type: ignore[arg-type]


def _vector(given: Any) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in given)
    return x, y, z


def _axes(bench: Bench, centre: Floats, tell: Tell) -> Floats:
    """Unit vectors to the right, away and down: the perpendicular ones that are nearest to how it was moved."""
    moved = np.eye(3)
    words = {0: "to the right", 1: "away from you", 2: "down, towards the table"}
    if bench.axes == [2]:
        words = {2: "clockwise, or down"}
    for axis in bench.axes:
        tell(f"move it some {100 * FAR:.0f} to 5 cm {words[axis]}, and keep still")
        there = bench.still(lambda place: bool(np.linalg.norm(place - centre) > FAR), "the handle was not moved")
        way = there.mean(axis=0) - centre
        moved[axis] = way / np.linalg.norm(way)
        tell("back to the middle")
        bench.still(lambda place: bool(np.linalg.norm(place - centre) < 0.5 * FAR), "the handle was not put back")
    left, _, right = np.linalg.svd(moved)
    nearest: Floats = left @ right
    off = np.degrees(np.arccos(np.clip(np.sum(nearest * moved, axis=1), -1.0, 1.0)))
    if off.max() > SKEW:
        worst = words[int(np.argmax(off))]
        raise DeviceError(f"{bench.title}: the three movements are not perpendicular: {worst} is {off.max():.0f} "
                          f"degrees off, at most {SKEW:g} are taken. Calibrate again")  # fmt: skip
    if np.linalg.det(nearest) < 0.0 and len(bench.axes) == 3:
        raise DeviceError(f"{bench.title}: right, away and down are mirrored: was one of them the other way round? "
                          "Calibrate again")  # fmt: skip
    return nearest


class _Carry:
    """Holds the handle where it is let go, then moves it along ``down``: a spring, a damper, and what is left over."""

    def __init__(self, start: Floats, axes: list[int]) -> None:
        self.start, self.axes = start, axes
        self.begun = self.last = time.monotonic()
        self.place, self.speed, self.sum = start.copy(), np.zeros(3), np.zeros(3)
        self.rows: list[tuple[float, Floats]] = []
        self.wrong = ""

    def target(self, elapsed: float) -> tuple[float, float]:
        """How far down, and which way it goes."""
        t = elapsed - SETTLES
        quarter = SWING / SPEED
        if t < 0.0 or t > 4.0 * quarter:
            return 0.0, 0.0
        if t < quarter or t > 3.0 * quarter:
            return (SPEED * t if t < quarter else SPEED * t - 4.0 * SWING), 1.0
        return 2.0 * SWING - SPEED * t, -1.0

    @property
    def lasts(self) -> float:
        return SETTLES + 4.0 * SWING / SPEED

    def __call__(self, now: float, place: Floats) -> Floats:
        step = min(max(now - self.last, 1e-4), 0.05)
        self.last = now
        fresh = (place - self.place) / step
        self.speed += min(1.0, step / 0.01) * (fresh - self.speed)
        self.place = place.copy()
        if self.wrong or np.linalg.norm(place - self.start) > RAN_AWAY:
            self.wrong = (
                self.wrong or "the handle ran away: the device pushes by itself, or its force goes the other way"
            )
            return np.zeros(3)
        down, way = self.target(now - self.begun)
        wanted = self.start + np.array([0.0, 0.0, down])
        error = wanted - place
        self.sum += INTEGRAL * step * error
        force = STIFFNESS * error - DAMPING * (self.speed - np.array([0.0, 0.0, SPEED * way])) + self.sum
        force = np.where(np.isin(range(3), self.axes), force, 0.0)
        if np.linalg.norm(force) > CARRIES:
            self.wrong = f"more than {CARRIES:g} N are needed to carry the handle"
            return np.zeros(3)
        if way:
            self.rows.append((way, force))
        return force


def _carried(bench: Bench) -> tuple[Floats, float]:
    """Weight [N], as the force that carries the handle, and friction [N]."""
    start = bench.seen[-1][1]
    carry = _Carry(start, bench.axes)
    bench.law = carry
    while time.monotonic() - carry.begun < carry.lasts and not carry.wrong:
        bench.check()
        time.sleep(0.02)
    bench.law = None
    if carry.wrong:
        raise DeviceError(f"{bench.title}: {carry.wrong}. It carries nothing now; calibrate again, with your hands off")
    forces = {sense: np.array([force for s, force in carry.rows if s == sense]) for sense in (1.0, -1.0)}
    if min(map(len, forces.values())) < 20:
        raise DeviceError(f"{bench.title}: too few readings came while the handle was moved")
    down, up = (np.median(_late(forces[sense]), axis=0) for sense in (1.0, -1.0))
    return 0.5 * (down + up), float(max(0.0, 0.5 * (down - up)[2]))


def _late(rows: Floats) -> Floats:
    """Without the part after each turn."""
    return rows[math.floor(0.3 * len(rows)) :]


def words(found: Calibration) -> str:
    """What was found, in a line."""
    weight = float(np.linalg.norm(found.weight))
    return (f"the handle weighs {weight:.2f} N, which is carried; below {found.friction:.2f} N friction holds it; "
            f"noise {1e6 * found.noise:.0f} um")  # fmt: skip
