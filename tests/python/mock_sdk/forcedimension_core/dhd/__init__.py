# SPDX-License-Identifier: BSD-3-Clause
"""Functions return -1 where they fail, as documented; the reason is errorGetLastStr."""

import math

from desk import Desk

from . import expert as expert

_desk = Desk()
_error = "no error"


def _fails(why: str) -> int:
    global _error
    _error = why
    return -1


def _there(ID: int) -> bool:
    return _desk.present == 1.0 and _desk.opened == 1.0 and ID in (-1, 0)


def errorGetLastStr() -> str:
    return _error


def open() -> int:
    return openID(0)


def openID(index: int) -> int:
    if _desk.present != 1.0 or index != 0:
        return _fails("no device found")
    _desk.opened = 1.0
    return 0


def close(ID: int = -1) -> int:
    if not _there(ID):
        return _fails("no device found")
    _desk.opened = 0.0
    return 0


def stop(ID: int = -1) -> int:
    if not _there(ID):
        return _fails("no device found")
    _desk.force(0.0, 0.0, 0.0)
    return 0


def enableForce(enable: bool, ID: int = -1) -> int:
    return 0 if _there(ID) else _fails("no device found")


def getPosition(out, ID: int = -1) -> int:
    if not _there(ID):
        return _fails("communication error")
    if _desk.stall != 1.0:
        _desk.move()
    out[0], out[1], out[2] = (math.nan, 1e300, 7.0) if _desk.garbage == 1.0 else (_desk.x, _desk.y, _desk.z)
    return 0


def getButtonMask(ID: int = -1) -> int:
    return int(_desk.buttons)


def setForce(f, ID: int = -1) -> int:
    if not _there(ID):
        return _fails("communication error")
    _desk.force(float(f[0]), float(f[1]), float(f[2]))
    return 0
