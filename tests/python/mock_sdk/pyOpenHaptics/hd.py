# SPDX-License-Identifier: BSD-3-Clause
"""Places in millimetres, forces in N. A device that does not open gives None, and a line on standard output."""

import os
import threading
import time

from desk import Desk

if os.environ.get("NANOTOUCH_MOCK") == "no SDK":  # as CDLL does
    raise OSError("libHD.so: cannot open shared object file: No such file or directory")

_desk = Desk()
_runs = threading.Event()
_threads: list[threading.Thread] = []
DONE, CONTINUE = 0, 1


def init_device(name="Default Device"):
    name.encode()
    if _desk.present != 1.0:
        print("Unable to initialize the device. Check the connection!")
        return None
    _desk.opened = 1.0
    return 0


def get_transform():
    rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    _desk.move()
    place = [float("nan")] * 3 if _desk.garbage == 1.0 else [1e3 * _desk.x, 1e3 * _desk.y, 1e3 * _desk.z]
    return [*rows, [*place, 1.0]]


def get_buttons():
    return int(_desk.buttons)


def set_force(feedback):
    _desk.force(*map(float, feedback))


def get_error():
    return _desk.present != 1.0


def enable_force():
    print("Force feedback enabled!")


def start_scheduler():
    _runs.set()


def stop_scheduler():
    _runs.clear()
    for thread in _threads:
        thread.join(1.0)
    _threads.clear()
    _desk.force(0.0, 0.0, 0.0)


def close_device(id):
    _desk.opened = 0.0


def schedule(callback):
    """The scheduler's thread."""

    def run():
        while _runs.is_set():
            if _desk.stall != 1.0 and callback(None) == DONE:
                return
            time.sleep(1e-3)

    _threads.append(threading.Thread(target=run, daemon=True))
    _threads[-1].start()
