# SPDX-License-Identifier: BSD-3-Clause
"""Live without a window: the host and its hand at wall pace, changes and their history, the display that is none."""

from __future__ import annotations

import re
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.live import display, files, readings, relief, stage
from nanotouch_app.live.host import Host
from nanotouch_app.live.look import LIGHT, digits, step_up
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.sliders import offered
from nanotouch_app.live.subject import PRESETS, of_preset

PATIENCE = 30.0  # of a loaded machine [s]


@pytest.fixture
def host() -> Iterator[Host]:
    told: list[dict[str, Any]] = []
    made = Host(of_preset("silicon_in_air"), told.append)
    made.told = told  # type: ignore[attr-defined]
    yield made
    made.close()


def wait(host: Host, until: Callable[[Any], bool], act: Callable[[], None] = lambda: None) -> Any:
    """The first frame of which this holds."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        host.tick()
        frame = host.observer.newest()
        if frame is not None and until(frame):
            return frame
        act()
        time.sleep(0.005)
    raise AssertionError(f"it never came: {host.observer.newest()}")


def scroll(host: Host) -> Callable[[], None]:
    return lambda: host.answer({"do": "wheel", "steps": 1.0})


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_every_preset_is_touched_and_let_go(name: str) -> None:
    host = Host(of_preset(name), lambda message: None)
    try:
        host.answer({"do": "press", "on": True})
        pressed = wait(host, lambda frame: frame["tip_force"][2] > 0.4 * host.session.scene.range.maximum_load)
        assert pressed["state"] == 0
        host.answer({"do": "press", "on": False})
        free = wait(host, lambda frame: frame["gap"] > 0.3 * host.session.clearance)
        assert free["state"] == 0
    finally:
        host.close()


def test_the_spring_holds_the_tip(host: Host) -> None:
    wait(host, lambda frame: frame["tip_force"][2] > 2e-8, scroll(host))
    settled = time.monotonic() + 0.5
    frame = wait(host, lambda frame: time.monotonic() > settled)
    lead = float(frame["tip_position"][2]) - host.core.state["height"]
    assert float(frame["tip_force"][2]) == pytest.approx(lead * host.core.state["stiffness"], rel=0.15, abs=3e-9)


def test_the_hand_stops_before_the_force_limit(host: Host) -> None:
    wait(host, lambda frame: True)
    for _ in range(400):
        host.answer({"do": "wheel", "steps": 1.0})
    end = time.monotonic() + 1.0
    frame = wait(host, lambda frame: time.monotonic() > end)
    assert frame["state"] == 0
    assert 0.5 * host.core.state["limit"] < frame["tip_force"][2] < 1.1 * host.core.state["limit"]


def test_a_pause_holds_and_a_step_steps(host: Host) -> None:
    wait(host, lambda frame: frame["sequence"] > 100)
    host.answer({"do": "pause"})
    time.sleep(0.05)
    held = host.observer.newest()["sequence"]
    time.sleep(0.1)
    assert host.observer.newest()["sequence"] == held
    host.answer({"do": "step"})
    wait(host, lambda frame: frame["sequence"] == held + 10)


def test_dry_air_pulls_off_as_the_law_says_and_undo_takes_it_back(host: Host) -> None:
    wet = host.session.plan.pull_off_force
    host.answer({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.0})
    scene, _ = nt.presets.silicon_in_air()
    scene["medium.relative_humidity"] = 0.0
    assert host.session.plan.pull_off_force == pytest.approx(scene.plan().pull_off_force, rel=1e-9)
    wait(host, lambda frame: frame["contact_radius"] > 0.0, scroll(host))
    lowest = [0.0]

    def note() -> None:
        frames = reader.read()
        lowest[0] = np.minimum(lowest[0], frames["tip_force"][:, 2].min(initial=0.0))
        host.answer({"do": "wheel", "steps": -0.3})

    with nt.frames.attach(host.name) as reader:
        wait(host, lambda frame: frame["gap"] > 5e-9, note)
        note()
    assert -lowest[0] == pytest.approx(host.session.plan.pull_off_force, rel=0.1)
    host.answer({"do": "undo"})
    assert host.session.plan.pull_off_force == pytest.approx(wet)
    host.answer({"do": "redo"})
    assert host.session.scene["medium.relative_humidity"] == 0.0


def test_another_lever_is_mounted_and_a_bad_one_refused(host: Host) -> None:
    host.answer({"do": "change", "what": "rig", "field": "probe.spring_constant", "value": 2.0})
    assert host.session.rig["probe.spring_constant"] == 2.0
    host.answer({"do": "change", "what": "scene", "field": "tip.radius", "value": 1e-12})
    assert host.told[-1]["tell"] == "refused"  # type: ignore[attr-defined]
    assert "tip.radius" in host.told[-1]["why"]  # type: ignore[attr-defined]
    assert host.session.scene["tip.radius"] == 20e-9
    host.answer({"do": "undo"})
    assert host.session.rig["probe.spring_constant"] == 8.0
    wait(host, lambda frame: frame["sequence"] > 100)


def test_rewind_goes_back(host: Host) -> None:
    for _ in range(2):  # four times as fast
        host.answer({"do": "faster"})
    before = wait(host, lambda frame: frame["time"] > 6.0)
    host.answer({"do": "rewind"})
    assert wait(host, lambda frame: True)["time"] < before["time"] - 4.0
    wait(host, lambda frame: frame["tip_force"][2] > 1e-8, scroll(host))


def test_rewind_shows_where_it_went_in_a_pause(host: Host) -> None:
    host.answer({"do": "faster"})
    host.answer({"do": "faster"})
    before = wait(host, lambda frame: frame["time"] > 6.0)
    host.answer({"do": "pause"})
    host.answer({"do": "rewind"})
    back = host.observer.newest()
    assert before["time"] - 5.6 < back["time"] < before["time"] - 3.0  # four times as fast as the clock
    assert host.paused
    sequence = back["sequence"]
    time.sleep(0.1)
    assert host.observer.newest()["sequence"] == sequence


def test_a_refused_slider_says_how_far_it_may_go(host: Host) -> None:
    """What is said to be possible is taken, and a percent more is refused."""
    old = host.session.settings["gains.alpha_f"]
    request = {"do": "change", "what": "settings", "field": "gains.alpha_f"}
    host.answer(request | {"value": 10.0 * old})
    why = host.told[-1]["why"]  # type: ignore[attr-defined]
    found = re.fullmatch(
        r"force scaling ([\d.]+) million: the loop would not be stable enough \(margin [\d.]+ of virtual coupling; "
        r"at least 1.5 is kept\)\. Possible is up to ([\d.]+) million\. It stays at ([\d.]+) million\.", why,
    )  # fmt: skip
    assert found, why
    assert float(found[1]) == pytest.approx(10.0 * old / 1e6, rel=0.01)
    assert float(found[3]) == pytest.approx(old / 1e6, rel=0.01)
    possible = 1e6 * float(found[2])
    host.answer(request | {"value": 1.02 * possible})
    assert host.told[-1]["tell"] == "refused"  # type: ignore[attr-defined]
    host.answer(request | {"value": 0.99 * possible})
    assert host.session.settings["gains.alpha_f"] == 0.99 * possible


@pytest.mark.parametrize(
    ("preset", "field", "value", "words"),
    [
        ("silicon_on_gold", "medium.relative_humidity", 0.0,
         "humidity 0 %: known only within 1.5 % there, and this session keeps 1 %. It stays at 61 %."),
        ("mica_in_air", "adhesion.work_of_adhesion", 2e-3,
         "that does not go with adhesion.hamaker_constant = 1e-19 J, which would have to be within 0 .. "),
    ],
)  # fmt: skip
def test_what_a_law_does_not_cover_is_told_in_words(preset: str, field: str, value: float, words: str) -> None:
    told: list[dict[str, Any]] = []
    host = Host(of_preset(preset), told.append, stepped=True)
    host.advance(0.02)
    host.answer({"do": "change", "what": "scene", "field": field, "value": value})
    assert words in told[-1]["why"]
    host.close()


def test_old_frames_are_not_felt(host: Host) -> None:
    seen = Seen()
    seen.hear(host.world())
    wait(host, lambda frame: frame["tip_force"][2] > 2e-8, scroll(host))
    time.sleep(0.05)
    with nt.frames.attach(host.name) as observer:
        wait(host, lambda frame: len(seen.tail) > 0, lambda: seen.look(observer))
        assert seen.force != 0.0
        host.session.halt()
        seen.look(observer)
        time.sleep(0.15)
        seen.look(observer)
    assert seen.stale
    assert seen.force == 0.0


def test_sliders_are_those_that_mean_something(host: Host) -> None:
    sliders = {slider.row.field: slider for slider in offered(host.world())}
    assert "medium.relative_humidity" in sliders
    assert "medium.brush_thickness" not in sliders
    for slider in sliders.values():
        assert slider.row.at(slider.row.place(slider.value)) == pytest.approx(slider.value, rel=0.01)
        assert slider.row.doc
        assert 0.0 <= slider.row.low < slider.row.high


def test_only_the_adhesion_that_is_read_has_a_slider() -> None:
    subject = of_preset("polyester")
    world = {"scene": subject.scene.to_dict(), "rig": subject.rig.to_dict(), "settings": nt.Settings().to_dict()}
    fields = [slider.row.field for slider in offered(world)]
    assert "adhesion.sample_surface_energy" in fields
    assert "adhesion.work_of_adhesion" not in fields


def test_a_surface_is_drawn_with_few_triangles() -> None:
    heights = np.random.default_rng(1).standard_normal((4096, 1500))
    means, size = relief.coarse(heights)
    assert 2 * (means.shape[0] - 1) * (means.shape[1] - 1) <= 2**17
    assert means[3, 5] == pytest.approx(heights[3 * size : 4 * size, 5 * size : 6 * size].mean())


def test_heights_are_raised_so_that_a_relief_is_seen_and_a_strand_stays_a_strand() -> None:
    x = np.mgrid[:64, :64][1] / 64.0
    waves = 1e-9 * np.sin(2.0 * np.pi * x)
    assert relief.exaggeration(waves, (1e-6 / 64, 1e-6 / 64), 1e-6) == 50.0  # 0.12 of the width is 60 times 2 nm
    assert relief.exaggeration(np.zeros((4, 4)), (1e-8, 1e-8), 1e-6) == 1.0
    assert relief.exaggeration(np.full((4, 4), np.nan), (1e-8, 1e-8), 1e-6) == 1.0
    strand = 1e-9 * np.exp(-(((x - 0.5) / 0.01) ** 2))
    factor = relief.exaggeration(strand, (1e-6 / 64, 1e-6 / 64), 1e-6)
    assert factor == 30.0  # 0.12 of the width is 120 nm, twice the pixel that it is wide 31 nm
    dna = of_preset("dna").topography
    heights, merged = relief.coarse(dna.heights)
    dy, dx = np.asarray(dna.pixel_size) * merged
    assert relief.exaggeration(heights, (dy, dx), 500e-9) == 15.0


def test_the_factor_of_heights_goes_up_and_down_by_steps() -> None:
    ladder, factor = [1.0], 1.0
    while (higher := relief.stepped(factor, True, 0.02)) != factor:
        ladder.append(higher)
        factor = higher
    assert ladder == [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0]  # 0.5 of the width is 25 times
    back = [factor := relief.stepped(factor, False, 0.02) for _ in range(9)]
    assert back == [*ladder[-2::-1], 1.0]
    assert relief.stepped(1.0, True, 0.9) == 1.0


def test_numbers_keep_three_digits() -> None:
    assert digits(1.7976e-8, "N") == "18.0 nN"
    assert digits(-4.5e-10, "m") == "-450 pm"
    assert digits(0.0, "N") == "0 N"
    assert digits(float("nan"), "N") == "-"
    assert step_up(2.1e-9) == pytest.approx(5e-9)


def test_no_display_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(nt.Error, match="DISPLAY is not set"):
        display.check()
    for name, reason in ((":7654", "nobody listens"), ("what", "names none")):
        monkeypatch.setenv("DISPLAY", name)
        with pytest.raises(nt.Error, match=reason):
            display.check()


def test_a_display_that_does_not_answer_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    with socket.create_server(("127.0.0.1", 0)) as silent:
        number = silent.getsockname()[1] - display.BASE_PORT
        monkeypatch.setenv("DISPLAY", f"127.0.0.1:{number}.0")
        with pytest.raises(nt.Error, match=r"did not answer within 0\.2 s"):
            display.check(0.2)


def test_forces_are_scaled_as_in_a_first_touch(host: Host) -> None:
    scene, rig = nt.presets.silicon_in_air()
    wanted = nt.margins.felt_alpha_f(rig, nt.Settings.for_rig(rig), scene.plan(), load=scene.range.maximum_load)
    assert host.session.settings.gains.alpha_f == pytest.approx(wanted)
    assert wanted * scene.plan().pull_off_force >= 0.1  # [N]: felt


def test_the_shadow_lies_on_the_surface() -> None:
    vtk = pytest.importorskip("vtkmodules.all")
    heights = np.outer(np.ones(40), np.linspace(0.0, 1e-7, 40))
    made = stage.Stage(vtk, vtk.vtkRenderer(), heights, np.array([1e-8, 1e-8]))
    made.instrument._cast(np.array([0.5, 0.5, 0.0]), 0.0, made._on)
    for _, data in made.instrument.below_tip + made.instrument.below_beam:
        for x, _, z in (data.GetPoint(point) for point in range(data.GetNumberOfPoints())):
            assert 0.0 < x < 2.0 * made.centre[0]
            drawn = (x * made.unit / 1e-8 - 0.5) / 39 * 1e-7 * made.scale[2]
            assert z == pytest.approx(drawn + stage.LIFTED, abs=1e-6)


@pytest.mark.parametrize("view", ["0", "2", "3"])
def test_a_drag_is_as_much_finer_as_the_picture_is_larger(view: str) -> None:
    """It grows about the tip, which is seen where it was, wherever that is."""
    vtk = pytest.importorskip("vtkmodules.all")
    window, renderer = vtk.vtkRenderWindow(), vtk.vtkRenderer()
    window.SetSize(800, 600)
    window.AddRenderer(renderer)
    made = stage.Stage(vtk, renderer, np.zeros((64, 64)), np.array([1e-8, 1e-8]))
    tip, pixels = np.array([0.8, 0.3, 0.05]), np.array([30.0, 10.0])
    made.camera(view)
    made.turn(20.0, -5.0)
    place, way = made.pixel(tip), np.array(made.dragged(tip, pixels))
    for steps in (4.0, 100.0, -100.0):
        factor = made.magnify(steps)
        made._look_at(tip)
        assert made.pixel(tip) == pytest.approx(place, abs=1e-6)
        assert factor * np.array(made.dragged(tip, pixels)) == pytest.approx(way, rel=0.02)  # by a difference
    assert factor == 1.0


def test_what_is_no_display_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Somebody answers on the port of a display, and is none."""
    server = socket.socket()
    server.bind(("127.0.0.1", 0))
    server.listen()
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(display, "BASE_PORT", server.getsockname()[1])
    monkeypatch.setenv("DISPLAY", "127.0.0.1:0")

    def answer(words: bytes) -> None:
        wire, _ = server.accept()
        wire.recv(12)
        wire.sendall(words)
        wire.close()

    for words, is_display in ((b"HTTP/1.1 400", False), (b"\x00\x12No protocol", True), (b"\x01", True)):
        thread = threading.Thread(target=answer, args=(words,))
        thread.start()
        if is_display:
            display.check()
        else:
            with pytest.raises(nt.Error, match="what answers there is no X server"):
                display.check()
        thread.join()
    server.close()


def test_a_large_file_is_told_of_until_it_is_laid(tmp_path: Path) -> None:
    """In the lower line, with the seconds since; then what to try."""
    image, told = tmp_path / "large.gsf", []
    nt.images.write(image, nt.surface.dots(size=400e-9, pixels=64, count=6, seed=4))
    files.of(str(image), told=told.append)
    assert told == ["reading large.gsf", "levelling 64 x 64 pixels of large.gsf"]
    host, seen = Host(of_preset("silicon_in_air"), lambda message: seen.hear(message), stepped=True), Seen()
    seen.hear({"tell": "note", "text": f"{told[1]} ..."})
    at, words, is_bad = seen.notes[-1]
    seen.notes[-1] = (at - 20.0, words, is_bad)
    assert readings._lower(LIGHT, seen, "")[0] == f"{words} 20 s"
    host.answer({"do": "open", "path": str(tmp_path / "none.gsf")})
    assert "none.gsf" in readings._lower(LIGHT, seen, "")[0]
    seen.notes[-1] = (at - 20.0, *seen.notes[-1][1:])
    assert readings._lower(LIGHT, seen, "")[0] == ""  # that it is read is told no more
    host.answer({"do": "open", "path": str(image)})
    assert readings._lower(LIGHT, seen, "")[0] == ""
    assert seen.world["hint"] == "Feel your own surface."
    host.close()


def test_a_caption_of_a_film_is_no_progress() -> None:
    """It ends with dots, too, and is from the future, so that it stays."""
    seen = Seen()
    seen.notes.append((time.monotonic() + 1e6, "the water holds ...", False))
    assert readings._lower(LIGHT, seen, "")[0] == "the water holds ..."


def test_a_move_goes_on_pressing_and_the_wheel_does_not() -> None:
    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    host.advance(0.01)
    host.answer({"do": "press", "on": True})
    host.answer({"do": "move", "way": (1e-9, 0.0, 0.0)})
    assert host.core.state["presses"]
    host.answer({"do": "wheel", "steps": 1.0})
    assert not host.core.state["presses"]
    host.close()
