# SPDX-License-Identifier: BSD-3-Clause
"""What a touch came to: the numbers of summary.json, and the same in words."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.plots import adhesion
from nanotouch.record import STATES, Recording
from nanotouch.session import REASONS


def summarise(session: nt.Session, recording: Recording) -> dict[str, Any]:
    """The numbers, SI; null where there is none (no snap-in above the noise, no retraction)."""
    seen = adhesion(recording)
    alpha_f = session.settings.gains.alpha_f
    margins = session.margins()
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
        "position_tracking_rms_m": _rms(_position_error(session, recording)),
        "force_tracking_rms_N": _rms(_force_error(session, recording)),
        "alpha_p": session.settings.gains.alpha_p,
        "alpha_f": alpha_f,
        "loop_rate_Hz": session.rate,
        "steps": len(recording),
        "duration_s": len(recording) / session.rate,
        "stability_margin": session.stability_margin,
        "force_limit_N": session.settings.limits.force,
        "force_overshoot_N": session.force_overshoot,
        "stability": {name: _finite(value) for name, value in margins._asdict().items()},
        "states": {name: int(np.count_nonzero(recording.state == code)) for code, name in enumerate(STATES)},
        "reasons": _reasons(recording),
        "seed": session.seed,
        "version": nt.__version__,
    }


def guarantee(session: nt.Session) -> str:
    """What holds before anything moves: the force limit and by how much it can be exceeded, the stability margin."""
    return f"limits: {session.guarantee()}; stability margin {session.stability_margin:.1f} (1 is the limit)"


def words(summary: dict[str, Any]) -> str:
    """The summary for a reader."""
    time = f"{summary['duration_s']:.1f} s, {summary['steps']} steps at {summary['loop_rate_Hz'] / 1e3:g} kHz"
    lines = [f"{summary['mode']} on {summary['surface']}: {time}"]
    lines += [f"  {line}" for line in summary["models"]]
    lines += [
        f"  scaling           alpha_p {summary['alpha_p']:.3g}, alpha_f {summary['alpha_f']:.3g}",
        f"  snap-in           {_force(summary, 'snap_in')}",
        f"  pull-off          {_force(summary, 'pull_off')}",
        f"  largest force     {summary['largest_force_N'] * 1e9:.1f} nN",
        f"  position tracking {summary['position_tracking_rms_m'] * 1e9:.2f} nm RMS at the stage",
        f"  force tracking    {_tracking(summary['force_tracking_rms_N'])}",
        f"  stability margin  {summary['stability_margin']:.1f} (1 is the limit)",
    ]
    seconds = {name: count / summary["loop_rate_Hz"] for name, count in summary["states"].items()}
    stopped = [f"{seconds[name]:.4g} s {name}" for name in seconds if name != "RUN" and seconds[name]]
    if stopped:
        lines.append(f"  stopped           {', '.join(stopped)}: {', '.join(summary['reasons'])}")
    return "\n".join(lines)


def _force(summary: dict[str, Any], name: str) -> str:
    tip, hand = summary[f"{name}_force_N"], summary[f"hand_{name}_force_N"]
    return "none" if tip is None else f"{tip * 1e9:.1f} nN at the tip, {hand:.3f} N at the hand"


def _tracking(force: float | None) -> str:
    return "none: never in contact" if force is None else f"{force:.3f} N RMS at the hand"


def _position_error(session: nt.Session, recording: Recording) -> Any:
    """alpha_p (x_m - its start) - x_s [m]."""
    gains = session.settings.gains
    return gains.alpha_p * (recording.master_position - session.core.master_start) - recording.stage_position


def _force_error(session: nt.Session, recording: Recording) -> Any:
    """f_m - alpha_f f_s in contact; in topography mode the height servo's alpha_f (set-point - f_s) [N]."""
    gains = session.settings.gains
    touching = recording.contact_radius > 0.0
    if session.mode == "topography":
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
