# SPDX-License-Identifier: BSD-3-Clause
"""What a touch came to: the numbers of summary.json, and the same in words."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import margins
from nanotouch.plots import adhesion
from nanotouch.touch.options import INDENTATION_RANGE
from nanotouch.touch.record import STATES, Recording
from nanotouch.touch.session import REASONS

SERVOED = ("approach", "curve")
"""modes in which the stage does not follow the hand"""


def summarise(session: nt.Session, recording: Recording) -> dict[str, Any]:
    """The numbers, SI; null where there is none (no snap-in above the noise, no retraction); ``incomplete`` is why the
    recording ended before it was to."""
    seen = adhesion(recording)
    alpha_f = session.settings.gains.alpha_f
    pull_off = _number(seen.pull_off_force)
    return {
        "surface": session.surface.topography.name if session.surface else "flat",
        "mode": session.mode,
        "models": str(session.plan).splitlines(),
        "snap_in_force_N": _number(seen.snap_in_force),
        "pull_off_force_N": pull_off,
        "hand_snap_in_force_N": None if math.isnan(seen.snap_in_force) else alpha_f * seen.snap_in_force,
        "hand_pull_off_force_N": None if pull_off is None else alpha_f * pull_off,
        "planned_pull_off_force_N": session.plan.pull_off_force,
        "largest_force_N": float(np.max(recording.tip_force)),
        "largest_sideways_force_N": _sideways(recording),
        "dents": _dents(session, recording),
        "touched": _touched(session, recording),
        "position_tracking_rms_m": None if session.mode in SERVOED else _rms(_position_error(session, recording)),
        "force_tracking_rms_N": _rms(_force_error(session, recording)),
        "alpha_p": session.settings.gains.alpha_p,
        "alpha_f": alpha_f,
        "loop_rate_Hz": session.rate,
        "steps": len(recording),
        "duration_s": len(recording) / session.rate,
        "incomplete": recording.incomplete,
        "stability_margin": _finite(session.stability_margin),
        "force_limit_N": session.settings.limits.force,
        "force_overshoot_N": session.force_overshoot,
        "stability": {name: _finite(value) for name, value in session.margins()._asdict().items()},
        "calm": {name: _finite(value) for name, value in session.calm().facts().items()},
        "states": {name: int(np.count_nonzero(recording.state == code)) for code, name in enumerate(STATES)},
        "reasons": _reasons(recording),
        "seed": session.seed,
        "version": nt.__version__,
    }


def before(session: nt.Session) -> str:
    """What is known before anything moves: how near the loop is to its limit, what holds whatever the operator does,
    and with how many steps the hand feels it."""
    found = session.margins()
    travel = session.clearance + INDENTATION_RANGE + session.relief
    budget = margins.resolution(session.rig, session.settings, travel)
    verdict = "" if found.refusal is None else f"; ARMED AGAINST THE VERDICT, {found.refusal}"
    lines = [
        f"loop:    {session.control} control at {session.rate / 1e3:g} kHz, {session.probe_model} probe; "
        f"stability margin {found.verdict}{verdict}",
        *([f"felt:    {session.calm()}"] if session.mode in ("point", "scan") else []),
        *_unfelt(session),
        *(f"limits:  {line}" for line in str(session.guarantee()).splitlines()),
        *(f"steps:   {line}" for line in str(budget).splitlines()),
    ]
    return "\n".join(lines)


def words(summary: dict[str, Any]) -> str:
    """The summary for a reader."""
    time = f"{summary['duration_s']:.1f} s, {summary['steps']} steps at {summary['loop_rate_Hz'] / 1e3:g} kHz"
    lines = [f"{summary['mode']} on {summary['surface']}: {time}"]
    if summary["incomplete"] is not None:
        lines.append(f"  INCOMPLETE        {summary['incomplete']}")
    lines += [f"  {line}" for line in summary["models"]]
    lines += [
        f"  scaling           alpha_p {summary['alpha_p']:.3g}, alpha_f {summary['alpha_f']:.3g}",
        f"  snap-in           {force(summary, 'snap_in')}",
        f"  pull-off          {force(summary, 'pull_off')}",
        f"  max force         {summary['largest_force_N'] * 1e9:.1f} nN",
        *_rubbed(summary["largest_sideways_force_N"]),
        f"  position tracking {_position(summary['position_tracking_rms_m'])}",
        f"  force tracking    {_tracking(summary)}",
        f"  stability margin  {_margin(summary['stability_margin'])}",
    ]
    seconds = {name: count / summary["loop_rate_Hz"] for name, count in summary["states"].items()}
    stopped = [f"{seconds[name]:.4g} s {name}" for name in seconds if name != "RUN" and seconds[name]]
    if stopped:
        lines.append(f"  stopped           {', '.join(stopped)}: {', '.join(summary['reasons'])}")
    return "\n".join(lines)


def _touched(session: nt.Session, recording: Recording) -> bool:
    """In contact, or pressed by forces before contact with more than a hundredth of the limit, as a soft sample is."""
    pressed = float(np.max(recording.tip_force)) > 0.01 * session.settings.limits.force
    return pressed or bool(np.any(recording.contact_radius > 0.0))


def _dents(session: nt.Session, recording: Recording) -> list[dict[str, float]] | None:
    """What the tip has left in a sample that keeps dents; None for another sample."""
    if session.scene.sample.dents != "yes":
        return None
    return [
        {"load_N": dent.load, "radius_m": dent.imprint.radius, "depth_m": dent.imprint.depth,
         "start_x_m": dent.imprint.start_x, "start_y_m": dent.imprint.start_y,
         "end_x_m": dent.imprint.end_x, "end_y_m": dent.imprint.end_y}
        for dent in recording.dents
    ]  # fmt: skip


def _sideways(recording: Recording) -> float | None:
    """Friction and slopes together; None where the recording does not have it."""
    columns = recording.columns
    if "tip_force_x" not in columns:
        return None
    return _number(float(np.nanmax(np.hypot(columns["tip_force_x"], columns["tip_force_y"]), initial=0.0)))


def _rubbed(largest: float | None) -> list[str]:
    return [] if largest is None else [f"  sideways force    {largest * 1e9:.1f} nN at most, not felt"]


def _unfelt(session: nt.Session) -> list[str]:
    """No hand feels friction: what it would have to."""
    friction = session.plan.friction
    if not friction.included:
        return []
    return [f"unfelt:  friction, up to {friction.force * 1e9:.3g} nN at the tip: no motor acts sideways"]


def force(summary: dict[str, Any], name: str) -> str:
    """Snap-in or pull-off, at the tip and at the hand."""
    tip, hand = summary[f"{name}_force_N"], summary[f"hand_{name}_force_N"]
    if tip is not None:
        return f"{tip * 1e9:.1f} nN at the tip, {hand:.3f} N at the hand"
    return f"none: {_WITHOUT[name] if summary['touched'] else 'never touched'}"


_WITHOUT = {"snap_in": "no sudden pull on the way in", "pull_off": "no sudden release on the way out"}


def _position(error: float | None) -> str:
    return "none: the stage goes by itself" if error is None else f"{error * 1e9:.2f} nm RMS at the stage"


def _margin(margin: float | None) -> str:
    return "none: no loop through the hand" if margin is None else f"{margin:.1f} (1 is the limit)"


def _tracking(summary: dict[str, Any]) -> str:
    force = summary["force_tracking_rms_N"]
    if force is None:
        return "none: " + ("the hand follows no force" if summary["mode"] == "curve" else "never touched")
    return f"{force:.3f} N RMS at the hand"


def _position_error(session: nt.Session, recording: Recording) -> Any:
    """alpha_p (x_m - its start) - x_s [m]."""
    gains = session.settings.gains
    return gains.alpha_p * (recording.master_position - session.core.master_start) - recording.stage_position


def _force_error(session: nt.Session, recording: Recording) -> Any:
    """f_m - alpha_f f_s in contact; for the height servo alpha_f (set-point - f_s); curve and tapping have none [N]."""
    gains = session.settings.gains
    touching = recording.contact_radius > 0.0
    if session.mode in ("curve", "tapping"):
        return ()
    if session.mode in ("topography", "approach"):
        return gains.alpha_f * (gains.set_point - recording.slave_force[touching])
    return (recording.operator_force - gains.alpha_f * recording.slave_force)[touching]


def _rms(error: Any) -> float | None:
    return float(np.sqrt(np.mean(np.square(error)))) if len(error) else None


def _number(value: float) -> float | None:
    return None if math.isnan(value) else float(value)


def _finite(value: float | str) -> float | str | None:
    return value if isinstance(value, str) or math.isfinite(value) else None


def _reasons(recording: Recording) -> list[str]:
    bits = int(np.bitwise_or.reduce(recording.reasons)) if len(recording) else 0
    return [name for bit, name in enumerate(REASONS) if bits >> bit & 1]
