# SPDX-License-Identifier: BSD-3-Clause
"""A sample that keeps dents in the live view: the drawn law beside the session's frames, the section beside Hertz, the
surface as it was edited, undo and rewind."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from nanotouch import plasticity
from nanotouch_app import view
from nanotouch_app.common.scenes import felt
from nanotouch_app.live import board, cards, dented, film
from nanotouch_app.live.host import Host
from nanotouch_app.live.look import LIGHT
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import PRESETS, of_preset
from touching import Operator, newest

GOLD = plasticity.Indentation(30e-9, 77e9, 0.35e9)


class Watched:
    """A stepped host, and what a picture knows of it."""

    def __init__(self, preset: str = "soft_gold") -> None:
        self.seen = Seen()
        self.told: list[dict[str, Any]] = []
        self.host = Host(of_preset(preset), self.hear, stepped=True)
        self.host.report()
        self.frames: list[Any] = []

    @property
    def observer(self) -> Any:
        return self.host.observer

    def hear(self, message: dict[str, Any]) -> None:
        self.told.append(message)
        self.seen.hear(message)

    def answer(self, message: dict[str, Any]) -> bool:
        return self.host.answer(message)

    def advance(self, duration: float) -> None:
        self.host.advance(duration)
        self.seen.look(self.host.observer)
        self.frames.append((self.host.observer.newest(), self.seen.curve))


@pytest.fixture
def watched() -> Any:
    made = Watched()
    made.advance(0.05)
    yield made
    made.host.close()


def operator(watched: Watched) -> Operator:
    watched.answer({"do": "task", "name": "dent", "seed": 1})
    return Operator(watched, 300e-9)


def test_the_drawn_law_is_the_one_that_is_felt(watched: Watched) -> None:
    """Way in and way out of two presses, the second one in the dent of the first."""
    hand = operator(watched)
    for force in (100e-9, 200e-9):
        watched.frames.clear()
        hand.down_to(force)
        pressed = [(frame, law) for frame, law in watched.frames if frame["contact_radius"] > 0.0]
        assert len(pressed) > 5
        for frame, law in pressed:  # noise unloads it a little now and then
            drawn = [np.interp(-frame["gap"], -law.apart[:, 0], law.apart[:, 1])]
            if len(law.attached):
                drawn.append(np.interp(frame["gap"], law.attached[:, 0], law.attached[:, 1]))
            off = min(abs(frame["tip_force"][2] - one) for one in drawn)
            assert off < 0.5e-9 + 0.01 * frame["tip_force"][2]
        way_out = watched.seen.curve.attached
        assert len(way_out)
        for _ in range(20):
            frame = hand.wheel(-0.5)
            if frame["contact_radius"] > 0.0:
                drawn = np.interp(frame["gap"], way_out[:, 0], way_out[:, 1])
                assert frame["tip_force"][2] == pytest.approx(drawn, rel=1e-2, abs=0.5e-9)
        hand.up()
    (dent,) = watched.host.dents
    assert watched.seen.dented is not None
    assert watched.seen.dented.dents == (dent,)
    assert watched.seen.dented.began == dent.imprint.radius
    assert "dent" in watched.seen.dented.words


def test_energies_of_a_dent_are_heat(watched: Watched) -> None:
    """What the hand has put in when the tip is away again is the heat of the dent."""
    hand = operator(watched)
    hand.down_to(150e-9)
    hand.up()
    (dent,) = watched.host.dents
    assert watched.seen.dented is not None
    heat = float(watched.seen.dented.law.at_load(dent.load).dissipated)
    assert watched.host.clock()["energies"][2] == pytest.approx(heat, rel=0.02)
    assert watched.seen.dented.stored(0.0) == 0.0


def test_undo_takes_the_dent_back(watched: Watched) -> None:
    hand = operator(watched)
    hand.down_to(100e-9)
    hand.up()
    assert len(watched.host.dents) == 1
    assert watched.host.world()["undo"] == 1
    watched.answer({"do": "undo"})
    assert watched.host.dents == ()
    assert watched.seen.dented is not None
    assert watched.seen.dented.dents == ()
    watched.answer({"do": "undo"})
    assert not [message for message in watched.told if message["tell"] == "refused"]


def made(*loads: float) -> dented.Dented:
    found = dented.Dented(GOLD, 300e-9)
    rows = []
    for number, load in enumerate(loads):
        of = GOLD.at_load(load)
        place = 60e-9 * (number + 1)
        imprint = plasticity.Imprint(place, 50e-9, place, 50e-9, float(of.contact_radius), float(of.residual_depth))
        rows.append(plasticity.Dent(imprint, load, None))
    found.dents = tuple(rows)
    return found


def test_the_section_is_continuous_and_hertz_around_the_contact() -> None:
    """Under full load it meets the tip at the rim, a^2/(2 R') below the flat; far away it falls as F/(pi E* r)."""
    sample = made()
    load = 200e-9
    of = GOLD.at_load(load)
    a = sample.reached = float(of.contact_radius)
    r = np.array([0.0, a * (1 - 1e-9), a * (1 + 1e-9), 20.0 * a])
    section = sample.section(-float(of.indentation), r)
    assert section.contact_radius == pytest.approx(a, rel=1e-6)
    assert section.sample[0] == pytest.approx(-float(of.indentation), rel=1e-9)
    assert section.sample[1] == pytest.approx(section.sample[2], rel=2e-2)  # a sphere beside a paraboloid
    assert -section.sample[2] == pytest.approx(0.5 * a * a / float(of.effective_radius), rel=1e-6)
    assert -section.sample[3] == pytest.approx(load / (np.pi * GOLD.effective_modulus * 20.0 * a), rel=1e-3)
    apart = sample.section(5e-9, r)
    assert apart.sample[0] == -float(of.residual_depth)
    assert apart.contact_radius == 0.0


def test_the_surface_has_the_dents_and_leaves_out_what_is_finer_than_its_pixels() -> None:
    sample = made(200e-9, 1e-9)
    flat = np.zeros((256, 512))
    heights = sample.heights(flat, (0.4e-9, 0.4e-9), (0.0, 0.0))
    moved = sample.heights(flat[10:, 20:], (0.4e-9, 0.4e-9), (8e-9, 4e-9))
    np.testing.assert_allclose(moved, heights[10:, 20:], atol=1e-15)
    assert heights.min() == pytest.approx(-sample.dents[0].imprint.depth, rel=1e-2)
    assert np.unravel_index(heights.argmin(), heights.shape) == (pytest.approx(125, abs=1), pytest.approx(150, abs=1))
    assert not heights[:, 250:].any()
    assert not flat.any()
    assert sample.lowered(60e-9, 50e-9) == (sample.dents[0].imprint.depth, sample.dents[0].imprint.radius)
    assert sample.lowered(200e-9, 50e-9) == (0.0, 0.0)


def test_dents_that_overlap_are_as_deep_as_the_deepest_and_one_at_the_edge_is_cut_off() -> None:
    """Beside Specimen's own picture of one dent alone."""
    sample = made(200e-9, 100e-9)
    first, second = sample.dents
    a = first.imprint.radius
    shifted = second.imprint._replace(start_x=60e-9 + a, end_x=60e-9 + a)
    sample.dents = (first, second._replace(imprint=shifted))
    flat = np.zeros((256, 256))
    heights = sample.heights(flat, (0.4e-9, 0.4e-9), (0.0, 0.0))
    alone = plasticity.Specimen(flat, 0.4e-9)
    alone.take(first)
    deep = np.array(alone.heights)
    alone.undo()
    alone.take(sample.dents[1])
    np.testing.assert_allclose(heights.min(), min(deep.min(), alone.heights.min()), rtol=1e-12)
    np.testing.assert_allclose(heights[deep < 0.0], np.minimum(deep, alone.heights)[deep < 0.0], atol=1e-24)
    moved = sample.heights(flat, (0.4e-9, 0.4e-9), (60e-9, 50e-9))  # the corner lies in the middle of the first one
    assert moved[0, 0] == pytest.approx(-first.imprint.depth, rel=1e-2)


def test_one_undo_takes_back_all_that_a_touch_has_left(watched: Watched) -> None:
    """A groove, and the tap before it."""
    hand = operator(watched)
    for count in (1, 2):
        hand.down_to(150e-9)
        for _ in range(12):
            watched.answer({"do": "move", "way": (3e-9, 0.0, 0.0)})
            watched.advance(0.02)
        if count == 2:
            watched.answer({"do": "undo"})
            refused = [message["why"] for message in watched.told if message["tell"] == "refused"]
            assert "lift it first" in refused[-1]
        hand.up()
        left = watched.host.dents
        if count == 1:
            before = left
            watched.answer({"do": "move", "way": (0.0, 40e-9, 0.0)})
            watched.advance(0.3)
    assert len(left) > len(before) > 0
    watched.answer({"do": "undo"})
    assert watched.host.dents == before
    assert watched.host.clock()["undo"] == len(before)
    watched.answer({"do": "undo"})
    assert watched.host.dents == ()


def test_the_picture_draws_dents_and_balls(tmp_path: Any) -> None:
    pytest.importorskip("vtkmodules")
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)
    studio = film.Studio(of_preset("soft_gold"))
    host, stage = studio.host, studio.picture.stage
    factor = stage.factor
    assert factor > 1.0  # as high as its deepest dents ask for, from the beginning
    before = float(stage.heights.min())
    rig = Watched.__new__(Watched)
    rig.host, rig.seen, rig.frames = host, studio.picture.seen, []
    hand = operator(rig)
    hand.down_to(200e-9)
    hand.up()
    assert stage.heights.min() < before - 0.5e-9
    assert stage.factor == factor
    pixels = np.asarray(next(iter(studio.play([(0.2, {})]))))
    assert pixels.std() > 5.0
    host.answer({"do": "task", "name": "push", "lay": True, "seed": 1})
    assert len(studio.picture.stage.balls.balls) == 1
    studio.look()
    assert studio.picture.seen.dented is None
    host.answer({"do": "task", "name": ""})
    assert not studio.picture.stage.balls.balls
    studio.close()


def test_each_preset_has_a_card_with_its_words() -> None:
    written: list[str] = []
    painter = SimpleNamespace(box=lambda *_: None, text=lambda _x, _y, words, *_, **__: written.append(words))
    cards.draw(cast(Any, painter), LIGHT, (0.0, 0.0, 800.0, 800.0), "")
    for name, preset in PRESETS.items():
        assert preset["title"] in written
        assert felt(name)


def test_each_task_of_the_menu_has_a_key() -> None:
    pytest.importorskip("vtkmodules")
    from nanotouch_app.live.keys import FUNCTION_KEYS

    assert len(FUNCTION_KEYS) >= len(board.MENU)


def test_another_tip_lays_a_fresh_sample(watched: Watched) -> None:
    hand = operator(watched)
    hand.down_to(100e-9)
    hand.up()
    watched.answer({"do": "task", "name": ""})
    assert watched.seen.dented is not None
    assert watched.seen.dented.dents
    watched.answer({"do": "change", "what": "scene", "field": "tip.radius", "value": 40e-9})
    assert watched.seen.dented is not None
    assert not watched.seen.dented.dents
    assert watched.seen.dented.law.radius == pytest.approx(40e-9, rel=1e-6)


def test_a_dent_task_on_a_sample_that_keeps_none_is_refused() -> None:
    watched = Watched("polyester")
    watched.answer({"do": "task", "name": "dent"})
    watched.host.close()
    assert "keeps no dents; lay soft_gold" in newest(watched.told, "refused")["why"]
    assert board.TASKS["scratch"]["preset"] == "soft_gold"
