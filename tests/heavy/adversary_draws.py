# SPDX-License-Identifier: BSD-3-Clause
"""What an adversary draws for a run (adversary.py): scene, surface, rig, settings, one fault; nothing of it is a
default of the library but what is left out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.touch.faults import KINDS
from nanotouch.touch.session import settings_for_path

SIZE = 40
"""pixels of a relief along x and y"""
DOORS = ("session", "session", "session", "live", "master", "slave", "mailbox")
"""how a person enters; a mailbox runs in real time, so it is drawn less often (``Dice.door``)"""
HARMLESS = {"stale", "dropout", "late", "clock", "push", "emergency-stop", "limit-switch", "device-lost", "clock-drift"}
"""faults that are no failure of the force bound (docs/safety.md), whatever their channel"""


@dataclass
class Dice:
    """Random numbers of one seed."""

    random: np.random.Generator

    def log(self, low: float, high: float) -> float:
        """Evenly over the decades."""
        return float(np.exp(self.random.uniform(math.log(low), math.log(high))))

    def between(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def chance(self, share: float) -> bool:
        return bool(self.random.random() < share)

    def one(self, choices: Any) -> Any:
        return choices[int(self.random.integers(len(choices)))]

    @property
    def door(self) -> str:
        found = self.one(DOORS)
        return "session" if found == "mailbox" and self.chance(0.8) else found


@dataclass
class Plot:
    """One run, before it is opened."""

    seed: int
    door: str
    scene: nt.Scene
    rig: nt.Rig
    surface: nt.Surface | None
    settings: nt.Settings
    clearance: float
    fault: Any
    """(name, channel, at, duration, value) or None"""

    @property
    def leads(self) -> bool:
        """Whether a hand of three axes leads the tip over a relief."""
        return self.rig.master.axes == 3.0 and self.rig.stage.axes == 3.0 and self.surface is not None

    @property
    def kind(self) -> str:
        """Of rig, for the tightness of the bound."""
        if self.door in ("live", "slave", "mailbox"):
            return self.door
        if self.surface is None:
            return "flat"
        return "three axes" if self.leads else "one axis" if self.rig.stage.axes == 1.0 else "inputs"


def scene_of(d: Dice) -> nt.Scene:
    """Polymers to ceramics, sharp to blunt, dry or humid; half of them rub."""
    work = d.log(1e-4, 0.1)
    scene = nt.Scene(
        sample={"youngs_modulus": d.log(1e9, 3e11), "poisson_ratio": d.between(0.2, 0.45)},
        tip={"radius": d.log(8e-9, 100e-9)},
        medium={"relative_humidity": 0.0 if d.chance(0.6) else d.between(0.1, 0.8)},
        adhesion={"work_of_adhesion": work, "hamaker_constant": min(1e-18, 37.7 * (0.16e-9) ** 2 * work)},
    )
    if d.chance(0.5):
        scene["friction.shear_strength"] = d.log(1e6, 200e6)
        scene["friction.coefficient"] = 0.0 if d.chance(0.3) else d.between(0.02, 0.6)
    return scene


def relief_of(d: Dice, radius: float) -> nt.Surface:
    """A plane, ridges, waves or steps: slopes of 0.05 to 2.5."""
    pitch, slope, kind = d.log(4e-9, 30e-9), d.log(0.05, 2.5), d.one(("plane", "ridges", "waves", "steps"))
    y, x = np.mgrid[0:SIZE, 0:SIZE] * pitch
    turn, period = d.between(0.0, 2.0 * math.pi), d.between(6.0, 20.0) * pitch
    along = x * math.cos(turn) + y * math.sin(turn)
    heights = {
        "plane": slope * along,
        "ridges": slope * period * np.abs((along / period) % 1.0 - 0.5),
        "waves": slope * period / 9.0 * (np.sin(2 * math.pi * along / period) + np.cos(3.7 * y / period + turn)),
        "steps": slope * pitch * np.floor(2.0 * along / period),
    }[kind]
    tip = {"tip_radius": radius} if d.chance(0.7) else {}
    return nt.Surface(nt.Topography(heights, (pitch, pitch)), **tip)


def rig_of(d: Dice) -> nt.Rig:
    """Half of them have a master of three axes."""
    spring = d.log(0.2, 40.0)
    three = d.chance(0.5)
    stage = {"resonance": d.log(300.0, 3000.0), "quality": d.log(2.0, 30.0), "axes": 1 if d.chance(0.15) else 3}
    master = {"axes": 3 if three else 1, "mass": d.log(0.03, 0.3), "damping": d.log(3.0, 60.0)}
    if d.chance(0.2):
        master |= {"gauge": "no"}
    probe = {"spring_constant": spring, "resonance": 40e3 * spring**0.4, "noise": d.log(1e-3, 3e-2)}
    if d.chance(0.7):
        probe["lateral_stiffness"] = d.log(5.0, 300.0)
    return nt.Rig(probe=probe, stage=stage, master=master)


def _allowed(settings: nt.Settings, rig: nt.Rig) -> float:
    """Speed at which the lever takes up the force limit while loop and stage react, as a person chooses it [m/s]."""
    reacts = 4.0 / settings.gains.rate + 0.6 / rig.stage.resonance
    return float(np.clip(settings.limits.force / rig.probe.spring_constant / reacts, 1e-8, 1e-3))


def settings_of(d: Dice, scene: nt.Scene, rig: nt.Rig, surface: nt.Surface | None) -> nt.Settings:
    """Any limits that the rig can keep; scales as a session would choose them, and others."""
    relief = 0.0 if surface is None else float(np.ptp(surface.topography.heights))
    settings = settings_for_path(rig, relief, load=float(scene.range.maximum_load))
    settings.limits.force *= d.log(0.1, 1.0)
    settings.gains.set_point = d.between(0.1, 0.9) * settings.limits.force
    settings.gains.rate = d.one((2e3, 5e3, 10e3))
    settings.limits.stage_speed = min(d.log(0.1, 1.0) * _allowed(settings, rig), rig.stage.max_speed)
    settings.limits.lateral_speed = d.log(0.1, 2.0) * _allowed(settings, rig)
    if d.chance(0.2):  # whatever follows
        settings.limits.stage_speed = min(d.log(1e-6, 60e-6), rig.stage.max_speed)
        settings.limits.lateral_speed = d.log(1e-6, 300e-6)
    settings.limits.lateral_force = d.log(20e-9, 2e-6)
    settings.limits.indentation = d.log(2e-9, 300e-9)
    settings.gains.force_gain = 0.0 if rig.master.gauge == 0.0 else d.between(0.0, 3.0)
    settings.gains.alpha_p *= d.log(0.3, 10.0)
    settings.gains.alpha_f *= d.log(0.01, 2.0)
    return settings


def fault_of(d: Dice, plot: Plot) -> tuple[str, str, float, float, float | None]:
    """Of random kind, channel, time and value. Over a relief those alone for which a number is printed there."""
    pairs = [(name, channel) for name, kind in KINDS.items() for channel in kind.channels
             if plot.surface is None or name in HARMLESS or channel in ("master_position", "operator_force", "motor")
             ]  # fmt: skip
    name, channel = d.one(pairs)
    sign = d.one((-1.0, 1.0))
    value = {
        "noise": d.log(1.0, 300.0), "jump": sign * d.between(0.0, plot.rig.stage.slip), "late": d.log(0.1, 100.0),
        "clock": sign * d.log(1e-5, 1e3), "limit": d.log(1e-9, 300e-9), "hysteresis": d.between(0.0, 0.4),
        "gain": d.between(0.0, 1.0) if d.chance(0.5) else sign * d.log(0.01, 20.0), "push": d.between(-8.0, 8.0),
        "drift": sign * d.log(1e-9, 10.0 if channel == "operator_force" else 5e-6), "power": -d.log(1e-7, 1e-5),
        "clock-drift": sign * d.log(1e-7, 0.1),
        "slip": sign * d.log(1e-10, 1e-3 if channel == "master_position" else 1e-5),
    }.get(name)  # fmt: skip
    runs = name == "gain" and channel == "stage"  # one that ends would jump back, which is not covered
    duration = math.inf if runs or d.chance(0.5) else d.log(1e-4, 0.5)
    return name, channel, d.between(0.02, 0.4), duration, value


def plot_of(seed: int, door: str = "") -> Plot:
    """The run of a seed."""
    d = Dice(np.random.default_rng(seed))
    scene, rig = scene_of(d), rig_of(d)
    entered = door or d.door
    relief = d.chance(0.8 if rig.master.axes == 3.0 else 0.4)
    surface = relief_of(d, float(scene.tip.radius)) if relief else None
    settings = settings_of(d, scene, rig, surface)
    clearance = min(d.log(5e-9, 60e-9), max(4e-9, 0.04 * float(settings.limits.stage_speed)))  # it lands in time
    plot = Plot(seed, entered, scene, rig, surface, settings, clearance, None)
    if entered in ("session", "live") and d.chance(0.35):
        plot.fault = fault_of(d, plot)
    return plot
