# SPDX-License-Identifier: BSD-3-Clause
"""The 3-D view: what it shows is where it is, the picture is not blank, and a crash of VTK stays outside."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch.errors import Error, MissingExtra, missing
from nanotouch.images import Topography
from nanotouch.touch.record import Recording
from nanotouch_app import view
from nanotouch_app.view import picture, stage
from nanotouch_app.view.picture import Picture

SCENE = {"tip": {"radius": 30e-9, "half_angle": 0.2}}


def letter(pixels: int = 64) -> Topography:
    """An F of 8 nm on 20 um x 10 um: its bars point to +x, its top is at large y."""
    heights = np.zeros((pixels, 2 * pixels))
    heights[pixels // 8 : -pixels // 8, pixels // 2 : pixels // 2 + pixels // 8] = 8e-9
    heights[-pixels // 4 : -pixels // 8, pixels // 2 : -pixels // 2] = 8e-9
    return Topography(heights=heights, pixel_size=(10e-6 / pixels, 10e-6 / pixels), name="letter F")


def press(rows: int = 5000) -> Recording:
    """Down 500 nm at (4 um, 2 um), touching over the middle fifth, and up."""
    travel = 500e-9 * np.clip(2.5 * np.minimum(np.linspace(0, 1, rows), np.linspace(1, 0, rows)), 0, 1)
    made = {"time": np.arange(rows) * 1e-4, "x": np.full(rows, 4e-6), "y": np.full(rows, 2e-6)}
    force = np.where(travel >= 500e-9, 1e-7, 0.0)
    made |= {"stage_position": travel, "deflection": np.zeros(rows), "slave_force": force}
    return Recording(made, {"start_height": 500e-9, "scene": SCENE})


@pytest.fixture(scope="module")
def vtk_works() -> None:
    """Skip where VTK cannot render; what it says then is tested without it."""
    pytest.importorskip("vtkmodules")
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)


def pixels(path: Path) -> Any:
    return pytest.importorskip("matplotlib.image").imread(path)[..., :3]


def test_picture_is_true_to_scale() -> None:
    shown = Picture.of(letter(), press())
    assert shown.unit == pytest.approx(20e-6)
    assert shown.exaggeration * 8e-9 / 20e-6 == pytest.approx(picture.RELIEF, rel=0.35)  # rounded to a plain number
    x, y, z, radius, half_angle = shown.tip
    assert (x, y) == (pytest.approx(0.2), pytest.approx(0.1))
    assert z == pytest.approx(0.0, abs=1e-9)
    assert (radius, half_angle) == (pytest.approx(30e-9 / 20e-6), 0.2)
    assert shown.trace[:, 2].max() <= 8e-9 * shown.exaggeration / shown.unit + picture.TRACE_CEILING
    assert shown.trace[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert shown.force.max() == pytest.approx(1e-7)
    assert f"{shown.exaggeration:g} times as high" in shown.caption
    assert "R = 30 nm" in shown.caption


def test_steep_and_flat_surfaces_are_not_exaggerated() -> None:
    for heights in (np.zeros((8, 8)), np.eye(8) * 1e-6):
        shown = Picture.of(Topography(heights=heights, pixel_size=(1e-7, 1e-7)), None)
        assert shown.exaggeration == 1
        assert "to scale" in shown.caption


def test_large_surfaces_are_thinned() -> None:
    heights = np.random.default_rng(1).standard_normal((4096, 1500)) * 1e-9
    shown = Picture.of(Topography(heights=heights, pixel_size=(1e-8, 2e-8)), None)
    assert shown.heights.shape == (512, 188)
    assert shown.heights[3, 5] == pytest.approx(heights[24:32, 40:48].mean())
    np.testing.assert_allclose(shown.pixel_size, (8e-8, 16e-8))


def test_picture_survives_the_way_to_the_other_process(tmp_path: Path) -> None:
    shown = Picture.of(letter(), press())
    shown.save(tmp_path / "p.npz")
    back = Picture.load(tmp_path / "p.npz")
    assert back.caption == shown.caption
    assert back.exaggeration == shown.exaggeration
    np.testing.assert_array_equal(back.trace, shown.trace)


@pytest.mark.usefixtures("vtk_works")
def test_png_shows_the_letter_the_right_way_up(tmp_path: Path) -> None:
    """Gold is high: seen from the front, the upper half of the drawn F is wider to the right than the lower half."""
    view.render_png(letter(), None, tmp_path / "view.png", size=(400, 300))
    assert [path.name for path in tmp_path.iterdir()] == ["view.png"]
    image = pixels(tmp_path / "view.png")
    assert image.shape == (300, 400, 3)
    gold = (image[..., 0] > 0.65) & (image[..., 2] < 0.5)
    gold[:, 340:] = False  # the scale of heights
    rows = np.flatnonzero(gold.any(axis=1))
    middle = (rows[0] + rows[-1]) // 2
    right = [np.flatnonzero(part.any(axis=0)).max() for part in (gold[:middle], gold[middle:])]
    assert right[0] > right[1] + 20


@pytest.mark.usefixtures("vtk_works")
def test_a_touch_at_a_point_is_seen_through_its_tip() -> None:
    """A ring and a fainter tip for a touch that stands; neither for one that moves."""
    pytest.importorskip("vtkmodules")
    standing = press()
    x = np.linspace(1e-6, 19e-6, len(standing))
    moving = Recording({**standing.columns, "x": x}, standing.metadata)
    found = []
    for recording in (standing, moving):
        actors = stage.build(Picture.of(letter(), recording), 300).GetActors()
        looks = [actors.GetItemAsObject(number).GetProperty() for number in range(actors.GetNumberOfItems())]
        rings = [one for one in looks if one.GetColor() == pytest.approx(stage.REPULSION) and not one.GetLighting()]
        found.append((len(rings), min(one.GetOpacity() for one in looks)))
    assert found[0] == (1, pytest.approx(0.25))
    assert found[1] == (0, pytest.approx(0.55))


@pytest.mark.usefixtures("vtk_works")
def test_png_shows_tip_and_trace(tmp_path: Path) -> None:
    view.render_png(letter(), None, tmp_path / "without.png", size=(400, 300))
    view.render_png(letter(), press(), tmp_path / "with.png", size=(400, 300))
    different = np.abs(pixels(tmp_path / "with.png") - pixels(tmp_path / "without.png")).max(axis=-1) > 0.1
    assert different[60:240, 60:330].mean() > 0.01  # the tip
    assert different[:, :60].mean() > 0.02  # the scale of forces


@pytest.mark.usefixtures("vtk_works")
def test_nothing_is_left_where_nothing_can_be_written(tmp_path: Path) -> None:
    with pytest.raises(Error, match=r"could not write|cannot write|could not render"):
        view.render_png(letter(), None, tmp_path / "missing" / "view.png")
    assert list(tmp_path.iterdir()) == []


def fake_worker(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    """Let another program stand in for the worker, in a process of its own as the real one."""
    real = subprocess.run
    monkeypatch.setattr(view.importlib.util, "find_spec", lambda name: object())
    monkeypatch.setattr(view.subprocess, "run", lambda command, **kw: real([sys.executable, "-c", code], **kw))


def test_a_crash_of_vtk_is_a_sentence(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fake_worker(monkeypatch, f"import os; os.kill(os.getpid(), {int(signal.SIGSEGV)})")
    works, reason = view.probe()
    assert not works
    assert "SIGSEGV" in reason
    assert "libegl1 libgl1-mesa-dri" in reason
    with pytest.raises(Error, match="SIGSEGV"):
        view.render_png(letter(), None, tmp_path / "view.png")
    assert list(tmp_path.iterdir()) == []


def test_a_hanging_vtk_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_worker(monkeypatch, "import time; time.sleep(60)")
    monkeypatch.setattr(view, "PROBE_TIME", 0.2)
    assert view.probe() == (False, "VTK did not answer within 0.2 s")


def test_an_error_of_vtk_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_worker(monkeypatch, "raise RuntimeError('no OpenGL 3.2')")
    assert "no OpenGL 3.2" in view.probe()[1]


def test_without_vtk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(view.importlib.util, "find_spec", lambda name: None)
    assert view.probe() == (False, str(missing("vtk", "view")))
    with pytest.raises(MissingExtra):
        view.render_png(letter(), None, tmp_path / "view.png")


def test_without_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("WAYLAND_DISPLAY", "")
    monkeypatch.delenv("DISPLAY", raising=False)
    assert not view.has_display()
    with pytest.raises(Error, match="no display"):
        view.open_window(letter(), None)
    monkeypatch.setenv("DISPLAY", ":7")
    assert view.has_display()
