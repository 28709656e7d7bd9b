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
from adversary_hand import Hand, changed, fastest
from adversary_judge import Judge
from nanotouch.errors import Error
from nanotouch.touch.hal import Action, Capabilities, Channel, Reading
from nanotouch.touch.operator import Input

DURATION = 0.2
"""of a run, in the session [s]"""


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


def in_thread(session: Any, hand: Hand, d: Dice, judge: Judge) -> None:
    """A while in its own thread, as fast as it goes, and back by a moment while it runs."""
    session.aim(hand.blow())
    session.start("free", duration=0.3)
    for _ in range(3):
        judge.watch(session.read(1000))
        with contextlib.suppress(Error):  # it has ended
            session.rewind(d.between(0.0, 0.2))
    session.halt()
    judge.watch(session.read(65536))


def assaulted(session: Any, hand: Hand, judge: Judge) -> None:
    """Lifted to where it is steepest, and struck there."""
    with contextlib.suppress(Error):  # not in this mode from here
        session.set_mode("point")
    session.arm(True)
    judge.clutched = True
    for opens in (True, False):  # nothing is owed to the hand after that
        session.clutch(opens)
        columns = session.advance(0.07 if opens else 0.005, hand.centre())
        judge.watch(columns)
        judge.clutched = False
    hand.follow(columns)
    for step in range(2):
        wait, blow = hand.assault()[step]
        columns = session.advance(wait, blow)
        judge.watch(columns)
        hand.follow(columns)


def held_still(session: Any, plot: Plot, d: Dice, judge: Judge) -> None:
    """A hand that presses with one force: does a ripple last, or grow?"""
    settings = session.settings
    x, y = session.path[0]
    press = Input(d.between(0.2, 0.7) * min(5.0, settings.gains.alpha_f * settings.limits.force), x, y, 0.05)
    judge.watch(session.advance(0.2, press))
    columns = session.advance(0.45, press)
    judge.watch(columns)
    if (columns["contact_radius"] > 0.0).all() and (columns["state"] == 0).all():
        judge.calm(session, lambda seconds: session.advance(seconds, press)["tip_force"], columns["tip_force"])


def fought(session: Any, plot: Plot, d: Dice, judge: Judge) -> None:
    """Blows, requests, and back to a moment before; what stops is armed again, but after a fault."""
    hand = Hand(session, plot, d)
    judge.promise(session)
    kept = [(session.snapshot(), False)]
    columns = session.advance(0.06, hand.down())
    judge.watch(columns)
    left = DURATION
    while left > 0.0:
        hand.follow(columns)
        if d.chance(0.15):
            with contextlib.suppress(Error):
                changed(session, d, judge)
            judge.promise(session)
        if d.chance(0.04):
            kept.append((session.snapshot(), judge.clutched))
        if d.chance(0.04):
            moment, clutched = d.one(kept)
            with contextlib.suppress(Error):  # what was changed since is not changed back
                session.restore(moment)
                judge.rewound(clutched)
            judge.promise(session)
        lasts = d.log(1e-3, 0.08)
        columns = session.advance(lasts, hand.blow())
        judge.watch(columns)
        left -= lasts
        if session.state in ("RETRACT", "LATCHED") and plot.fault is None:
            session.arm(True)
    if plot.fault is None and d.chance(0.8):
        assaulted(session, hand, judge)
    if d.chance(0.1):
        in_thread(session, hand, d, judge)
    elif plot.rig.master.axes == 1.0 and plot.fault is None and session.mode == "point" and d.chance(0.4):
        held_still(session, plot, d, judge)


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
    for _ in range(8):
        judge.watch(session.advance(0.04))
        if d.chance(0.3):
            with contextlib.suppress(Error):
                changed(session, d, judge)
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
    plot.scene["friction.shear_strength"], plot.scene["friction.coefficient"] = 0.0, 0.0
    judge.ground, judge.steepest = None, True  # of one slope everywhere
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
    left = 0.2
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
    stepped = plot.fault is not None or d.chance(0.8)
    try:
        host = Seen(subject, lambda message: None, stepped=stepped)
    except Error as error:
        raise Refused(str(error)) from error
    asks = ("move", "move", "wheel", "press", "press", "change", "undo", "redo", "arm", "stop")
    try:
        judge.promise(host.session)
        if plot.fault is not None:
            name, channel, at, duration, value = plot.fault
            host.session.inject(nt.Faults().add(name, channel, at=at, duration=duration, value=value))
        for _ in range(12):
            length = d.log(0.3e-9, 300e-9)
            asked = d.one(asks if stepped else (*asks, "rewind", "faster", "slower"))
            host.answer({
                "move": {"way": tuple(d.one((-1, 1)) * d.log(0.1, 1.0) * length for _ in range(3))},
                "wheel": {"steps": d.between(-5.0, 20.0)}, "press": {"on": d.chance(0.7)},
                "change": {"what": "scene", "field": "sample.youngs_modulus",
                           "value": float(host.session.scene.sample.youngs_modulus) * d.log(0.5, 2.0)},
            }.get(asked, {}) | {"do": asked})  # fmt: skip
            judge.promise(host.session)
            lasts = d.log(0.01, 0.06)
            if stepped:
                host.advance(lasts)
            else:
                time.sleep(lasts)
                host.tick()
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
