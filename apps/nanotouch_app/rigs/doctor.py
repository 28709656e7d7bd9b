# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch doctor``: what is installed, what works here, and what to install for the rest."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import os
import platform
import shutil
import sys
import warnings
from importlib import metadata
from typing import Any

import nanotouch
from nanotouch import hal
from nanotouch.errors import Error
from nanotouch.extras import ADDS, EXTRAS, advice

from nanotouch_app import view
from nanotouch_app.common import output
from nanotouch_app.live import display, hands

OK, MISSING = "ok", "--"
Row = tuple[str, str, str]
"""name, OK or MISSING, and what is there or what to install"""


def add_parser(subparsers: Any) -> None:
    """Add ``doctor`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "doctor",
        description="Say what is installed and works here, and what to install for the rest.",
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Print the findings; status 0 whatever they are."""
    with output.busy("looking"):
        found = sections()
    args.answer = {
        "version": nanotouch.__version__, "python": platform.python_version(), "prefix": sys.prefix,
        "findings": {
            title: {name: {"ok": mark == OK, "says": says} for name, mark, says in rows}
            for title, rows in found.items()
        },
    }  # fmt: skip
    print("\n".join(findings(found)))
    return 0


def findings(found: dict[str, list[Row]] | None = None) -> list[str]:
    """One line per finding; what is missing says what to install."""
    found = sections() if found is None else found
    lines = [
        f"nanotouch {nanotouch.__version__}, Python {platform.python_version()}, numpy {metadata.version('numpy')}, "
        f"{platform.system()} {platform.machine()}",
        f"  {sys.prefix}",
    ]
    for title, rows in found.items():
        lines += ["", title]
        lines += [f"  {mark:3}{f'{name} ':11}{text}" for name, mark, text in rows]
    return lines


def sections() -> dict[str, list[Row]]:
    """All findings."""
    return {
        "extras": [_extra(name, packages) for name, packages in EXTRAS.items()],
        "compiled parts": [("core", OK, f"nanotouch._core {nanotouch.__version__}"), _fit()],
        "backends": [_simulated(), _gpio()],
        "view": [_display(), _vtk()],
        "nanotouch live": [_live(), _film(), _pace(), *_hands()],
    }


def _extra(name: str, packages: dict[str, str]) -> tuple[str, str, str]:
    missing = [package for package, module in packages.items() if not _found(module)]
    if missing:
        return name, MISSING, f"{', '.join(missing)} missing, for {ADDS[name]}: {advice(name, missing)}"
    broken = [said for said in map(_broken, packages.values()) if said]
    if broken:
        return name, MISSING, f"does not load: {'; '.join(broken)}"
    return name, OK, f"{ADDS[name]}: " + ", ".join(f"{package} {_version(package)}" for package in packages)


def _broken(module: str) -> str:
    """Why the module does not load; empty if it does."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what a module says of itself
            importlib.import_module(module)
    except Exception as error:  # whatever a damaged installation raises
        return f"{module} ({type(error).__name__}: {error})"
    return ""


def _found(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except (ImportError, ValueError):  # ValueError: blocked by None in sys.modules
        return False


def _version(package: str) -> str:
    """The installed version; the same module may come from a distribution of another name."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "(installed under another name)"


def _fit() -> tuple[str, str, str]:
    try:
        importlib.import_module("nanotouch._fit")
    except ImportError as error:
        if _found("nanotouch._fit"):
            return "fit", MISSING, f"does not load: {error}"
        return "fit", MISSING, "built without Ceres: apt-get install libceres-dev, then install nanotouch again"
    return "fit", OK, "nanotouch._fit, on Ceres"


def _simulated() -> Row:
    """A hundredth of a second of a touch, tried out."""
    try:
        ran = nanotouch.Session().advance(0.01)
    except Error as error:
        return "simulated", MISSING, str(error)
    return "simulated", OK, f"the simulated rig ran {len(ran['time'])} ticks"


def _gpio() -> tuple[str, str, str]:
    try:
        found = hal.gpio_lines()
    except Error as error:
        return "gpio", MISSING, str(error)
    if not found:
        return "gpio", MISSING, "no chip that may be opened (/dev/gpiochip*): nothing is connected, or no permission"
    named = [f"{line.name} ({line.chip}:{line.offset})" for line in found if line.name]
    chips = len({line.chip for line in found})
    return "gpio", OK, f"{chips} chips, {len(found)} lines; named: {', '.join(named) or 'none'}"


def _display() -> tuple[str, str, str]:
    if not view.has_display():
        return "display", MISSING, "no DISPLAY or WAYLAND_DISPLAY: the view is rendered to a picture, no window opens"
    shown = [f"{name}={os.environ[name]}" for name in ("DISPLAY", "WAYLAND_DISPLAY") if os.environ.get(name)]
    return "display", OK, ", ".join(shown) or platform.system()


def _live() -> tuple[str, str, str]:
    """Whether a window can be opened for a hand, tried out."""
    if not _found("vtkmodules"):
        return "window", MISSING, f"vtk is missing: {advice('view')}"
    try:
        display.check()
    except Error as error:
        return "window", MISSING, str(error)
    return "window", OK, "a window can be opened: nanotouch live"


def _film() -> tuple[str, str, str]:
    """Without a display."""
    missing = [extra for extra, module in (("view", "vtkmodules"), ("app", "PIL")) if not _found(module)]
    if missing:
        return "film", MISSING, " and ".join(advice(extra) for extra in missing)
    if shutil.which("ffmpeg") is None:
        return "film", OK, "--film FILE: .gif and .png; .mp4 needs ffmpeg: apt-get install ffmpeg"
    return "film", OK, "--film FILE: .gif, .mp4 and .png"


def _pace() -> tuple[str, str, str]:
    """A session at the pace of a clock needs threads and shared memory."""
    if sys.platform != "linux":
        return "wall pace", MISSING, "threads and frames in shared memory need Linux"
    return "wall pace", OK, "a simulated slave; a real one runs at hard pace in a program of your own (docs/live.md)"


def _hands() -> list[tuple[str, str, str]]:
    """Gamepad and SpaceMouse, tried out."""
    rows = []
    for name, kind in hands.KINDS.items():
        try:
            kind.first().close()
            rows.append((name, OK, f"connected: nanotouch live --hand {name}"))
        except Error as error:
            rows.append((name, MISSING, str(error)))
    return rows


def _vtk() -> tuple[str, str, str]:
    works, reason = view.probe()
    return "VTK", OK if works else MISSING, reason
