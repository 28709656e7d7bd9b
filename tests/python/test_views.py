# SPDX-License-Identifier: BSD-3-Clause
"""The views of a live session decide nothing: no name of a task, a sample or a slider occurs in their source."""

from __future__ import annotations

import re
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch.touch import host

ROOT = Path(__file__).resolve().parents[2]
WINDOW = ("window", "picture", "stage", "board", "cards", "sliders", "entry", "charts", "contact", "readings", "balls",
          "painter", "seen", "desk", "serving", "host", "film", "led", "remote")  # fmt: skip
VIEWS = [ROOT / f"apps/nanotouch_app/live/{name}.py" for name in WINDOW]
VIEWS += [*sorted((ROOT / "apps/page/src").glob("*.js")), ROOT / "apps/page/page.html"]
PLAIN = {"find", "trace", "steady", "rough", "push", "pull_off", "slower"}  # words of the field or requests of the host
NAMES = [row["name"] for row in (*host.presets(), *host.tasks())]
SLIDERS = host.sliders(nt.Scene().core, nt.Rig().core, nt.Settings().core)
TITLES = [row["title"] for row in (*host.presets(), *host.tasks())] + [f'"{slider.title}"' for slider in SLIDERS]


@pytest.mark.parametrize("path", VIEWS, ids=lambda path: path.name)
def test_a_view_knows_no_name(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    found = [name for name in NAMES if name not in PLAIN and re.search(rf"[\"'`]{re.escape(name)}[\"'`]", source)]
    found += [name for name in NAMES if name not in PLAIN and "_" in name and re.search(rf"\b{name}\b", source)]
    found += [title for title in TITLES if title in source]
    assert not found
