# SPDX-License-Identifier: BSD-3-Clause
"""Films and pictures of the live view without a display: a script takes the place of the person, and the session runs
as far as each picture needs, so that the same command makes the same film on any machine."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch.errors import Error, require
from nanotouch.touch.record import replacing

from nanotouch_app.live import parts as vtk_parts
from nanotouch_app.live.arrays import pixels
from nanotouch_app.live.host import Host
from nanotouch_app.live.look import DARK, HEIGHT, LIGHT, WIDTH
from nanotouch_app.live.picture import Picture
from nanotouch_app.live.subject import Subject

RATE = 8.0  # pictures per second
# H.264 with the colours of HD, as players expect of this size; its index stands first, so that a page can play it
MP4 = ("-vf", "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int", "-pix_fmt", "yuv420p",
       "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
       "-movflags", "+faststart")  # fmt: skip
GIF_WIDTH, GIF_COLOURS = 960, 96
Act = tuple[float, dict[str, Any]]
"""a duration [s], and what is asked at its beginning"""
Part = tuple[Subject, list[Act]]

PRESS: list[Act] = [(0.8, {}), (2.2, {"do": "press", "on": True}), (1.5, {}), (3.0, {"do": "press", "on": False})]


class Studio:
    """A host without a clock, and a picture without a display."""

    def __init__(self, subject: Subject, dark: bool = False) -> None:
        vtk = vtk_parts.load()
        self.vtk, self.window = vtk, vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetSize(WIDTH, HEIGHT)
        self.picture = Picture(vtk, self.window, subject.topography.heights, subject.topography.pixel_size)
        if dark:
            self.picture.turn_light()
        self.host = Host(subject, self.picture.hear, stepped=True)
        self.host.report()
        self.picture.stage.give(self.host.properties())
        self.look()

    def look(self) -> None:
        """Take in what the session has done; another session may have taken its place."""
        self.picture.hear(self.host.clock())
        self.picture.seen.look(self.host.observer)

    def play(self, script: list[Act]) -> Iterator[Any]:
        """Pictures of a script, as bytes (height, width, 3), RATE of them for each second of it."""
        owed = 0.0
        for duration, request in script:
            if "say" in request:
                self.picture.seen.notes.append((time.monotonic() + 1e6, request["say"], False))
            if "do" in request:
                self.host.answer(request)
            owed += duration
            while owed > 1.0 / RATE:
                owed -= 1.0 / RATE
                self.host.advance(1.0 / RATE)
                self.look()
                self.picture.render()
                yield pixels(self.vtk, self.window)

    def close(self) -> None:
        """End the session."""
        self.host.close()


def write(parts: Sequence[Part], path: Path, progress: Callable[[float], None], dark: bool = False) -> None:
    """Film scripts one after another as GIF, MP4, or, of their end, PNG."""
    save = {".gif": _gif, ".mp4": _mp4, ".png": _png}.get(path.suffix.lower())
    if save is None:
        raise Error(f"{path}: a film ends in .gif or .mp4, a picture in .png")
    total = RATE * sum(duration for _, script in parts for duration, _ in script)
    save(_filmed(parts, dark, lambda number: progress(min(number / total, 1.0))), path)


def _filmed(parts: Sequence[Part], dark: bool, told: Callable[[int], None]) -> Iterator[Any]:
    number = 0
    for subject, script in parts:
        studio = Studio(subject, dark)
        try:
            for picture in studio.play(script):
                number += 1
                told(number)
                yield picture
        finally:
            studio.close()


def _gif(pictures: Iterator[Any], path: Path) -> None:
    image = require("PIL.Image", "app")
    height = round(GIF_WIDTH * HEIGHT / WIDTH)
    small = [image.fromarray(np.ascontiguousarray(one)).resize((GIF_WIDTH, height), image.LANCZOS) for one in pictures]
    table = _table(image, small)
    flat = [one.quantize(palette=table, dither=image.Dither.NONE) for one in small]
    flat[0].save(path, save_all=True, append_images=flat[1:], duration=round(1000 / RATE), loop=0, optimize=True)


def _table(image: Any, pictures: list[Any]) -> Any:
    """The colours of a few pictures, and each of the palette's own, however small its part is."""
    own = [colour for palette in (LIGHT, DARK) for colour in vars(palette).values() if isinstance(colour[0], int)]
    few = [np.asarray(pictures[len(pictures) * part // 5]) for part in range(5)]
    strip = np.repeat(np.array(own, dtype=np.uint8)[:, None, :], 1, axis=1)
    sample = image.fromarray(np.concatenate([one[::4, ::4].reshape(-1, 1, 3) for one in few]))
    found = sample.quantize(GIF_COLOURS - len(own), method=image.Quantize.MEDIANCUT).getpalette()
    table = image.new("P", (1, 1))
    table.putpalette([*strip.ravel().tolist(), *found[: 3 * (GIF_COLOURS - len(own))]])
    return table


def _mp4(pictures: Iterator[Any], path: Path) -> None:
    if shutil.which("ffmpeg") is None:
        raise Error(f"{path}: ffmpeg is not installed: apt-get install ffmpeg; a .gif needs none")
    with replacing(path) as part:
        command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
                   "-s", f"{WIDTH}x{HEIGHT}", "-r", f"{RATE:g}", "-i", "-", *MP4, "-f", "mp4", str(part)]  # fmt: skip
        with tempfile.TemporaryFile() as said:
            # a Ctrl-C of the terminal is ours alone: we end it
            film = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said, start_new_session=True)
            try:
                _feed(film, pictures)
            except BaseException:
                film.kill()
                raise
            finally:
                film.wait()
            said.seek(0)
            if film.returncode:
                words = said.read().decode(errors="replace").strip().splitlines()
                raise Error(f"{path}: ffmpeg ended with status {film.returncode}: {words[-1] if words else 'no word'}")


def _feed(film: subprocess.Popen[bytes], pictures: Iterator[Any]) -> None:
    """All pictures, unless it ends before; then it says why."""
    assert film.stdin is not None
    try:
        for picture in pictures:
            film.stdin.write(np.ascontiguousarray(picture).tobytes())
    except BrokenPipeError:
        pass
    finally:
        with suppress(BrokenPipeError):
            film.stdin.close()


def _png(pictures: Iterator[Any], path: Path) -> None:
    image = require("PIL.Image", "app")
    last = None
    for last in pictures:  # noqa: B007 the last one is what is wanted
        pass
    if last is not None:
        image.fromarray(np.ascontiguousarray(last)).save(path)
