# SPDX-License-Identifier: BSD-3-Clause
"""A real half in a rig file: which chip's channel is which position, force or deflection, and what a volt means.

::

    file = nt.rig_file.read("rig.toml")
    session = nt.Session(rig=nt.Rig.from_tables(file.rig), slave=file.slave)    # and session.start(pace="hard")

Nothing of a calibration has a default: a key that is missing is refused by its name. docs/hardware.md has a whole file.
A half may also be a shared object, a program with a mailbox, or slow converters that drivers of IIO run::

    [slave]                           [master]                     [slave]
    backend = "shared_object"         backend = "mailbox"          backend = "iio"
    path = "stage.so"                 name = "falcon"              context = "local:"

A shared object is code: it is refused unless the user has allowed it (:mod:`nanotouch.touch.allowed_code`).
"""

from __future__ import annotations

import datetime
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch._io.files import toml_tables
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.touch import _rig_chips, allowed_code
from nanotouch.touch._rig_table import AXES, Table, keys_of, unit_of
from nanotouch.touch.hal import Mailbox, SharedObject
from nanotouch.units import key_spellings

HALVES = ("master", "slave")
ELSEWHERE = {"shared_object": ("path", "option"), "mailbox": ("name",)}
"""backends that a program of its own makes, with their keys"""
BACKENDS = ("spidev", "iio", *ELSEWHERE, "simulated")


@dataclass(frozen=True)
class Converters:
    """A half on converters, for ``master=`` or ``slave=`` of a session. Its buses are opened with the session."""

    setup: Mapping[str, Any]
    calibrated: Mapping[str, datetime.date]
    """by table: when its volts were compared"""


RealHalf = Converters | SharedObject | Mailbox


class RigFile(NamedTuple):
    """A rig file: the description of the rig, and its real halves."""

    rig: dict[str, Any]
    """tables for :meth:`Rig.from_tables`"""
    master: RealHalf | None
    """None: simulated"""
    slave: RealHalf | None


def _refuse_twice(named: Mapping[str, object], what: str) -> None:
    """What two keys name, one of them has not."""
    seen: dict[object, str] = {}
    for where, value in named.items():
        if value in seen:
            raise InvalidValue(f"{seen[value]} and {where} are the same {what}: {value}")
        seen[value] = where


def _check_wires(half: str, setup: Mapping[str, Any], names: Sequence[str]) -> None:
    """Each output drives one thing, each input measures one."""
    for is_driven in (True, False):
        wires = {
            f"[{half}.{key}]": f"channel {one['channel']} of {names[one['converter']]}"
            for name, keys in keys_of(half).items()
            if (name == "driven") == is_driven
            for key, one in zip(keys, setup[name], strict=True)
            if one
        }
        _refuse_twice(wires, "wire")


def _check_devices(halves: Mapping[str, RealHalf | None]) -> None:
    """Each device is one chip, each line has one purpose, of both halves."""
    devices: dict[str, object] = {}
    lines: dict[str, object] = {}
    for half, found in halves.items():
        if not isinstance(found, Converters):
            continue
        if "context" not in found.setup:  # a device of IIO may both drive and measure
            devices |= {f"[{half}.chips.{chip['name']}]": os.path.realpath(chip["device"])
                        for chip in found.setup["chips"]}  # fmt: skip
        named = found.setup["lines"] or {}
        lines |= {f"[{half}.lines] {name}": named[name] for name in _rig_chips.LINES if named.get(name) is not None}
    _refuse_twice(devices, "device")
    _refuse_twice(lines, "line")


def _half(half: str, table: Table, backend: str) -> Converters:
    context = {"context": _rig_chips.context(table)} if backend == "iio" else {}
    read_chip = _rig_chips.iio_chip if backend == "iio" else _rig_chips.chip
    axes = table.word("axes", int, "1")
    named = table.table("chips", "a table for each chip")
    chips = {name: {"name": name} | read_chip(named.table(name, "a chip")) for name in list(named.left)}
    if not chips:
        raise InvalidValue(f"[{half}.chips] is empty: it needs a table for each chip")
    calibrated: dict[str, datetime.date] = {}
    keys = keys_of(half)
    setup: dict[str, Any] = {"half": half, "axes": axes, "chips": list(chips.values())} | context
    setup["keys"] = list(keys.values())
    for name, tables in keys.items():
        setup[name] = [
            _rig_chips.channel(table.table(key, ""), list(chips), unit_of(half, key), calibrated)
            if key in table.left
            else None
            for key in tables
        ]
    needed = ("position_z",) if half == "master" else ("position_z", "deflection_z", "travel_z")
    for key in needed:
        if f"{half}.{key}" not in calibrated:
            raise InvalidValue(f"[{half}.{key}] is missing: a {half} needs it")
    moved = [f"{needed[-1][:-1]}{axis}" for axis in AXES if f"{half}.{needed[-1][:-1]}{axis}" in calibrated]
    if len(moved) < axes:
        raise InvalidValue(f"[{half}] axes = {axes}: it has {', '.join(moved)} alone")
    if half == "slave" or "lines" in table.left:
        setup["lines"] = _rig_chips.lines(table.table("lines", "a slave that moves needs an emergency stop"))
    else:
        setup["lines"] = None
    table.done()
    _check_wires(half, setup, list(chips))
    setup["amplitude_step"] = _core.rigs.check_converters(setup)
    return Converters(setup, calibrated)


def _elsewhere(half: str, backend: str, table: Table, folder: Path) -> SharedObject | Mailbox:
    """A half of another maker: by its file, which a relative path seeks beside the rig file, or by its name."""
    if backend == "mailbox":
        made: SharedObject | Mailbox = Mailbox(table.word("name", example='"stage"'))
    else:
        path = folder / table.word("path", example='"stage.so"')
        if not path.is_file():
            raise InvalidValue(f"[{half}] path = {str(path)!r}: there is no such file")
        made = SharedObject(path, table.word("option") if "option" in table.left else "")
    table.done()
    return made


def _taken(half: str, tables: dict[str, Any], folder: Path) -> RealHalf | None:
    """The real half, its keys taken out of the tables; what describes the rig stays."""
    given = tables.get(half)
    if half == "slave" and half in tables and not isinstance(given, Mapping):
        raise InvalidValue(f"[{half}] must be a table")
    if not isinstance(given, Mapping) or ("backend" not in given and half == "master" and "chips" not in given):
        return None
    if "backend" not in given:
        raise InvalidValue(
            f'[{half}] backend is missing: write backend = "spidev"; others are {", ".join(BACKENDS[1:])}'
        )
    backend = given["backend"]
    if backend not in BACKENDS:
        raise InvalidValue(f"[{half}] backend = {backend!r}: valid are {', '.join(BACKENDS)}")
    channels = {key for keys in keys_of(half).values() for key in keys}
    context = {"context"} if backend == "iio" else set()
    own = {"backend", *ELSEWHERE.get(backend, {"axes", "chips", "lines"} | channels | context)}
    rest = {key: value for key, value in given.items() if key not in own}
    if half == "master":
        tables[half] = rest | ({"axes": given["axes"]} if "axes" in given else {})
    else:
        del tables[half]
        if rest:
            raise InvalidValue(f"[{half}] has no key {told(next(iter(rest)))}")
    if backend == "simulated":
        return None
    table = Table(half, {key: given[key] for key in given if key in own and key != "backend"})
    return _elsewhere(half, backend, table, folder) if backend in ELSEWHERE else _half(half, table, backend)


def _known(given: Any, stated: Mapping[str, tuple[float, str]]) -> Any:
    """A table of the rig with what the channels say of it, so that margins and guarantee count with it."""
    if not isinstance(given, Mapping):
        return given  # refused with the other tables
    made = dict(given)
    for name, (value, unit) in stated.items():
        keys = key_spellings(name, unit)
        if not set(keys) & set(given):
            made[next(key for key, factor in keys.items() if factor == 1.0)] = value
    return made


def from_tables(tables: Mapping[str, Any], folder: str | PathLike[str] = "", *, allow_code: bool = False) -> RigFile:
    """From the tables of a rig file; refused, with the key's name, if anything is missing or unknown.

    Parameters
    ----------
    tables : mapping
        As ``tomllib`` gives them.
    folder : str or path
        Where the file is, for paths in it.
    allow_code : bool
        Whether a shared object that they name may run.
    """
    found = described(tables, folder)
    for half in HALVES:
        named = getattr(found, half)
        if isinstance(named, SharedObject):
            allowed_code.check(half, named, None, allow_code)
    return found


def described(tables: Mapping[str, Any], folder: str | PathLike[str] = "") -> RigFile:
    """What the tables say, for who runs nothing of it: a shared object in it may be one that is not allowed."""
    left = dict(tables)
    found = {half: _taken(half, left, Path(folder)) for half in HALVES}
    _check_devices(found)
    if isinstance(found["slave"], Converters):
        setup = found["slave"].setup
        deflection = setup["felt"][2]
        lever = {"sensitivity": (abs(deflection["gain"]), "m/V"), "sensitivity_sigma": (deflection["uncertainty"], "")}
        left["probe"] = _known(left.get("probe", {}), lever)
        ways = {"travel_sigma": "driven", "position_sigma": "position"}
        sigmas = {key: (max(axis["uncertainty"] for axis in setup[name][:3] if axis), "") for key, name in ways.items()}
        only = {"axes": (1, "")} if setup["axes"] == 1 else {}
        left["stage"] = _known(left.get("stage", {}), sigmas | only)
        if only and isinstance(left["stage"], Mapping) and left["stage"]["axes"] != 1:
            raise InvalidValue(f"[stage] axes = {left['stage']['axes']!r}: its half has one, [slave] axes = 1")
        if any(setup["lock_in"]):
            noise, step = setup["lock_in"][0]["noise"], setup["amplitude_step"]
            left["tap"] = _known(left.get("tap", {}), {"noise": (noise, "m"), "resolution": (step, "m")})
    return RigFile(left, found["master"], found["slave"])


def is_real(tables: Mapping[str, Any]) -> bool:
    """Whether these tables name a half that is not simulated."""
    halves = [tables.get(half) for half in HALVES]
    return any(isinstance(half, Mapping) and half.get("backend", "simulated") != "simulated" for half in halves)


def read(path: str | PathLike[str], *, allow_code: bool = False) -> RigFile:
    """A rig file.

    Parameters
    ----------
    path : str or path
        The TOML file.
    allow_code : bool
        Whether a shared object that it names may run; by default one that ``nanotouch rig allow`` has remembered. It
        lies in the folder of the file, or one that the user lists (:mod:`nanotouch.touch.allowed_code`).
    """
    found = described(toml_tables(path), Path(path).parent)
    for half in HALVES:
        named = getattr(found, half)
        if isinstance(named, SharedObject):
            allowed_code.check(half, named, path, allow_code)
    return found


class Latency(NamedTuple):
    """How late a loop was woken up."""

    period: float
    """of the loop [s]"""
    ticks: int
    missed: int
    """periods lost as a whole"""
    quantiles: dict[float, float]
    """by share: 0.5, 0.99, 0.999, 0.9999 [s]"""
    longest: float
    """[s]"""
    edges: list[float]
    """where the buckets of the histogram begin, those that hold something [s]"""
    counts: list[int]
    refused: str
    """a line for each wish that the kernel did not grant"""


class FrameTimes(NamedTuple):
    """How long a frame of a chip takes."""

    median: float
    """[s]"""
    late: float
    """what 99.9 % of them do not exceed [s]"""


def latency(period: float, duration: float, *, priority: int = 80, processor: int = -1) -> Latency:
    """Run a loop that does nothing for ``duration`` seconds, and tell how late each wake-up was."""
    if not 1e-6 <= period <= 0.999:
        raise InvalidValue(f"period = {period} s: valid is 1e-06 .. 0.999 s")
    if not period <= duration <= 86400.0:
        raise InvalidValue(f"duration = {duration} s: valid is {period:g} .. 86400 s")
    found = _core.rigs.latency(period, round(duration / period), priority, processor)
    quantiles = {share: found[share] for share in (0.5, 0.99, 0.999, 0.9999)}
    return Latency(
        period, found["ticks"], found["missed"], quantiles, found["most"], found["edges"], found["counts"],
        found["refused"],
    )  # fmt: skip


def frame_times(half: Converters, count: int = 2000) -> list[FrameTimes]:
    """Open the buses of a half and time frames that change nothing, chip by chip."""
    if not 1 <= count <= 10**6:
        raise InvalidValue(f"count = {count}: valid is 1 .. 1000000")
    found = []
    for times in _core.rigs.time_frames(half.setup, count):
        ordered = sorted(times)
        found.append(FrameTimes(ordered[(count - 1) // 2], ordered[min(count - 1, math.ceil(0.999 * count) - 1)]))
    return found


def iio_scan(half: Converters, chip: str, count: int, *, trigger: str | None = None) -> NDArray[np.float64]:
    """Scans of a chip behind IIO, by the buffer of its driver: evenly spaced in time, as a spectrum needs them.

    Parameters
    ----------
    half : Converters
        Of a rig file with ``backend = "iio"``; no session has it open.
    chip : str
        Its table in the rig file, ``[slave.chips.adc]``: ``"adc"``. It measures.
    count : int
        Number of scans. All are waited for: 1 s, and twice their time where trigger or device has a
        ``sampling_frequency``.
    trigger : str, optional
        Name of a trigger of the kernel's; by default the one that the device has.

    Returns
    -------
    array, shape (count, channels)
        A column for each of the chip's ``inputs`` [V].

    Raises
    ------
    DeviceError
        There is no such trigger, or not all scans have come.
    """
    chips = [one["name"] for one in half.setup["chips"]]
    if "context" not in half.setup:
        raise InvalidValue('scans need backend = "iio": a converter on spidev is asked frame by frame')
    if chip not in chips:
        raise InvalidValue(f"chip = {chip!r}: this half has {', '.join(chips)}")
    at = chips.index(chip)
    if half.setup["chips"][at]["is_output"]:
        raise InvalidValue(f"chip = {chip!r} drives: scans are of one that measures")
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= 10**7:
        raise InvalidValue(f"count = {count!r}: valid is 1 .. 10000000")
    scans: NDArray[np.float64] = _core.rigs.iio_scan(half.setup, at, count, trigger)
    return scans
