# SPDX-License-Identifier: BSD-3-Clause
"""The generated corpus: a sample of it is read rightly, and other people's readers agree with what is written."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")

sys.path.insert(0, str(Path(__file__).parents[1] / "corpus"))

import corpus
import corpus_peers
import generated
import nanotouch as nt
import synthetic
from made import Curves, Image, Made, Plane

IMAGES = [name for name in generated.writers() if "image" in name]
CURVES = [name for name in generated.writers() if "curve" in name]


def made(name: str, seed: int, folder: Path) -> Made:
    place = folder / str(seed)
    place.mkdir(parents=True)
    return generated.writers()[name](np.random.default_rng(seed), place, plain=True)


@pytest.mark.parametrize("name", IMAGES)
def test_other_readers_of_images_agree_with_the_writer(name: str, tmp_path: Path) -> None:
    for seed in (1, 2, 3):
        file = made(name, seed, tmp_path)
        assert isinstance(file.truth, Image)
        due = file.truth.defaults[0]
        size = tuple(n * step for n, step in zip(due.heights.shape, due.pixel, strict=True))
        read = corpus._asked(corpus_peers.IMAGES, file.path)
        if not read:
            pytest.skip(f"no other reader of {name} is installed")
        for peer, channels in read.items():
            assert any(agrees(channel, due, size) for channel in channels), peer  # type: ignore[arg-type]


def agrees(theirs: corpus_peers.Image, due: Plane, size: tuple[float, ...]) -> bool:
    return (
        theirs.heights.shape == due.heights.shape
        and theirs.size == pytest.approx(size, rel=1e-4)
        and theirs.heights == pytest.approx(due.heights, abs=2e-6 * np.abs(due.heights).max(), nan_ok=True)
    )


@pytest.mark.parametrize("name", CURVES)
def test_other_readers_of_curves_agree_with_the_writer(name: str, tmp_path: Path) -> None:
    for seed in (1, 2, 3):
        file = made(name, seed, tmp_path)
        assert isinstance(file.truth, Curves)
        read = corpus._asked(corpus_peers.CURVES, file.path)
        if not read:
            pytest.skip(f"no other reader of {name} is installed")
        first = file.truth.curves[0].parts
        travel = np.ptp(np.concatenate([part.z for part in first]))
        force = np.ptp(np.concatenate([part.force for part in first if part.force is not None]))
        for peer, found in read.items():
            assert isinstance(found, corpus_peers.Curves)
            assert len(found.points) == len(file.truth.curves), peer
            if found.points[0]:
                assert found.points[0] == sum(len(part.z) for part in first), peer
            assert found.travel == pytest.approx(travel, rel=1e-6), peer
            assert found.force == pytest.approx(force, rel=1e-6), peer


def test_afmformats_agrees_with_the_writer_of_nova(tmp_path: Path) -> None:
    """It has to be given the calibration, with a sensitivity in m/A."""
    import afmformats

    file = made("Nova text curves (.txt)", 3, tmp_path)
    assert isinstance(file.truth, Curves)
    names = {"spring constant": file.given["spring_constant"], "sensitivity": file.given["sensitivity"]}
    read = afmformats.load_data(file.path, meta_override=names)[0]
    parts = file.truth.curves[0].parts
    assert read["height (measured)"] == pytest.approx(np.concatenate([part.z for part in parts]), rel=1e-9)
    force = np.concatenate([part.force for part in parts if part.force is not None])
    assert read["force"] == pytest.approx(force, abs=1e-9 * np.ptp(force))


def test_nanonispy_agrees_with_the_writer_of_nanonis(tmp_path: Path) -> None:
    nanonispy = pytest.importorskip("nanonispy2")
    file = made("Nanonis image (.sxm)", 3, tmp_path)
    assert isinstance(file.truth, Image)
    scan = nanonispy.read.Scan(str(file.path))
    forward, backward = file.truth.defaults[0], file.truth.others[0]
    assert np.array_equal(scan.signals["Z"]["forward"], forward.heights)
    assert np.array_equal(scan.signals["Z"]["backward"][:, ::-1], backward.heights)
    sides = [n * step for n, step in zip(forward.heights.shape[::-1], forward.pixel[::-1], strict=True)]
    assert list(scan.header["scan_range"]) == pytest.approx(sides, rel=1e-6)


def test_a_sample_is_read_rightly(tmp_path: Path) -> None:
    """Two of each format; many more is ``make corpus``."""
    rows = list(generated.rows(2 * len(generated.MODULES), 1, (), tmp_path))
    assert [
        (row.made.format, row.seed, row.verdict) for row in rows if generated._class(row) in ("wrong", "refused")
    ] == []
    assert {row.made.format for row in rows} == set(generated.writers())


def test_the_judge_notices_what_is_wrong(tmp_path: Path) -> None:
    """The same file against another truth: size, orientation, sign, a segment more, a unit."""
    image = made("Asylum image (.ibw)", 5, tmp_path)
    assert isinstance(image.truth, Image)
    plane = image.truth.defaults[0]
    assert generated.judge(image).kind == "right"
    for other, told in (
        (replace(plane, pixel=(2 * plane.pixel[0], plane.pixel[1])), "dy"),
        (replace(plane, heights=plane.heights[::-1]), "upside down"),
        (replace(plane, heights=plane.heights[:, ::-1]), "mirrored"),
        (replace(plane, heights=1.001 * plane.heights), "heights over"),
        (replace(plane, heights=plane.heights[1:]), "pixels"),
    ):
        verdict = generated.judge(replace(image, truth=Image((other,))))
        assert verdict.kind == "wrong"
        assert told in verdict.reason
    assert "no note" in generated.judge(replace(image, told=(("a dog",),))).reason
    assert "read, though" in generated.judge(replace(image, must_refuse="it is none")).reason
    assert "read without" in generated.judge(replace(image, given={"pixel_size": 1e-9})).reason
    curve = made("Asylum curves (.ibw)", 5, tmp_path / "curves")
    assert isinstance(curve.truth, Curves)
    first = curve.truth.curves[0]
    assert first.spring_constant is not None
    for changed, told in (
        (replace(first, parts=first.parts[:1]), "segments"),
        (replace(first, spring_constant=1e-9 * first.spring_constant), "spring constant"),
        (replace(first, parts=tuple(replace(p, z=-p.z) for p in first.parts)), "z "),
        (
            replace(first, parts=tuple(replace(p, force=1e9 * p.force) for p in first.parts if p.force is not None)),
            "force",
        ),
    ):
        verdict = generated.judge(replace(curve, truth=Curves((changed,))))
        assert verdict.kind == "wrong"
        assert told in verdict.reason
    assert generated.judge(replace(image, path=tmp_path / "absent.ibw")).kind == "refused"


def _heights(file: Path) -> float:
    return float(np.ptp(nt.images.read(file).heights))


def _trigger(file: Path) -> float:
    """Largest force of the first approach above its free level."""
    force = nt.curves.read(file)[0].segments[0].force
    assert force is not None
    return float(force.max() - np.median(force[: len(force) // 4]))


def _force(file: Path, **given: float) -> NDArray[np.float64]:
    segments = nt.curves.read(file, **given)[0].segments  # type: ignore[arg-type]
    return np.concatenate([segment.force for segment in segments if segment.force is not None])


def _nova(file: Path) -> NDArray[np.float64]:
    """Forces, at a calibration that the file does not state."""
    return _force(file, spring_constant=0.055, sensitivity=61.0)


def _unitless(file: Path) -> NDArray[np.float64]:
    """Heights of the pattern that Gwyddion made, which has no unit."""
    return nt.images.read(file, "Test", pixel_size=1e-9, z_unit="um").heights


NOVA = "fmt-ntmdt-txt-fd_2015_01_17_gel4-0,1_mQ_adh_6B_Curve_DFL_Height_51.txt"

#: What the maker's software wrote beside the data, and how near the data have to be.
PRINTED: list[tuple[str, Callable[[Path], float], float, float, str]] = [
    ("images/stp-1.stp", _heights, 13.7008e-9, 1e-4, "WSxM: Z Amplitude"),
    ("corpus/images/sample_0.stp", _heights, 59.7449e-9, 1e-4, "WSxM: Z Amplitude"),
    ("corpus/images/sur-2.sur", _heights, (103880 - 89120) * 1e-10, 1e-6, "Digital Surf: (Zmax - Zmin) dz"),
    ("corpus/images/A151216.123306-02602.sxm", lambda f: float(nt.images.read(f).heights.mean()), -21.8616e-9, 1e-4,
     "Nanonis: Z-Controller>Z, held over the scan"),
    ("corpus/images/nid-1.nid", lambda f: nt.images.read(f).size[1], 20e-6, 1e-6, "Nanosurf: Image size"),
    ("images/di-3.di", lambda f: nt.images.read(f).size[0], 10e-6, 1e-6, "NanoScope: Scan Size, aspect 1:1"),
    ("images/spot_1-1000nm.ibw", lambda f: nt.images.read(f).size[1] * 255 / 256, 20e-6, 1e-4, "Asylum: FastScanSize"),
    ("curves/fsas/Test.000", lambda f: float(np.ptp(nt.curves.read(f)[0].segments[1].z)) * 512 / 511, 300e-9, 1e-4,
     "NanoScope: ramp of 300 nm (Test.txt)"),
    ("curves/fmt-igor-fd_SiN_FD_plot.ibw", _trigger, 1e-8, 0.01, "Asylum: TriggerPoint"),
    ("curves/fmt-jpk-cc_pr14-polymergel-2021.06.30.jpk-force", _trigger, 2.693631715897275 * 6.086e-8 * 0.061, 0.01,
     "JPK: relative setpoint"),
    ("curves/fmt-jpk-fd_spot3-0192.jpk-force", _trigger, 1.3137932359860578 * 7.000143623e-8 * 0.0434936664, 0.01,
     "JPK: relative setpoint"),
    ("corpus/images/gwyfile-test.gwy", lambda f: float(np.ptp(_unitless(f))), 0.001e-6, 1e-12,
     "Gwyddion: lat_synth(height=0,001) in its log"),
    ("corpus/images/matrix-3.txt", lambda f: nt.images.read(f).size[0], 10e-6, 1e-9,
     "Gwyddion's text: Height: 10.00 um"),
    ("corpus/curves/fmt-hdf5-fd_version_0.13.3.h5", _trigger, 6e-9, 0.01, "HDF5: setpoint of JPK"),
    (f"corpus/curves/{NOVA}", lambda f: float(_nova(f).max()), 1.4726e-9 * 61.0 * 0.055, 1e-9, "Nova: max DFL [nA]"),
]  # fmt: skip

#: What other readers assert of the same files in their own tests.
ASSERTED: list[tuple[str, Callable[[Path], float], float, float, str]] = [
    ("corpus/images/gwyfile-test.gwy", lambda f: float(_unitless(f)[::-1][44, 33]), 0.00085301e-6, 1e-5, "gwyfile"),
    ("corpus/images/matrix-3.txt", lambda f: float(nt.images.read(f).heights.std()), 3.5222918750198742e-08, 1e-12,
     "SurfaceTopography: rms height"),
    ("corpus/images/sample_0.h5-jpk", lambda f: sum(float(nt.images.read(f, f"Height trace frame {n}").heights.sum())
     for n in (1, 2, 3, 4)), 48525583.047271535e-9, 1e-12, "AFMReader: sum of four frames"),
    ("corpus/curves/fmt-hdf5-fd_version_0.13.3.h5", lambda f: float(_force(f)[2000]), -7.038311459845539e-10, 1e-15,
     "afmformats: force at 2000"),
    (f"corpus/curves/{NOVA}", lambda f: float(np.argmax(_nova(f))), 821.0, 0.0, "afmformats: turn of the Nova curve"),
    (f"corpus/curves/{NOVA}", lambda f: float(_nova(f).size), 1644.0, 0.0, "afmformats: points of the Nova curve"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "read", "printed", "near", "where"),
    [*PRINTED, *ASSERTED],
    ids=[row[4] for row in (*PRINTED, *ASSERTED)],
)
def test_what_the_maker_prints_and_others_assert(
    name: str, read: Callable[[Path], float], printed: float, near: float, where: str
) -> None:
    """Where the files come from stands in docs/formats.md; NANOTOUCH_DATA names a folder that holds them."""
    path = synthetic.DATA / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    assert read(path) == pytest.approx(printed, rel=near), where


def test_the_page_of_formats_tells_what_varies_now() -> None:
    page = (Path(__file__).parents[2] / "docs/formats.md").read_text(encoding="utf-8")
    assert [row for row in generated.fields() if row not in page] == []
