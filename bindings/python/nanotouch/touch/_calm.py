# SPDX-License-Identifier: BSD-3-Clause
"""What the hand feels of a loop that is stable: ripple, ringing, a stage too slow for its steps (docs/margins.md)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from nanotouch import _core
from nanotouch.scene import Rig, Settings

CLEARLY_FELT = float(_core.CLEARLY_FELT)
"""a force at the hand that nobody misses [N]: well above the 0.02 N that the paper's gauge resolves"""
RINGING_MOST = float(_core.RINGING_MOST)
"""a contact that answers a slow oscillation of the hand with more than so many times its force rings"""
SOURCES = (
    ("steps of the master", "master.resolution", "m", "gains.alpha_p"),
    ("steps of the stage's command", "stage.command_resolution", "m", "gains.alpha_f"),
    ("steps and noise of the stage's read-out", "stage.resolution", "m", "gains.alpha_f"),
    ("noise and steps of the probe", "probe.noise", "V", "gains.alpha_f"),
    ("noise and steps of the hand's gauge", "master.gauge_noise", "N", "gains.force_gain"),
)
"""of the ripple: words, the field of the rig behind it, its unit, and the gain that lowers it"""


class Calm(NamedTuple):
    """What is felt of the loop itself, pressing at rest on the stiffest contact; ``str()`` is a sentence."""

    ripple: float
    """of the force at the hand, peak to peak: steps and noise (6 sigma) through the loop [N]"""
    parts: tuple[float, ...]
    """of it, in the order of ``SOURCES`` [N]"""
    felt: float
    """ripple from which the loop is not calm: CLEARLY_FELT, or a quarter of what the force limit leaves the hand [N]"""
    ringing: float
    """largest force at the contact over that of a hand that oscillates"""
    slewing: float
    """R1's margin, counting the time in which the stage answers one step of the master"""
    least: float
    """felt over ripple, RINGING_MOST over ringing, or slewing over 1.5, the smallest; calm at 1 and above"""
    rule: str
    """which one: ripple, ringing, slewing"""
    change: str
    """what would calm it, in words; empty where nothing need be changed"""

    @property
    def is_calm(self) -> bool:
        """Whether nothing of the loop itself is clearly felt."""
        return self.least >= 1.0

    def facts(self) -> dict[str, float | str]:
        """All numbers in one flat dict, for a file; each part under the name of the field that causes it."""
        facts: dict[str, float | str] = {name: value for name, value in self._asdict().items() if name != "parts"}
        return facts | {f"ripple of {source[1]}": part for source, part in zip(SOURCES, self.parts, strict=True)}

    def __str__(self) -> str:
        if math.isnan(self.least):
            return "not known: the loop is not linear, or too late to be told"
        what = f"a ripple of {self.ripple:.2g} N at the hand ({self.felt:.2g} N are felt), ringing {self.ringing:.2g}"
        if self.is_calm:
            return f"calm: {what} ({RINGING_MOST:g} is felt)"
        return f"NOT CALM: {_felt(self)}; {self.change}"


def _felt(found: Calm) -> str:
    """What the hand notices."""
    if found.rule == "ripple":
        worst = SOURCES[max(range(len(SOURCES)), key=lambda i: found.parts[i])][0]
        return (
            f"the force at the hand ripples by {found.ripple:.2g} N at rest ({found.felt:.2g} N are clearly "
            f"felt), mostly {worst}"
        )
    if found.rule == "ringing":
        return f"the contact rings, {found.ringing:.2g} times the force of the hand ({RINGING_MOST:g} is felt)"
    return (
        "the stage takes too long for one step of the master (limits.stage_speed): with that the margin is "
        f"{found.slewing:.2g}, where 1.5 is needed"
    )


def calm(rig: Rig, settings: Settings, contact_stiffness: float) -> Calm:
    """What is felt of a loop in touch at a contact stiffness k [N/m], and which gain would calm it."""
    rig.check()
    settings.check()
    found = Calm(**_core.calm(rig.core, settings.core, contact_stiffness), change="")
    if not found.least < 1.0:
        return found
    return found._replace(change=_change(found, rig, settings, contact_stiffness))


def _change(found: Calm, rig: Rig, settings: Settings, contact_stiffness: float) -> str:
    """Which gain, and to what: the one that the worst part scales with, else the other ones."""
    _, field, unit, first = SOURCES[max(range(len(SOURCES)), key=lambda i: found.parts[i])]
    gains = [first] if found.rule == "ripple" else []
    for gain in dict.fromkeys([*gains, "gains.alpha_p", "gains.alpha_f"]):
        value = _calming(gain, rig, settings, contact_stiffness)
        if value is not None:
            return f"{gain} = {value:.2g} instead of {settings[gain]:.3g} would be calm"
    return f"a finer {field} than {rig[field]:.3g} {unit}"


def _calming(gain: str, rig: Rig, settings: Settings, contact_stiffness: float) -> float | None:
    """The largest value of a gain below its own at which the loop is calm; None down to a thousandth."""
    trial, own = settings.copy(), float(settings[gain])

    def is_calm(share: float) -> bool:
        trial[gain] = share * own
        facts: dict[str, Any] = _core.calm(rig.core, trial.core, contact_stiffness)
        return float(facts["least"]) >= 1.02  # as printed, rounded

    low, high = 1e-3, 1.0
    if not is_calm(low):
        return None
    for _ in range(12):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if is_calm(middle) else (low, middle)
    return low * own
