# SPDX-License-Identifier: BSD-3-Clause
"""The other side of :mod:`nanotouch._io.worker`: forks a child for each file, which confines itself and reads."""

from __future__ import annotations

import gc
import importlib
import json
import mimetypes
import os
import signal
import socket
import struct
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from . import guard
from ._io import confine, transfer
from ._io.readers import _registered
from .errors import Error

_FOR_IMAGES = ("cv2", "h5py", "scipy.io", "tifffile", "igor2.binarywave", "SurfaceTopography.IO")
_OWN = (".gsf", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".mcap", ".part", ".nc", ".topostats")
_NEEDED: dict[str, tuple[str, ...]] = dict.fromkeys(
    (".spm", ".di", ".000", ".001", ".002", ".003", ".sxm", ".stp", ".top", ".tiff"), ()
)
_NEEDED[".ibw"] = ("igor2.binarywave",)
"""what our own readers of formats need whose names others use too; what else is wanted is imported by the child"""
_SPAN = 1 << 16  # of a request [byte]
_BESIDE = 64  # files of the same stem


_JOBS = {
    "images.read": "nanotouch.images:read",
    "images.plane": "nanotouch.images.values:plane_of",
    "images.channels": "nanotouch.images:channels",
    "images.planes": "nanotouch.images:planes",
    "images.picture": "nanotouch.images.masking:picture_of",
    "curves.read": "nanotouch.curves:read",
    "curves.thermal": "nanotouch.curves:thermal_spectrum",
    "curves.stream": "nanotouch.curves.reading:Stream",
    "record.read": "nanotouch.touch._recording_file:parts_of",
    "maps.read": "nanotouch.maps.dataset:parts_of",
}
"""what reads, by the words of a request; imported when it is first asked for"""


def _reader(job: str) -> Callable[..., Any]:
    module, _, name = _JOBS[job].partition(":")
    found: Callable[..., Any] = getattr(importlib.import_module(module), name)
    return found


def main() -> None:
    """Serve the socket whose number is the argument, until it closes."""
    serve(socket.socket(fileno=int(sys.argv[1])))


def serve(control: socket.socket) -> None:
    """Answer requests; the process has no other purpose."""
    guard.forget()
    warnings.simplefilter("ignore")  # nobody would see them
    gc.disable()  # nothing that was inherited is closed behind our back
    os.environ["HDF5_PLUGIN_PRELOAD"] = "::"  # no filters from elsewhere
    mimetypes.init([])  # which by itself reads what a confined child may not read; readers of others import it
    confine.prepare()
    control.sendall(b"ready\n")
    while True:
        message, files, _, _ = socket.recv_fds(control, _SPAN, 1)
        if not message:
            return
        while not message.endswith(b"\n"):
            message += control.recv(_SPAN)
        request = json.loads(message)
        _prepare(request["job"], Path(request["file"]))
        child = os.fork()
        if child == 0:
            control.close()
            os._exit(_child(request, files[0]))
        os.close(files[0])
        control.sendall(f"{os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])}\n".encode())


def _prepare(job: str, file: Path) -> None:
    """Import once what every child of this kind would import again, going by the name of the file alone."""
    ending = file.suffix.lower()
    with suppress(Exception):  # what cannot be loaded is named when it is wanted
        _reader(job)
        _registered()
    wanted: tuple[str, ...] = ()
    if job == "record.read":
        wanted = ("mcap.stream_reader", "zstandard")
    elif job == "maps.read":
        wanted = ("xarray", "h5netcdf")
    elif ending in _NEEDED:
        wanted = () if job.startswith("images.") else _NEEDED[ending]
    elif ending not in _OWN:
        wanted = _FOR_IMAGES if job.startswith("images.") else ("h5py", "afmformats")
    for name in wanted:
        with suppress(Exception):  # an extra that is not installed or is broken; asking for it will say so
            importlib.import_module(name)


def _child(request: dict[str, Any], channel: int) -> int:
    file, folder = Path(request["file"]), request.get("folder")
    tempfile.tempdir = folder
    scratch = None if folder is None else (Path(folder), int(request["written"]))
    is_asked = request.get("series") or request["job"] == "curves.stream"
    with os.fdopen(channel, "r+b" if is_asked else "wb", buffering=0) as stream:
        files = _files_of(stream) if request.get("series") else [file]
        confine.confine(request["limits"], _readable(files), scratch)
        found = _in_turn(stream) if request.get("series") else _answers(request, file, stream)
        for answer in found:
            for piece in answer:
                _write(stream, piece)
    return 0


def _line(stream: Any) -> bytes:
    """Up to the end of a line; empty where the other side has closed."""
    line = bytearray()
    while not line.endswith(b"\n") and (byte := stream.read(1)):
        line += byte
    return bytes(line)


def _in_turn(stream: Any) -> Iterator[list[bytes | memoryview]]:
    """The answers of a batch; each file has the time of a single one."""
    gc.freeze()
    while line := _line(stream):
        request = json.loads(line)
        seconds = request["limits"]["time"]
        signal.setitimer(signal.ITIMER_REAL, 3.0 * seconds)
        signal.setitimer(signal.ITIMER_PROF, seconds)
        yield from _answers(request, Path(request["file"]), stream)
        gc.collect()


def _write(stream: Any, piece: bytes | memoryview) -> None:
    left = memoryview(piece)
    while left:
        left = left[stream.write(left) :]


def _files_of(stream: Any) -> list[Path]:
    """The files of a batch."""
    (left,) = struct.unpack("<Q", stream.read(8))
    names = bytearray()
    while len(names) < left and (piece := stream.read(left - len(names))):
        names += piece
    return [Path(name) for name in json.loads(names)]


def _readable(files: list[Path]) -> list[Path]:
    """The files, and those that belong to them: of the same stem, and the other half of a pair."""
    found = dict.fromkeys(files)
    for folder in {file.parent for file in files}:
        beside: dict[str, list[Path]] = {}
        for name in os.listdir(folder):
            beside.setdefault(Path(name).stem, []).append(folder / name)
        for file in files:
            if file.parent == folder:
                found |= dict.fromkeys(beside.get(file.stem, [])[:_BESIDE])
    for file in files:
        if file.suffix.lower() == ".ibw":
            found |= dict.fromkeys(importlib.import_module("nanotouch.curves.asylum_pair").files_of(file))
    return list(found)


def _answers(request: dict[str, Any], file: Path, stream: Any) -> Iterator[list[bytes | memoryview]]:
    try:
        if request["job"] == "curves.stream":
            yield from _streamed(file, request["options"], stream)
        else:
            yield transfer.packed(_reader(request["job"])(file, **request["options"]))
    except Error as error:
        reader = getattr(error, "reader", "")
        yield transfer.packed({"error": str(error), "type": type(error).__name__, "reader": reader})
    except MemoryError:
        yield transfer.packed({"error": f"{file}: asks for more memory than is allowed", "type": "MemoryError"})
    except Exception as error:
        said = " ".join(str(error).split())[:200] or type(error).__name__
        yield transfer.packed({"error": f"{file}: it cannot be read: {said}"})


def _streamed(file: Path, options: dict[str, Any], stream: Any) -> Iterator[list[bytes | memoryview]]:
    """First where each curve was taken, then the curves that are asked for, a line ``start stop`` each."""
    found = _reader("curves.stream")(file, importlib.import_module("nanotouch.curves").Calibration(**options))
    yield transfer.packed({"places": [found.place(number) for number in range(len(found))]})
    while line := _line(stream):
        start, stop = map(int, line.split())
        yield transfer.packed([_or_error(found, number) for number in range(start, stop)])


def _or_error(found: Any, number: int) -> Any:
    try:
        return found[number]
    except Error as error:
        return {"error": str(error), "type": type(error).__name__, "reader": getattr(error, "reader", "")}


if __name__ == "__main__":
    main()
