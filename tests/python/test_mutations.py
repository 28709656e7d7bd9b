# SPDX-License-Identifier: BSD-3-Clause
"""Damaged files and bombs: an answer within the limits, plausible or refused. 2000 of them: ``make damage``."""

from __future__ import annotations

import io
import os
import resource
import struct
import sys
import zipfile
from pathlib import Path

import mutations
import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")
if sys.platform != "linux":
    pytest.skip("the guarded worker runs on Linux", allow_module_level=True)

from nanotouch import curves, images
from nanotouch.errors import ReadError


def test_some_damaged_files_of_every_format(tmp_path: Path) -> None:
    """Implausible scales are refused (asserted inside), and none crashes, hangs or takes more than 2 GiB."""
    found = mutations.run(tmp_path, per_seed=1, real=False)
    total = sum(found.values(), mutations.Counter())
    assert total["stopped"] == 0
    assert total["refused"] >= 4  # the damage is felt: of the 2000, a half
    assert set(total) <= set(mutations.OUTCOMES)


def _zip_bomb(path: Path) -> None:
    """A sound JPK curve whose deflection unpacks to 900 MiB of zeros: 0.9 MB."""
    known = synthetic.known_curve(n=200)
    segments = [("extend", known.approach_z, known.approach_force), ("retract", known.retract_z, known.retract_force)]
    whole = zipfile.ZipFile(synthetic.write_jpk(path, segments))
    out = io.BytesIO()
    with whole, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for item in whole.infolist():
            content = whole.read(item)
            if item.filename.endswith("header.properties"):
                content = content.replace(b"num-points=200", b"num-points=235929600")
            if item.filename == "segments/0/channels/vDeflection.dat":
                with archive.open(item.filename, "w", force_zip64=True) as stream:
                    for _ in range(900):
                        stream.write(bytes(1 << 20))
            else:
                archive.writestr(item.filename, content)
    path.write_bytes(out.getvalue())


def _hdf5(path: Path, what: str) -> None:
    h5py = pytest.importorskip("h5py")
    other = path.with_name("secret.bin")
    np.arange(64.0).tofile(other)
    with h5py.File(path.with_name("other.h5"), "w") as file:
        file["z"] = np.arange(64.0).reshape(8, 8)
    with h5py.File(path, "w") as file:
        if what == "huge":
            file.create_dataset("z", (200_000, 200_000), "f8", chunks=(1000, 1000))
        elif what == "external storage":
            file.create_dataset("z", (8, 8), "f8", external=[(str(other), 0, 512)])
        elif what == "external link":
            file["z"] = h5py.ExternalLink("other.h5", "z")
        elif what == "virtual":
            layout = h5py.VirtualLayout((8, 8), "f8")
            layout[:] = h5py.VirtualSource(path.with_name("other.h5"), "z", (8, 8))
            file.create_virtual_dataset("z", layout)
        elif what == "round":
            file["group/inside"] = file["/"]  # a hard link to its own parent
            file["group/z"] = np.zeros((2, 2))  # no image


def _npy(path: Path) -> None:
    header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (16000, 4000000), }"
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header) + 1) + header + b"\n" + bytes(1000))


def _nanoscope(path: Path) -> None:
    synthetic.write_nanoscope(path, [(np.zeros(256), np.zeros(256))])
    path.write_bytes(path.read_bytes().replace(b"Samps/line: 256 256", b"Samps/line: 999999999999 999999999999"))


def _gwy(path: Path) -> None:
    whole = synthetic.write_gwy(path, synthetic.asymmetric(), mutations.SIDE).read_bytes()
    for key in (b"xres\0i", b"yres\0i"):
        at = whole.index(key) + len(key)
        whole = whole[:at] + struct.pack("<i", 16000) + whole[at + 4 :]
    path.write_bytes(whole)


BOMBS = {
    "zip.jpk-force": (_zip_bomb, "unpacks to 900 MiB"),
    "huge.h5": (lambda path: _hdf5(path, "huge"), "unpacks to 305176 MiB"),
    "external storage.h5": (lambda path: _hdf5(path, "external storage"), "keeps 'z' in another file"),
    "external link.h5": (lambda path: _hdf5(path, "external link"), "links to another file in 'z'"),
    "virtual.h5": (lambda path: _hdf5(path, "virtual"), "keeps 'z' in another file"),
    "round.h5": (lambda path: _hdf5(path, "round"), "2 x 2 pixels"),
    "array.npy": (_npy, "pixels|cannot read"),
    "ramp.000": (_nanoscope, "no whole number of curves"),
    "image.gwy": (_gwy, "cannot read|pixels"),
}


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # files that numpy's reader leaves open
@pytest.mark.parametrize("name", BOMBS)
@pytest.mark.parametrize("untrusted", [False, True])
def test_bombs_are_refused(tmp_path: Path, name: str, untrusted: bool) -> None:
    """With the guard and without it, before anything is allocated."""
    make, message = BOMBS[name]
    path = tmp_path / name
    make(path)
    assert path.stat().st_size < 8 << 20
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    options = {} if path.suffix in (".jpk-force", ".000") else {"pixel_size": 1e-8, "z_unit": "m"}
    read = images.read if options else curves.read
    with pytest.raises(ReadError, match=message):
        read(path, untrusted=untrusted, **options)  # type: ignore[operator]
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 500 << 10  # KiB, in this process


def test_a_pipe_is_no_file(tmp_path: Path) -> None:
    """It would be waited for, for ever."""
    os.mkfifo(tmp_path / "pipe.gwy")
    with pytest.raises(ReadError, match="a device or a pipe"):
        images.read(tmp_path / "pipe.gwy")
