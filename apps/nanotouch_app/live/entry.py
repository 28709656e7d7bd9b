# SPDX-License-Identifier: BSD-3-Clause
"""A number that is typed with its unit: for a slider, or as the answer to a task."""

from __future__ import annotations

from typing import Any

from nanotouch.errors import InvalidValue
from nanotouch.units import parse_quantity

from nanotouch_app.live.sliders import Slider

LONGEST = 24  # letters


def value_of(slider: Slider, text: str) -> float:
    """What was typed for a slider, in SI units; :class:`InvalidValue` in words where it is no such quantity."""
    unit = slider.row.unit
    plain = text.replace(" ", "")
    if plain.endswith("%"):
        return parse_number(plain[:-1]) / 100.0
    return parse_number(plain) if unit in ("", "-", "N/N", "m/m") else parse_quantity(text, unit)


def parse_number(text: str) -> float:
    """A number without a unit."""
    try:
        return float(text)
    except ValueError:
        raise InvalidValue(f"{text!r} is no number") from None


class Entry:
    """What has been typed so far; ``slider`` None: the answer to a task."""

    def __init__(self, slider: Slider | None, asked: str = "") -> None:
        self.slider, self.text = slider, ""
        self.label = asked if slider is None else f"{slider.name}, as {slider.row.told(slider.value)}"

    @property
    def shown(self) -> str:
        """With a cursor."""
        return f"{self.label}: {self.text}_    (Enter: take it, Escape: leave it)"

    def key(self, name: str, letter: str) -> str:
        """Take a key; "done", "left" or "" while it goes on."""
        if name in ("return", "kp_enter"):
            return "done" if self.text.strip() else "left"
        if name == "escape":
            return "left"
        if name == "backspace":
            self.text = self.text[:-1]
        elif letter.isprintable() and letter and len(self.text) < LONGEST:
            self.text += letter
        return ""

    def request(self) -> dict[str, Any]:
        """What is asked of the host."""
        if self.slider is None:
            return {"do": "say", "text": self.text}
        return {"do": "change", "what": self.slider.row.what, "field": self.slider.row.field,
                "value": value_of(self.slider, self.text)}  # fmt: skip
