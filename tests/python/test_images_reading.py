# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.images.read: the right way up, in metres, and one clear error for everything else."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import InvalidValue, ReadError

SIDE = (3e-6, 4e-6)  # of the asymmetric picture: 24 x 32 pixels of 125 nm


def written(path: Path) -> Path:
    """The asymmetric picture in the format of the path's ending."""
    heights = synthetic.asymmetric()
    if path.suffix == ".gwy":
        return synthetic.write_gwy(path, heights, SIDE)
    if path.suffix == ".nid":
        return synthetic.write_nid(path, heights, SIDE)
    if path.suffix == ".ibw":
        return synthetic.write_ibw_image(path, {"HeightTrace": heights}, 1.25e-7)
    return synthetic.write_matrix(path, heights, SIDE)


@pytest.mark.parametrize("ending", [".txt", ".gwy", ".ibw", ".nid"])
def test_orientation_scale_and_unit(tmp_path: Path, ending: str) -> None:
    """Formats that store their lines from the top, from the bottom or by columns all give the same picture."""
    topography = images.read(written(tmp_path / f"image{ending}"))
    # .nid holds int32 over the range, text nine digits: 40 nm / 1e9
    np.testing.assert_allclose(topography.heights, synthetic.asymmetric(), rtol=0, atol=1e-16)
    assert topography.heights.dtype == np.float64
    assert topography.heights.flags.c_contiguous
    assert topography.pixel_size == pytest.approx((1.25e-7, 1.25e-7), rel=1e-9)  # size / N, not / (N - 1)
    assert topography.size == pytest.approx(SIDE, rel=1e-9)
    assert topography.masked_pixels == 0


def test_pixel_size_is_that_of_other_readers(tmp_path: Path) -> None:
    """Scan size over N. gwyfile states the size and N, Igor the pitch; SurfaceTopography the size of N pixels."""
    io = pytest.importorskip("SurfaceTopography.IO")
    gwyfile = pytest.importorskip("gwyfile")
    binarywave = pytest.importorskip("igor2.binarywave")
    gwy, ibw = written(tmp_path / "image.gwy"), written(tmp_path / "image.ibw")
    field = gwyfile.load(str(gwy))["/0/data"]
    assert images.read(gwy).pixel_size == pytest.approx((field.yreal / field["yres"], field.xreal / field["xres"]))
    pitch = binarywave.load(str(ibw))["wave"]["wave_header"]["sfA"]
    assert images.read(ibw).pixel_size == pytest.approx((pitch[1], pitch[0]), rel=1e-12)
    for path in (gwy, ibw):
        with io.open_topography(str(path)) as reader:
            loaded = reader.topography()
            width = loaded.physical_sizes[0] * (1e-6 if loaded.unit == "µm" else 1.0)
            assert images.read(path).size[1] == pytest.approx(width, rel=1e-12)
            assert images.read(path).pixel_size[1] == pytest.approx(width / 32, rel=1e-12)


def test_format_is_chosen_by_content_not_by_name(tmp_path: Path) -> None:
    path = written(tmp_path / "image.gwy").rename(tmp_path / "image.txt")
    assert images.read(path).source == "SurfaceTopography/gwy"


def test_the_height_channel_is_taken_by_default(tmp_path: Path) -> None:
    heights = synthetic.asymmetric()
    stack = {"PhaseTrace": 0 * heights, "HeightRetrace": heights + 1e-9, "AmplitudeTrace": heights}
    stack["HeightTrace"] = heights
    path = synthetic.write_ibw_image(tmp_path / "stack.ibw", stack, 1.25e-7)
    assert images.read(path).channel == "HeightTrace"
    listed = {channel.name: channel for channel in images.channels(path)}
    assert list(listed) == list(stack)
    assert [name for name, channel in listed.items() if channel.default] == ["HeightTrace"]
    assert listed["HeightTrace"].shape == (24, 32)
    assert listed["HeightTrace"].size == pytest.approx(SIDE)
    assert listed["HeightTrace"].unit == "m"
    assert listed["PhaseTrace"].kind == "phase"
    np.testing.assert_array_equal(images.read(path, "heightretrace").heights, heights + 1e-9)
    with pytest.raises(ReadError, match=r"no channel 'Height'; it holds PhaseTrace, HeightRetrace"):
        images.read(path, "Height")


def test_without_a_height_channel_it_lists_what_there_is(tmp_path: Path) -> None:
    path = synthetic.write_ibw_image(tmp_path / "phase.ibw", {"PhaseTrace": synthetic.asymmetric()}, 1.25e-7)
    with pytest.raises(ReadError, match="no height channel; it holds PhaseTrace"):
        images.read(path)


def test_a_gwy_whose_only_channel_is_no_length_says_so(tmp_path: Path) -> None:
    volts = synthetic.write_gwy(tmp_path / "v.gwy", synthetic.asymmetric(), SIDE, first=("Phase", "V"))
    assert [(one.name, one.unit, one.default) for one in images.channels(volts)] == [("Phase", "V", False)]
    with pytest.raises(ReadError, match=r"no height channel; it holds Phase \(V\), of which none is a length; save"):
        images.read(volts)
    with pytest.raises(ReadError, match=r"'Phase' is in 'V', not a length .*; give another channel"):
        images.read(volts, "phase")
    with pytest.raises(ReadError, match="no channel 'Height'; it holds Phase"):
        images.read(volts, "Height")


def test_a_gwy_whose_only_channel_has_no_unit_is_read_as_its_refusal_says(tmp_path: Path) -> None:
    bare = synthetic.write_gwy(tmp_path / "b.gwy", 1e9 * synthetic.asymmetric(), SIDE, first=("Z", ""))
    with pytest.raises(ReadError, match=r"Z \(no unit\); .* give its name \(channel\) and its height unit \(z unit\)"):
        images.read(bare)
    topography = images.read(bare, "Z", z_unit="nm")
    np.testing.assert_allclose(topography.heights, synthetic.asymmetric(), rtol=1e-12, atol=1e-24)


def test_a_plain_tiff_says_what_it_lacks_and_the_way_round_works(tmp_path: Path) -> None:
    picture = (1e12 * synthetic.asymmetric()[::-1]).astype("<u2")  # from the top, in pm
    pytest.importorskip("tifffile").imwrite(tmp_path / "plain.tif", picture)
    for ask in (images.channels, images.read):
        with pytest.raises(ReadError, match=r"a TIFF without a channel in a unit of length .* as \.npy and give"):
            ask(tmp_path / "plain.tif")
    np.save(tmp_path / "plain.npy", picture)
    topography = images.read(tmp_path / "plain.npy", pixel_size=1.25e-7, z_unit="pm")
    np.testing.assert_allclose(topography.heights, synthetic.asymmetric(), atol=1e-12)


def test_bare_arrays_are_pictures_from_the_top(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "array.h5"
    with h5py.File(path, "w") as file:
        file["z"] = synthetic.asymmetric()[::-1] * 1e9
    with pytest.raises(ReadError, match="no scan size; give the pixel size"):
        images.read(path)
    with pytest.raises(ReadError, match="height unit of channel 'z' is not stated; give the height unit"):
        images.read(path, pixel_size=1.25e-7)
    topography = images.read(path, pixel_size=1.25e-7, z_unit="nm")
    np.testing.assert_allclose(topography.heights, synthetic.asymmetric(), rtol=1e-12, atol=1e-24)


def test_unknown_unit_is_refused_and_overridden(tmp_path: Path) -> None:
    path = synthetic.write_matrix(tmp_path / "bare.txt", 1e9 * synthetic.asymmetric(), None, unit=None)
    with pytest.raises(ReadError, match="pixel size"):
        images.read(path)
    topography = images.read(path, pixel_size=(1e-7, 2e-7), z_unit="nm")
    assert topography.pixel_size == (1e-7, 2e-7)
    assert topography.height_range == pytest.approx(40e-9)
    volts = synthetic.write_matrix(tmp_path / "volts.txt", synthetic.asymmetric(), SIDE, unit="V")
    with pytest.raises(ReadError):
        images.read(volts)


def test_overrides(tmp_path: Path) -> None:
    path = written(tmp_path / "image.gwy")
    assert images.read(path, pixel_size=1e-8).pixel_size == (1e-8, 1e-8)
    assert images.read(path, z_unit="m").height_range == pytest.approx(40e-9)
    with pytest.raises(ReadError, match="contradicts the z unit 'nm'"):
        images.read(path, z_unit="nm")
    with pytest.raises(InvalidValue, match="z_unit"):
        images.read(path, z_unit="furlong")
    for wrong in (0.0, -1e-9, float("nan"), 1.0):
        with pytest.raises(InvalidValue, match="pixel_size"):
            images.read(path, pixel_size=wrong)


def test_few_missing_pixels_are_filled_from_their_neighbours(tmp_path: Path) -> None:
    heights = synthetic.asymmetric()
    ramp = 1e-9 * np.add.outer(np.arange(40), 2 * np.arange(50))
    holed = ramp.copy()
    holed[10, 20] = holed[30, 5] = np.nan
    holed[20:22, 30:32] = np.nan
    topography = images.read(synthetic.write_matrix(tmp_path / "holes.txt", holed, (4e-6, 5e-6)))
    assert topography.masked_pixels == 6
    np.testing.assert_array_equal(topography.mask, np.isnan(holed))
    # A hole of one pixel in a ramp is filled exactly; one of 2 x 2 within half the diagonal step, 3 nm.
    np.testing.assert_allclose(topography.heights, ramp, rtol=0, atol=1.6e-9)
    np.testing.assert_allclose(topography.heights[[10, 30], [20, 5]], ramp[[10, 30], [20, 5]], rtol=0, atol=1e-16)
    mask = np.zeros(heights.shape, bool)
    mask[3, 4] = True
    assert images.read(synthetic.write_gwy(tmp_path / "mask.gwy", heights, SIDE, mask)).masked_pixels == 1


def test_many_missing_pixels_are_masked_and_told_too_many_refused(tmp_path: Path) -> None:
    heights = synthetic.asymmetric()
    heights[:2] = np.nan  # 64 of 768 pixels
    path = synthetic.write_matrix(tmp_path / "half.txt", heights, SIDE)
    topography = images.read(path)
    np.testing.assert_array_equal(topography.mask, np.isnan(heights))
    assert topography.notes == ("8.33 % of the pixels are missing: filled from their neighbours and masked",)
    heights[2:22] = np.nan
    with pytest.raises(ReadError, match=r"91\.7 % of the pixels are missing"):
        images.read(synthetic.write_matrix(path, heights, SIDE))


def test_a_wide_hole_gets_the_heights_of_its_rim(tmp_path: Path) -> None:
    plane = 1e-9 * np.add.outer(np.arange(200.0), 0.5 * np.arange(160.0))
    holed = plane.copy()
    holed[30:170, 30:130] = np.nan
    topography = images.read(synthetic.write_matrix(tmp_path / "hole.txt", holed, (2e-6, 1.6e-6)))
    inside = topography.heights[30:170, 30:130]
    assert plane.min() <= inside.min() <= inside.max() <= plane.max()
    assert topography.heights[31, 80] == pytest.approx(plane[31, 80], abs=3e-9)


@pytest.mark.parametrize(
    ("size", "factor", "message"),
    [(60e-3, 1.0, "a scan of 60 mm"), (30e-9, 1.0, "heights over 4e-08 m, more than the longer side"),
     (3e-6, 0.0, "all heights are equal")],
)  # fmt: skip
def test_what_is_unusual_is_read_and_told(tmp_path: Path, size: float, factor: float, message: str) -> None:
    path = synthetic.write_matrix(tmp_path / "image.txt", factor * synthetic.asymmetric(), (0.75 * size, size))
    (note,) = images.read(path).notes
    assert message in note


def _empty(path: Path) -> None:
    path.write_bytes(b"")


def _prose(path: Path) -> None:
    path.write_text("Call me Ishmael. Some years ago, never mind how long precisely,\nhaving little or no money.\n")


def _numbers_in_prose(path: Path) -> None:
    path.write_text("We measured 3 samples in 2020.\n1 2 3\n4 5\n")


def _picture(path: Path) -> None:
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8)


def _noise(path: Path) -> None:
    path.write_bytes(np.random.default_rng(3).bytes(5000))


def _cut_off(path: Path) -> None:
    whole = written(path.with_name("whole.gwy")).read_bytes()
    path.write_bytes(whole[: len(whole) // 2])


def _curve(path: Path) -> None:
    synthetic.write_ibw_curve(path, synthetic.known_curve(n=100))


@pytest.mark.parametrize("spoil", [_empty, _prose, _numbers_in_prose, _picture, _noise, _cut_off, _curve])
def test_what_is_not_an_image_is_refused_in_one_sentence(tmp_path: Path, spoil: object) -> None:
    path = tmp_path / "file.dat"
    spoil(path)  # type: ignore[operator]
    with pytest.raises(ReadError) as caught:
        images.read(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)
    with pytest.raises(ReadError):
        images.channels(path)


def test_missing_file_and_folder(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="no such file"):
        images.read(tmp_path / "nothing.gwy")
    with pytest.raises(ReadError, match="a folder"):
        images.read(tmp_path)


@pytest.mark.parametrize(
    ("factor_side", "factor_height", "message"),
    [(1e6, 1.0, "a scan of"), (1e-5, 1.0, "a scan of"), (1.0, 1e4, "heights over a range")],
)
def test_implausible_scales_are_refused(tmp_path: Path, factor_side: float, factor_height: float, message: str) -> None:
    side = (SIDE[0] * factor_side, SIDE[1] * factor_side)
    path = synthetic.write_gwy(tmp_path / "odd.gwy", factor_height * synthetic.asymmetric(), side)
    with pytest.raises(ReadError, match=message):
        images.read(path)


def test_too_small_is_refused(tmp_path: Path) -> None:
    path = synthetic.write_gwy(tmp_path / "small.gwy", 1e-9 * np.eye(3), SIDE)
    with pytest.raises(ReadError, match="3 x 3 pixels"):
        images.read(path)


@pytest.mark.parametrize("ending", [".txt", ".gwy", ".ibw", ".nid"])
def test_damaged_files_give_a_read_error_or_a_plausible_image(tmp_path: Path, ending: str) -> None:
    """Bytes overwritten at random, mostly in the header: never another exception, never an absurd scale."""
    whole = bytearray(written(tmp_path / f"whole{ending}").read_bytes())
    rng = np.random.default_rng(5)
    path, refused = tmp_path / f"damaged{ending}", 0
    for _ in range(40):
        damaged = whole.copy()
        for place in rng.integers(0, min(len(whole), 600), 4):
            damaged[place] = rng.integers(256)
        path.write_bytes(damaged)
        try:
            topography = images.read(path)
        except ReadError:
            refused += 1
        else:
            assert np.isfinite(topography.heights).all()
            assert min(topography.size) >= 1e-9
            assert max(topography.size) <= 1e-3
            assert topography.height_range <= max(topography.size)
    assert refused > 0  # the damage was felt


def test_topography_is_read_only_and_checks_itself() -> None:
    mine = synthetic.asymmetric()
    topography = images.Topography(mine, (1e-7, 1e-7))
    with pytest.raises(ValueError, match="read-only"):
        topography.heights[0, 0] = 1.0
    mine[0, 0] = 0.0  # the caller's own array stays writable
    assert topography.shape == (24, 32)
    with pytest.raises(InvalidValue, match="not finite"):
        images.Topography(np.full((8, 8), np.nan), (1e-7, 1e-7))
    with pytest.raises(InvalidValue, match="pixel_size"):
        images.Topography(mine, (0.0, 1e-7))
    with pytest.raises(InvalidValue, match="at least 4 pixels"):
        images.Topography(np.zeros((3, 9)), (1e-7, 1e-7))
    with pytest.raises(InvalidValue, match="masked arrays"):
        images.Topography(np.ma.masked_array(mine), (1e-7, 1e-7))


REAL = [
    # file, channel, (ny, nx), side [um]; the sizes are those of the data's description
    ("20160301DKRUStorageMedium10um.nid", "Scan forward (Z-Axis)", (128, 128), 10.0),
    ("example_ps.tiff", "Z Height", (512, 512), 1.0),
    ("spot_1-1000nm.ibw", "HeightTrace", (256, 256), 20.08),
    ("mi-1.mi", "Topography", (256, 256), 20.0),
    ("stp-1.stp", "Topography", (256, 256), 0.6),
    ("di-3.di", "ZSensor", (256, 256), 10.0),
]


@pytest.mark.parametrize(("name", "channel", "shape", "side"), REAL)
def test_real_images(name: str, channel: str, shape: tuple[int, int], side: float) -> None:
    path = synthetic.DATA / "images" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    topography = images.read(path)
    assert topography.channel == channel
    assert topography.shape == shape
    assert topography.size == pytest.approx((side * 1e-6, side * 1e-6), rel=1e-3)
    with warnings.catch_warnings():  # what levelling says about rows is not the matter here
        warnings.simplefilter("ignore")
        clean, _ = images.prepare(topography)
    assert 1e-9 < clean.height_range < 500e-9
    assert abs(clean.heights[~clean.mask].mean()) < 1e-10


def test_real_ibw_against_another_reader() -> None:
    """Igor's wave is wave[x, y] with y upwards: our heights are its transpose, without a flip."""
    path = synthetic.DATA / "images" / "spot_1-1000nm.ibw"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    binarywave = pytest.importorskip("igor2.binarywave")
    wave = binarywave.load(str(path))["wave"]["wData"]
    np.testing.assert_array_equal(images.read(path).heights, wave[:, :, 0].T)
