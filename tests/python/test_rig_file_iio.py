# SPDX-License-Identifier: BSD-3-Clause
"""Rig files whose converters drivers of IIO run: the one in the docs is read, what is missing or wrong is refused by
its name. The driver itself: ``test_hal_iio`` and ``make kernel``."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from nanotouch import rig_file
from nanotouch.errors import Error, InvalidValue
from nanotouch_app.main import main

FILE = Path(__file__).parents[2] / "docs/examples/rig/iio.toml"


def tables() -> dict[str, Any]:
    return tomllib.loads(FILE.read_text())


def test_the_file_of_the_docs(capsys: pytest.CaptureFixture[str]) -> None:
    found = rig_file.read(FILE)
    assert isinstance(found.slave, rig_file.Converters)
    setup = found.slave.setup
    assert setup["context"] == "local:"
    assert [chip["is_output"] for chip in setup["chips"]] == [True, False]
    assert setup["chips"][1]["channels"] == ["voltage0", "voltage1"]
    assert setup["driven"][2]["offset"] == pytest.approx(-10e-6)
    assert nt.Rig.from_tables(found.rig).probe.sensitivity == pytest.approx(33e-9)
    assert main(["rig", "check", str(FILE)]) == 0
    assert "IIO at ad5686, IIO at ad7606" in capsys.readouterr().out


NEEDED = [
    ("context",), ("chips", "dac", "device"), ("chips", "dac", "outputs"), ("chips", "adc", "inputs"),
    ("chips", "adc", "bits"), ("chips", "adc", "low_V"), ("chips", "adc", "high_V"),
]  # fmt: skip


@pytest.mark.parametrize("path", NEEDED, ids="-".join)
def test_each_key_is_needed_and_named(path: tuple[str, ...]) -> None:
    given = tables()
    table = given["slave"]
    for key in path[:-1]:
        table = table[key]
    del table[path[-1]]
    with pytest.raises(InvalidValue, match=rf"{path[-1].removesuffix('_V')}.*(is missing|one of them)"):
        rig_file.from_tables(given)


WRONG: dict[tuple[str, ...], tuple[object, str]] = {
    ("context",): (3, "context = 3"),
    ("chips", "dac", "bits"): (21, "2 .. 20 bits"),
    ("chips", "adc", "bits"): (1, "2 .. 24 bits"),
    ("chips", "adc", "inputs"): ([], "inputs = "),
    ("chips", "dac", "outputs"): ("voltage0", "outputs = 'voltage0'"),
    ("chips", "dac", "inputs"): (["voltage0"], "needs inputs or outputs, one of them"),
    ("chips", "adc", "clock_MHz"): (10, "has no key 'clock_MHz'"),
    ("chips", "adc", "high_V"): (-10, "converter.span.high"),
    ("travel_z", "channel"): (1, "channel.channel"),
    ("deflection_z", "channel"): (2, "channel.channel"),
    ("travel_z", "chip"): ("adc", "driven: channels of a DAC"),
    ("travel_z", "maximum_um"): (11, "channel.maximum"),
}


@pytest.mark.parametrize("path", WRONG, ids="-".join)
def test_wrong_values_are_refused(path: tuple[str, ...]) -> None:
    given = tables()
    table = given["slave"]
    for key in path[:-1]:
        table = table[key]
    value, words = WRONG[path]
    table[path[-1]] = value
    with pytest.raises(InvalidValue, match=words):
        rig_file.from_tables(given)


UNITS = {
    "um": "uN",
    "nm": "V",
    "pm": "s",
    "V": "nm",
    "ms": "Hz",
    "percent": "m",
    "um_per_V": "um",
    "nm_per_V": "N_per_V",
}


def test_each_wrong_unit_is_refused() -> None:
    tried = 0
    for name, table in tables()["slave"].items():
        for key in table if isinstance(table, dict) else ():
            unit = next((unit for unit in sorted(UNITS, key=len, reverse=True) if key.endswith(f"_{unit}")), None)
            if unit is None:
                continue
            given = tables()
            wrong = given["slave"][name]
            wrong[key.removesuffix(unit) + UNITS[unit]] = wrong.pop(key)
            with pytest.raises(InvalidValue, match=name):
                rig_file.from_tables(given)
            tried += 1
    assert tried == 19


@pytest.mark.parametrize("names", [["voltage0"] * 6, ["a b"], [""], [1], [["voltage0"]]])
def test_odd_lists_of_channels(names: list[object]) -> None:
    given = tables()
    given["slave"]["chips"]["adc"]["inputs"] = names
    with pytest.raises(InvalidValue):
        rig_file.from_tables(given)


def test_spidev_knows_no_context() -> None:
    given = tables()
    given["slave"]["backend"] = "spidev"
    with pytest.raises(InvalidValue, match=r"context|chip"):
        rig_file.from_tables(given)


def test_a_context_that_is_not_there() -> None:
    given = tables()
    given["slave"]["context"] = "ip:127.0.0.1:9"
    found = rig_file.from_tables(given)
    assert isinstance(found.slave, rig_file.Converters)
    with pytest.raises(Error, match=r"libiio|127"):
        rig_file.frame_times(found.slave, 1)


@pytest.mark.parametrize("context", ["xml:/nowhere.xml", "nonsense", "/../../tmp/evil:", "", "\x00local:"])
def test_a_context_that_names_a_file_or_a_plug_in_is_refused(context: str) -> None:
    given = tables()
    given["slave"]["context"] = context
    with pytest.raises(InvalidValue, match="context"):
        rig_file.from_tables(given)
