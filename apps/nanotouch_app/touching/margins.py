# SPDX-License-Identifier: BSD-3-Clause
"""How far a loop is from its stability limit, before anything moves. Told are the rules R1 to R5, the exact limit,
Llewellyn's number, Z-width, the resolution budget and the verdict. The stability map shows theory and simulation. Of
a recording: the same at the stiffness that it met, its energy and its Z-width."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import margins, plots, record
from nanotouch.errors import InvalidValue, require
from nanotouch.plots import BLUE, GREEN, ORANGE, VERMILION, new_figure, saved
from nanotouch.touch.margins import Margins, Resolution
from nanotouch.touch.options import INDENTATION_RANGE
from nanotouch.touch.record import write_csv
from nanotouch.touch.session import MODES, settings_for_path

from nanotouch_app.common import output, scenes
from nanotouch_app.common.quantity import parse_quantity
from nanotouch_app.touching import loop, stability
from nanotouch_app.touching.stability import Floats, Limit

FILES = ("margins.json", "stability.csv", "stability.png", "z_width.png")
RATES = (300.0, 1e3, 3e3, 10e3, 30e3)
"""at which the limit is sought in simulation [Hz]"""
MODULI = {1e13: "rigid", 3e8: "soft"}
"""of the bodies in these trials [Pa]"""
GAINS = (0.0, 2.0, 10.0, 100.0)
"""K_f of the Z-width"""
CLEARANCE = 0.1e-6


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("margins", description=__doc__)
    parser.add_argument("scene", nargs="?", metavar="SCENE", help=scenes.HELP.format(what="scene, rig and gains")
                        + "; or the recording.mcap of a session (default: the paper's)")  # fmt: skip
    loop.add_options(parser)
    parser.add_argument("--mode", choices=MODES, default="point", help="(default: %(default)s)")
    parser.add_argument("--path", metavar="LENGTH", help="of the stage, as 0.4um, for the resolution budget")
    output.add_options(parser)
    parser.add_argument("--no-map", action="store_true", help="numbers only")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command: 0 if a session would be armed, 1 if it would be refused."""
    if args.scene and Path(args.scene).suffix == ".mcap":
        return _recorded(args)
    scene, rig, tables = scenes.read(args.scene)
    settings = settings_for_path(rig, clearance=CLEARANCE, load=scene.range.maximum_load)
    plan = scene.plan()
    loop.scale_force(args.force_range, plan, rig, settings)
    settings.update_from_tables(tables)
    loop.close(settings, args)
    if not loop.says_scale(tables, args.force_range):
        settings.gains.alpha_f = margins.felt_alpha_f(rig, settings, plan, load=scene.range.maximum_load)
    path = CLEARANCE + INDENTATION_RANGE if args.path is None else parse_quantity(args.path, "m")
    stiffness = plan.maximum_stiffness
    found, budget = margins.compute(rig, settings, stiffness, args.mode), margins.resolution(rig, settings, path)
    calm, hand = margins.calm(rig, settings, stiffness), margins.motor_bound(rig, settings)
    if not args.no_map:
        require("matplotlib", "app")
    with output.folder(args, FILES) as out:
        output.say(
            "\n".join(
                [
                    *(f"warning: {warning}" for warning in plan.warnings),
                    words(found, budget, settings, rig),
                    f"felt: {calm}",
                    str(hand),
                ]
            )
        )
        facts = {
            "contact_stiffness": stiffness,
            **found._asdict(),
            "refusal": found.refusal,
            **budget._asdict(),
            "hand": hand._asdict(),
            "calm": {name: _plain(value) for name, value in calm.facts().items()},
        }
        args.answer = {name: _plain(value) for name, value in facts.items()}
        output.write_json(out / "margins.json", args.answer)
        if not args.no_map:
            _map(rig, settings, out)
        output.say(f"written to {out}/: {', '.join(name for name in FILES if (out / name).exists())}")
    return 0 if found.refusal is None else 1


def _recorded(args: argparse.Namespace) -> int:
    """Margins, energy and Z-width of a recording: 0 if it was passive, 1 if not."""
    given = [name for name in ("rate", "delay", "force_range", "path") if getattr(args, name) is not None]
    if given or args.control != "default" or args.mode != "point":
        raise InvalidValue(f"{args.scene}: a recording holds its own rate, law, mode, delay and scales")
    with output.busy("reading"):
        recording = record.read(args.scene)
        felt = margins.of_recording(recording)
    with output.folder(args, FILES) as out:
        output.say(_felt(felt))
        facts = {
            "contact_stiffness": felt.contact_stiffness, "felt_stiffness": felt.felt_stiffness,
            "drag": felt.free_damping, "energy": float(felt.energy[-1]), "dissipated": float(felt.dissipated[-1]),
            "is_passive": felt.is_passive, **felt.margins._asdict(),
        }  # fmt: skip
        args.answer = {name: _plain(value) for name, value in facts.items()}
        output.write_json(out / "margins.json", args.answer)
        if not args.no_map:
            plots.z_width(recording, save=out / "z_width.png")
        output.say(f"written to {out}/: {', '.join(name for name in FILES if (out / name).exists())}")
    return 0 if felt.is_passive else 1


def _felt(felt: margins.Felt) -> str:
    """What a recording has met, for a reader."""
    energy, kept = float(felt.energy[-1]), float(felt.dissipated[-1])
    return (
        f"met            contact of {felt.contact_stiffness:.3g} N/m (inf: stiffer than can be told), "
        f"{felt.felt_stiffness:.3g} N/m at the hand\n"
        f"drag in air    {felt.free_damping:.3g} N s/m measured, {felt.margins.free_damping:.3g} by the law\n"
        f"R1 contact     margin {felt.margins.margin:.3g}, exact limit {felt.margins.exact_limit:.4g} N/m over kappa "
        f"{felt.margins.loop_stiffness:.3g} N/m\n"
        f"energy         {energy * 1e3:.3g} mJ from the hand, {kept * 1e3:.3g} mJ kept by the loop, as read: a step "
        "of the master counts before the force answers it\n"
        f"verdict: {'passive' if felt.is_passive else 'NOT PASSIVE'}; min margin {felt.margins.verdict}"
    )


def words(found: Margins, budget: Resolution, settings: nt.Settings, rig: nt.Rig) -> str:
    """All numbers for a reader, one rule a line."""
    gains = settings.gains
    rows = [
        ("R1 contact", f"kappa {found.loop_stiffness:.3g} N/m, stable by rule of thumb to {found.stability_limit:.3g} "
         f"N/m (b_m over a delay of {found.loop_delay * 1e3:.3g} ms): margin {found.margin:.3g}{_decides(found)}"),
        ("exact limit", _exact(found)),
        ("R2 finger pad", f"K_f {gains.force_gain:g} of {_limit(found.pad_limit)}"),
        ("R3 finger mass", f"K_f {gains.force_gain:g} of {_limit(found.mass_limit)}"),
        ("exact K_f", f"{gains.force_gain:g} of {_limit(found.force_gain_limit)}, filters and hand included"),
        ("R4 steps", f"one step of stage or master is {found.quantisation_step:.3g} N at the motor, which has "
         f"{rig.master.max_force:.3g} N"),
        ("R5 noise", f"{found.force_noise:.3g} N RMS at the motor: margin {_over(rig, 3.0 * found.force_noise)}"),
        ("topography", f"height servo: margin {found.height_margin:.3g}"),
        ("Llewellyn", f"{found.llewellyn:.3g} at the least below {margins.HAND_BAND:g} Hz; 1 would be stable against "
         "any surface, a sampled loop never is"),
        ("Z-width", f"from {found.free_damping:.3g} N s/m and {found.free_mass * 1e3:.3g} g in air to "
         f"{found.passive_stiffness:.3g} N/m by R1, {found.stable_stiffness:.3g} N/m stable, at the hand"),
        ("bandwidth", f"the contact's stiffness is felt within 3 dB up to {found.bandwidth:.3g} Hz"),
        ("passivity", _passive(found, settings)),
    ]  # fmt: skip
    lines = [f"{name:14s} {text}" for name, text in rows]
    lines += ["resolution:", *(f"  {line}" for line in str(budget).splitlines())]
    verdict = "armed" if found.refusal is None else f"REFUSED, {found.refusal}"
    return "\n".join([*lines, f"verdict: {verdict}; min margin {found.verdict}"])


def _decides(found: Margins) -> str:
    """R1 knows no hand: a spring or mass on the gauge can leave less."""
    if not 0.0 < found.exact_limit < found.stability_limit:
        return ""
    return f"; TOO MUCH by a factor of {found.stability_limit / found.exact_limit:.3g}, the exact limit decides"


def _passive(found: Margins, settings: nt.Settings) -> str:
    """Up to where the hand is given no energy."""
    if found.passive_up_to >= 0.5 * settings.gains.rate:
        return "the loop gives the hand no energy at any frequency"
    return (
        f"above {found.passive_up_to:.3g} Hz the loop can give the hand energy (Re Z < 0: low-pass of f_m and delays); "
        "which hand that stirs the exact limit tells"
    )


def _exact(found: Margins) -> str:
    if not found.exact_limit > 0.0:
        return "unstable without any contact: the stage's own loop"
    ratio = found.exact_limit / found.loop_stiffness if found.loop_stiffness > 0.0 else math.inf
    return f"kappa {found.exact_limit:.4g} N/m, oscillating at {found.exact_frequency:.3g} Hz: margin {ratio:.3g}"


def _over(rig: nt.Rig, force: float) -> str:
    return f"{rig.master.max_force / force:.3g}" if force > 0.0 else "inf"


def _limit(value: float) -> str:
    return "no limit (none described)" if math.isinf(value) else f"{value:.3g}"


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _map(rig: nt.Rig, settings: nt.Settings, out: Any) -> None:
    trials: dict[str, list[Limit]] = {}
    with output.progress_bar("trials on the simulated rig") as progress:
        for number, (modulus, name) in enumerate(MODULI.items()):
            share = (lambda first: lambda done: progress((first + done) / len(MODULI)))(number)
            trials[name] = stability.limits(rig, settings, np.array(RATES), modulus, share)
    rows = [(name, *limit) for name, found in trials.items() for limit in found]
    headers = (
        "contact (name)", "rate [Hz]", "K_f limit in simulation [-]", "contact stiffness [N/m]", "K_f limit exact [-]"
    )  # fmt: skip
    columns = {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}
    write_csv(out / "stability.csv", columns, {"command": "nanotouch margins"})
    saved(draw(rig, settings, trials), out / "stability.png", dpi=140)


def draw(rig: nt.Rig, settings: nt.Settings, trials: dict[str, list[Limit]]) -> Any:
    """Left: K_f over the rate at three stiffnesses. Right: the Z-width over the rate at four K_f."""
    figure = new_figure(12.5, 6.2)
    left, right = figure.subplots(1, 2)
    rates = np.geomspace(100.0, 100e3, 121)
    _gain_panel(left, rig, settings, trials, rates)
    _width_panel(right, rig, settings, rates)
    for panel in (left, right):
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel("rate of the force loop (Hz)")
        panel.grid(alpha=0.3, which="both", lw=0.5)
        panel.axvline(settings.gains.rate, color="0.4", lw=0.8)
        panel.legend(fontsize="small", frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3)
    return figure


def _gain_panel(panel: Any, rig: nt.Rig, settings: nt.Settings, trials: dict[str, list[Limit]], rates: Floats) -> None:
    gains, k_c = settings.gains, rig.probe.spring_constant
    contacts = {name: found[0].contact_stiffness for name, found in trials.items()}
    contacts["softer"] = 0.25 * k_c
    for (name, stiffness), colour in zip(contacts.items(), (BLUE, VERMILION, GREEN), strict=True):
        exact, rule = stability.exact_gains(stability.ideal(rig), settings, rates, stiffness)
        effective = k_c / (1.0 + k_c / stiffness)
        panel.plot(rates, exact, color=colour, label=f"{name}: $k_{{eff}}$ = {effective:.3g} N/m, exact")
        panel.plot(rates, rule, color=colour, ls=":")
        found = [limit for limit in trials.get(name, ()) if math.isfinite(limit.force_gain)]
        if found:
            panel.plot([limit.rate for limit in found], [limit.force_gain for limit in found], "o", mfc="none",
                       mec=colour, label=f"{name}, simulated rig")  # fmt: skip
    panel.plot(gains.rate, max(gains.force_gain, 0.1), "k*", ms=10, label="this loop")
    panel.set_ylabel("force gain $K_f$")
    panel.set_title("Unstable above the line (exact; dotted: R1)", loc="left", fontsize="medium")


def _width_panel(panel: Any, rig: nt.Rig, settings: nt.Settings, rates: Floats) -> None:
    passive, stable = (np.empty((len(GAINS), len(rates))) for _ in range(2))
    for i, gain in enumerate(GAINS):
        for j, rate in enumerate(rates):
            own = settings.copy()
            own["gains.force_gain"], own["gains.rate"] = gain, float(rate)
            found = margins.compute(rig, own, math.inf)
            passive[i, j], stable[i, j] = found.passive_stiffness, found.stable_stiffness
    for gain, low, high, colour in zip(GAINS, passive, stable, (BLUE, GREEN, ORANGE, VERMILION), strict=True):
        panel.plot(rates, np.where(high > 0.0, high, np.nan), color=colour, label=f"$K_f$ = {gain:g}")
        panel.plot(rates, low, color=colour, ls=":")
    here = settings.gains.alpha_f * settings.gains.alpha_p * rig.probe.spring_constant
    panel.plot(settings.gains.rate, here, "k*", ms=10, label="this loop, rigid sample")
    panel.set_ylabel(r"stiffness at the hand, $\alpha_f \alpha_p k_{eff}$ (N/m)")
    panel.set_title("Z-width: the stiffest contact that can be felt (exact; dotted: R1)", loc="left", fontsize="medium")
