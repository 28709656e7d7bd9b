# SPDX-License-Identifier: BSD-3-Clause
"""Scans of a converter behind IIO (``rig_file.iio_scan``, nt_iio_scan): libiio's own client on a model of iiod."""

from __future__ import annotations

import errno
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mock_iiod import Iiod, served
from nanotouch import rig_file
from nanotouch.errors import DeviceError, Error, InvalidValue

FILE = Path(__file__).parents[2] / "docs/examples/rig/iio.toml"
STEP = 20.0 / 65536.0  # [V]


def half(**slave: Any) -> rig_file.Converters:
    tables = tomllib.loads(FILE.read_text())
    tables["slave"] |= slave
    found = rig_file.from_tables(tables).slave
    assert isinstance(found, rig_file.Converters)
    return found


@pytest.fixture
def iiod() -> Iterator[Iiod]:
    with served() as server:
        try:
            rig_file.frame_times(half(context=server.uri), 1)
        except Error as error:
            if "without libiio" in str(error):
                pytest.skip(str(error))
            raise
        yield server


def test_scans_are_those_of_the_device(iiod: Iiod) -> None:
    volts = rig_file.iio_scan(half(context=iiod.uri), "adc", 100, trigger="clock")
    numbers = 10 * np.arange(100)[:, None] + [0, 1]
    np.testing.assert_allclose(volts, STEP * numbers, atol=2 * STEP)  # the file's ends are good for two steps
    np.testing.assert_allclose(np.diff(volts, axis=0), 10 * STEP, rtol=1e-4)
    assert iiod.trigger == "clock"


def test_the_wait_is_as_long_as_the_scans(iiod: Iiod) -> None:
    iiod.rate = 100.0
    found = rig_file.iio_scan(half(context=iiod.uri), "adc", 1000, trigger="clock")
    assert found.shape == (1000, 2)
    assert max(iiod.timeouts) == 500 + 10_000  # [ms]; libiio tells a server half of what it waits itself
    again = rig_file.iio_scan(half(context=iiod.uri), "adc", 3000)  # the trigger that it has
    assert again.shape == (3000, 2)
    assert max(iiod.timeouts) == 500 + 30_000
    assert iiod.timeouts[-1] == 500


@pytest.mark.parametrize(
    ("error", "words"), [(errno.EBUSY, "busy"), (errno.ENODEV, "No such device"), (errno.EIO, "Input/output error")]
)
def test_an_error_has_no_scans(iiod: Iiod, error: int, words: str) -> None:
    iiod.error = error
    with pytest.raises(DeviceError, match=words):
        rig_file.iio_scan(half(context=iiod.uri), "adc", 10)


def test_a_trigger_that_does_not_fire_or_is_not_there(iiod: Iiod) -> None:
    iiod.comes = 5
    with pytest.raises(DeviceError, match="timed out"):
        rig_file.iio_scan(half(context=iiod.uri), "adc", 10, trigger="clock")
    with pytest.raises(DeviceError, match="'nobody': No such device"):
        rig_file.iio_scan(half(context=iiod.uri), "adc", 10, trigger="nobody")


def test_what_cannot_be_scanned() -> None:
    for chip, words in (("dac", "drives"), ("lever", "this half has dac, adc")):
        with pytest.raises(InvalidValue, match=words):
            rig_file.iio_scan(half(), chip, 10)
    for count in (0, -1, True, 2.5, 10**8):
        with pytest.raises(InvalidValue, match="count"):
            rig_file.iio_scan(half(), "adc", count)  # type: ignore[arg-type]
    spidev = rig_file.read(FILE.parent / "rig.toml").slave
    assert isinstance(spidev, rig_file.Converters)
    with pytest.raises(InvalidValue, match='backend = "iio"'):
        rig_file.iio_scan(spidev, "adc", 10)
