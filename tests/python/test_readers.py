# SPDX-License-Identifier: BSD-3-Clause
"""Readers of others by entry point, files from elsewhere in a guarded worker, and the table of formats."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")

from nanotouch import curves, formats, guard, images
from nanotouch._io import readers, series, transfer, worker
from nanotouch.errors import Error, InvalidValue, ReadError

#: A reader of files that begin with ``FAKE``; what follows says how it behaves.
READER = """
import os, socket, time
import numpy as np
from nanotouch.images import Channel, Plane
from nanotouch.curves import ForceCurve, Segment
kind = {kind!r}

def recognises(file, head):
    return head.startswith(b"FAKE")

def channels(file):
    return [Channel("Height", (8, 9), None, "nm", "height", True)]

def read(file, channel=None):
    what = file.read_text().split(maxsplit=1)[1]
    if kind == "curves":
        z = np.concatenate([np.linspace(1e-6, 0, 50), np.linspace(0, 1e-6, 50)])
        force = np.where(z < 1e-7, 1e-7 - z, 0.0) * 0.5
        t = np.arange(50.0)
        segments = [Segment(r, t, z[p], "height (piezo)", force[p], force[p] / 0.5)
                    for r, p in (("approach", slice(0, 50)), ("retract", slice(50, 100)))]
        return [ForceCurve(tuple(segments), {{"spring constant": 0.5, "sensitivity": 5e-8}}, file.name)]
    scale = 1.0
    if what == "loop":
        while True: pass
    if what == "sleep": time.sleep(1000)
    if what == "crash": os.kill(os.getpid(), 11)
    if what == "exit": os._exit(0)
    if what == "memory": hog = np.ones(2 ** 31)
    if what == "raise": raise RuntimeError("no such thing")
    if what == "absurd": scale = 1e9
    if what == "network": socket.create_connection(("127.0.0.1", {port}), timeout=1)
    if what == "files": many = [open(file) for _ in range(50)]
    if what == "write": open(file.with_suffix(".written"), "w").write("x" * 10000)
    ramp = scale * np.add.outer(np.arange(8.0), 2 * np.arange(9.0))
    return Plane("Height", ramp, "nm", (1e-8, 2e-8), "fake")
"""


@pytest.fixture(scope="module")
def registered(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Two distributions that are not installed otherwise, one with a reader of images, one of curves."""
    tmp_path = tmp_path_factory.mktemp("distributions")
    with socket.create_server(("127.0.0.1", 0)) as server, pytest.MonkeyPatch.context() as monkeypatch:
        port = server.getsockname()[1]
        for kind in ("images", "curves"):
            place = tmp_path / f"site_{kind}"
            info = place / f"fake_{kind}-1.0.dist-info"
            info.mkdir(parents=True)
            (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: fake-{kind}\nVersion: 1.0\n")
            (info / "entry_points.txt").write_text(f"[nanotouch.readers]\nfake-{kind} = fake_{kind}\n")
            (place / f"fake_{kind}.py").write_text(READER.format(kind=kind, port=port))
            monkeypatch.syspath_prepend(place)
        _fresh()
        yield
    _fresh()


def _fresh() -> None:
    readers._registered.cache_clear()
    worker._stop_at_exit()


def fake(path: Path, what: str) -> Path:
    path.write_text(f"FAKE {what}")
    return path


def test_a_registered_reader_is_asked_first_and_checked_like_the_others(tmp_path: Path, registered: None) -> None:
    topography = images.read(fake(tmp_path / "a.xyz", "normal"))
    assert (topography.source, topography.channel, topography.pixel_size) == ("fake", "Height", (1e-8, 2e-8))
    assert topography.heights[1, 1] == pytest.approx(3e-9)  # nm, row 0 below: as handed over
    assert [c.name for c in images.channels(tmp_path / "a.xyz")] == ["Height"]
    with pytest.raises(ReadError, match=r"no such thing \(reader: fake-images\)|fake-images cannot read it: no such"):
        images.read(fake(tmp_path / "b", "raise"))
    with pytest.raises(ReadError, match=r"heights over a range of 23 m .* \(reader: fake\)") as caught:
        images.read(fake(tmp_path / "c", "absurd"))
    assert caught.value.reader == "fake"
    (curve,) = curves.read(fake(tmp_path / "d", "normal"), spring_constant=1.5)
    assert curve.retract is not None
    assert curve.approach is not None
    assert curve.approach.force is not None
    assert curve.approach.force[-1] == pytest.approx(1.5 * 1e-7)


def test_a_reader_that_cannot_be_loaded_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    info = tmp_path / "site" / "broken-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[nanotouch.readers]\nbroken = no_such_module\n")
    monkeypatch.syspath_prepend(tmp_path / "site")
    readers._registered.cache_clear()
    try:
        with pytest.raises(Error, match=r"the registered reader 'broken' \(no_such_module\) cannot be loaded"):
            images.read(fake(tmp_path / "a", "normal"))
    finally:
        readers._registered.cache_clear()


linux = pytest.mark.skipif(sys.platform != "linux", reason="the worker runs on Linux")


@linux
def test_the_guarded_worker_gives_the_same_data(tmp_path: Path) -> None:
    heights = synthetic.asymmetric()
    heights[3, 4] = np.nan
    path = synthetic.write_matrix(tmp_path / "image.txt", heights, (3e-6, 4e-6))
    plain, guarded = images.read(path), images.read(path, untrusted=True)
    np.testing.assert_array_equal(guarded.heights, plain.heights)
    np.testing.assert_array_equal(guarded.mask, plain.mask)
    for key in ("pixel_size", "name", "channel", "source"):
        assert getattr(guarded, key) == getattr(plain, key)
    assert images.channels(path, untrusted=True) == images.channels(path)
    jpk = synthetic.write_jpk(tmp_path / "curve.jpk-force", [
        ("extend", synthetic.known_curve(n=100).approach_z, synthetic.known_curve(n=100).approach_force),
        ("retract", synthetic.known_curve(n=100).retract_z, synthetic.known_curve(n=100).retract_force),
    ])  # fmt: skip
    (a,), (b,) = curves.read(jpk, sensitivity=5e-8), curves.read(jpk, sensitivity=5e-8, untrusted=True)
    assert dict(a.meta) == dict(b.meta)
    for one, other in zip(a.segments, b.segments, strict=True):
        for key in ("time", "z", "force", "deflection"):
            np.testing.assert_array_equal(getattr(one, key), getattr(other, key))
    with pytest.raises(ReadError, match="not an AFM image in any format") as caught:
        images.read(_prose(tmp_path / "prose"), untrusted=True)
    assert str(caught.value).startswith(str(tmp_path / "prose"))
    with pytest.raises(InvalidValue, match="sensitivity"):
        curves.read(jpk, sensitivity=1.0, untrusted=True)


def _prose(path: Path) -> Path:
    path.write_text("Call me Ishmael.\n")
    return path


DEEDS = [
    ("loop", r"not read within 0\.4 s and stopped"),
    ("sleep", r"not read within 0\.4 s and stopped"),
    ("crash", r"it crashes its reader \(SIGSEGV\)"),
    ("exit", "the worker gave no valid answer"),
    ("memory", "asks for more memory than there is"),
    ("network", "cannot read it"),
    ("files", "Too many open files"),
    ("write", r"SIGXFSZ|File too large|cannot read it"),
    ("absurd", "heights over a range of 23 m"),
]


@linux
@pytest.mark.parametrize(("what", "message"), DEEDS)
def test_whatever_a_file_does_to_the_worker_is_a_read_error(
    tmp_path: Path, registered: None, monkeypatch: pytest.MonkeyPatch, what: str, message: str
) -> None:
    monkeypatch.setattr(guard, "LIMITS", guard.Limits(time=0.4))
    with pytest.raises(ReadError, match=message):
        images.read(fake(tmp_path / what, what), untrusted=True)
    assert images.read(fake(tmp_path / "next", "normal"), untrusted=True).source == "fake"  # the next file is read
    assert not (tmp_path / "write.written").exists() or (tmp_path / "write.written").stat().st_size == 0


@linux
def test_whatever_a_file_of_a_batch_does_the_others_are_read(
    tmp_path: Path, registered: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = {fake(tmp_path / what, what): message for what, message in DEEDS}
    good = [fake(tmp_path / f"good {number}", "normal") for number in range(len(bad) + 1)]
    batch = [good[0], *(file for pair in zip(bad, good[1:], strict=True) for file in pair)]
    with series.of(batch):
        for file in batch:
            monkeypatch.setattr(guard, "LIMITS", guard.Limits(time=0.4 if file in bad else 20.0))
            if file in bad:
                with pytest.raises(ReadError, match=bad[file]):
                    images.read(file, untrusted=True)
            else:
                assert images.read(file, untrusted=True).source == "fake"
        held = worker.current_series()
        assert isinstance(held, series.Series)
        assert 1 < held.children <= len(bad) + 1
    assert not (tmp_path / "write.written").exists() or (tmp_path / "write.written").stat().st_size == 0


@linux
def test_the_network_is_there_without_the_guard(tmp_path: Path, registered: None) -> None:
    """Else the case above would prove nothing."""
    assert images.read(fake(tmp_path / "a", "network")).source == "fake"


@linux
def test_a_worker_that_was_killed_is_started_again(tmp_path: Path) -> None:
    path = synthetic.write_matrix(tmp_path / "image.txt", synthetic.asymmetric(), (3e-6, 4e-6))
    images.read(path, untrusted=True)
    assert worker._current is not None
    os.kill(worker._current.pid, 9)
    assert images.read(path, untrusted=True).shape == (24, 32)


@linux
def test_no_worker_is_left_behind(tmp_path: Path) -> None:
    path = synthetic.write_matrix(tmp_path / "image.txt", synthetic.asymmetric(), (3e-6, 4e-6))
    code = (
        "import sys, nanotouch as nt; from nanotouch._io import series, worker\n"
        f"nt.images.read({str(path)!r}, untrusted=True); print(worker._current.pid)"
    )
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    assert done.stderr == ""
    assert not Path(f"/proc/{done.stdout.strip()}").exists()


def test_elsewhere_it_says_that_it_cannot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(Error, match="untrusted files are opened on Linux only, not on win32"):
        images.read(_prose(tmp_path / "a"), untrusted=True)


class _Stream:
    def __init__(self, data: bytes) -> None:
        self.data = data

    def __call__(self, count: int) -> bytes:
        if count > len(self.data):
            raise EOFError
        piece, self.data = self.data[:count], self.data[count:]
        return piece


TYPES = (images.Topography,)


def test_an_answer_holds_data_only(tmp_path: Path) -> None:
    """Whatever bytes a worker that was taken over sends: an answer of known types within the limits, or none."""
    topography = images.Topography(synthetic.asymmetric(), (1e-7, 1e-7), "a", "b", "c")
    whole = b"".join(transfer.packed([topography, {"x": (1, 2.5, None, True)}]))
    back, rest = transfer.unpacked(_Stream(whole), tmp_path, TYPES)
    np.testing.assert_array_equal(back.heights, topography.heights)
    assert rest == {"x": (1, 2.5, None, True)}
    with pytest.raises(transfer.BadAnswer):
        transfer.unpacked(_Stream(whole), tmp_path, (images.Channel,))  # of a type that was not asked for
    head = len(whole) - topography.heights.nbytes - topography.mask.nbytes
    for old, new in (
        (b"Topography", b"subprocess"), (b'"<f8"', b'"|O8"'), (b"[24, 32]", b"[-4, 32]"),
        (b"[24, 32]", b"[10000000000, 32]"), (b'"array": 0', b'"array": 9'), (b"pixel_size", b"__class__x"),
        (b'"fields"', b'"fieldz"'), (b'"tree"', b'"free"'),
    ):  # fmt: skip
        text = whole[8:head].replace(old, new)
        assert text != whole[8:head]
        with pytest.raises(transfer.BadAnswer):
            transfer.unpacked(_Stream(len(text).to_bytes(8, "little") + text + whole[head:]), tmp_path, TYPES)
    with pytest.raises(transfer.BadAnswer, match="an answer of"):
        transfer.unpacked(_Stream((1 << 60).to_bytes(8, "little") + whole), tmp_path, TYPES)
    rng = np.random.default_rng(11)
    for _ in range(300):
        damaged = bytearray(whole)
        for place in rng.integers(0, head, 3):
            damaged[place] = rng.integers(256)
        try:
            transfer.unpacked(_Stream(bytes(damaged)), tmp_path, TYPES)
        except (transfer.BadAnswer, EOFError):
            continue


# --- the table of formats ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "page"), [("images", "images.md"), ("curves", "curves.md")])
def test_the_documentation_shows_the_table(kind: formats.Kind, page: str) -> None:
    path = Path(__file__).resolve().parents[2] / "docs" / page
    assert formats.markdown(kind) in path.read_text(encoding="utf-8")


@pytest.mark.parametrize("known", [f for f in formats.FORMATS if not f.reader], ids=lambda f: f"{f.kind}-{f.name}")
def test_a_known_format_is_refused_with_what_the_table_says(tmp_path: Path, known: formats.Format) -> None:
    start = bytearray(formats.HEAD)
    for at, mark in known.signatures[:1]:
        start[at : at + len(mark)] = mark
    path = tmp_path / f"file{known.endings[0]}"
    path.write_bytes(bytes(start))
    read = images.read if known.kind == "images" else curves.read
    with pytest.raises(ReadError) as caught:
        read(path)
    assert known.remedy in str(caught.value)
    assert known.name in str(caught.value)
