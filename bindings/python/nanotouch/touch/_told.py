# SPDX-License-Identifier: BSD-3-Clause
"""What a session says of itself: in a line, and in a notebook."""

from __future__ import annotations

from typing import Any

from nanotouch._io import html
from nanotouch.touch import _stopped
from nanotouch.touch.options import PACE_REASONS


def in_a_line(session: Any) -> str:
    """Mode, state, how far, what law, how stable."""
    return (
        f"Session(mode {session.mode!r}, {stopped(session)}, {session.rate:g} Hz, {_time(session):.6g} s run, "
        f"{session.plan.contact_law}, stability margin {session.stability_margin:.3g}{_paced(session)})"
    )


def as_html(session: Any) -> str:
    """The same as a table, with the guarantee and the instrument."""
    tip, probe = session.scene.tip, session.rig.probe
    rows = [
        ("state", stopped(session)),
        ("mode", session.mode),
        ("run so far", f"{_time(session):.6g} s"),
        ("rate", f"{session.rate:g} Hz"),
        ("contact law", session.plan.contact_law),
        ("bound of the plan", f"{100.0 * session.plan.bound:.2g} %"),
        ("stability margin", f"{session.stability_margin:.3g} (1 is the limit)"),
        ("force never above", f"{session.guarantee().force:.4g} N"),
        ("hand", str(session.guarantee().hand)),
        ("tip", f"{tip.shape}, {tip.radius:.4g} m"),
        ("spring constant", f"{probe.spring_constant:.4g} N/m"),
    ]
    return html.table("Session", ("", ""), rows)


def stopped(session: Any) -> str:
    """ "RUN", or "LATCHED at 0.09 s: sensor stuck"."""
    return _stopped.in_words(session.core.state, session.core.since / session.rate, session.core.reasons)


def _paced(session: Any) -> str:
    return "" if session.pace == "free" else f", {PACE_REASONS[session.pace]}"


def _time(session: Any) -> float:
    return float(session.progress.ticks / session.rate)
