# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch scan --scene rig.toml``: contact mode on the slave of a rig file. The spidev half: ``make kernel``."""

from __future__ import annotations

import json
import os
import re
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch_app.common import output, scenes
from nanotouch_app.main import main
from test_scan_lateral import Bench

FILE = Path(__file__).parents[2] / "docs/examples/rig/tapping.toml"
RASTER = ["--set-point", "50nN", "--area", "0.6um,0.5um,0.8um,0.1um", "--pixels", "16", "--lines", "4"]


class Ranged(Bench):
    """Its channels say how far it goes."""

    last = 5e-6

    def describe(self) -> nt.hal.Capabilities:
        ranges = [(0.0, self.last), (0.0, 5e-6), (-10e-6, 10e-6)]
        rows = [nt.hal.Channel(f"travel {'xyz'[axis]}", "m", True, axis, *ranges[axis]) for axis in range(3)]
        return nt.hal.Capabilities(axes=3, feels=True, channels=rows)


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> type[Ranged]:
    """A rig file whose half is played by a device in Python."""
    text = FILE.read_text().replace("spring_constant_N_per_m = 40", "spring_constant_N_per_m = 8")
    for table in ("drive", "tap", "zloop", "slave.drive_amplitude", "slave.amplitude", "slave.lag"):  # contact mode
        text = re.sub(rf"\[{re.escape(table)}\][^\[]*(?=\[)", "", text)
    (tmp_path / "rig.toml").write_text(text + "\n[medium]\nrelative_humidity_percent = 0\n")
    monkeypatch.chdir(tmp_path)

    def halves(_name: str | None, _allow_code: bool) -> dict[str, Any]:
        return {"slave": Ranged()}

    monkeypatch.setattr(scenes, "real_halves", halves)
    monkeypatch.setattr(Ranged, "last", 5e-6)
    return Ranged


@pytest.mark.usefixtures("undrawn")
def test_the_image_is_that_of_the_device(rig: type[Ranged], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scan", "--scene", "rig.toml", *RASTER, "--out", "out"]) == 0
    told = capsys.readouterr().out
    assert "promised" in told
    assert "held at 50 nN" in told
    height = nt.images.read("out/scan.gwy", channel="Height").heights
    assert height[0, 12] - height[0, 3] == pytest.approx(10e-9, abs=0.3e-9)
    facts = json.loads(Path("out/scan.json").read_text())
    assert facts["height_range"] == pytest.approx(10e-9, abs=1e-9)
    assert facts["peak_force"] == pytest.approx(50e-9 + 8.0 * 10e-9, rel=0.1)  # up the step, before the servo moves
    assert np.isfinite(facts["guarantee"])


def test_ctrl_c_keeps_the_lines_and_lifts_the_tip(
    rig: type[Ranged], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """``close``, in which a device lifts its tip, is called when the command ends."""
    closed: list[bool] = []

    @contextmanager
    def interrupted(_: str) -> Iterator[Callable[[float], None]]:
        yield lambda done: os.kill(os.getpid(), signal.SIGINT) if done > 0.6 else None

    monkeypatch.setattr(rig, "close", lambda _: closed.append(True))
    monkeypatch.setattr(output, "progress_bar", interrupted)
    assert main(["scan", "--scene", "rig.toml", *RASTER[:-1], "8", "--out", "out"]) == 130
    found = re.search(r"(\d) of 8 lines are kept", capsys.readouterr().err)
    assert found is not None
    assert nt.images.read("out/scan.gwy", channel="Height").shape == (int(found[1]), 16)
    assert 4 <= int(found[1]) <= 7
    assert closed == [True]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["--steady"], "scans in time"),
        (["--mode", "tapping"], "no lock-in amplifier"),
        (["--mode", "phase"], "no lock-in amplifier"),
        (["--free-amplitude", "10nm"], "goes with --mode tapping or phase"),
        ([*RASTER, "--set-point", "900nN"], r"set_point|limits\.force"),
        ([*RASTER, "--line-rate", "900Hz"], "valid is up to"),
        ([*RASTER, "--gain", "0Hz"], "valid is above 0"),
        (["--set-point", "50nN", "--area", "4um,0um,2um,1um"], r"travel x has 0 \.\. 5e-06 m"),
    ],
)
def test_refusals(rig: type[Ranged], given: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scan", "--scene", "rig.toml", *given]) == 2
    assert re.search(words, capsys.readouterr().err)


def test_a_forecast_is_told_for_the_same_area(rig: type[Ranged], capsys: pytest.CaptureFixture[str]) -> None:
    """On a flat, where nobody names a surface: an area beyond that of the built-in ones, too."""
    area = ["--area", "8um,8um,2um,2um", "--pixels", "16", "--set-point", "50nN", "--mode", "contact"]
    assert main(["scan", "--scene", "rig.toml", *area, "--forecast"]) == 0
    assert "scan takes" in capsys.readouterr().out


@pytest.mark.usefixtures("undrawn")
def test_an_area_is_the_slaves(rig: type[Ranged], monkeypatch: pytest.MonkeyPatch) -> None:
    """6 um are the flat's of the built-in surfaces, not the slave's."""
    monkeypatch.setattr(Ranged, "last", 20e-6)
    area = ["--set-point", "50nN", "--area", "9um,0.5um,0.8um,0.1um", "--pixels", "16", "--lines", "4"]
    assert main(["scan", "--scene", "rig.toml", *area, "--out", "far"]) == 0


def test_a_raster_beyond_the_range_of_the_stage(rig: type[Ranged], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Ranged, "last", 1e-6)
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 50e-9},
        raster={"x": 0.6e-6, "y": 0.5e-6, "width": 0.8e-6, "height": 1e-7, "pixels": 16, "lines": 1, "line_rate": 0.5},
    )
    path = [(0.5e-6, 0.5e-6), (0.9e-6, 0.5e-6)]
    session = nt.Session(nt.Scene(), mode="topography", path=path, slave=Ranged())
    with pytest.raises(InvalidValue, match=r"travel x has 0 \.\. 1e-06 m"):
        nt.raster.image(session, settings)
