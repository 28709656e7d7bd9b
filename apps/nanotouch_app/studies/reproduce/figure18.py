# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 18: a silicon grating of 480 nm is felt, with force, along a line."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import margins, presets
from nanotouch.touch.margins import CLEARLY_FELT
from nanotouch.touch.operator import Input

from nanotouch_app.studies.reproduce import drawing, paper, touching
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, near, quantity
from nanotouch_app.studies.reproduce.stopped import run

LITERAL = Parameter("alpha_p, literal", 1e-6, "m/m", "Sec. VI-C, as printed")
REPAIRED = Parameter("alpha_p, repaired", 1e-4, "m/m", "ours: 480 nm are 4.8 mm of the master")
ALPHA_F = Parameter("alpha_f", 1e6, "N/N", "Sec. VI-C")
GAIN = Parameter("K_f", 10.0, "", "Sec. VI-C")
STEP = Parameter("height of the grating", 480e-9, "m", "Sec. VI-C, TGZ-03")
HAND = Parameter("hand force while scanning", 0.6, "N", "not in the text; 0.6 uN at the tip")
TIME = Parameter("time of the scan", 30.0, "s", "not in the text")
PARAMETERS = (LITERAL, REPAIRED, ALPHA_F, GAIN, STEP, HAND, TIME, paper.TIP, paper.CANTILEVER, touching.RATE)
LINE = (0.3e-6, 5.7e-6)
"""of the scan [m]: two lines of the grating"""


def session() -> nt.Session:
    """Silicon tip on the silicon grating, the paper's force scale and gain."""
    scene, rig = presets.paper_silicon()
    surface = nt.Surface(nt.surface.grating(), scene.tip.radius, scene.tip.half_angle)
    chosen = touching.settings(
        rig, touching.RATE.value, alpha_p=REPAIRED.value, alpha_f=ALPHA_F.value, force_gain=GAIN.value
    )
    return nt.Session(
        scene, rig, settings=chosen, surface=surface, mode="scan", path=[(LINE[0], 3e-6), (LINE[1], 3e-6)],
        clearance=50e-9, seed=1, preflight=False, probe_model="quasi-static",
    )  # fmt: skip


def scan(touched: nt.Session) -> nt.Recording:
    """Down on the ground, along the line, from there on."""
    x0, x1, force = LINE[0], LINE[1], HAND.value
    script = [
        Input(0.1, x0, 3e-6, 0.5), Input(0.1, x0, 3e-6, 2.0), Input(force, x0, 3e-6, 1.0), Input(force, x0, 3e-6, 1.0),
        Input(force, x1, 3e-6, TIME.value),
    ]  # fmt: skip
    recording = run(touched, operator=script)
    return recording[recording.time > 4.0]


def felt_height(recording: nt.Recording) -> Floats:
    """Height that the hand was lifted to, alpha_p x_m, from its lowest [m]."""
    height = -recording.parameter("alpha_p") * recording.master_position
    return np.asarray(height - np.quantile(height, 0.05))


def reproduce() -> Reproduction:
    """Compute the figure."""
    touched = session()
    found = touched.margins()
    recording = scan(touched)
    distance = np.linspace(recording.x[0], recording.x[-1], touching.ROWS)
    truth = recording.surface_height - np.quantile(recording.surface_height, 0.05)
    columns: dict[str, Floats] = {
        "distance along the line [m]": distance - distance[0],
        "surface under the tip [m]": np.interp(distance, recording.x, truth),
        "height at the hand alpha_p x_m [m]": np.interp(distance, recording.x, felt_height(recording)),
        "height of the stage [m]": np.interp(
            distance, recording.x, -recording.stage_position + np.quantile(recording.stage_position, 0.95)
        ),
        "force at the hand [N]": np.interp(distance, recording.x, recording.operator_force),
        "scaled slave force [N]": np.interp(distance, recording.x, recording.scaled_slave_force),
    }
    statements = (
        _literal(),
        _armed(found),
        _jumps(recording),
        _forces(recording),
        _positions(recording),
        _edges(recording),
    )
    return Reproduction(
        18, "a grating of 480 nm felt with force, K_f = 10", PARAMETERS, columns, statements,
        lambda figure: _draw(figure, columns),
    )  # fmt: skip


def _literal() -> Statement:
    reach = LITERAL.value * 0.02
    return Statement(
        "alpha_p = 1e-6 lets the hand follow the grating (as printed, m/m)", "VI-C", holds(reach > STEP.value),
        "travel of the tip for all of the master's 2 cm", reach, "m",
        "480 nm would take 48 cm. As metres per millimetre, 1e-3 m/m, one step of the master moves the tip by 40 nm.",
    )  # fmt: skip


def _armed(found: margins.Margins) -> Statement:
    return Statement(
        "K_f = 10 and alpha_f = 1e6 are stable (alpha_p = 1e-4, 10 kHz)", "VI-C", holds(found.refusal is None),
        f"least margin, of {found.rule}", found.least, "",
        f"R1 {found.margin:.3g}; with alpha_p = 1e-3 it would be a tenth of that, and refused.",
    )  # fmt: skip


def _jumps(recording: nt.Recording) -> Statement:
    height = felt_height(recording)
    top = recording.surface_height > np.max(recording.surface_height) - 0.1 * STEP.value
    bottom = recording.surface_height < np.min(recording.surface_height) + 0.1 * STEP.value
    step = float(np.median(height[top]) - np.median(height[bottom]))
    return Statement(
        "the upward jumps stand for grid structures of 480 nm height", "VI-C, Fig. 18",
        holds(near(step / STEP.value)), "median lift of the hand from ground to line, scaled", step, "m",
        "Position of the hand times alpha_p, while it presses with a steady force.",
    )  # fmt: skip


def _forces(recording: nt.Recording) -> Statement:
    error, force = touching.rms(touching.force_error(recording)), ALPHA_F.value * recording.tip_force
    least, span = float(np.min(force)), float(np.ptp(force))
    return Statement(
        "the operator can feel the contact forces while the tip moves in x-y", "VI-C, Fig. 18",
        holds(least > CLEARLY_FELT and error < 0.2 * HAND.value), "least force of the tip at the hand", least, "N",
        f"{quantity(CLEARLY_FELT, 'N')} are clearly felt. What the walls add and take, {quantity(span, 'N')} in all, "
        f"is less than that. RMS of f_m - alpha_f f_s: {quantity(error, 'N')}.",
    )  # fmt: skip


def _positions(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.position_error(recording))
    return Statement(
        "x_s follows alpha_p x_m (Eq. 16)", "IV-B", holds(error < 10e-9), "RMS of alpha_p x_m - x_s along the line",
        error, "m", "One step of the master is 4 nm of the stage.",
    )  # fmt: skip


def _edges(recording: nt.Recording) -> Statement:
    worst = float(np.max(recording.tip_force))
    lowest = float(np.min(recording.tip_force))
    return Statement(
        "the tip stays in contact along the line", "VI-C", holds(bool(np.mean(recording.contact_radius > 0.0) > 0.99)),
        "share of the time in contact", float(np.mean(recording.contact_radius > 0.0)), "",
        f"The force at the tip runs from {quantity(lowest, 'N')} to {quantity(worst, 'N')}: downward walls let it go, "
        "upward ones push.",
    )  # fmt: skip


def _draw(figure: Any, columns: dict[str, Floats]) -> None:
    upper, lower = figure.subplots(2, 1, sharex=True)
    x = columns["distance along the line [m]"] * 1e6
    upper.fill_between(x, columns["surface under the tip [m]"] * 1e9, color="0.85", lw=0, label="surface, dilated")
    lower_names = ("force at the hand [N]", "scaled slave force [N]")
    upper_names = ("height at the hand alpha_p x_m [m]", "height of the stage [m]")
    for panel, names, scale in ((upper, upper_names, 1e9), (lower, lower_names, 1.0)):
        for name, (colour, style) in zip(names, drawing.LOOKS, strict=False):
            panel.plot(x, columns[name] * scale, color=colour, ls=style, lw=1.0, label=name.split(" [")[0])
    drawing.dress(upper, "Felt along the line", "", "height (nm)", "center")
    drawing.dress(lower, "", "distance (µm)", "force (N)", "upper right")
