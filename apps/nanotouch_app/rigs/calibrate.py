# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch rig calibrate``: drive a rig, fit its numbers with their uncertainties, write them to the rig file.

Each job names what has to be so before it begins. A simulated half is driven, too: that is a rehearsal.
"""

from __future__ import annotations

import argparse
import datetime
import math
import os
import re
import tempfile
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import rig_file
from nanotouch.errors import InvalidValue
from nanotouch.touch import calibrate
from nanotouch.touch.calibrate import Value
from nanotouch.units import from_si, in_words, key_spellings

from nanotouch_app.common.quantity import parse_quantity

NEEDS = {
    "stage": "nothing is below the tip for the whole stroke",
    "response": "nothing is below the tip",
    "master": "nobody holds the master",
    "sensitivity": "a hard sample is below the tip, within --way",
    "lever": "the end of a lever of known stiffness is below the tip, within --way; and sensitivity is asked for, too",
    "thermal": "a spectrum of the free lever is in --spectrum",
    "sader": "--length, --width, --resonance and --quality are of the free lever",
}
FIELDS = {  # where a number is kept: table, name, unit; and its sigma, if there is a key for it
    "stage.resonance": ("stage", "resonance", "Hz", ""),
    "stage.quality": ("stage", "quality", "", ""),
    "stage.hysteresis": ("stage", "hysteresis", "", ""),
    "delay": ("converters", "dac_latency", "s", ""),
    "master.mass": ("master", "mass", "kg", ""),
    "master.damping": ("master", "damping", "N s/m", ""),
    "probe.sensitivity": ("probe", "sensitivity", "m/V", "sensitivity_sigma"),
    "probe.spring_constant": ("probe", "spring_constant", "N/m", "spring_constant_sigma"),
}
NONE_BELOW_0 = ("stage.hysteresis", "delay")


def add_options(parser: argparse.ArgumentParser) -> None:
    """What a calibration has to be told."""
    parser.add_argument("jobs", nargs="+", choices=NEEDS, metavar="JOB",
                        help="; ".join(f"{job}: {words}" for job, words in NEEDS.items()))  # fmt: skip

    def quantity(flag: str, unit: str, default: float | None, words: str) -> None:
        parser.add_argument(flag, type=lambda text: parse_quantity(text, unit), default=default, help=words)

    quantity("--stroke", "m", 1e-6, "of job stage; the longer, the better the hysteresis (default: 1um)")
    quantity("--press", "m", 100e-9, "deflection to press to (default: 100nm)")
    quantity("--way", "m", 2e-6, "the stage seeks the sample no farther than this (default: 2um)")
    quantity("--speed", "m/s", 1e-6, "while it seeks and presses (default: 1um/s)")
    quantity("--sample-stiffness", "N/m", math.inf, "of the contact with the hard sample (default: rigid)")
    quantity("--lever-stiffness", "N/m", None, "of the reference lever")
    quantity("--length", "m", None, "of the cantilever (sader)")
    quantity("--width", "m", None, "of the cantilever (sader)")
    quantity("--resonance", "Hz", None, "of the free cantilever (sader)")
    parser.add_argument("--quality", type=float, help="of the free cantilever (sader)")
    parser.add_argument("--lever-sigma", type=float, default=0.05, help="of its stiffness, over it (default: 0.05)")
    parser.add_argument("--spectrum", type=Path, metavar="FILE", help="thermal spectrum, .tnd, or CSV: Hz, m^2/Hz")
    parser.add_argument("--averages", type=int, help="periodograms that the spectrum is the mean of")
    parser.add_argument("--true-deflection", action="store_true",
                        help="the spectrum is of the lever's end, not of an optical lever's light")  # fmt: skip
    parser.add_argument("--rate", type=lambda text: parse_quantity(text, "Hz"), default=1e4, help="(default: 10kHz)")
    parser.add_argument("--seed", type=int, default=1, help="of a simulated rig")
    parser.add_argument("--write", action="store_true", help="write what was found to the rig file")


class Bench:
    """A rig file's halves to be driven, and what has been found."""

    def __init__(self, args: argparse.Namespace, file: rig_file.RigFile) -> None:
        self.args, self.rig, self.file = args, nt.Rig.from_tables(file.rig), file
        self.period = 1.0 / args.rate
        self.values: dict[str, Value] = {}
        self.stiffness: dict[str, Value] = {}
        """k_c by method"""
        self.hard: Value | None = None

    def drive(self, path: Any, *, is_master: bool = False, **more: Any) -> calibrate.Driven:
        half: Any = self.file.master if is_master else self.file.slave
        if half is None:
            clearance = self.args.way / 2 if "turn" in more else 0.5 * self.rig.stage.travel
            half = calibrate.simulated(self.rig, nt.Scene().plan(), period=self.period, clearance=clearance,
                                       seed=self.args.seed)  # fmt: skip
        return calibrate.drive(half, path, period=self.period, is_master=is_master, **more)

    def press(self) -> Value:
        points = max(2, round(self.args.way / (self.args.speed * self.period)))
        run = self.drive(np.linspace(0.0, self.args.way, points), turn=self.args.press, returns=True)
        if run.felt.max() < 0.9 * self.args.press:
            raise InvalidValue(f"way = {in_words(self.args.way, 'm')}: no contact within it")
        return calibrate.contact_slope(run)

    def needed(self, *names: str) -> list[Any]:
        found = [getattr(self.args, name) for name in names]
        for name, value in zip(names, found, strict=True):
            if value is None:
                raise InvalidValue(f"--{name.replace('_', '-')} is missing")
        return found


def _stage(bench: Bench) -> None:
    if not 0.0 < bench.args.stroke <= 0.5 * bench.rig.stage.travel:
        raise InvalidValue(f"stroke = {in_words(bench.args.stroke, 'm')}: valid is up to half of the travel, "
                           f"{in_words(0.5 * bench.rig.stage.travel, 'm')}")  # fmt: skip
    path = calibrate.staircase(bench.args.stroke, period=bench.period)
    bench.values |= calibrate.stage_gain(bench.drive(path), bench.rig, stroke=bench.args.stroke)


def _response(bench: Bench) -> None:
    stage = bench.rig.stage
    highest = min(3.0 * stage.resonance, 0.3 * bench.args.rate)
    path = calibrate.sweep(stage.max_speed, lowest=0.1 * stage.resonance, highest=highest, period=bench.period)
    bench.values |= calibrate.stage_response(bench.drive(path), bench.rig)


def _master(bench: Bench) -> None:
    path = calibrate.pushes(bench.rig, period=bench.period)
    bench.values |= calibrate.master_motion(bench.drive(path, is_master=True), bench.rig)


def _sensitivity(bench: Bench) -> None:
    bench.hard = bench.press()
    slave = bench.file.slave
    sigma = slave.setup["position"][2]["uncertainty"] if isinstance(slave, rig_file.Converters) else 0.0
    bench.values["probe.sensitivity"] = calibrate.sensitivity(
        bench.hard, bench.rig, position_sigma=sigma, sample_stiffness=bench.args.sample_stiffness
    )


def _lever(bench: Bench) -> None:
    if bench.hard is None:
        raise InvalidValue("job lever needs sensitivity before it")
    if "sensitivity" in bench.args.jobs and bench.file.slave is not None:
        input("put the reference lever below the tip, then press Enter ")
    (stiffness,) = bench.needed("lever_stiffness")
    bench.stiffness["reference lever"] = calibrate.reference_lever(
        bench.hard, bench.press(), stiffness, stiffness_sigma=stiffness * bench.args.lever_sigma
    )


def _thermal(bench: Bench) -> None:
    file, averages = bench.needed("spectrum", "averages")
    if file.suffix.lower() == ".tnd":
        from nanotouch.curves.thermal_file import thermal_spectrum

        found = thermal_spectrum(file)
        frequency, density = found.frequency, found.density
    else:
        try:
            frequency, density = np.loadtxt(file, delimiter=",", comments="#", ndmin=2).T
        except (OSError, ValueError) as error:
            raise InvalidValue(f"{file}: two columns are expected, Hz and m^2/Hz: {error}") from None
    known = bench.values.get("probe.sensitivity")
    share = known.sigma / known.value if known else bench.rig.probe.sensitivity_sigma
    bench.stiffness["thermal"] = calibrate.thermal(
        frequency, density, averages=averages, temperature=bench.rig.probe.temperature, sensitivity_sigma=share,
        correction=0.971 if bench.args.true_deflection else 0.817,
    )  # fmt: skip


def _sader(bench: Bench) -> None:
    from nanotouch.curves.sader import sader

    length, width, resonance, quality = bench.needed("length", "width", "resonance", "quality")
    value, _ = sader(length=length, width=width, resonance=resonance, quality_factor=quality)
    sigma = math.hypot(2.0 * 0.02, 0.02, 0.02)  # width by 2 %, enters squared; length and Q by 2 %
    bench.stiffness["sader"] = Value(value, sigma * value, "N/m")


JOBS: dict[str, Callable[[Bench], None]] = {
    "stage": _stage, "response": _response, "master": _master, "sensitivity": _sensitivity, "lever": _lever,
    "thermal": _thermal, "sader": _sader,
}  # fmt: skip


def run(args: argparse.Namespace, file: rig_file.RigFile) -> int:
    """Do the jobs in their order; print, and write if asked."""
    bench = Bench(args, file)
    for job in [job for job in JOBS if job in args.jobs]:
        JOBS[job](bench)
    for method, value in bench.stiffness.items():
        print(f"spring constant, {method}: {_told(value)}")
    if bench.stiffness:
        bench.values["probe.spring_constant"] = calibrate.combined(bench.stiffness)
    for name, value in bench.values.items():
        print(f"{name}: {_told(value)}")
    args.answer |= {name: value._asdict() for name, value in bench.values.items()}
    if args.write:
        write(args.file, bench.values, file)
        print(f"written to {args.file}")
    return 0


def _told(value: Value) -> str:
    return f"{in_words(value.value, value.unit, 6)} +- {in_words(value.sigma, value.unit, 2)}"


# --- the rig file, whose comments stay ---


def write(path: Path, values: dict[str, Value], file: rig_file.RigFile) -> None:
    """Put what was found into the file, with sigma and date. The file is replaced as a whole, or left as it was."""
    text = path.read_text(encoding="utf-8")
    today = datetime.datetime.now().astimezone().date().isoformat()
    slave = file.slave if isinstance(file.slave, rig_file.Converters) else None
    for name, value in values.items():
        if name in ("stage.gain", "probe.sensitivity") and slave is not None:
            table, axis = ("slave.travel_z", "driven") if name == "stage.gain" else ("slave.deflection_z", "felt")
            channel = slave.setup[axis][2]
            reference = slave.setup["position"][2]["uncertainty"] if name == "stage.gain" else 0.0
            share = math.hypot(value.sigma / value.value, reference)
            gain = (
                channel["gain"] * value.value if name == "stage.gain" else math.copysign(value.value, channel["gain"])
            )
            text = put(text, table, "gain", "m/V", gain)
            for end in ("minimum", "maximum"):  # the same volts as before
                moved = channel["offset"] + (channel[end] - channel["offset"]) * gain / channel["gain"]
                text = put(text, table, end, "m", moved)
            text = put(text, table, "uncertainty", "", share)
            text = re.sub(rf"(^\[{re.escape(table)}\][^\[]*?^calibrated\s*=\s*)\S+", rf"\g<1>{today}", text, flags=re.M)
        elif name in FIELDS:
            table, key, unit, sigma = FIELDS[name]
            number = max(0.0, value.value) if name in NONE_BELOW_0 else value.value
            text = put(text, table, key, unit, number, f"+- {value.sigma:.2g} {unit}".rstrip() + f", {today}")
            if sigma:
                text = put(text, table, sigma, "", value.sigma / value.value, today)
    made = rig_file.described(tomllib.loads(text), path.parent)
    nt.Rig.from_tables(made.rig)  # refused before anything is replaced
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as new:
        new.write(text)
    os.chmod(new.name, path.stat().st_mode & 0o777)
    os.replace(new.name, path)


def put(text: str, table: str, name: str, unit: str, value: float, comment: str = "") -> str:
    """The text with this key of a table set, in the spelling that it has there."""
    lines, keys = text.splitlines(), key_spellings(name, unit)
    heads = [n for n, line in enumerate(lines) if re.match(r"\s*\[", line)]
    at = next((n for n in heads if re.match(rf"\s*\[\s*{re.escape(table)}\s*\]", lines[n])), None)
    if at is None:
        lines += ["", f"[{table}]"]
        at = len(lines) - 1
    end = next((n for n in heads if n > at), len(lines))
    for n in range(at + 1, end):
        found = re.match(r"\s*([A-Za-z_0-9]+)\s*=\s*[^#]*?(\s*#.*)?$", lines[n])
        if found and found[1] in keys:
            note = f"  # {comment}" if comment else found[2] or ""
            lines[n] = f"{found[1]} = {from_si(value, keys[found[1]])!r}{note}"
            return "\n".join(lines) + "\n"
    key = next(key for key, factor in keys.items() if factor == 1.0)
    lines.insert(at + 1, f"{key} = {float(value)!r}" + (f"  # {comment}" if comment else ""))
    return "\n".join(lines) + "\n"
