# SPDX-License-Identifier: BSD-3-Clause
"""Asylum images: values against igor2, units by the note and by name, and a listing by the header alone."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import ReadError
from test_images_nanoscope import NX, picture, write

HEIGHTS = synthetic.asymmetric()


def test_values_are_those_that_igor_stores(tmp_path: Path) -> None:
    binarywave = pytest.importorskip("igor2.binarywave")
    path = synthetic.write_ibw_image(tmp_path / "a.ibw", {"PhaseTrace": HEIGHTS, "ZSensorTrace": 2 * HEIGHTS}, 1e-8)
    stored = binarywave.load(str(path))["wave"]["wData"]
    read = images.read(path)
    assert read.channel == "ZSensorTrace"
    np.testing.assert_array_equal(read.heights, stored[:, :, 1].T)  # x first, y upwards
    assert read.pixel_size == (1e-8, 1e-8)


def test_units_by_the_note_and_by_name(tmp_path: Path) -> None:
    names = ("HeightTrace", "HeightRetrace", "CurrentTrace", "NapPhaseRetrace", "UserTrace", "UserTrace")
    path = synthetic.write_ibw_image(tmp_path / "a.ibw", dict.fromkeys(names, HEIGHTS), 1e-8)
    listed = {one.name: (one.unit, one.kind, one.default) for one in images.channels(path)}
    assert listed == {
        "HeightTrace": ("m", "height", True), "HeightRetrace": ("m", "height", False),
        "CurrentTrace": ("ampere", "current", False), "NapPhaseRetrace": ("deg", "phase", False),
        "UserTrace": (None, "voltage", False),
    }  # fmt: skip
    with pytest.raises(ReadError, match="'CurrentTrace' is in 'ampere', not a length"):  # A is no Angstrom here
        images.read(path, "CurrentTrace")


def test_the_unit_of_the_wave_counts_where_the_note_states_none(tmp_path: Path) -> None:
    wave, labels = np.asarray(HEIGHTS.T)[:, :, None], ["HeightTrace"]
    path = synthetic.write_ibw(tmp_path / "a.ibw", 1e9 * wave, labels, pitch=1e-8, note={"ScanSize": 1e-6}, unit="nm")
    np.testing.assert_allclose(images.read(path).heights, HEIGHTS, rtol=1e-12)


def test_a_channel_that_is_cut_off_is_refused(tmp_path: Path) -> None:
    path = synthetic.write_ibw_image(tmp_path / "a.ibw", {"HeightTrace": HEIGHTS}, 1e-8)
    path.write_bytes(path.read_bytes()[:-2000])
    with pytest.raises(ReadError, match="bytes long, but its header states"):
        images.read(path)


def test_a_listing_needs_no_reader_of_others(tmp_path: Path) -> None:
    """SurfaceTopography, pandas and scipy take 1.7 s of processor time to be imported."""
    files = [synthetic.write_ibw_image(tmp_path / "a.ibw", {"HeightTrace": HEIGHTS}, 1e-8),
             write(tmp_path / "b.spm", picture(NX))]  # fmt: skip
    code = (
        "import sys\nfrom nanotouch import curves, images\n"
        f"for file in {[str(file) for file in files]}:\n"
        "    images.channels(file)\n    images.read(file)\n"
        "    try:\n        curves.read(file)\n    except curves.reading.ReadError:\n        pass\n"
        "print(sorted({'SurfaceTopography', 'afmformats', 'pandas', 'scipy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
