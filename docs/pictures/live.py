# SPDX-License-Identifier: BSD-3-Clause
"""The film of the README and the picture of live.md: ``python docs/pictures/live.py``, some minutes. With a folder:
a picture of each preset, pressed, to be looked at; far quicker. A neck of water
forms, holds and tears; dry air; an image and a force curve of one's own are touched."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nanotouch as nt
from nanotouch import curves, images
from nanotouch_app.live import files, film
from nanotouch_app.live.subject import PRESETS, of_preset

DOWN, UP = {"do": "wheel", "steps": 1.0}, {"do": "wheel", "steps": -1.0}
DRY = {"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.0}


def wheel(way: dict[str, Any], steps: int) -> list[film.Act]:
    """So many steps of the wheel."""
    return [(0.12, way)] * steps


WATER: list[film.Act] = [
    (1.5, {"say": "Scroll down: the tip comes closer."}), *wheel(DOWN, 9),
    (2.5, {"say": "Snap: a neck of water has formed."}),
    (0.2, {"say": "Press: the contact grows. The band from tip to ring is what would be felt."}), *wheel(DOWN, 18),
    (1.5, {"say": "Pull up: the water holds ..."}), *wheel(UP, 40),
    (2.0, {"say": "... and has torn. Now set the humidity to 0."}), (3.0, DRY),
    (0.2, {"say": "The same in dry air: the law has moved, and the pull-off is smaller."}), *wheel(DOWN, 30),
    *wheel(UP, 30), (1.0, {}),
]  # fmt: skip
IMAGE: list[film.Act] = [
    (1.5, {"say": "Your own image: its relief is touched."}), *wheel(DOWN, 14), (1.0, {}),
    *[(0.12, {"do": "move", "way": (2e-9, 1e-9, 0.0)})] * 30, *wheel(UP, 8), (0.5, {}),
]  # fmt: skip
CURVE: list[film.Act] = [
    (2.5, {"say": "Your own force curve: its fit is the scene. Touch what you have measured."}),
    (3.5, {"do": "press", "on": True}), (2.5, {"do": "press", "on": False}),
]  # fmt: skip


def look(folder: Path) -> None:
    """A picture of each preset, pressed, in light and in dark."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in PRESETS:
        for dark in (False, True):
            target = folder / f"{name}-{'dark' if dark else 'light'}.png"
            press = [(0.5, {}), (1.5, {"do": "press", "on": True})]
            film.write([(of_preset(name), press)], target, lambda share: None, dark=dark)


def main() -> None:
    """Write live.gif and live.png beside this file."""
    contact = nt.Contact(radius=2e-6, effective_modulus=20e6, work_of_adhesion=0.03, cohesive_stress=5e6)
    curve = curves.synthesize(contact, spring_constant=1.0, noise=0.2e-9, depth=600e-9, clearance=1.5e-6)
    with TemporaryDirectory() as folder:
        image = Path(folder) / "your image.gwy"
        images.write(image, nt.surface.dots(size=400e-9, pixels=256, count=16, seed=4))
        parts = [(of_preset("silicon_in_air"), WATER), (files.of_image(image), IMAGE),
                 (files.of_fit(curve, "your curve", 2e-6), CURVE)]  # fmt: skip
        film.write(parts, Path(__file__).with_name("live.gif"), lambda share: print(f"{100 * share:.0f} %", end="\r"))
    film.write([(of_preset("silicone_rubber"), [(1.5, {}), (2.0, {"do": "press", "on": True})])],
               Path(__file__).with_name("live.png"), lambda share: None)  # fmt: skip


if __name__ == "__main__":
    if len(sys.argv) > 1:
        look(Path(sys.argv[1]))
    else:
        main()
