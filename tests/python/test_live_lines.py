# SPDX-License-Identifier: BSD-3-Clause
"""What is said of the state is computed from the state: whatever slider is moved, no line contradicts a number."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import of_preset
from touching import Operator, newest

PREFIXES = {"a": 1e-18, "f": 1e-15, "p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}


def number(words: str, pattern: str) -> float:
    """A quantity of a line in SI."""
    found = re.search(pattern.replace("#", r"([\d.]+) ([afpnµmkMG]?)"), words)
    assert found is not None, words
    return float(found[1]) * PREFIXES[found[2]]


def check(host: Host, world: dict[str, Any]) -> None:
    """Every number of the lines beside a plan that is made anew."""
    scene, gains = host.session.scene, host.session.settings.gains
    plan = scene.plan(relative_accuracy=world["relative_accuracy"])
    pull, words = plan.pull_off_force, world["felt"]
    if pull > 1e-3 * scene.range.maximum_load:
        assert number(words, "holds with #N,") == pytest.approx(pull, rel=6e-3)
        assert number(words, "N, #N at your hand") == pytest.approx(pull * gains.alpha_f, rel=6e-3)
        water = plan.explain()["adhesion_source"] == "meniscus"
        assert ("water" in words) == water
    else:
        assert "nothing holds" in words
    assert number(words, "#m deep") == pytest.approx(float(plan.explain()["largest_indentation"]), rel=6e-3)
    assert number(words, "#N/m stiff") == pytest.approx(plan.maximum_stiffness, rel=6e-3)
    assert world["pull_off"] == pytest.approx(pull, rel=1e-9)
    for field, shown in world["shown"].items():
        section, key = field.split(".")
        value = next(world[what][section][key] for what in ("scene", "rig", "settings") if section in world[what])
        told = float(re.search(r"[\d.]+", shown)[0])  # type: ignore[index]
        scale = 10.0 ** round(np.log10(value / told)) if told and value else 1.0
        assert told * scale == pytest.approx(value, rel=6e-3), (field, shown)


def guided(told: list[dict[str, Any]], host: Host) -> None:
    """What to do next, while nothing touches, beside the plan."""
    scene, words = host.session.scene, newest(told, "guide")["text"]
    plan = scene.plan(relative_accuracy=host.about["relative_accuracy"])
    holds = plan.pull_off_force > 1e-3 * scene.range.maximum_load
    assert ("the water snaps" in words) == (holds and plan.explain()["adhesion_source"] == "meniscus"), words
    assert holds or "snaps" not in words, words


def test_a_hint_names_what_the_hand_is_moved_with_and_follows_what_happens() -> None:
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    for device, words in (("finger", "bar at the left"), ("keys", "Page Down"), ("pad", "right stick"),
                          ("wheel", "Scroll down")):  # fmt: skip
        host.answer({"do": "device", "name": device})
        assert newest(told, "guide")["text"].endswith("until the water snaps.")
        assert words in newest(told, "guide")["text"]
    host.answer({"do": "device", "name": "spoon"})
    assert "valid are wheel, finger, keys, pad" in newest(told, "refused")["why"]
    host.answer({"do": "press", "on": True})
    host.advance(1.0)
    assert newest(told, "guide")["text"] == "Scroll up until it tears."
    host.answer({"do": "press", "on": False})
    host.advance(1.5)
    assert newest(told, "guide")["text"] == host.about["hint"]
    host.answer({"do": "task", "name": "find"})
    host.advance(0.1)
    assert newest(told, "guide")["text"] == ""  # the task has words of its own
    host.close()


@pytest.mark.parametrize("name", ["silicon_in_air", "mica_in_air", "silicone_rubber", "latex_on_glass"])
def test_no_line_contradicts_a_number(name: str) -> None:
    """All samples: tests/heavy/lines.py."""
    moved(name)


def moved(name: str) -> None:
    """Each slider of a preset, to one side."""
    told: list[dict[str, Any]] = []
    flat = nt.Topography(heights=np.zeros((16, 16)), pixel_size=2 * (of_preset(name).topography.size[0] / 16,))
    host = Host(replace(of_preset(name), topography=flat), told.append, stepped=True)  # a relief changes no line
    host.advance(0.01)
    host.report()
    rows = newest(told, "sliders")["sliders"]
    check(host, newest(told, "world"))
    guided(told, host)
    for place, row in enumerate(rows):
        value, words = row["stops"][(40, 150)[place % 2]]
        told.clear()
        host.answer({"do": "change", "what": row["what"], "field": row["field"], "value": value})
        if any(message["tell"] == "refused" for message in told):
            assert words in newest(told, "refused")["why"]
            continue
        world = newest(told, "world")
        assert world["shown"][row["field"]] == words
        check(host, world)
        guided(told, host)
        host.answer({"do": "undo"})
    host.close()


def test_dry_air_holds_with_less_and_says_so() -> None:
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    host.answer({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.0})
    host.close()
    words = newest(told, "world")["felt"]
    assert words.startswith("the sample holds with 12.1 nN")
    assert "18" not in words.split(";")[0]


def test_a_snap_and_a_tear_are_one_number() -> None:
    """At the tip and at the hand: that of the tear is the pull that the frames have shown."""
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    hand = Operator(host, float(host.session.scene.range.maximum_load))
    host.observer.read()
    hand.down_to(0.05 * hand.load)
    (snap,) = (message for message in told if message["tell"] == "event")
    host.observer.read()
    hand.up()
    frames = host.observer.read()
    tear = newest(told, "event")
    clock = host.clock()
    host.close()
    scale = float(host.session.settings.gains.alpha_f)
    assert (snap["kind"], tear["kind"]) == ("snap", "tear")
    assert tear["force"] == pytest.approx(host.session.scene.plan().pull_off_force, rel=0.1)
    assert tear["force"] >= -frames["tip_force"][:, 2].min() - 1e-12
    assert tear["hand"] == pytest.approx(scale * tear["force"], rel=1e-9)
    assert re.fullmatch(r"1[78] nN, 0\.3\d N at your hand", tear["text"])
    assert clock["facts"].startswith("gap ")
    assert "never above" in clock["facts"]
