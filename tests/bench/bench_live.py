# SPDX-License-Identifier: BSD-3-Clause
"""The live view in numbers: ``python tests/bench/bench_live.py``.

From ``nanotouch live`` to the first felt force on a virtual screen (Xvfb and xdotool) with a synthetic mouse; and what
a moved tip costs by the size of the surface, drawn off screen. Beside them stands how long a fixed piece of work took
this machine at its best and just now: on a busy one, divide by that.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import time

import nanotouch as nt
import numpy as np
from nanotouch.errors import DeviceError
from nanotouch_app.live import parts
from nanotouch_app.live.host import Host
from nanotouch_app.live.picture import Picture
from nanotouch_app.live.subject import of_preset

SIZES = (64, 256, 1024, 4096)
MOVES = 12
PATIENCE = 120.0  # [s]
FELT = 0.01  # of the largest load: the first force


def work() -> float:
    """Time of a fixed piece of work [s]."""
    begun = time.perf_counter()
    sum(number * number for number in range(300_000))
    return time.perf_counter() - begun


def slowness() -> float:
    """How much longer it takes now, in the mean, than at its best."""
    times = [work() for _ in range(20)]
    return statistics.fmean(times) / min(times)


def first_force() -> tuple[float, float]:
    """From the command to the window, and to the first force on the tip [s]."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1440x900x24"], pass_fds=[write], stderr=subprocess.DEVNULL
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        where = {**os.environ, "DISPLAY": f":{pipe.readline().strip()}"}
    begun = time.perf_counter()
    command = [sys.executable, "-m", "nanotouch_app", "live", "--hand", "none"]
    view = subprocess.Popen(command, env=where, stdout=subprocess.DEVNULL)
    try:
        observer, load = None, 4e-7
        while observer is None and time.perf_counter() < begun + PATIENCE:
            try:
                observer = nt.frames.attach(f"live-{view.pid}-1")
            except DeviceError:
                time.sleep(0.01)
        search = ["xdotool", "search", "--sync", "--name", "nanotouch live"]
        subprocess.run(search, env=where, stdout=subprocess.DEVNULL, timeout=PATIENCE, check=True)
        opened = time.perf_counter() - begun
        subprocess.run(["xdotool", "mousemove", "440", "380"], env=where, check=True)
        while time.perf_counter() < begun + PATIENCE:
            subprocess.run(["xdotool", "click", "5"], env=where, check=True)
            frame = None if observer is None else observer.newest()
            if frame is not None and abs(frame["tip_force"][2]) > FELT * load:
                return opened, time.perf_counter() - begun
        raise TimeoutError("no force was felt")
    finally:
        for process in (view, server):
            process.terminate()
            process.wait()


def updates() -> None:
    """A row for each size: to lay the surface once; then, for a moved tip, its bytes, CPU time and a whole picture."""
    vtk = parts.load()
    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    print("pixels      laid once   tip moved: bytes of surface   triangles   stage CPU   picture CPU")
    for size in SIZES:
        window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(True)
        window.SetSize(1440, 900)
        heights = 5e-9 * np.random.default_rng(1).random((size, size))
        begun = time.process_time()
        picture = Picture(vtk, window, heights, np.full(2, 500e-9 / size))
        picture.hear(host.world())
        host.advance(0.02)
        picture.seen.look(host.observer)
        picture.render()
        laid = time.process_time() - begun
        tiles = picture.stage.tiles
        meshes = [*tiles.coarse.data.values(), *tiles.fine.data.values()]
        before, stage, whole = [mesh.GetMTime() for mesh in meshes], [], []
        for _ in range(MOVES):
            host.answer({"do": "move", "way": (2e-9, 1e-9, 0.0)})
            host.advance(0.02)
            picture.seen.look(host.observer)
            begun = time.process_time()
            picture.stage.update(picture.seen)
            stage.append(time.process_time() - begun)
            begun = time.process_time()
            picture.render()
            whole.append(time.process_time() - begun)
        sent = sum(1024 * mesh.GetActualMemorySize()
                   for mesh, made in zip(meshes, before, strict=True) if mesh.GetMTime() != made)  # fmt: skip
        drawn = sum(2 * actor.GetMapper().GetInput().GetNumberOfPolys()
                    for actor in picture.stage.surface if actor.GetVisibility())  # fmt: skip
        times = (1e3 * statistics.median(stage), 1e3 * statistics.median(whole))
        print(f"{size:4d}²  {1e3 * laid:12.0f} ms   {sent:27d}   {drawn:9d}   {times[0]:6.2f} ms   {times[1]:8.1f} ms")
        window.Finalize()
    host.close()


def main() -> None:
    """Both."""
    print(f"this machine is {slowness():.2f} times slower now than at its best")
    if shutil.which("Xvfb") and shutil.which("xdotool"):
        opened, felt = first_force()
        print(f"from the command to the window {opened:.2f} s, to the first felt force {felt:.2f} s")
    else:
        print("Xvfb and xdotool are not installed: the first force is not measured")
    updates()
    print(f"this machine is {slowness():.2f} times slower now than at its best")


if __name__ == "__main__":
    main()
