# SPDX-License-Identifier: BSD-3-Clause
"""A mocked device of each kind on the desk, for the tests of its bridge."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

HERE = Path(__file__).parent
SDK = HERE / "mock_sdk"
sys.path.append(str(SDK))

from desk import Desk  # noqa: E402

PATIENCE = 30.0  # with a machine that is busy [s]


class Kind(NamedTuple):
    """How the mock of a device lies in its own axes."""

    name: str
    down: tuple[str, float]
    """the axis that goes towards the sample, with its sign"""
    right: tuple[str, float]
    away: tuple[str, float]
    home: tuple[float, float, float] = (0.0, 0.0, 0.0)


KINDS = (
    Kind("inverse3", ("z", -1.0), ("x", 1.0), ("y", 1.0), (0.0, -0.15, 0.2)),
    Kind("forcedimension", ("z", -1.0), ("y", 1.0), ("x", -1.0)),
    Kind("geomagic", ("y", -1.0), ("x", 1.0), ("z", -1.0)),
    Kind("wheel", ("x", 1.0), ("x", 1.0), ("x", 1.0)),
)


class OnDesk(NamedTuple):
    """A device that lies there, plugged in."""

    kind: Kind
    desk: Desk
    option: str

    def hold(self, axis: str, distance: float) -> None:
        """The hand goes to this distance from the middle: "down", "right" or "away" [m]."""
        name, sign = getattr(self.kind, axis)
        setattr(self.desk, f"t{name}", self.kind.home["xyz".index(name)] + sign * distance)

    def pressed(self, axis: str = "down") -> float:
        """What its motor does along an axis now [N]."""
        name, sign = getattr(self.kind, axis)
        return sign * self.desk.motor()["xyz".index(name)]

    @property
    def size(self) -> float:
        """Of its motor's force now [N]."""
        return math.hypot(*self.desk.motor())


@contextmanager
def placed(kind: Kind, folder: Path, patch: pytest.MonkeyPatch, **values: float) -> Iterator[OnDesk]:
    """The device, and what its maker runs."""
    x, y, z = kind.home
    desk = Desk.new(folder / "desk", **({"x": x, "y": y, "z": z, "tx": x, "ty": y, "tz": z} | values))
    patch.setenv("NANOTOUCH_DESK", str(folder / "desk"))
    patch.syspath_prepend(str(SDK))
    if kind.name != "inverse3":
        yield OnDesk(kind, desk, "")
        return
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    service = subprocess.Popen([sys.executable, str(HERE / "mock_inverse3.py")], env=environment,
                               stdout=subprocess.PIPE, text=True)  # fmt: skip
    try:
        assert service.stdout is not None
        yield OnDesk(kind, desk, f"ws://127.0.0.1:{int(service.stdout.readline())}")
    finally:
        service.kill()
        service.communicate()


def awaited(condition: Callable[[], object], what: str) -> None:
    """Until it holds."""
    due = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < due, f"not within {PATIENCE:g} s: {what}"
        time.sleep(5e-3)
