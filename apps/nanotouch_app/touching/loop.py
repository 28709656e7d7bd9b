# SPDX-License-Identifier: BSD-3-Clause
"""Options that say how the loop is closed, common to ``touch`` and ``margins``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch import margins, record
from nanotouch.touch.margins import ForceRange
from nanotouch.touch.session import CONTROLS, choose_control

from nanotouch_app.common.quantity import parse_quantity


def add_options(group: Any) -> None:
    """The rate, the law, the delay and what the forces are scaled for."""
    group.add_argument(
        "--rate", metavar="FREQUENCY", help="of the force loop, as 5kHz (default: that of the scene, or 10kHz)"
    )
    group.add_argument(
        "--control", choices=CONTROLS, default="default", help="control law; paper: Eq. 16-17 as printed; impedance: "
        "for a master without force sensor (default: %(default)s)"
    )  # fmt: skip
    group.add_argument("--delay", metavar="TIME", help="of the link between hand and probe, as 1ms (default: none)")
    group.add_argument(
        "--force-range", metavar="RANGE", help="forces on the tip that fill the hand's range (alpha_f by the paper's "
        "Eq. 19): 'plan' for pull-off to force limit, the recording.mcap of a test touch, or LOW,HIGH with an equals "
        "sign, --force-range=-20nN,500nN (default: the sample's pull-off is 0.3 N at the hand, where 'plan' allows it)"
    )  # fmt: skip


def rate_of(text: str | None) -> float | None:
    """[Hz]"""
    return None if text is None else parse_quantity(text, "Hz")


def delay_of(text: str | None) -> float:
    """[s]"""
    delay = 0.0 if text is None else parse_quantity(text, "s")
    if delay < 0.0:
        raise nt.errors.InvalidValue(f"--delay {text}: it must be a time of 0 s or more")
    return delay


def scale_force(text: str | None, plan: nt.Plan, rig: nt.Rig, settings: nt.Settings) -> None:
    """Let alpha_f follow ``--force-range``."""
    if text is not None:
        settings.gains.alpha_f = margins.heuristic_alpha_f(rig, _force_range(text, plan, settings))


def says_scale(tables: dict[str, Any], text: str | None) -> bool:
    """Whether file or option say how forces are scaled."""
    return text is not None or any(key.startswith("alpha_f_N") for key in tables.get("gains", {}))


def _force_range(text: str, plan: nt.Plan, settings: nt.Settings) -> ForceRange:
    if text == "plan":
        return margins.force_range(plan, settings.limits.force)
    if Path(text).suffix == ".mcap":
        return margins.force_range(record.read(text))
    low, comma, high = text.partition(",")
    if not comma:
        raise nt.errors.InvalidValue(f"--force-range {text}: write plan, a recording.mcap, or LOW,HIGH as -20nN,500nN")
    return ForceRange(parse_quantity(low, "N"), parse_quantity(high, "N"))


def close(settings: nt.Settings, args: Any) -> None:
    """Law, rate and delay into the settings."""
    rate = rate_of(args.rate)
    if rate is not None:
        settings["gains.rate"] = rate
    settings["gains.delay"] = settings.gains.delay + delay_of(args.delay) * settings.gains.rate
    choose_control(settings, args.control)
