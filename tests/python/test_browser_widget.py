# SPDX-License-Identifier: BSD-3-Clause
"""The widget's end in the kernel: what the page is sent, what it may ask."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("anywidget", reason="pip install 'nanotouch[notebook]'")
from nanotouch_app.browser.update import LAYOUT
from nanotouch_app.browser.widget import Touch

LONG = 60.0  # on a loaded machine [s]


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """All that goes into the channel."""
    kept: list[Any] = []
    monkeypatch.setattr(Touch, "send", lambda self, content, buffers=None: kept.append((content, buffers)))
    return kept


@pytest.fixture
def touch(sent: list[Any], tmp_path: Path) -> Iterator[Touch]:
    page = tmp_path / "page.html"
    page.write_text("<!doctype html>")
    made = Touch(page=page)
    yield made
    made.close()


def wait(sent: list[Any], is_it: Any) -> Any:
    """Until something is sent."""
    end = time.monotonic() + LONG
    while time.monotonic() < end:
        found = next((one for one in list(sent) if is_it(*one)), None)
        if found is not None:
            return found
        time.sleep(0.01)
    raise AssertionError(f"not sent: {[content for content, _ in sent]}")


def told(kind: str) -> Any:
    return lambda content, _: content.get("message", {}).get("tell") == kind


def test_a_frame_that_opens_is_told_all_and_is_asked_before_more_comes(sent: list[Any], touch: Touch) -> None:
    touch._heard(None, {"do": "hello"}, None)
    wait(sent, lambda _, buffers: buffers and buffers[0][0] == 2)  # the surface
    world, _ = wait(sent, told("world"))
    json.dumps(world, allow_nan=False)
    _, (update,) = wait(sent, lambda _, buffers: buffers and buffers[0][0] == 1)
    assert len(update) == LAYOUT.size == 128
    time.sleep(0.3)
    assert sum(1 for _, buffers in sent if buffers and buffers[0][0] == 1) <= 2  # not taken: no other one is sent
    sent.clear()
    touch._heard(None, {}, None)
    wait(sent, lambda _, buffers: buffers and buffers[0][0] == 1)


def test_a_frame_asks_for_changes_and_for_nothing_of_this_machine(sent: list[Any], touch: Touch) -> None:
    touch._heard(None, {"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.1}, None)
    wait(
        sent,
        lambda content, _: (
            content.get("message", {}).get("scene", {}).get("medium", {}).get("relative_humidity") == 0.1
        ),
    )
    for hostile in ({"do": "open", "path": "/etc/passwd"}, [], "x", {"do": "leave"}):
        sent.clear()
        touch._heard(None, hostile, None)
        wait(sent, told("refused"))
