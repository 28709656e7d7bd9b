# SPDX-License-Identifier: BSD-3-Clause
"""The picture without a display: the surface stays as it was sent, films are made, recordings are played, files become
what is touched."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import nanotouch as nt
import numpy as np
import pytest
import synthetic
import ting_curves
from nanotouch import curves
from nanotouch.errors import Error
from nanotouch_app import view
from nanotouch_app.live import cards, files, film, parts, picture, readings, reel
from nanotouch_app.live.contact import Contact, View
from nanotouch_app.live.host import Host
from nanotouch_app.live.look import LIGHT
from nanotouch_app.live.remote import Remote
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import of_preset
from nanotouch_app.main import main


@pytest.fixture(scope="module")
def vtk_works() -> None:
    """Skip where VTK cannot render."""
    pytest.importorskip("vtkmodules")
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)


@pytest.mark.usefixtures("vtk_works")
def test_a_film_is_made_without_a_display(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    image = pytest.importorskip("PIL.Image")
    monkeypatch.setattr(film, "RATE", 1.0)
    monkeypatch.delenv("DISPLAY", raising=False)
    out = tmp_path / "touch.gif"
    assert main(["live", "mica_in_air", "--film", str(out), "--dark"]) == 0
    with image.open(out) as made:
        assert made.n_frames >= 4
        assert made.width == film.GIF_WIDTH


@pytest.mark.parametrize("round_", [False, True])
def test_a_ball_that_ends_inside_the_picture_is_drawn(round_: bool) -> None:
    """Beyond its radius there is no tip: its height is infinite there, and no difference of it is taken."""
    scene, _ = nt.presets.cell_in_liquid()
    section = nt.view.section(scene.plan(), scene, 1e-6, 0.0, np.linspace(0.0, 2.0 * scene.tip.radius, 50))
    assert np.isinf(section.tip).any()
    lines: list[int] = []
    painter = SimpleNamespace(area=lambda *_: None, line=lambda points, *_, **__: lines.append(len(points)))
    shown = View((0.0, 0.0, 400.0, 400.0), 2.0 * scene.tip.radius, round_)
    Contact._bodies(cast(Any, painter), LIGHT, shown, section)
    assert min(lines) >= 2


@pytest.mark.usefixtures("vtk_works")
def test_a_film_is_made_by_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its pictures, read back, have the colours that were drawn."""
    image = pytest.importorskip("PIL.Image")
    if shutil.which("ffmpeg") is None:
        pytest.skip("ffmpeg is not installed: apt-get install ffmpeg")
    monkeypatch.setattr(film, "RATE", 1.0)
    out, last = tmp_path / "touch.mp4", tmp_path / "last.png"
    drawn: list[Any] = []
    filmed = film._filmed
    monkeypatch.setattr(film, "_filmed", lambda *given: (drawn.append(one) or one for one in filmed(*given)))
    assert main(["live", "mica_in_air", "--film", str(out)]) == 0
    as_players_do = "scale=in_color_matrix=bt709:in_range=tv:flags=accurate_rnd+full_chroma_int"
    which = f"select=eq(n\\,{len(drawn) - 1}),{as_players_do}"
    subprocess.run(["ffmpeg", "-loglevel", "error", "-i", out, "-vf", which, "-frames:v", "1", last], check=True)
    with image.open(last) as made:
        found = np.asarray(made.convert("RGB"), dtype=float)
    assert found.shape == drawn[-1].shape
    # H.264 rounds, and halves the resolution of colours; the matrix of another standard shifts them by 5
    assert np.abs(found.mean(axis=(0, 1)) - drawn[-1].mean(axis=(0, 1))).max() < 1.0
    assert np.abs(found - drawn[-1])[400:560, 150:600].mean() < 2.5


def test_an_ffmpeg_that_ends_early_is_told_in_its_own_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = tmp_path / "ffmpeg"
    broken.write_text("#!/bin/sh\necho Unknown encoder libx264 >&2\nexit 3\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    pictures = iter([np.zeros((900, 1440, 3), np.uint8)] * 3)
    with pytest.raises(Error, match="status 3: Unknown encoder libx264"):
        film._mp4(pictures, tmp_path / "touch.mp4")
    assert sorted(tmp_path.iterdir()) == [broken]


def test_a_film_of_another_kind_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["live", "--film", str(tmp_path / "touch.avi")]) == 2
    assert "valid endings are .gif, .mp4, .png" in capsys.readouterr().err


def test_without_a_display_the_command_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    begun = time.monotonic()
    assert main(["live"]) == 2
    assert "no display: DISPLAY is not set" in capsys.readouterr().err
    assert time.monotonic() - begun < 3.0


def test_presets_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["live", "--list"]) == 0
    told = capsys.readouterr().out
    assert all(name in told for name in nt.presets.FELT)


def recorded(path: Path) -> nt.Recording:
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, out=str(path), stepped=True)
    host.answer({"do": "change", "what": "rig", "field": "probe.spring_constant", "value": 2.0})
    host.answer({"do": "preset", "name": "mica_in_air"})
    assert all("this one is being recorded" in message["why"] for message in told)
    assert len(told) == 2
    host.answer({"do": "press", "on": True})
    host.advance(0.6)
    host.close()
    return nt.record.read(path)


def test_a_recording_is_played(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "touch.mcap")
    played = reel.Reel(recording)
    played.answer({"do": "pause"})
    played.jump(0.3)
    frames = played.read()
    assert frames["time"][-1] - recording.time[0] == pytest.approx(0.3, abs=2e-4)
    row = np.searchsorted(recording.time, frames["time"][-1])
    assert frames["gap"][-1] == recording.gap[row]
    assert frames["tip_force"][-1, 2] == recording.tip_force[row]
    played.answer({"do": "step"})
    assert len(played.read()) == 10
    low, high = played.extremes(50)
    assert high.max() == recording.tip_force.max()
    assert low.min() == recording.tip_force[: len(recording) - 1].min()
    world = reel.world_of(recording.metadata, "touch", "recording")
    assert nt.Scene(**world["scene"]).plan().pull_off_force > 0.0
    assert max(reel.surface_of(recording)[0].size) > 0.0


def test_a_scene_file_is_touched(tmp_path: Path) -> None:
    file = tmp_path / "gold.toml"
    file.write_text("[sample]\nyoungs_modulus_GPa = 79\n[tip]\nradius_nm = 30\n")
    subject = files.of(str(file))
    assert subject.scene["sample.youngs_modulus"] == 79e9
    assert max(subject.topography.size) == pytest.approx(files.EXTENT * 30e-9)


def test_an_image_is_touched_with_its_own_relief(tmp_path: Path) -> None:
    pytest.importorskip("gwyfile")
    file = tmp_path / "dots.gwy"
    nt.images.write(file, nt.surface.dots(size=200e-9, pixels=64, count=6))
    subject = files.of(str(file))
    assert subject.topography.height_range > 2e-9
    assert subject.scene["tip.radius"] == 20e-9


def test_a_curve_becomes_the_scene() -> None:
    pytest.importorskip("nanotouch._fit")
    contact = nt.Contact(radius=2e-6, effective_modulus=20e6, work_of_adhesion=0.03, cohesive_stress=5e6)
    curve = curves.synthesize(contact, spring_constant=1.0, noise=0.2e-9, depth=600e-9, clearance=1.5e-6)
    subject = files.of_fit(curve, "curve", 2e-6)
    plan = subject.scene.plan()
    assert plan.pull_off_force == pytest.approx(nt.contact.pull_off_force("maugis", contact), rel=0.05)
    assert plan.explain()["effective_modulus"] == pytest.approx(20e6, rel=0.05)
    assert subject.rig["probe.spring_constant"] == 1.0
    host = Host(subject, lambda message: None, stepped=True)
    host.answer({"do": "press", "on": True})
    host.advance(3.0)
    assert host.observer.newest()["contact_radius"] > 0.0
    host.answer({"do": "press", "on": False})
    host.advance(3.0)
    free = host.observer.newest()
    assert (free["contact_radius"], free["state"]) == (0.0, 0)  # torn off, and not stopped
    host.close()


def test_what_a_curve_does_not_tell_is_assumed_and_said() -> None:
    """A hard sample under a soft lever: the pull-off that is touched is the measured one."""
    pytest.importorskip("nanotouch._fit")
    contact = nt.Contact(radius=20e-9, effective_modulus=77e9, work_of_adhesion=0.1, cohesive_range=0.2e-9)
    curve = curves.synthesize(contact, spring_constant=0.05, noise=0.2e-9, depth=300e-9, clearance=900e-9)
    subject = files.of_fit(curve, "curve", 20e-9)
    measured = curves.analyse(curve).pull_off_force
    assert measured == pytest.approx(nt.contact.pull_off_force("maugis", contact), rel=0.05)
    assert subject.scene.plan().pull_off_force == pytest.approx(measured, rel=0.01)
    assert "E* 10 GPa (assumed: stiff)" in subject.said
    assert "(from the pull-off)" in subject.said
    assert "--radius" not in subject.said


def test_a_curve_is_felt_by_the_law_that_fit_takes() -> None:
    """It was Maugis-Dugdale's on the retraction always: 59.1 kPa where ``nanotouch fit`` said 64.9."""
    pytest.importorskip("nanotouch._fit")
    contact = nt.Contact(radius=1e-6, effective_modulus=5e3, work_of_adhesion=0.0)
    curve = curves.synthesize(contact, "hertz", spring_constant=0.05, noise=10e-12, depth=600e-9, clearance=1.5e-6)
    subject, fitted = files.of_fit(curve, "curve", 1e-6), nt.fit.fit_curve(curve, "auto", radius=1e-6)
    assert fitted.model == "hertz"
    known = subject.scene.plan().explain()
    assert known["effective_modulus"] == pytest.approx(fitted.values["effective_modulus"], rel=1e-6)
    assert known["work_of_adhesion"] == 0.0
    assert "no adhesion" in subject.said


def test_a_curve_of_a_gel_is_felt_as_it_relaxes() -> None:
    """Ting's closed form, 1.2 kPa at 1 s and beta = 0.2: what is felt relaxes so, and the points lie on its fit."""
    pytest.importorskip("nanotouch._fit")
    noise = 10e-12
    curve = ting_curves.curve_of(ting_curves.Sample(1200.0, 0.2), noise=noise, seed=5)
    subject = files.of_fit(curve, "gel", 2.5e-6)
    felt = subject.scene.rheology
    assert (felt.kind, felt.modulus, felt.exponent) == (
        "power_law", pytest.approx(1200.0, rel=0.02), pytest.approx(0.2, abs=0.005)
    )  # fmt: skip
    assert "it relaxes with beta 0.2" in subject.said
    rows = np.array(subject.measured)
    assert 50 < len(rows) < 400
    assert np.abs(rows[:, 1] - rows[:, 2]).max() < 6.0 * noise
    seen = Seen()
    host = Host(subject, seen.hear, stepped=True)
    host.report()
    assert len(seen.world["measured"]) == len(rows)
    assert seen.world["slow"] == pytest.approx((1e6) ** -0.2 * (1.0 - 0.2), rel=0.02)  # E(100 s) over that of 0.1 ms
    host.answer({"do": "press", "on": True})
    host.advance(2.0)
    assert host.observer.newest()["tip_force"][2] > 0.4 * subject.scene.range.maximum_load
    host.close()


def test_each_real_curve_can_be_touched() -> None:
    files_there = sorted((synthetic.DATA / "curves").glob("*.*"))
    if not files_there:
        pytest.skip("the real curves are not there")
    for file in files_there:
        subject = files.of(str(file))
        assert subject.said.startswith("Your curve: ")
        assert "R = 20 nm is assumed" in subject.said
        host = Host(subject, lambda message: None, stepped=True)
        host.answer({"do": "press", "on": True})
        for _ in range(120):  # one of a cell: E* of 17 kPa under a tip taken as 20 nm
            host.advance(0.1)
            if host.observer.newest()["tip_force"][2] > 0.4 * subject.scene.range.maximum_load:
                break
        assert host.observer.newest()["tip_force"][2] > 0.4 * subject.scene.range.maximum_load, file.name
        host.close()


class Stage(nt.hal.Slave):
    """A real slave of one axis says where it is and what its lever bends, and nothing of the sample."""

    def __init__(self) -> None:
        self.travel = 0.0

    def describe(self) -> nt.hal.Capabilities:
        return nt.hal.Capabilities(axes=1, feels=True)

    def read(self) -> nt.hal.Reading:
        bent = max(0.0, 0.5 * (self.travel - 100e-9)) + 1e-12 * np.random.default_rng(int(1e12 * self.travel)).random()
        return nt.hal.Reading(position=(np.nan, np.nan, self.travel), felt=(np.nan, np.nan, bent))

    def write(self, action: nt.hal.Action) -> None:
        self.travel = action.target[2]


def test_a_real_slave_is_watched(recwarn: pytest.WarningsRecorder) -> None:
    pytest.importorskip("vtkmodules")
    name = f"real-{os.getpid()}"
    session = nt.Session(rig=nt.Rig(stage={"axes": 1}), slave=Stage(), path=[(1e-6, 2e-6)], preflight=False)
    session.publish(name)
    vtk, observer = parts.load(), nt.frames.attach(name)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(1008, 704)
    made = picture.Picture(vtk, window, np.zeros((16, 16)), np.full(2, 0.25e-6))
    remote = Remote(name, observer)
    world = remote.news()
    assert world is not None
    made.hear(world)
    for _ in range(8):
        session.advance(0.1, nt.Input(0.4, np.nan, np.nan, 0.3))
        made.seen.look(observer)
        made.render()
    assert made.seen.is_blind
    measured = session.rig.probe.spring_constant * float(made.seen.frame["deflection"])
    assert made.seen.force == measured > 10e-9
    assert tuple(made.seen.frame["tip_position"][:2]) == (1e-6, 2e-6)
    assert "the gap is not known: a real slave" in readings._facts(made.seen)
    assert not list(recwarn)
    remote.close()
    observer.close()


def test_a_reason_is_told_once(tmp_path: Path) -> None:
    empty = tmp_path / "empty.ibw"
    empty.touch()
    with pytest.raises(Error) as caught:
        files.of(str(empty))
    assert str(caught.value) == f"{empty}: the file is empty"


def test_nonsense_is_refused(tmp_path: Path) -> None:
    with pytest.raises(nt.Error, match="neither a file nor a preset"):
        files.of("nothing")
    file = tmp_path / "no.txt"
    file.write_text("hello")
    with pytest.raises(Error, match="no image"):
        files.of(str(file))


def test_a_tip_and_a_lever_are_of_a_curve(tmp_path: Path) -> None:
    pytest.importorskip("gwyfile")
    file = tmp_path / "dots.gwy"
    nt.images.write(file, nt.surface.dots(size=200e-9, pixels=64, count=6))
    with pytest.raises(Error, match="--radius is of a force curve; "):
        files.of(str(file), 30e-9)
    with pytest.raises(Error, match="--radius and --spring-constant are of a force curve; "):
        files.of(str(file), 30e-9, 2.0)


def test_a_curve_without_a_spring_constant_says_where_to_give_it() -> None:
    pytest.importorskip("nanotouch._fit")
    file = synthetic.DATA / "corpus/curves/asylum-pairs/Line0000Point0002Defl.ibw"
    if not file.is_file():
        pytest.skip("the real curves are not there")
    with pytest.raises(Error, match=r"no spring constant; give it .*--spring-constant"):
        files.of(str(file))
    assert files.of(str(file), spring_constant=0.1).rig["probe.spring_constant"] == 0.1


def test_a_map_is_touched_with_the_modulus_of_each_place(tmp_path: Path) -> None:
    for module in ("xarray", "h5netcdf", "nanotouch._fit"):
        pytest.importorskip(module)
    x = np.mgrid[:8, :8][1] / 8
    modulus = np.where(x < 0.5, 2e8, 1e9)
    sample = nt.maps.synthesize(
        modulus, np.full_like(x, 0.02), np.zeros_like(x), radius=20e-9, spring_constant=1.0, points=300, depth=20e-9
    )
    file = tmp_path / "map.nc"
    nt.maps.write(file, nt.maps.fit(sample, "maugis", radius=20e-9, cohesive_range=0.2e-9))
    subject = files.of(str(file))
    surface = subject.touched(subject.scene)
    assert surface.youngs_modulus is not None
    assert surface.youngs_modulus.max() > 3.0 * surface.youngs_modulus.min()
    host = Host(subject, lambda message: None, stepped=True)
    host.answer({"do": "press", "on": True})
    host.advance(1.0)
    frame = host.observer.newest()
    host.close()
    assert frame is not None
    assert frame["tip_force"][2] > 0.0


@pytest.mark.usefixtures("vtk_works")
def test_another_sample_is_laid_under_the_tip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(film, "RATE", 2.0)
    studio = film.Studio(of_preset("silicon_in_air"))
    try:
        card = cards.boxes(studio.picture.layout.cards)["cell_in_liquid"]
        assert cards.at(studio.picture.layout.cards, card[0] + 5.0, card[1] + 5.0) == "cell_in_liquid"
        assert cards.at(studio.picture.layout.cards, card[0] - 5.0, card[1] + 5.0) == ""
        studio.picture.cards = studio.picture.help = True
        first = list(studio.play([(0.6, {})]))[-1]
        studio.picture.cards = studio.picture.help = False
        second = list(studio.play([(0.6, {"do": "preset", "name": "cell_in_liquid"})]))[-1]
        assert studio.picture.seen.world["title"] == "A living cell"
        assert studio.picture.stage.unit == pytest.approx(60e-6)
        assert "medium.brush_thickness" in [slider.row.field for slider in studio.picture.sliders.sliders]
        assert np.any(first != second)
    finally:
        studio.close()
