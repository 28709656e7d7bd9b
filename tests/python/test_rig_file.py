# SPDX-License-Identifier: BSD-3-Clause
"""Rig files: the one in the docs is read, and each thing that is missing or wrong is refused by its name; then the
machine's latency and ``nanotouch rig``, of which no time is judged."""

from __future__ import annotations

import datetime
import random
import re
import tomllib
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from nanotouch import rig_file
from nanotouch.errors import DeviceError, Error, InvalidValue
from nanotouch_app.live import files
from nanotouch_app.main import main

FILE = Path(__file__).parents[2] / "docs/examples/rig/rig.toml"


def tables() -> dict[str, Any]:
    return tomllib.loads(FILE.read_text())


def test_the_file_of_the_docs():
    found = rig_file.read(FILE)
    assert found.master is None
    assert found.slave is not None
    probe = {"spring_constant_N_per_m": 8, "sensitivity_m_per_V": 33e-9, "sensitivity_sigma": 0.02}
    stage = {"axes": 1, "travel_sigma": 0.01, "position_sigma": 0.005}
    assert found.rig == {"probe": pytest.approx(probe), "stage": pytest.approx(stage)}
    assert nt.Rig.from_tables(found.rig).probe.spring_constant == 8.0
    setup = found.slave.setup
    assert [chip["chip"] for chip in setup["chips"]] == ["AD5791", "AD7606"]
    assert setup["chips"][0]["clock"] == 10e6
    assert setup["driven"][2]["gain"] == 1e-6
    assert setup["felt"][2]["gain"] == 33e-9
    assert setup["felt"][2]["uncertainty"] == 0.02
    assert setup["felt"][2]["noise"] == 20e-12
    assert setup["felt"][0] is None
    assert setup["lines"]["debounce"] == 2e-3
    assert set(found.slave.calibrated.values()) == {datetime.date(2026, 11, 20)}


def leaves(given: dict[str, Any], path: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """The path of each table and key below [slave]."""
    found = []
    for key, value in given.items():
        found.append((*path, key))
        if isinstance(value, dict):
            found += leaves(value, (*path, key))
    return found


OPTIONAL = {"noise_nm", "noise_pm", "debounce_ms", "limit_switch", "laser_enable", "watchdog", "convert", "position_z"}
NEEDED = [path for path in leaves(tables()["slave"]) if path[-1] not in OPTIONAL - {"position_z"}]


@pytest.mark.parametrize("path", NEEDED, ids="-".join)
def test_each_key_is_needed_and_named(path: tuple[str, ...]):
    given = tables()
    table = given["slave"]
    for key in path[:-1]:
        table = table[key]
    del table[path[-1]]
    if path == ("backend",):  # without it the half is no real one: its table is unknown
        with pytest.raises(InvalidValue, match="slave"):
            nt.Rig.from_tables(rig_file.from_tables(given).rig)
        return
    name = path[-1].rsplit("_", 3)[0] if "_per_" in path[-1] else path[-1].rsplit("_", 1)[0]
    with pytest.raises(InvalidValue, match=rf"{name}.*(is missing|needs)|this half has"):
        rig_file.from_tables(given)


WRONG = {
    ("slave", "chips", "adc", "clock_MHz"): (18, "AD7606: clock = 1.8e.07 Hz"),
    ("slave", "chips", "adc", "device"): ("/dev/spidev0.0", r"chips.dac\] and .*chips.adc\] are the same device"),
    ("slave", "deflection_z", "channel"): (0, r"position_z\] and .*deflection_z\] are the same wire: channel 0 of adc"),
    ("slave", "lines", "watchdog"): ("estop", r"emergency_stop and .*watchdog are the same line: estop"),
    ("slave", "lines", "debounce_ms"): (-1, "debounce = -0.001 s: valid is 0"),
    ("slave", "chips", "dac", "chip"): ("AD9999", "known are AD5791"),
    ("slave", "chips", "dac", "clock_MHz"): (float("nan"), "finite"),
    ("slave", "chips", "dac", "high_V"): (-10, "converter.span.high"),
    ("slave", "travel_z", "chip"): ("adc", "driven"),
    ("slave", "travel_z", "channel"): (1, "channel.channel"),
    ("slave", "travel_z", "channel "): (0, "has no key 'channel '"),
    ("slave", "travel_z", "gain_um_per_V"): (0, "not 0"),
    ("slave", "travel_z", "gain_nm_per_V"): (1000, "has both"),
    ("slave", "travel_z", "maximum_um"): (11, "channel.maximum"),
    ("slave", "deflection_z", "uncertainty_percent"): (200, "channel.uncertainty"),
    ("slave", "deflection_z", "calibrated"): ("yesterday", "2026-11-20"),
    ("slave", "lines", "emergency_stop"): (4, "estop"),
    ("slave", "lines", "stop"): ("x", "no key 'stop'"),
    ("slave", "axes"): (4, "axes"),
    ("slave", "backend"): ("comedi", "valid are spidev, iio, shared_object, mailbox, simulated"),
    ("slave", "speed"): (1, "no key 'speed'"),
}


@pytest.mark.parametrize("path", WRONG, ids="-".join)
def test_what_is_wrong_is_named(path: tuple[str, ...]):
    given = tables()
    value, words = WRONG[path]
    table = given
    for key in path[:-1]:
        table = table[key]
    table[path[-1]] = value
    with pytest.raises(InvalidValue, match=words):
        rig_file.from_tables(given)


TOMORROW = datetime.date.today() + datetime.timedelta(days=3)  # the tests may go on past midnight
ODD: dict[str, tuple[str, dict[str, Any], str]] = {  # table, what is odd in it, and what the refusal says
    "future": ("slave.position_z", {"calibrated": TOMORROW}, r"slave.position_z\] calibrated = .* is in the future"),
    "coarse": ("slave.travel_z", {"gain_um_per_V": 1e9}, "travel_z: channel.gain, with which the range has 16 steps"),
    "loud": (
        "slave.deflection_z",
        {"noise_pm": 1e9},
        "deflection_z: channel.noise = 0.001 m: valid is 0 .. 6.59",
    ),
    "no start": ("slave.travel_z", {"minimum_um": 2}, "travel_z: channel.minimum of a travel that holds 0 = 2e-06 m"),
    "far": ("slave.travel_z", {"maximum_um": 20}, "travel_z: channel.maximum = 2e-05 m: valid is -1e-05 .. 9.9"),
    "way": ("slave.chips.adc", {"device": "/dev/./spidev0.0"}, "are the same device: /dev/spidev0.0"),
    "two axes": ("slave", {"axes": 2}, r"\[slave\] axes = 2: it has travel_z alone"),
    "rig": ("stage", {"axes": 3}, r"\[stage\] axes = 3: its half has one"),
    "backend": ("slave", {"backend": None}, r"\[slave\] backend is missing: write backend = \"spidev\""),
}


@pytest.mark.parametrize("name", ODD)
def test_what_cannot_be_is_named_with_its_table(name: str):
    given = tables()
    where, odd, words = ODD[name]
    table = given
    for key in where.split("."):
        table = table[key]
    table |= odd
    if odd == {"backend": None}:
        del table["backend"]
    with pytest.raises(InvalidValue, match=words):
        rig_file.from_tables(given)


def test_the_rig_has_the_axes_of_its_half():
    given = tables()
    del given["stage"]
    assert rig_file.from_tables(given).rig["stage"]["axes"] == 1


def test_a_master_on_converters_and_a_simulated_one():
    given = tables()
    given["master"] = {"rate_Hz": 1000, "backend": "simulated"}
    found = rig_file.from_tables(given)
    assert found.master is None
    assert found.rig["master"] == {"rate_Hz": 1000}
    channel = {key: value for key, value in given["slave"]["position_z"].items() if not key.startswith("noise")}
    motor = {"chip": "dac", "channel": 0, "gain_N_per_V": 0.5, "offset_N": 0, "minimum_N": -5, "maximum_N": 4.99,
             "uncertainty_percent": 3, "calibrated": datetime.date(2026, 1, 2)}  # fmt: skip
    given["master"] = {"backend": "spidev", "axes": 1, "chips": given["slave"]["chips"], "position_z": channel,
                       "motor_z": motor}  # fmt: skip
    with pytest.raises(InvalidValue, match=r"\[master.chips.dac\] and \[slave.chips.dac\] are the same device"):
        rig_file.from_tables(given)
    given["master"]["chips"] = {name: chip | {"device": chip["device"].replace("spidev0", "spidev1")}
                                for name, chip in given["slave"]["chips"].items()}  # fmt: skip
    found = rig_file.from_tables(given)
    assert found.master is not None
    assert found.master.setup["driven"][2]["gain"] == 0.5
    assert found.rig["master"] == {"axes": 1}
    assert found.master.setup["lines"] is None


def test_a_session_says_what_device_is_missing():
    half = rig_file.read(FILE).slave
    with pytest.raises(DeviceError, match=r"/dev/spidev0\.0: open: "):
        nt.Session(slave=half)
    with pytest.raises(TypeError, match="these converters are the rig's slave"):
        nt.Session(master=half)


def test_latency_is_counted_whole():
    found = rig_file.latency(1e-3, 0.2, priority=0)
    assert found.ticks <= 200 <= found.ticks + found.missed  # more if it was late beyond the last period
    assert sum(found.counts) == found.ticks
    assert found.quantiles[0.5] <= found.quantiles[0.999] <= found.longest
    with pytest.raises(InvalidValue, match="period"):
        rig_file.latency(0.0, 1.0)
    with pytest.raises(Error):
        rig_file.latency(1e-3, 0.1, processor=10**9)


def test_the_commands(capsys: pytest.CaptureFixture[str], tmp_path: Path):
    assert main(["rig", "check", str(FILE)]) == 0
    assert "AD5791 at /dev/spidev0.0, AD7606 at /dev/spidev0.1; 3 channels" in capsys.readouterr().out
    assert main(["rig", "probe", str(FILE), "--seconds", "0.1"]) == 2
    assert "/dev/spidev0.0: open: " in capsys.readouterr().err
    picture = tmp_path / "wake.png"
    assert main(["latency", "--seconds", "0.2", "--out", str(picture)]) == 0
    told = capsys.readouterr().out
    assert "p99.9" in told
    assert picture.stat().st_size > 1000
    assert main(["latency", "--rate", "0.5Hz"]) == 2
    assert main(["latency", "--out", str(picture)]) == 2
    capsys.readouterr()
    assert main(["latency", "--out", str(tmp_path / "none/wake.png"), "--seconds", "600"]) == 2
    assert "there is no folder" in capsys.readouterr().err


def test_probe_of_simulated_halves_is_that_of_the_machine(capsys: pytest.CaptureFixture[str], tmp_path: Path):
    file = tmp_path / "rig.toml"
    file.write_text("[probe]\nspring_constant_N_per_m = 8\n")
    status = main(["rig", "probe", str(file), "--seconds", "0.2", "--rate", "100Hz"])
    told = capsys.readouterr().out
    assert status in (0, 1)
    assert ("kept" if status == 0 else "not kept: ") in told


def test_check_reads_scene_and_loop_too(capsys: pytest.CaptureFixture[str], tmp_path: Path):
    file = tmp_path / "rig.toml"
    for wrong in ("[gains]\nrat_kHz = 1\n", "[tip]\nradius_nm = -1\n", "[gains]\nrate_kHz = 1e9\n"):
        file.write_text(FILE.read_text() + wrong)
        assert main(["rig", "check", str(file)]) == 2
        assert re.search("rat_kHz|radius|rate", capsys.readouterr().err)


@pytest.mark.parametrize("command", ["plan {}", "margins {} --no-map", "touch --scene {} --mode curve --surface flat",
                                     "curve --scene {}"])  # fmt: skip
def test_a_rehearsal_needs_one_word(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, undrawn: None):
    """backend = "simulated" in a file of a real half: all commands take it."""
    monkeypatch.chdir(tmp_path)
    Path("rig.toml").write_text(FILE.read_text().replace('"spidev"', '"simulated"'))
    assert main(command.format("rig.toml").split()) == 0
    assert files.of_scene(Path("rig.toml")).rig.probe.spring_constant == 8.0  # nanotouch live


def test_two_axes_on_one_output():
    given = tables()
    slave = given["slave"]
    slave["axes"] = 2
    slave["travel_x"], slave["position_x"] = dict(slave["travel_z"]), dict(slave["position_z"], channel=2)
    with pytest.raises(InvalidValue, match=r"travel_x\] and \[slave.travel_z\] are the same wire: channel 0 of dac"):
        rig_file.from_tables(given)


STRANGE: list[Any] = [
    None, True, -1, 0, 10**30, -(2**31) - 1, 1e308, float("nan"), float("-inf"), "", "x\x00y", "é" * 300, [], [1, 2],
    {}, {"a": {"b": 1}}, datetime.date(1, 1, 1), datetime.time(1, 2), b"bytes",
]  # fmt: skip


@pytest.mark.parametrize("seed", range(8))
def test_dice_are_refused_in_words_or_taken(seed: int):
    dice = random.Random(seed)
    taken = 0
    for _ in range(400):
        given = tables()
        for _ in range(dice.choice([1, 1, 2, 3])):
            path = dice.choice(leaves(given))
            table = given
            for key in path[:-1]:
                table = table[key]
            if not isinstance(table, dict):
                continue
            what = dice.random()
            if what < 0.2:
                table.pop(path[-1], None)
            elif what < 0.3:
                table[path[-1] + dice.choice(["_", "_nm", " ", "é"])] = table.get(path[-1])
            else:
                table[path[-1]] = dice.choice(STRANGE)
        try:
            rig_file.from_tables(given)
            taken += 1
        except InvalidValue as refused:
            assert str(refused)  # noqa: PT017  some are refused, some not
    assert taken < 400


def test_a_half_of_a_program_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "stage.so").touch()
    file = tmp_path / "rig.toml"
    file.write_text("[stage]\naxes = 1\n[slave]\nbackend = 'shared_object'\npath = 'stage.so'\noption = 'a b'\n"
                    "[master]\nbackend = 'mailbox'\nname = 'falcon'\nmax_force_N = 3\n")  # fmt: skip
    found = rig_file.read(file, allow_code=True)
    assert found.slave == nt.hal.SharedObject(tmp_path / "stage.so", "a b")
    assert found.master == nt.hal.Mailbox("falcon")
    assert found.rig == {"stage": {"axes": 1}, "master": {"max_force_N": 3}}
    assert rig_file.is_real(tomllib.loads(file.read_text()))
    assert not rig_file.is_real({"slave": {"backend": "simulated"}, "master": {"max_force_N": 3}})
    assert main(["rig", "check", str(file)]) == 0
    assert f"slave: the shared object {tmp_path / 'stage.so'}" in capsys.readouterr().out


ELSEWHERE = {
    "no such file": {"backend": "shared_object", "path": "none.so"},
    "path is missing": {"backend": "shared_object"},
    "name is missing": {"backend": "mailbox"},
    "no key 'path'": {"backend": "mailbox", "name": "stage", "path": "stage.so"},
    "write option": {"backend": "shared_object", "path": "here", "option": 3},
    "valid are spidev, iio, shared_object, mailbox, simulated": {"backend": "usb"},
}


@pytest.mark.parametrize("words", ELSEWHERE)
def test_a_wrong_half_of_a_program_of_its_own_is_refused(words: str, tmp_path: Path) -> None:
    (tmp_path / "here").touch()
    with pytest.raises(InvalidValue, match=words):
        rig_file.from_tables({"slave": ELSEWHERE[words]}, tmp_path, allow_code=True)
