# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 17: touching silicon with a silicon tip, with the gains as printed, which must be refused, and repaired."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
from nanotouch import presets
from nanotouch.touch.margins import CLEARLY_FELT
from nanotouch.touch.operator import Input
from nanotouch.touch.session import Control

from nanotouch_app.studies.reproduce import paper, touching
from nanotouch_app.studies.reproduce.statement import Parameter, Reproduction, Statement, holds, quantity
from nanotouch_app.studies.reproduce.stopped import run

LITERAL = Parameter("alpha_p, literal", 4e-3, "m/m", "Sec. VI-B, as printed")
REPAIRED = Parameter("alpha_p, repaired", 4.5e-5, "m/m", "Eq. 21: 0.6 + 0.3 um over 2 cm")
ALPHA_F = Parameter("alpha_f", 2e6, "N/N", "Sec. VI-B")
FELT = Parameter("alpha_f, felt", 1.79e7, "N/N", "ours: 0.3 N at the hand for 18 nN, the default of a first touch")
NEAR = Parameter("alpha_p, felt", 2e-5, "m/m", "ours: Eq. 21 for a first touch, 0.1 + 0.3 um over 2 cm")
GAIN = Parameter("K_f", 2.0, "", "Sec. VI-B")
HEIGHT = Parameter("initial tip height L", 0.6e-6, "m", "Sec. VI-B")
FORCE = Parameter("largest hand force", 2.0, "N", "read off the scale of the figure's axis, -2 .. 3 N")
PROPORTIONAL = Parameter("K_p", 10.0, "", "not in the text; x_s = K_p/(1 + K_p) of its target, 0.91")
STEP = Parameter("step of the gauge", 0.02, "N", "Sec. IV-C")
PARAMETERS = (
    LITERAL, REPAIRED, ALPHA_F, FELT, NEAR, GAIN, PROPORTIONAL, HEIGHT, FORCE, STEP, paper.TIP, paper.CANTILEVER,
    paper.HUMIDITY, paper.RESOLUTION, touching.RATE, touching.PAPER_RATE,
)  # fmt: skip
APPROACH, PULL = 0.05, -0.5
"""hand forces in air and on the way back [N]"""
SCRIPT = (
    Input(APPROACH, 0.0, 0.0, 0.5), Input(APPROACH, 0.0, 0.0, 9.5), Input(FORCE.value, 0.0, 0.0, 3.0),
    Input(FORCE.value, 0.0, 0.0, 1.0), Input(PULL, 0.0, 0.0, 4.0), Input(0.0, 0.0, 0.0, 1.0),
)  # fmt: skip
TRACKED = 0.05
"""an error below this share of the largest hand force counts as tracking"""


FIRST = 0.1e-6
"""height above the surface at which a first touch begins [m]"""
FIGURE = (1.0, 2.0)
"""the attraction at the hand that the figure shows [N]"""
WATER = 0.0728
"""surface tension of water at 20 C [N/m]"""


def session(
    alpha_p: float, rate: float, control: Control, minimum_margin: float = 1.5, alpha_f: float = ALPHA_F.value,
    height: float = HEIGHT.value,
) -> nt.Session:  # fmt: skip
    """The paper's silicon under the given scales, rate and law, from a height [m]."""
    scene, rig = presets.paper_silicon()
    chosen = touching.settings(
        rig, rate, alpha_p=alpha_p, alpha_f=alpha_f, force_gain=GAIN.value, stage_proportional=PROPORTIONAL.value
    )
    return nt.Session(
        scene, rig, settings=chosen, control=control, clearance=height, minimum_margin=minimum_margin, seed=1,
        preflight=False, probe_model="quasi-static",
    )  # fmt: skip


def reproduce() -> Reproduction:
    """Compute the figure."""
    literal = session(LITERAL.value, touching.PAPER_RATE.value, "paper", 0.0)
    refused = literal.margins()
    repaired = session(REPAIRED.value, touching.RATE.value, "default")
    rescaled = session(NEAR.value, touching.RATE.value, "default", alpha_f=FELT.value, height=FIRST)
    runs = {name: run(made, operator=SCRIPT) for name, made in
            {"literal": literal, "repaired": repaired, "felt": rescaled}.items()}  # fmt: skip
    found = touching.columns(runs, sum(step.duration for step in SCRIPT))
    felt = runs["repaired"]
    statements = (
        _refused(refused), _runs(runs["literal"]), _forces(felt), _positions(felt), _sticking(felt), _large(felt),
        _implied(), _felt(runs["felt"], rescaled),
    )  # fmt: skip
    titles = {
        "literal": "literal, armed against the verdict:\n$\\alpha_p$ = 4e-3, 3 ms, Eq. 17",
        "repaired": "repaired:\n$\\alpha_p$ = 4.5e-5, 10 kHz",
        "felt": "felt by the hand:\n$\\alpha_p$ = 2e-5, $\\alpha_f$ = 1.8e7",
    }
    return Reproduction(
        17, "touching silicon with a silicon tip", PARAMETERS, found, statements,
        lambda figure: touching.panels(figure, found, titles),
    )  # fmt: skip


def _refused(found: nt.margins.Margins) -> Statement:
    return Statement(
        "K_f = 2, alpha_p = 4e-3 and alpha_f = 2e6 at 3 ms are stable (parameters as printed)", "VI-B, Fig. 17",
        holds(found.margin > 1.0 and found.exact_limit > found.loop_stiffness), "margin of rule R1", found.margin, "",
        f"kappa = {found.loop_stiffness * 1e-3:.3g} kN/m, and the loop is passive up to "
        f"{found.stability_limit * 1e-3:.3g} kN/m: refused when armed. The hardware had friction and a bandwidth of "
        "33 Hz that Eq. 12 and 13 do not know.",
    )  # fmt: skip


def _runs(recording: nt.Recording) -> Statement:
    stopped = np.flatnonzero(recording.state > 0)
    at = float(recording.time[stopped[0]]) if stopped.size else float(recording.time[-1])
    return Statement(
        "ideal responses of tracking are realized (parameters as printed)", "VI-B, Fig. 17", holds(not stopped.size),
        "time until the supervisor stops the loop", at, "s",
        "Armed against the verdict, with Eq. 17 as printed and K_p = 10: the stage's own loop is unstable at 3 ms.",
    )  # fmt: skip


def _contact(recording: nt.Recording) -> nt.Recording:
    return recording[recording.contact_radius > 0.0]


def _forces(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.force_error(_contact(recording)))
    return Statement(
        "ideal responses of tracking are realized: forces (repaired)", "VI-B, Fig. 17",
        holds(error < TRACKED * FORCE.value), "RMS of f_m - alpha_f f_s in contact", error, "N",
        "In air the hand feels the damping of the master, b_m v/(1 + K_f), and no force of the tip.",
    )  # fmt: skip


def _positions(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.position_error(recording))
    return Statement(
        "there is almost no tracking error for the positions (repaired)", "VI-B, Fig. 17", holds(error < 10e-9),
        "RMS of alpha_p x_m - x_s", error, "m",
        "One step of the master is 1.8 nm of the stage; the paper's closed loop resolves 10 nm.",
    )  # fmt: skip


def _attractions(recording: nt.Recording) -> tuple[float, float]:
    """Largest attraction within 10 ms after the tip has landed, and on the way back [N]."""
    landed = int(np.argmax(recording.contact_radius > 0.0))
    after = recording.tip_force[landed : landed + 100]
    back = recording.tip_force[int(np.argmax(recording.stage_position)) :]
    return -float(np.min(after)), -float(np.min(back))


def _sticking(recording: nt.Recording) -> Statement:
    snap_in, pull_off = _attractions(recording)
    at_hand = [quantity(ALPHA_F.value * force, "N") for force in (snap_in, pull_off)]
    return Statement(
        "sticking is small during the approach and very large when retracting", "VI-B, Fig. 17",
        holds(pull_off > 2.0 * snap_in and ALPHA_F.value * pull_off > CLEARLY_FELT),
        "pull-off over snap-in in the loop", pull_off / snap_in, "",
        f"{quantity(snap_in, 'N')} and {quantity(pull_off, 'N')} at the tip: larger it is. At the hand it is "
        f"{at_hand[0]} and {at_hand[1]}, both less than the {quantity(CLEARLY_FELT, 'N')} that are clearly felt, and "
        "neither very large.",
    )  # fmt: skip


def _large(recording: nt.Recording) -> Statement:
    felt, noise = ALPHA_F.value * _attractions(recording)[1], ALPHA_F.value * paper.RESOLUTION.value
    return Statement(
        "the attractive forces are large enough to feel the sticking", "VI-B, Fig. 17", holds(felt > CLEARLY_FELT),
        "pull-off at the hand", felt, "N",
        f"Hardly above one step of the gauge, {quantity(STEP.value, 'N')}, and the noise of the probe, "
        f"{quantity(noise, 'N')} peak to peak; {quantity(CLEARLY_FELT, 'N')} are clearly felt.",
    )  # fmt: skip


def _implied() -> Statement:
    low, high = (force / ALPHA_F.value for force in FIGURE)
    return Statement(
        "the figure's -1 to -2 N come from the tip of 20 to 30 nm", "VI-B, Fig. 17", holds(radius(high) < 30e-9),
        "radius of a flooded tip for -1 N, 4 pi gamma R", radius(low), "m",
        f"They imply {quantity(low, 'N')} to {quantity(high, 'N')} at the tip, a meniscus on a blunt or flooded tip of "
        f"{quantity(radius(low), 'm')} to {quantity(radius(high), 'm')}.",
    )  # fmt: skip


def radius(attraction: float) -> float:
    """R of a sphere that a meniscus of water, wetting both sides, pulls at with this force, 4 pi gamma R [m]."""
    return attraction / (4.0 * math.pi * WATER)


def _felt(recording: nt.Recording, made: nt.Session) -> Statement:
    felt, found, calm = FELT.value * _attractions(recording)[1], made.margins(), made.calm()
    return Statement(
        f"the sticking of this tip can be felt within the margins (alpha_f = {FELT.value:.3g})", "ours",
        holds(felt > CLEARLY_FELT and found.refusal is None and calm.is_calm), "pull-off at the hand", felt, "N",
        f"Least margin {found.least:.3g}, {found.rule}. The loop ripples by {quantity(calm.ripple, 'N')} peak to "
        f"peak, noise of the probe and steps, less than the {quantity(calm.felt, 'N')} that are felt. With the alpha_p "
        f"of the figure, {REPAIRED.value:.2g}, it would be more.",
    )  # fmt: skip
