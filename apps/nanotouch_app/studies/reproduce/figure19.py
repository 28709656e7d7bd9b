# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 19: quantum dots felt along a line, topography only: constant force, the hand is drawn to the height."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import margins, presets

from nanotouch_app.studies.reproduce import drawing, paper, touching
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, quantity
from nanotouch_app.studies.reproduce.stopped import run

SIZE = Parameter("smallest and largest dot", 10e-9, "m", "Sec. VI-C, 10 to 30 nm")
TIME = Parameter("time of the line", 40.0, "s", "not in the text")
SCALE = Parameter("alpha_p", 3e-6, "m/m", "not in the text; 10 nm are 3.3 mm of the master")
SET = Parameter("set force", 100e-9, "N", "not in the text; eight times the probe's noise")
PARAMETERS = (SIZE, TIME, SCALE, SET, paper.TIP, paper.CANTILEVER, paper.RESOLUTION, touching.RATE)
FELT = 0.2
"""an RMS error of the height below this share of its range counts as felt"""


def session() -> nt.Session:
    """Silicon tip on the InAs dots, along the middle."""
    scene, rig = presets.paper_inas()
    surface = nt.Surface(nt.surface.dots(), scene.tip.radius, scene.tip.half_angle)
    chosen = touching.settings(rig, touching.RATE.value, alpha_p=SCALE.value, set_point=SET.value)
    return nt.Session(
        scene, rig, settings=chosen, surface=surface, mode="topography", clearance=10e-9, seed=1, preflight=False,
        probe_model="quasi-static",
    )  # fmt: skip


def follow(touched: nt.Session) -> nt.Recording:
    """The line alone, without the landing."""
    recording = run(touched, TIME.value)
    moving = np.abs(recording.x - recording.x[0]) > 1e-12
    return recording[moving & (recording.x < recording.x[-1] - 1e-12)]


def heights(recording: nt.Recording) -> tuple[Floats, Floats]:
    """The surface under the tip, and what the hand felt of it, alpha_p x_m, both about their median [m]."""
    truth = recording.surface_height - np.median(recording.surface_height)
    felt = -recording.parameter("alpha_p") * recording.master_position
    return np.asarray(truth), np.asarray(felt - np.median(felt))


def reproduce() -> Reproduction:
    """Compute the figure."""
    touched = session()
    margin = touched.margins().least
    recording = follow(touched)
    truth, felt = heights(recording)
    distance = np.linspace(recording.x[0], recording.x[-1], touching.ROWS)
    stage = -recording.stage_position + np.median(recording.stage_position)
    columns: dict[str, Floats] = {
        "distance along the line [m]": distance - distance[0],
        "surface under the tip [m]": np.interp(distance, recording.x, truth),
        "height at the hand alpha_p x_m [m]": np.interp(distance, recording.x, felt),
        "height of the stage [m]": np.interp(distance, recording.x, stage),
        "slave force [N]": np.interp(distance, recording.x, recording.tip_force),
        "motor force [N]": np.interp(distance, recording.x, recording.motor_force),
    }
    statements = (_felt(recording), _smallest(recording, touched), _constant(recording), _servo(margin))
    return Reproduction(
        19, "quantum dots, topography only", PARAMETERS, columns, statements, lambda figure: _draw(figure, columns)
    )


def _felt(recording: nt.Recording) -> Statement:
    truth, felt = heights(recording)
    error = touching.rms(felt - truth)
    return Statement(
        "just the surface topography is sensed at the operator's hand", "VI-C, Fig. 19",
        holds(error < FELT * float(np.ptp(truth))), "RMS of alpha_p x_m against the surface", error, "m",
        f"The surface under the tip spans {quantity(float(np.ptp(truth)), 'm')}.",
    )  # fmt: skip


def _smallest(recording: nt.Recording, touched: nt.Session) -> Statement:
    """Felt as everywhere: by a force at the hand, here that which draws one that stands."""
    truth, felt = heights(recording)
    height = float(np.ptp(truth))
    noise = touching.rms((felt - truth)[np.abs(truth) < 0.1 * height])
    way, gains = height / SCALE.value, touched.settings.gains
    force = min(gains.height_stiffness * way, touched.settings.limits.motor_force)
    return Statement(
        "quantum dots of 10 to 30 nm are felt along the line", "VI-C, Fig. 19",
        holds(height > 5.0 * noise and force > margins.CLEARLY_FELT), "force on a hand that stays behind", force, "N",
        f"10 to 30 nm is their diameter, {quantity(height, 'm')} their height: {quantity(way, 'm')} of the hand, which "
        f"is drawn there by up to the motor's limit. The height errs by {quantity(noise, 'm')} RMS on the flat. The "
        f"tip of {quantity(paper.TIP.value, 'm')} widens them: the dilated dots are what the hand follows.",
    )  # fmt: skip


def _constant(recording: nt.Recording) -> Statement:
    error = touching.rms(recording.tip_force - SET.value)
    return Statement(
        "the z position is controlled for a constant contact force", "VI-C", holds(error < paper.RESOLUTION.value),
        "RMS of the force about its set value", error, "N",
        f"The probe's noise is {quantity(paper.RESOLUTION.value, 'N')} peak to peak.",
    )  # fmt: skip


def _servo(margin: float) -> Statement:
    return Statement(
        "the loop of constant force is stable (10 kHz)", "VI-C", holds(margin > 1.5), "margin of the height servo",
        margin, "", "The text gives no gains.",
    )  # fmt: skip


def _draw(figure: Any, columns: dict[str, Floats]) -> None:
    upper, lower = figure.subplots(2, 1, sharex=True)
    x = columns["distance along the line [m]"] * 1e9
    truth = columns["surface under the tip [m]"] * 1e9
    upper.fill_between(x, truth, truth.min(), color="0.85", lw=0, label="surface, dilated")
    for name, (colour, style) in zip(list(columns)[2:4], drawing.LOOKS, strict=False):
        upper.plot(x, columns[name] * 1e9, color=colour, ls=style, lw=1.0, label=name.split(" [")[0])
    lower.plot(x, columns["slave force [N]"] * 1e9, color=drawing.LOOKS[0][0], lw=1.0, label="force on the tip")
    lower.axhline(SET.value * 1e9, color=drawing.GREY, lw=0.8, ls=":")
    drawing.dress(upper, "Felt along the line", "", "height (nm)", "upper right")
    drawing.dress(lower, "", "distance (nm)", "force (nN)", "upper right")
