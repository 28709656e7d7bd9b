# SPDX-License-Identifier: BSD-3-Clause
"""Each slider of each sample is moved: no line about the state contradicts a number (tests/python/test_live_lines.py).

Usage: python tests/heavy/lines.py"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
from nanotouch.touch import host
from test_live_lines import moved

for preset in host.presets():
    moved(preset["name"])
    print(f"{preset['name']}: every line is that of its state", flush=True)
