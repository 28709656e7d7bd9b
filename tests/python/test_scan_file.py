# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch scan FILE``: how the image is read and what was done to it is told; what ends early keeps its lines."""

from __future__ import annotations

import math
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import images
from nanotouch.units import in_words
from nanotouch_app.common import output
from nanotouch_app.main import main

Captured = pytest.CaptureFixture[str]


def bumps(pixels: int = 64) -> np.ndarray[Any, Any]:
    y, x = np.mgrid[:pixels, :pixels] / pixels
    return 30e-9 * np.exp(-((x - 0.3) ** 2 + (y - 0.25) ** 2) / 0.0128)


def written(path: Path, heights: Any) -> str:
    """As gwyfile writes it, which takes missing pixels."""
    pytest.importorskip("SurfaceTopography")
    objects = pytest.importorskip("gwyfile.objects")
    metre = objects.GwySIUnit(unitstr="m")
    field = objects.GwyDataField(heights, xreal=1e-6, yreal=1e-6, si_unit_xy=metre, si_unit_z=metre)
    container = objects.GwyContainer()
    container["/0/data"], container["/0/data/title"] = field, "Height"
    container.tofile(str(path))
    return str(path)


def test_what_was_filled_and_levelled_is_told(tmp_path: Path, capsys: Captured) -> None:
    heights = bumps()
    heights[20:30] = math.nan
    file = written(tmp_path / "bumps.gwy", heights)
    assert main(["scan", file, "--pixels", "8", "--forecast"]) == 0
    said = capsys.readouterr().out
    assert "15.6 % of the pixels are missing" in said
    assert "auto levelling" in said


def test_level_none_scans_the_tilt(tmp_path: Path, capsys: Captured) -> None:
    """5 degrees, away from the borders, where a surface goes on level (docs/surface.md)."""
    tilted = np.tile(np.arange(64) / 64 * 1e-6 * math.tan(math.radians(5.0)), (64, 1))
    file = written(tmp_path / "tilted.gwy", tilted)
    line = ["scan", file, "--pixels", "8", "--area", "0.2um,0.2um,0.6um,0.6um", "--mode", "contact", "--forecast"]
    assert main([*line, "--level", "none"]) == 0
    assert "the steepest slope, 0.0875," in capsys.readouterr().out


def test_a_flat_has_no_steepest_slope(tmp_path: Path, capsys: Captured) -> None:
    """What levelling leaves of it, 1e-40 m, is none."""
    file = written(tmp_path / "flat.gwy", np.full((64, 64), 5e-9))
    assert main(["scan", file, "--pixels", "8", "--forecast", "--mode", "contact"]) == 0
    said = capsys.readouterr().out
    assert "nothing was measured in this channel" in said
    assert "slope" not in said
    assert "parachuting" not in said


def test_an_image_that_states_no_size(tmp_path: Path, capsys: Captured) -> None:
    pytest.importorskip("SurfaceTopography")
    np.save(tmp_path / "bare.npy", bumps() * 1e9)
    line = ["scan", str(tmp_path / "bare.npy"), "--pixels", "8", "--forecast", "--mode", "contact"]
    assert main(line) == 2
    assert "give the pixel size" in capsys.readouterr().err
    assert main([*line, "--pixel-size", "15.625nm", "--z-unit", "nm"]) == 0
    assert main(["scan", "dots", "--forecast", "--level", "plane"]) == 2
    assert "--level goes with an IMAGE" in capsys.readouterr().err


def test_two_digits_in_words() -> None:
    assert in_words(7.24e-10, "m", 2) == "720 pm"
    assert in_words(9.96e-10, "m", 2) == "1 nm"
    assert in_words(3.936e-10, "N") == "393.6 pN"


@contextmanager
def interrupted(_: str) -> Iterator[Callable[[float], None]]:
    """A progress bar that presses Ctrl-C once half is done."""
    yield lambda done: os.kill(os.getpid(), signal.SIGINT) if done >= 0.5 else None


@pytest.mark.parametrize("lines", [80, 8])
def test_ctrl_c_keeps_the_lines_that_are_done(
    lines: int, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(output, "progress_bar", interrupted)
    line = ["scan", "flat", "--mode", "contact", "--pixels", "4", "--lines", str(lines), "--line-rate", "20Hz"]
    assert main([*line, "--out", str(tmp_path / "out")]) == 130
    found = images.read(tmp_path / "out" / "scan.gwy", "Height")
    kept = found.shape[0]
    assert lines // 2 <= kept <= lines
    assert f"{kept} of {lines} lines are kept" in capsys.readouterr().err
    assert found.shape == (kept, 4)
    assert found.pixel_size[0] == pytest.approx(nt.surface.flat().size[0] / lines)


def test_a_scan_in_time_that_is_ended_keeps_its_lines() -> None:
    """Of the strip in hand too, as they are in the whole image."""
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 5e-9, "rate": 20e3},
        raster={"width": 1e-7, "height": 1e-7, "pixels": 8, "lines": 60, "line_rate": 0.5},
    )
    made = nt.Scanner(nt.Scene(medium={"relative_humidity": 0.0}).plan(0.1), settings)
    shares: list[float] = []

    def until_begun(share: float) -> bool:
        shares.append(share)
        return share == 0.0

    part = made.run(progress=until_begun)
    lines = len(part.trace.height)
    assert 1 <= lines < 60
    whole = made.run()
    np.testing.assert_array_equal(part.retrace.height, whole.retrace.height[:lines])


def session_and_scan() -> tuple[nt.Session, nt.Scan]:
    scene = nt.Scene(medium={"relative_humidity": 0.0})
    settings = nt.Scan(
        zloop={"mode": "contact", "set_force": 50e-9},
        raster={"x": 0.2e-6, "y": 0.2e-6, "width": 0.2e-6, "height": 40e-9, "pixels": 8, "lines": 4, "line_rate": 5.0},
    )
    return nt.Session(scene, mode="topography", path=[(0.2e-6, 0.2e-6), (0.4e-6, 0.2e-6)]), settings


def test_a_scan_through_the_hal_ends_when_asked() -> None:
    """With the whole lines so far, each as in the whole image."""
    whole = nt.raster.image(*session_and_scan())
    shares: list[float] = []

    def until_two_thirds(share: float) -> bool:
        shares.append(share)
        return share < 0.67

    part = nt.raster.image(*session_and_scan(), until_two_thirds)
    lines = len(part.trace.height)
    assert 1 <= lines <= 3
    assert shares == sorted(shares)
    assert part.pixel_size == whole.pixel_size
    for name in part.trace._fields:
        np.testing.assert_array_equal(getattr(part.retrace, name), getattr(whole.retrace, name)[:lines])


def test_a_stop_of_the_supervisor_leaves_the_lines_before() -> None:
    """The stop comes in the third line."""
    session, settings = session_and_scan()

    def stop(share: float) -> None:
        if share > 0.7:
            session.emergency_stop()

    with pytest.raises(nt.raster.Ended, match=r"line \d: the supervisor went to LATCHED .*: the scan ended there") as e:
        nt.raster.image(session, settings, stop)
    lines = len(e.value.image.trace.height)
    assert lines >= 1
    assert str(e.value).startswith(f"line {lines}:")
