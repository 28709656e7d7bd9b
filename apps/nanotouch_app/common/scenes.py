# SPDX-License-Identifier: BSD-3-Clause
"""What a command is told about the scene: a TOML file, or the name of a preset."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import nanotouch as nt
from nanotouch import presets, rig_file
from nanotouch.errors import InvalidValue
from nanotouch.scene import read_tables
from nanotouch.touch import host

LIBRARY = tuple(presets.FELT)  # of the library; the others are made here
PAPER = (
    "paper_silicon", "paper_gold", "paper_mica", "paper_polyester", "paper_silicone_rubber", "paper_inas",
)  # fmt: skip
"""the scenes of the paper as they stand there, up to the largest load of its rig"""
HELP = "TOML file with {what}, or a preset, as silicon_in_air (nanotouch plan --help lists them)"


def soft_gold() -> tuple[nt.Scene, nt.Rig]:
    """A diamond tip on annealed gold, which yields and keeps dents; contact alone."""
    scene = nt.Scene(
        tip={"material": "diamond", "radius": 30e-9},
        sample={"material": "gold", "yield_strength": 0.35e9, "dents": "yes"},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0, "contact_potential": 0.0},
        range={"maximum_load": 300e-9},
    )
    return scene, nt.Rig(probe={"spring_constant": 40.0, "resonance": 300e3})


def latex_on_glass(tip_radius: float = 50e-9) -> tuple[nt.Scene, nt.Rig]:
    """A coated tip on dry glass, for what a task lays there."""
    scene = nt.Scene(
        tip={"radius": tip_radius, "half_angle": 0.26},
        sample={"youngs_modulus": 70e9, "poisson_ratio": 0.22},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.01, "hamaker_constant": 3e-20},
        range={"maximum_load": 100e-9},
    )
    return scene, nt.Rig(probe={"spring_constant": 10.0})


MADE: dict[str, Callable[[], tuple[nt.Scene, nt.Rig]]] = {
    "soft_gold": soft_gold,
    "latex_on_glass": latex_on_glass,
    "wire_on_glass": lambda: latex_on_glass(20e-9),
}
ROWS: dict[str, dict[str, Any]] = {row["name"]: row for row in host.presets()}
"""the one list of presets, that of the C library: for plan, touch, scan, live, page and docs"""
PRESETS = tuple(ROWS)


def of_preset(name: str) -> tuple[nt.Scene, nt.Rig]:
    """Its scene and rig."""
    scene = ROWS[name]["scene"] if name in ROWS else name
    made: tuple[nt.Scene, nt.Rig] = (MADE.get(scene) or getattr(presets, scene))()
    return made


def felt(name: str) -> str:
    """What the hand feels of a preset."""
    row = ROWS[name]
    return str(row["felt"] or presets.FELT[row["scene"]])


class Described(NamedTuple):
    """What the name stands for."""

    scene: nt.Scene
    rig: nt.Rig
    tables: dict[str, Any]
    """of the file; empty for a preset"""


def read(name: str | None) -> Described:
    """A preset by its name, or a file; None is the default, silicon in humid air."""
    if name in PRESETS + PAPER:
        scene, rig = of_preset(str(name))
        return Described(scene, rig, {})
    tables = {} if name is None else read_tables(_checked(name))
    if name is not None:  # what it says of scene, rig and loop
        tables = rig_file.described(tables, Path(name).parent).rig
    return Described(nt.Scene.from_tables(tables), nt.Rig.from_tables(tables), tables)


def add_allow_code(group: Any) -> None:
    """The option of the commands that move what a rig file names."""
    group.add_argument(
        "--allow-code", action="store_true", help="let the rig file load the shared object that it names, this once "
        "(nanotouch rig allow: for good)",
    )  # fmt: skip


def is_real(name: str | None, half: str = "slave") -> bool:
    """Whether this scene is a rig file that names this half, which is not simulated."""
    if name is None or name in PRESETS + PAPER:
        return False
    return getattr(rig_file.described(read_tables(_checked(name)), Path(name).parent), half) is not None


def real_halves(name: str | None, allow_code: bool) -> dict[str, Any]:
    """The halves of a rig file that are not simulated, for a session; of any other scene none."""
    if name is None or name in PRESETS + PAPER or not rig_file.is_real(read_tables(_checked(name))):
        return {}
    file = rig_file.read(name, allow_code=allow_code)
    return {half: real for half, real in (("master", file.master), ("slave", file.slave)) if real is not None}


def _checked(name: str) -> str:
    """The file, if it can be one."""
    if not name.endswith(".toml") and not os.path.exists(name):
        close = difflib.get_close_matches(name, PRESETS + PAPER, n=1)
        hint = f"; did you mean {close[0]}" if close else ""
        raise InvalidValue(f"{name!r} is neither a TOML file nor a preset{hint}; presets are {', '.join(PRESETS)}")
    return name
