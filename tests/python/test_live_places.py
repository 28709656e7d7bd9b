# SPDX-License-Identifier: BSD-3-Clause
"""What each place has of its own: colour by property, the law under the tip, more surfaces, files that are dropped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.common import samples
from nanotouch_app.live import stage
from nanotouch_app.live.hands import Device, Feel, Motion
from nanotouch_app.live.held import Held
from nanotouch_app.live.host import Host
from nanotouch_app.live.look import PROPERTY_COLOURS
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import Subject, of_preset


def two_halves() -> Subject:
    """Soft at the left, stiff and sticky at the right."""
    scene, rig = nt.presets.polyester()
    scene["adhesion.given"], scene["adhesion.work_of_adhesion"] = "work_of_adhesion", 0.05
    flat = nt.surface.flat(size=40e-6, pixels=32)
    left = np.arange(32)[None, :] < 16
    modulus = np.broadcast_to(np.where(left, 1e9, 4e9), (32, 32))
    work = np.broadcast_to(np.where(left, 0.03, 0.06), (32, 32))

    def surface(touching: nt.Scene) -> nt.Surface:
        return nt.Surface.touched_by(touching, flat, youngs_modulus=modulus, work_of_adhesion=work)

    return Subject("halves", "Two halves", scene, rig, flat, surface=surface)


def test_law_and_section_are_those_of_the_place(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("nanotouch_app.live.seen.REPLACED", 0.0)
    host, seen = Host(two_halves(), lambda message: None, stepped=True), Seen()
    seen.hear(host.world())
    pulls = []
    for way in (-15e-6, 30e-6):
        for _ in range(10):
            host.answer({"do": "move", "way": (0.1 * way, 0.0, 0.0)})
            host.advance(0.1)
        seen.look(host.observer)
        seen.hear(host.clock())
        here = host.clock()["here"]
        local = host.session.scene.copy()
        local["sample.youngs_modulus"] = here["youngs_modulus"]
        local["adhesion.work_of_adhesion"] = here["work_of_adhesion"]
        local["tip.radius"] = here["radius"]
        assert seen.plan.pull_off_force == pytest.approx(local.plan().pull_off_force, rel=1e-6)
        pulls.append(seen.plan.pull_off_force)
    host.close()
    assert pulls[1] > 1.5 * pulls[0]


def test_a_hollow_pulls_more_than_a_hill() -> None:
    host = Host(of_preset("rough"), lambda message: None, stepped=True)
    host.advance(0.02)
    surface = host.session.surface
    assert surface is not None
    x = y = np.linspace(0.2e-6, 0.8e-6, 60)
    radii = surface.radius_map.radius(*np.meshgrid(x, y)).radius
    assert radii.max() > 1.5 * radii.min()
    assert host.clock()["here"]["radius"] > 0.0
    host.close()


def test_properties_have_colours_with_units() -> None:
    vtk = pytest.importorskip("vtkmodules.all")
    made = stage.Stage(vtk, vtk.vtkRenderer(), np.zeros((32, 32)), np.array([1e-8, 1e-8]))
    modulus = np.broadcast_to(np.linspace(1e9, 4e9, 32), (32, 32))
    made.give({"youngs_modulus": modulus})
    assert made.colour_by_next() == "youngs_modulus"
    assert made.ends == (1e9, 4e9)
    colour = [0.0, 0.0, 0.0]
    made.colours.GetColor(4e9, colour)
    assert [round(255 * part) for part in colour] == list(PROPERTY_COLOURS["youngs_modulus"][-1])
    assert made.colour_by_next() == "height"
    meshes = made.tiles.coarse.data.values()
    assert {mesh.GetPointData().GetScalars().GetRange() for mesh in meshes} == {(0.0, 0.0)}


@pytest.mark.parametrize("name", sorted(PROPERTY_COLOURS))
def test_lightness_of_the_colours_rises_evenly(name: str) -> None:
    rgb = np.array(PROPERTY_COLOURS[name], dtype=float) / 255.0
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    lightness = np.where(luminance > 0.008856, 116.0 * np.cbrt(luminance) - 16.0, 903.3 * luminance)
    steps = np.diff(lightness)
    assert steps.min() > 0.5 * steps.mean()
    assert steps.max() < 1.6 * steps.mean()


def test_surfaces_are_what_they_are_called() -> None:
    strand = samples.dna()
    assert 0.7e-9 < strand.height_range < 1.2e-9
    assert 0.005 < (strand.heights > 0.5e-9).mean() < 0.05
    film = samples.rough(rms=2e-9)
    assert film.heights.std() == pytest.approx(2e-9)
    np.testing.assert_array_equal(samples.rough().heights, samples.rough().heights)


def test_a_dropped_file_is_opened(tmp_path: Path) -> None:
    pytest.importorskip("gwyfile")
    file = tmp_path / "dots.gwy"
    nt.images.write(file, nt.surface.dots(size=200e-9, pixels=64, count=6))
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    host.answer({"do": "open", "path": str(file)})
    laid = next(message for message in told if message["tell"] == "laid")
    with np.load(laid["path"]) as stored:
        assert stored["heights"].shape == host.subject.topography.shape
    assert host.subject.name == "dots"
    host.answer({"do": "open", "path": str(tmp_path / "nothing.gwy")})
    assert told[-1]["tell"] == "refused"
    assert host.subject.name == "dots"
    host.close()


def test_the_window_hears_of_dropped_files() -> None:
    vtk = pytest.importorskip("vtkmodules.all")
    from nanotouch_app.live.window import Window

    asked: list[dict[str, Any]] = []

    class Bare:
        vtk: Any
        picture = type("Picture", (), {"hear": lambda self, message: None})()

        def ask(self, what: str, **more: Any) -> None:
            asked.append({"do": what, **more})

    bare = Bare()
    bare.vtk = vtk
    interactor, names = vtk.vtkRenderWindowInteractor(), vtk.vtkStringArray()
    names.InsertNextValue("/tmp/image.gwy")
    interactor.AddObserver("DropFilesEvent", Window._dropper(bare))  # type: ignore[arg-type]
    interactor.InvokeEvent("DropFilesEvent", names)
    assert asked == [{"do": "open", "path": "/tmp/image.gwy"}]


class Puppet(Device):
    """A hand whose motion is set."""

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self.felt: list[Feel] = []

    def poll(self) -> Motion:
        return self.motion

    def feel(self, feel: Feel) -> None:
        self.felt.append(feel)


def test_a_hand_moves_the_tip_and_feels_it(monkeypatch: pytest.MonkeyPatch) -> None:
    host, seen = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True), Seen()
    seen.hear(host.world())
    puppet = Puppet(Motion(x=1.0, down=1.0))
    held = Held([puppet])
    host.advance(0.05)
    before = host.observer.newest()["tip_position"][0]
    for _ in range(60):
        held.move(0.05, host.session.surface.size[0], lambda what, **more: host.answer({"do": what, **more}))
        host.advance(0.05)
        seen.look(host.observer)
        held.feel(seen.feel())
    assert host.observer.newest()["tip_position"][0] > before + 50e-9
    assert puppet.felt[-1].level > 0.1
    assert "snap" in [feel.event for feel in puppet.felt]
    seen.age = 1.0  # frames are old
    assert seen.feel().level == 0.0
    puppet.motion = Motion(pressed=["stop"])
    held.move(0.05, 1e-6, lambda what, **more: host.answer({"do": what, **more}))
    host.advance(0.01)
    assert host.session.state == "LATCHED"
    held.close()
    host.close()


def test_a_sharp_place_that_would_yield_has_a_law_that_is_drawn() -> None:
    """Under the largest load a silicon tip yields on a sharp hill: the law is drawn as far as it holds."""
    host, seen = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True), Seen()
    seen.hear(host.world())
    host.close()
    load = seen.load
    sharp = {"radius": 2e-9}
    scene = seen.scene.copy()
    scene["tip.radius"] = sharp["radius"]
    with pytest.raises(nt.Error, match="yield"):
        scene.plan(relative_accuracy=0.01)
    seen.hear({"tell": "clock", "speed": 1.0, "paused": False, "slowdown": 1.0, "recorded": False, "here": sharp})
    assert float(seen.scene.tip.radius) == sharp["radius"]
    assert float(seen.scene.range.maximum_load) < load == seen.load
    assert seen.plan.pull_off_force > 0.0
