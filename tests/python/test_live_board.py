# SPDX-License-Identifier: BSD-3-Clause
"""Board and typed numbers without a window: what a click means, what may be typed."""

from __future__ import annotations

import json
import subprocess
import sys

import nanotouch as nt
import pytest
from nanotouch_app.live import board, look
from nanotouch_app.live.entry import Entry, value_of
from nanotouch_app.live.host import Host
from nanotouch_app.live.picture import Layout
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.sliders import Slider, Sliders, offered
from nanotouch_app.live.subject import of_preset

WORLD = {"scene": nt.Scene().to_dict(), "rig": nt.Rig().to_dict(), "settings": nt.Settings().to_dict()}
BY_FIELD = {slider.row.field: slider for slider in offered(WORLD)}
HUMIDITY, MODULUS = BY_FIELD["medium.relative_humidity"], BY_FIELD["sample.youngs_modulus"]
SCALE = BY_FIELD["gains.alpha_f"]


def typed(entry: Entry, text: str, last: str = "return") -> str:
    for letter in text:
        assert entry.key(letter, letter) == ""
    return entry.key(last, "")


@pytest.mark.parametrize(
    ("slider", "text", "value"),
    [(HUMIDITY, "25 %", 0.25), (HUMIDITY, "0.3", 0.3), (MODULUS, "70 GPa", 70e9), (MODULUS, "5e9Pa", 5e9),
     (SCALE, "2.5e6", 2.5e6)],
)  # fmt: skip
def test_a_number_is_typed_with_its_unit(slider: Slider, text: str, value: float) -> None:
    assert value_of(slider, text) == pytest.approx(value)
    entry = Entry(slider)
    assert typed(entry, text) == "done"
    assert entry.request() == {"do": "change", "what": slider.row.what, "field": slider.row.field,
                               "value": pytest.approx(value)}  # fmt: skip


@pytest.mark.parametrize(("slider", "text"), [(MODULUS, "70"), (MODULUS, "70 nm"), (HUMIDITY, "wet"), (SCALE, "x%")])
def test_what_is_no_such_number_is_refused_in_words(slider: Slider, text: str) -> None:
    with pytest.raises(nt.errors.InvalidValue, match=text.rstrip("%")):
        value_of(slider, text)


def test_typing_is_corrected_and_left() -> None:
    entry = Entry(None, "your answer")
    assert typed(entry, "18x", "backspace") == ""
    assert typed(entry, "nN") == "done"
    assert entry.request() == {"do": "say", "text": "18nN"}
    assert typed(Entry(None), "18", "escape") == "left"
    assert typed(Entry(None), "  ") == "left"


def test_a_typed_number_out_of_range_is_refused_with_the_range() -> None:
    told: list[dict[str, object]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    host.answer({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 1.5})
    host.close()
    assert told[-1]["tell"] == "refused"
    assert "relative_humidity" in str(told[-1]["why"])


def test_a_refused_answer_goes_when_the_next_one_is_given() -> None:
    seen = Seen()
    seen.hear({"tell": "note", "text": "saved a.png"})
    seen.hear({"tell": "refused", "why": "not yet: tear three times"})
    seen.asks("wheel")
    assert [text for _, text, _ in seen.notes] == ["saved a.png", "not yet: tear three times"]
    seen.asks("say")
    assert [text for _, text, _ in seen.notes] == ["saved a.png"]


def test_a_click_on_the_number_of_a_slider_is_no_drag() -> None:
    sliders = Sliders()
    sliders.frame, sliders.full = (0.0, 0.0, 800.0, 122.0), True
    sliders.sliders = [HUMIDITY, MODULUS]
    x, y, width, _ = sliders._box(1)
    assert sliders.value_at(x + 0.9 * width, y + 37) is MODULUS
    assert sliders.value_at(x + 0.9 * width, y + 14) is None
    assert sliders.at(x + 0.9 * width, y + 14) is MODULUS
    assert sliders.value_at(5000.0, 5.0) is None


def test_every_choice_of_the_menu_is_a_task_under_its_button() -> None:
    menu = board.menu()
    for number, (name, (x, y, width, height)) in enumerate(
        zip(board.MENU, board.buttons(menu, 20.0, 800.0), strict=True)
    ):
        assert board.at(menu, 20.0, 800.0, (x + 0.5 * width, y + 0.5 * height)) == number
        assert not name or name in board.TASKS
    assert board.at(menu, 20.0, 800.0, (25.0, 795.0)) is None


def loaded_after(code: str) -> set[str]:
    """The modules that a fresh interpreter has loaded."""
    done = subprocess.run([sys.executable, "-c", f"{code}; import json, sys; print(json.dumps(list(sys.modules)))"],
                          capture_output=True, text=True, check=True)  # fmt: skip
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_a_command_loads_its_own_module_alone() -> None:
    loaded = loaded_after("from nanotouch_app.main import main; main(['live', '--list'])")
    assert "nanotouch_app.live.command" in loaded
    unwanted = {"nanotouch_app.touching.touch", "nanotouch_app.data.fit", "nanotouch_app.live.film", "vtkmodules.all"}
    assert not loaded & unwanted


def test_the_window_loads_no_command_and_not_all_of_vtk() -> None:
    pytest.importorskip("vtkmodules")
    loaded = loaded_after("import nanotouch_app.live.window; from nanotouch_app.live import parts; parts.load()")
    assert "vtkmodules.vtkRenderingCore" in loaded
    assert not loaded & {"vtkmodules.all", "nanotouch_app.live.command", "nanotouch_app.live.host"}


def test_a_window_fits_its_screen() -> None:
    assert look.fitting(1440, 900) == look.fitting(1920, 1080) == (1440, 900)
    assert look.fitting(0, 0) == (1440, 900)
    for width, height in ((1400, 900), (1280, 800), (1024, 768)):
        made = look.fitting(width, height)
        assert made[0] <= width
        assert made[1] <= height


@pytest.mark.parametrize("size", [(1440, 900), (1384, 836), (1264, 736), (1008, 704), (784, 536)])
@pytest.mark.parametrize("full", [False, True])
def test_panels_lie_in_the_window_and_not_on_each_other(size: tuple[int, int], full: bool) -> None:
    made = Layout(*size, full)
    for frame in (made.top, made.guide, made.status, made.controls, made.view, made.bars, made.cards, made.help):
        assert min(frame) >= 0.0
        assert frame[0] + frame[2] <= size[0]
        assert frame[1] + frame[3] <= size[1]
    panels = [made.top, made.guide, made.status, made.controls, made.view]
    if made.column:
        panels += [made.history, made.law, made.contact] if full else [made.law]
    for number, one in enumerate(panels):
        for other in panels[:number]:
            apart = (one[0] + one[2] <= other[0] or other[0] + other[2] <= one[0]
                     or one[1] + one[3] <= other[1] or other[1] + other[3] <= one[1])  # fmt: skip
            assert apart, (one, other)
    sliders = Sliders()
    sliders.frame, sliders.sliders, sliders.full = made.controls, 8 * [SCALE], full
    for number in range(len(sliders.shown)):
        x, y, width, _ = sliders._box(number)
        assert made.controls[0] <= x
        assert x + width <= made.controls[0] + made.controls[2]
        assert made.controls[1] <= y
