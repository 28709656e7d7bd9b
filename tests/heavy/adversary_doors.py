# SPDX-License-Identifier: BSD-3-Clause
"""How people enter, and what an adversary does there (adversary.py): a session in Python, the host of ``nanotouch
live``, a master or a slave written in Python, a mailbox of another program."""

from __future__ import annotations

import contextlib
import math
import os
import threading
import time
from typing import Any

import nanotouch as nt
import numpy as np
from adversary_draws import Dice, Plot
from adversary_judge import Judge
from nanotouch.errors import Error
from nanotouch.touch.hal import Action, Capabilities, Channel, Reading
from nanotouch.touch.operator import Hold, Input

DURATION = 0.5
"""of a run, in the session [s]"""
FASTEST = 1.0
"""of a hand, where its master declares nothing [m/s]"""
MODES = ("point", "point", "scan", "topography", "approach", "curve")


def fastest(rig: nt.Rig) -> float:
    """Speed of a hand that the rig is made for [m/s]."""
    return float(getattr(rig.master, "max_speed", FASTEST))


class Refused(Exception):
    """Not opened: nothing is promised."""


def opened(plot: Plot, **own: Any) -> nt.Session:
    """Armed as a person would: at the default margin, with less of alpha_f where that is refused."""
    faults = nt.Faults()
    if plot.fault is not None:
        name, channel, at, duration, value = plot.fault
        faults.add(name, channel, at=at, duration=duration, value=value)
    if faults:
        own["faults"] = faults
    for _ in range(6):
        try:
            return nt.Session(plot.scene, plot.rig, surface=plot.surface, settings=plot.settings, seed=plot.seed + 1,
                              clearance=plot.clearance, **own)  # fmt: skip
        except Error as error:
            why = str(error)
            if "margin" not in why:
                break
            plot.settings.gains.alpha_f *= 0.2
    raise Refused(why)


class Hand:
    """Blows of any force, or any way, as fast as a hand goes."""

    def __init__(self, session: Any, plot: Plot, d: Dice) -> None:
        self.session, self.plot, self.d = session, plot, d
        self.at = np.array([0.0, 0.0, float(session.core.master_start)])
        self.presses, self.roams = d.between(0.3, 1.0), d.between(0.0, 1.0)  # shares of its blows
        self.tip, self.steep = np.zeros(2), None
        if plot.surface is not None:
            heights, pixel = plot.surface.topography.heights, plot.surface.topography.pixel_size
            slope = np.hypot(*np.gradient(heights, pixel[1], pixel[0]))
            row, column = np.unravel_index(int(np.argmax(slope)), slope.shape)
            self.steep = np.array([column * pixel[0], row * pixel[1]])

    def follow(self, columns: Any) -> None:
        """Where the master is now."""
        if len(columns["time"]):
            sideways = [columns[name][-1] if name in columns else 0.0 for name in ("master_x", "master_y")]
            at = np.array([*sideways, columns["master_position"][-1]])
            self.at = np.where(np.isfinite(at), at, self.at)
            self.tip = np.array([columns["x"][-1], columns["y"][-1]])

    def place(self) -> tuple[float, float]:
        """Where an input leads the tip: with a master of three axes nowhere."""
        d, surface = self.d, self.plot.surface
        if self.plot.rig.stage.axes == 1.0 or not d.chance(self.roams):
            return math.nan, math.nan
        if surface is None:
            return d.between(-1e-6, 1e-6), d.between(-1e-6, 1e-6)
        if self.steep is not None and d.chance(0.5):
            return float(self.steep[0]), float(self.steep[1])
        return d.between(0.0, surface.size[0]), d.between(0.0, surface.size[1])

    def down(self) -> Hold:
        """The first: the tip comes near, or lands."""
        alpha = self.session.settings.gains.alpha_p
        to = self.at + np.array([0.0, 0.0, self.d.between(0.7, 1.3) * self.plot.clearance / alpha])
        end = 0.49 * self.plot.rig.master.travel
        to[2] = min(to[2], end)
        return Hold(self._axes(to), math.nan, math.nan, self.d.log(5e-3, 0.05))

    def _axes(self, to: Any) -> Any:
        return tuple(map(float, to)) if self.plot.rig.master.axes == 3.0 else float(to[2])

    def blow(self) -> Input | Hold:
        d, gains = self.d, self.session.settings.gains
        three = self.plot.rig.master.axes == 3.0
        x, y = self.place()
        if d.chance(0.5):
            full = min(8.0, gains.alpha_f * self.session.settings.limits.force)
            push = (d.log(0.3, 3.0) if d.chance(self.presses) else -d.between(0.0, 1.0)) * full
            side = [d.between(-6.0, 6.0) * self.roams if three else 0.0 for _ in range(2)]
            return Input((*side, push), x, y, d.log(1e-4, 0.05))  # type: ignore[arg-type]
        down = 1.0 if d.chance(self.presses) else -1.0
        way = np.array([d.one((-1, 1)) * d.log(1e-9, 400e-9) if three and d.chance(self.roams) else 0.0
                        for _ in range(2)] + [down * d.log(1e-9, 200e-9)]) / gains.alpha_p  # fmt: skip
        if three and self.steep is not None and d.chance(0.4):
            way[:2] = (self.steep - self.tip) / gains.alpha_p
        end = 0.49 * self.plot.rig.master.travel
        to = np.clip(self.at + way, -end, end)
        quickest = float(np.linalg.norm(to - self.at)) / fastest(self.plot.rig)
        return Hold(self._axes(to), x, y, quickest * d.log(1.0, 30.0))


def changed(session: Any, d: Dice) -> None:
    """One request of a person; what is refused stays."""
    scene, settings = session.scene, session.settings
    share = d.log(0.5, 2.0)
    what = d.one(("scene", "settings", "mode", "scale", "clutch", "stop"))
    if what == "scene":
        field = d.one(("sample.youngs_modulus", "adhesion.work_of_adhesion", "medium.relative_humidity",
                       "friction.shear_strength", "friction.coefficient"))  # fmt: skip
        value = d.between(0.0, 0.8) if field == "medium.relative_humidity" else float(scene[field]) * share
        session.change("scene", field, value)
    elif what == "settings":
        field = d.one(("limits.force", "limits.stage_speed", "limits.lateral_speed", "limits.lateral_force",
                       "limits.indentation", "gains.set_point", "limits.motor_force", "gains.force_gain"))  # fmt: skip
        session.change("settings", field, float(settings[field]) * share)
    elif what == "mode":
        session.set_mode(d.one(MODES))
    elif what == "scale":
        session.rescale(settings.gains.alpha_p * share, settings.gains.alpha_f * d.log(0.5, 2.0))
    elif what == "clutch":
        session.clutch(d.chance(0.5))
    else:
        session.emergency_stop(True)
        session.emergency_stop(False)


def fought(session: Any, plot: Plot, d: Dice, judge: Judge) -> None:
    """Blows, requests, and back to a moment before; what stops is armed again, but after a fault."""
    hand = Hand(session, plot, d)
    judge.promise(session)
    begun = session.snapshot()
    columns = session.advance(0.06, hand.down())
    judge.watch(columns)
    left = DURATION
    while left > 0.0:
        hand.follow(columns)
        if d.chance(0.15):
            with contextlib.suppress(Error):
                changed(session, d)
            judge.promise(session)
        if d.chance(0.03):
            try:
                session.restore(begun)
                judge.promise(session)
            except Error:  # what was changed since is not changed back
                pass
        lasts = d.log(1e-3, 0.08)
        columns = session.advance(lasts, hand.blow())
        judge.watch(columns)
        left -= lasts
        if session.state in ("RETRACT", "LATCHED") and plot.fault is None:
            session.arm(True)


def by_session(plot: Plot, d: Dice, judge: Judge) -> None:
    """As in a notebook."""
    fought(opened(plot, mode="point"), plot, d, judge)


class Moved(nt.hal.Master):
    """A device that is led by its person, with motors; now and then a reading of it is bad."""

    def __init__(self, plot: Plot, d: Dice) -> None:
        super().__init__()
        self.axes, self.end, self.d = int(plot.rig.master.axes), 0.45 * plot.rig.master.travel, d
        self.at, self.to, self.speed, self.bad = np.zeros(3), np.zeros(3), 0.1, 0
        self.at[2] = self.to[2] = -0.4 * plot.rig.master.travel
        self.force = float(plot.rig.master.max_force)
        self.period = 1.0 / float(plot.settings.gains.rate)
        self.scale, self.fastest = float(plot.settings.gains.alpha_p), fastest(plot.rig)

    def describe(self) -> Capabilities:
        axes = range(3) if self.axes == 3 else (2,)
        names = {0: "x", 1: "y", 2: "z"}
        rows = [Channel(f"position {names[a]}", "m", axis=a, minimum=-1.0, maximum=1.0) for a in axes]
        most = {"minimum": -self.force, "maximum": self.force, "safe": 0.0}
        rows += [Channel(f"force {names[a]}", "N", driven=True, axis=a, **most) for a in axes]
        return Capabilities(axes=self.axes, pushes=True, channels=rows)

    def read(self) -> Reading:
        way = self.to - self.at
        length = float(np.linalg.norm(way))
        if length < 1e-12:
            lead = np.array([self.d.one((-1, 1)) * self.d.log(1e-9, 300e-9) for _ in range(3)]) / self.scale
            lead[:2] *= self.axes == 3
            self.to = np.clip(self.at + lead, -self.end, self.end)
            self.speed = self.d.log(1e-3, 1.0) * self.fastest
            self.bad = int(self.d.log(1.0, 100.0)) if self.d.chance(0.02) else 0
        else:
            self.at = self.at + way * min(1.0, self.speed * self.period / length)
        self.bad -= self.bad > 0
        z = math.nan if self.bad else self.at[2]
        return Reading(position=(self.at[0], self.at[1], z) if self.axes == 3 else (math.nan, math.nan, z))

    def write(self, action: Action) -> None:
        """The hand holds it."""


def by_master(plot: Plot, d: Dice, judge: Judge) -> None:
    """A master of one's own on the simulated slave."""
    plot.rig["master.gauge"] = "no"
    plot.settings.gains.force_gain = 0.0
    session = opened(plot, master=Moved(plot, d))
    judge.promise(session)
    for _ in range(12):
        judge.watch(session.advance(0.04))
        if d.chance(0.3):
            with contextlib.suppress(Error):
                changed(session, d)
            judge.promise(session)
        if session.state in ("RETRACT", "LATCHED"):
            session.arm(True)


class Spring(nt.hal.Slave):
    """A stage that is there at once, a lever at rest, and the plan's own law on a plane of a slope along x."""

    def __init__(self, plot: Plot, slope: float, plan: nt.Plan) -> None:
        gaps = np.linspace(30e-9, -150e-9, 6000)
        law = np.maximum(plan.force(gaps, "approach"), 0.0)
        self.k, self.lateral = float(plot.rig.probe.spring_constant), float(plot.rig.probe.lateral_stiffness)
        self.bases, self.law = (gaps - law / self.k)[::-1], law[::-1]
        self.slope, self.start, self.sigma = slope, plot.clearance, 1e-12
        self.at, self.random = (0.0, 0.0, 0.0), np.random.default_rng(plot.seed)
        self.force: list[float] = []

    def describe(self) -> Capabilities:
        return Capabilities(axes=3, feels=True)

    def read(self) -> Reading:
        x, _, travel = self.at
        force = float(np.interp(self.start - travel - self.slope * x, self.bases, self.law))
        self.force.append(force)
        noise = self.sigma * self.random.standard_normal(3)
        sides = -self.slope * force / self.lateral if self.lateral > 0.0 else math.nan
        return Reading(position=self.at, felt=(sides + noise[0], noise[1], force / self.k + noise[2]))

    def write(self, action: Action) -> None:
        self.at = tuple(now if math.isnan(to) else to for to, now in zip(action.target, self.at, strict=True))


def by_slave(plot: Plot, d: Dice, judge: Judge) -> None:
    """A slave of one's own, led by the simulated hand; its sample is the declared one, a plane through the start."""
    slope = d.log(0.05, 1.5) if d.chance(0.5) else 0.0
    plot.rig["stage.axes"], plot.scene["adhesion.work_of_adhesion"] = 3, 0.0
    plot.scene["adhesion.hamaker_constant"], plot.scene["medium.relative_humidity"] = 0.0, 0.0
    x = np.arange(24) * 200e-9
    flat = np.tile(slope * x, (24, 1))
    plot.surface = nt.Surface(nt.Topography(flat, (200e-9, 200e-9)))
    slave = Spring(plot, slope, plot.scene.plan())
    middle = 0.5 * plot.surface.size[0]
    slave.at = (middle, middle, 0.0)
    slave.start += slope * middle
    session = opened(plot, slave=slave)
    judge.promise(session)
    hand = Hand(session, plot, d)
    begun, ticks = len(slave.force), 0
    columns = session.advance(0.06, hand.down())
    left = 0.3
    while left > 0.0:
        hand.follow(columns)
        lasts = d.log(1e-3, 0.05)
        columns = session.advance(lasts, hand.blow())
        left -= lasts
        truth = np.array(slave.force[begun + ticks :])[-len(columns["time"]) :]
        nothing = np.zeros(len(truth))
        judge.watch({**columns, "tip_force": truth, "tip_force_x": -slope * truth, "tip_force_y": nothing,
                     "contact_radius": np.where(truth > 0.0, 1.0, 0.0)})  # fmt: skip
        if session.state in ("RETRACT", "LATCHED"):
            session.arm(True)


def by_live(plot: Plot, d: Dice, judge: Judge) -> None:
    """The host of ``nanotouch live``: a mouse of three axes, sliders, undo, stop; its own rig and settings."""
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import Subject

    class Seen(Host):
        """Keeps what happens."""

        def _keeps(self, scene: nt.Scene) -> bool:
            return True

        def _drain(self) -> None:
            while len((block := self.session.read(5000))["time"]):
                judge.watch(block)

    heights = np.zeros((SMALL, SMALL)) if plot.surface is None else plot.surface.topography.heights
    pixel = (10e-9, 10e-9) if plot.surface is None else plot.surface.topography.pixel_size
    subject = Subject("adversary", "", plot.scene, plot.rig, nt.Topography(heights, pixel))
    try:
        host = Seen(subject, lambda message: None, stepped=True)
    except Error as error:
        raise Refused(str(error)) from error
    try:
        judge.promise(host.session)
        if plot.fault is not None:
            name, channel, at, duration, value = plot.fault
            host.session.inject(nt.Faults().add(name, channel, at=at, duration=duration, value=value))
        for _ in range(25):
            length = d.log(0.3e-9, 300e-9)
            asked = d.one(("move", "move", "wheel", "press", "press", "change", "undo", "redo", "arm", "stop"))
            host.answer({
                "move": {"way": tuple(d.one((-1, 1)) * d.log(0.1, 1.0) * length for _ in range(3))},
                "wheel": {"steps": d.between(-5.0, 20.0)}, "press": {"on": d.chance(0.7)},
                "change": {"what": "scene", "field": "sample.youngs_modulus",
                           "value": float(host.session.scene.sample.youngs_modulus) * d.log(0.5, 2.0)},
            }.get(asked, {}) | {"do": asked})  # fmt: skip
            judge.promise(host.session)
            host.advance(d.log(0.01, 0.06))
    finally:
        host.close()


SMALL = 16


def by_mailbox(plot: Plot, d: Dice, judge: Judge) -> None:
    """A program of its own at 1 kHz leads the simulated slave, in real time."""
    plot.rig["master.gauge"] = "no"
    plot.settings.gains.force_gain, plot.settings.gains.rate, plot.rig["master.rate"] = 0.0, 2e3, 1e3
    name, ends = f"adversary-{os.getpid()}-{plot.seed}", threading.Event()
    axes = int(plot.rig.master.axes)
    hand = Moved(plot, d)
    hand.period = 1e-3

    def lead() -> None:
        with nt.mailbox.Device(name, hand.describe()._replace(period=1e-3), timeout=1.0) as device:
            ready.set()
            while not ends.is_set():
                device.ask()
                reading = hand.read()
                device.publish(reading if axes == 3 else reading._replace(position=(math.nan, math.nan, hand.at[2])))
                time.sleep(1e-3)

    ready = threading.Event()
    program = threading.Thread(target=lead)
    program.start()
    try:
        ready.wait(5.0)
        session = opened(plot, master=nt.hal.Mailbox(name))
        judge.promise(session)
        try:
            session.start("wall")
        except Error:
            session.start("hard")
        for _ in range(8):
            time.sleep(0.05)
            judge.watch(session.read(65536))
            if session.state in ("RETRACT", "LATCHED"):
                session.arm(True)
        session.halt()
        judge.watch(session.read(65536))
    finally:
        ends.set()
        program.join()


DOORS = {"session": by_session, "live": by_live, "master": by_master, "slave": by_slave, "mailbox": by_mailbox}
