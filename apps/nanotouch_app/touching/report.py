# SPDX-License-Identifier: BSD-3-Clause
"""A touch in a few lines: what was touched, what was felt, was it safe, what to try next."""

from __future__ import annotations

import argparse
import math
import shlex
from typing import Any

import nanotouch as nt

from nanotouch_app.touching import summary

DID = {
    "point": "pressed at one point",
    "scan": "felt the forces along a line",
    "topography": "followed a line at constant force",
    "approach": "found the surface and stayed on it",
    "curve": "recorded a force-distance curve",
    "tapping": "followed a line at constant amplitude",
}
NEXT = {
    "point": ("scan", "feel the forces along a line"),
    "scan": ("topography", "feel only the height, at constant force"),
    "topography": ("curve", "record a force-distance curve"),
    "approach": ("point", "press at one point"),
    "curve": ("point", "press at one point with the hand"),
    "tapping": ("topography", "feel only the height, at constant force"),
}
"""the mode to try after another one, and what it does"""


def report(session: nt.Session, facts: dict[str, Any], what: str, args: argparse.Namespace) -> str:
    """What a reader wants first, in at most eight lines without warnings; ``what`` names the surface. All of it with
    ``--verbose``."""
    rows = {
        "touched": _touched(session, facts, what),
        "felt": _felt(session, facts) if args.verbose else _felt_in_short(session, facts),
        "safe": _safe(session, facts) if args.verbose else _safe_in_short(session, facts),
        "warning": _warnings(session),
        "try next": _next(session, facts, args),
    }
    return "\n".join(
        f"{title if first else '':9}{line}" for title, lines in rows.items() for first, line in _told(lines)
    )


def _told(lines: list[str]) -> list[tuple[bool, str]]:
    return [(number == 0, line) for number, line in enumerate(lines)]


def _touched(session: nt.Session, facts: dict[str, Any], what: str) -> list[str]:
    scene, lever = session.scene, session.rig.probe.spring_constant
    lines = [
        what,
        f"{DID[facts['mode']]} for {facts['duration_s']:.1f} s, tip radius {scene.tip.radius * 1e9:.3g} nm, "
        f"lever {lever:.3g} N/m",
    ]
    return lines if facts["incomplete"] is None else [*lines, f"INCOMPLETE: {facts['incomplete']}"]


def _felt(session: nt.Session, facts: dict[str, Any]) -> list[str]:
    planned = facts["planned_pull_off_force_N"]
    expected = f" (expected {planned * 1e9:.3g} nN)" if facts["pull_off_force_N"] is not None else ""
    return [
        f"snap-in        {summary.force(facts, 'snap_in')}",
        f"pull-off       {summary.force(facts, 'pull_off')}{expected}",
        f"max force      {facts['largest_force_N'] * 1e9:.1f} nN",
        *_rubbed(session, facts),
        *_dents(facts),
        f"model error    {_bound(session.plan.bound)}",
    ]


def _felt_in_short(session: nt.Session, facts: dict[str, Any]) -> list[str]:
    planned = facts["planned_pull_off_force_N"]
    expected = f" (expected {planned * 1e9:.3g} nN)" if facts["pull_off_force_N"] is not None else ""
    bound = session.plan.bound
    model = "model error not known" if math.isnan(bound) else f"model error at most {100.0 * bound:.2g} %"
    return [
        f"snap-in {summary.force(facts, 'snap_in')}; max force {facts['largest_force_N'] * 1e9:.1f} nN, {model}",
        f"pull-off {summary.force(facts, 'pull_off')}{expected}",
        *_dents(facts),
    ]


def _bound(bound: float) -> str:
    return "not known" if math.isnan(bound) else f"at most {bound * 100.0:.2g} % of the force"


def _dents(facts: dict[str, Any]) -> list[str]:
    """What is left of it in a sample that keeps dents."""
    depths = [dent["depth_m"] for dent in facts.get("dents") or []]
    if not depths:
        return [] if facts.get("dents") is None else ["dents          none: it stayed elastic"]
    return [f"dents          {len(depths)}, the deepest {1e9 * max(depths):.3g} nm"]


def _rubbed(session: nt.Session, facts: dict[str, Any]) -> list[str]:
    """Friction, and who feels it."""
    friction, largest = session.plan.friction, facts["largest_sideways_force_N"]
    if not friction.included:
        return []
    seen = "" if largest is None else f"{largest * 1e9:.1f} nN at most, "
    sideways = session.sideways()
    felt = "not felt: no motor acts sideways"
    if session.settings.gains.projection_x != 0.0 or session.settings.gains.projection_y != 0.0:
        felt = "felt along z, by the projection"
    elif sideways.loop_stiffness > 0.0:
        felt = f"felt in x and y: margin {sideways.least:.3g} ({sideways.rule})"
    return [f"sideways       {seen}friction up to {friction.force * 1e9:.3g} nN; {felt}"]


def _safe(session: nt.Session, facts: dict[str, Any]) -> list[str]:
    promised = session.guarantee()
    found = session.margins()
    lines = [] if found.refusal is None else [f"NO: armed against the verdict, {found.refusal}"]
    lines.append(verdict(facts))
    lines.append(f"stability margin {found.verdict}")
    lines.append(
        f"whatever the hand does: at most {promised.force * 1e9:.4g} nN on the sample, and "
        f"{promised.zero_drift * 1e9:.2g} nN more each second; at most {promised.indentation * 1e9:.4g} nm deep"
    )
    lines.append(str(promised.hand))
    lines.append(_failing(promised.with_failure))
    lines.append(f"a stop takes effect within {promised.reaction_time * 1e3:.2f} ms")
    return lines


def _safe_in_short(session: nt.Session, facts: dict[str, Any]) -> list[str]:
    promised, found = session.guarantee(), session.margins()
    refused = [] if found.refusal is None else [f"NO: armed against the verdict, {found.refusal}"]
    return [
        *refused,
        verdict(facts),
        f"force bound {promised.force * 1e9:.4g} nN, whatever the hand does: the limit, and what a fast hand adds "
        f"until the stop acts ({promised.reaction_time * 1e3:.2g} ms)",
    ]


def _failing(most: float) -> str:
    return "if one part fails: " + (
        f"at most {most * 1e9:.4g} nN" if math.isfinite(most) else "no bound, see --verbose"
    )


def verdict(facts: dict[str, Any]) -> str:
    """Whether it was safe: was it stopped, and was the force limit kept."""
    limit, largest = facts["force_limit_N"] * 1e9, facts["largest_force_N"] * 1e9
    stopped = {
        name: count / facts["loop_rate_Hz"] for name, count in facts["states"].items() if name != "RUN" and count
    }
    if stopped:
        times = ", ".join(f"{name} for {seconds:.3g} s" for name, seconds in stopped.items())
        return f"it was stopped: {times} ({', '.join(facts['reasons'])})"
    if largest > limit:
        return f"no stop, but {largest:.1f} nN is above the limit of {limit:.4g} nN"
    return f"yes: no stop, and {largest:.1f} nN is below the limit of {limit:.4g} nN"


def _warnings(session: nt.Session) -> list[str]:
    lines = [str(warning) for warning in session.plan.warnings]
    promised = session.guarantee().warning
    if promised is not None:
        lines.append(promised)
    calm = session.calm()
    if session.mode in ("point", "scan") and not calm.is_calm:
        lines.append(str(calm))
    return lines


def _next(session: nt.Session, facts: dict[str, Any], args: argparse.Namespace) -> list[str]:
    same = _same(args)
    mode, does = NEXT[session.mode]
    own = "" if session.mode == "point" else f" --mode {session.mode}"
    lines = [] if facts["touched"] else untouched(facts)
    lines.append(f"{same} --mode {mode}    {does}")
    return lines if args.verbose else [*lines, f"{same}{own} --verbose    models, error bounds and limits in full"]


def untouched(facts: dict[str, Any]) -> list[str]:
    """What helps where nothing was touched."""
    if "force limit" in facts["reasons"]:
        return ["a softer lever or a higher force limit: the sensor read more than the limit, and nothing was touched"]
    if facts["reasons"]:
        return []
    return [f"a longer --duration than {facts['duration_s']:.3g} s: nothing was touched"]


def _same(args: argparse.Namespace) -> str:
    """The command on the same surface with the same scene."""
    words = ["nanotouch", "touch"]
    words += [args.image] if args.image is not None else []
    for option in ("surface", "scene", "channel", "pixel_size", "z_unit", "level"):
        value = getattr(args, option)
        words += [] if value is None else [f"--{option.replace('_', '-')}", value]
    return shlex.join(words)
