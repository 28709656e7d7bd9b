# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 16: simulated touch of a soft sample under a sinusoidal hand, literally and with the scale that makes sense."""

from __future__ import annotations

import math

import nanotouch as nt
from nanotouch import margins, presets

from nanotouch_app.studies.reproduce import paper, touching
from nanotouch_app.studies.reproduce.statement import Parameter, Reproduction, Statement, holds, quantity
from nanotouch_app.studies.reproduce.stopped import run

LITERAL = Parameter("alpha_p, literal", 15e-9, "m/m", "Sec. VI-B, as printed")
REPAIRED = Parameter("alpha_p, repaired", 15e-6, "m/m", "the same number as metres per millimetre")
ALPHA_F = Parameter("alpha_f", 4e6, "N/N", "Sec. VI-B")
GAIN = Parameter("K_f", 100.0, "", "Sec. VI-B")
PROPORTIONAL = Parameter("K_p", 0.5, "", "not in the text; above 1 the printed law is unstable even on an ideal stage")
NOISE = Parameter("gauge noise", math.sqrt(0.001), "N", "Sec. VI-B, variance 0.001")
SPRING = Parameter("spring constant k_c", 30.0, "N/m", "Sec. VI-B")
MEAN = Parameter("mean hand force", 0.6, "N", "not in the text; pressing all the time")
AMPLITUDE = Parameter("amplitude of the hand force", 0.5, "N", "not in the text; 0.3 uN at the tip at most")
PERIOD = Parameter("period of the hand force", 4.0, "s", "not in the text; low speed")
CLEARANCE = Parameter("clearance", 20e-9, "m", "not in the text")
LIMIT = Parameter("force limit", 0.5e-6, "N", "ours; the margin is for the contact at this load")
PARAMETERS = (
    LITERAL, REPAIRED, ALPHA_F, GAIN, PROPORTIONAL, NOISE, SPRING, paper.MICA, MEAN, AMPLITUDE, PERIOD, CLEARANCE,
    LIMIT, touching.RATE, touching.PAPER_RATE,
)  # fmt: skip
CYCLES = 2.0
CONVERGED = 0.1
"""an error below this share of the amplitude of the hand counts as convergence"""


def session(alpha_p: float, rate: float, minimum_margin: float = margins.MINIMUM) -> nt.Session:
    """The paper's simulation: of all noise only the gauge's; literally Eq. 17 and a stage without dynamics."""
    scene, rig = presets.paper_mica()
    rig["probe.noise"] = rig["probe.temperature"] = 0.0
    if minimum_margin == 0.0:
        rig["stage.resonance"], rig["stage.quality"] = 1e5, 0.5
        rig["stage.resolution"] = rig["stage.command_resolution"] = 0.0
    chosen = touching.settings(
        rig, rate, alpha_p=alpha_p, alpha_f=ALPHA_F.value, force_gain=GAIN.value, stage_proportional=PROPORTIONAL.value
    )
    chosen["limits.force"] = LIMIT.value
    return nt.Session(
        scene, rig, settings=chosen, control="paper" if minimum_margin == 0.0 else "default", preflight=False,
        clearance=CLEARANCE.value, minimum_margin=minimum_margin, probe_model="quasi-static", seed=1,
    )  # fmt: skip


def reproduce() -> Reproduction:
    """Compute the figure."""
    literal = session(LITERAL.value, touching.PAPER_RATE.value, 0.0)
    refusal = literal.margins()
    repaired = session(REPAIRED.value, touching.RATE.value)
    script = touching.sinusoid(MEAN.value, AMPLITUDE.value, PERIOD.value, CYCLES)
    runs = {"literal": run(literal, operator=script), "repaired": run(repaired, operator=script)}
    found = touching.columns(runs, CYCLES * PERIOD.value)
    statements = (
        _literal(runs["literal"]), _refused(refusal), _converges(runs["repaired"]), _held(runs["repaired"]),
    )  # fmt: skip
    titles = {
        "literal": r"literal: $\alpha_p$ = 15e-9 m/m, 3 ms, Eq. 17",
        "repaired": r"repaired: $\alpha_p$ = 15e-6 m/m, 10 kHz",
    }  # fmt: skip
    return Reproduction(
        16, "simulated touch, sinusoidal hand, K_f = 100", PARAMETERS, found, statements,
        lambda figure: touching.panels(figure, found, titles),
    )  # fmt: skip


def _settled(recording: nt.Recording) -> nt.Recording:
    return recording[recording.time > 0.5 * PERIOD.value]


def _literal(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.force_error(_settled(recording)))
    travel = LITERAL.value * 0.02
    needed = REPAIRED.value * 0.02 / LITERAL.value
    return Statement(
        "master and slave forces converge to the same value (parameters as printed)", "VI-B, Fig. 16",
        holds(error < CONVERGED * AMPLITUDE.value), "RMS of f_m - alpha_f f_s", error, "N",
        f"2 cm of the master are {quantity(travel, 'm')} of the tip, which never arrives: the path of "
        f"{quantity(REPAIRED.value * 0.02, 'm')} would take a master of {needed:.3g} m.",
    )  # fmt: skip


def _refused(found: nt.margins.Margins) -> Statement:
    return Statement(
        "K_f = 100 can be used with the given gauge noise at 3 ms", "VI-B", holds(found.refusal is None),
        f"margin of {found.rule}", found.least, "",
        f"The noise alone is {quantity(found.force_noise, 'N')} RMS at the motor, whose limit is 5 N. That of a real "
        "probe, which the simulation leaves out, would add 3.3 N.",
    )  # fmt: skip


def _converges(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.force_error(_settled(recording)))
    return Statement(
        "master and slave forces converge to the same value (alpha_p per millimetre, 10 kHz)", "VI-B, Fig. 16",
        holds(error < CONVERGED * AMPLITUDE.value), "RMS of f_m - alpha_f f_s", error, "N",
        f"The noise of the gauge, {quantity(NOISE.value, 'N')} RMS, is most of it. By the law the means agree exactly "
        "for any K_f.",
    )  # fmt: skip


def _held(recording: nt.Recording) -> Statement:
    error = touching.rms(touching.position_error(_settled(recording)))
    return Statement(
        "x_s = alpha_p x_m is held all the time (alpha_p per millimetre, 10 kHz)", "VI-B",
        holds(error < 1e-9), "RMS of alpha_p x_m - x_s", error, "m",
        "Behind the 450 Hz stage, with notch and integral; one step of the stage is 1 nm.",
    )  # fmt: skip
