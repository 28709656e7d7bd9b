# SPDX-License-Identifier: BSD-3-Clause
"""Images in HDF5 and netCDF of others: units, packed values, gaps and axes by the conventions of CF."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

h5py = pytest.importorskip("h5py")
pytest.importorskip("SurfaceTopography")

from nanotouch import images  # noqa: E402
from nanotouch.errors import ReadError  # noqa: E402

NY, NX = 8, 12
NM = np.add.outer(np.arange(NY) ** 2.0, 3.0 * np.arange(NX))  # [nm], row 0 first in the file
PIXEL = 1e-7


def write(path: Path, values: Any = NM, axes: dict[str, Any] | None = None, **told: Any) -> Path:
    with h5py.File(path, "w") as file:
        file["height"] = values
        file["height"].attrs.update(told)
        for number, (name, (places, unit)) in enumerate((axes or {}).items()):
            file[name] = places
            file[name].attrs["units"] = unit
            file[name].make_scale(name)
            file["height"].dims[number].attach_scale(file[name])
    return path


@pytest.mark.parametrize(
    ("unit", "metre"), [("nm", 1e-9), ("um", 1e-6), ("nanometers", 1e-9), (b"nm", 1e-9), (b"\xb5m", 1e-6)]
)
def test_a_stated_unit_counts(unit: Any, metre: float, tmp_path: Path) -> None:
    found = images.read(write(tmp_path / "a.h5", 0.01 * NM, units=unit), pixel_size=PIXEL)
    np.testing.assert_allclose(found.heights[::-1], 0.01 * NM * metre, rtol=1e-12)


@pytest.mark.parametrize("unit", ["um", "V"])
def test_a_unit_that_contradicts_the_one_given_is_refused(unit: str, tmp_path: Path) -> None:
    """The given one was taken: 1e3 times too little, or volts as heights."""
    with pytest.raises(ReadError, match=f"states '{unit}' for channel 'height'"):
        images.read(write(tmp_path / "a.h5", units=unit), pixel_size=PIXEL, z_unit="nm")


def test_a_scale_of_two_numbers_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"scale_factor is .*, 2 numbers, expected one"):
        images.read(write(tmp_path / "a.h5", units="nm", scale_factor=[1.0, 2.0]), pixel_size=PIXEL)


def test_packed_values_and_gaps(tmp_path: Path) -> None:
    packed = (10.0 * NM + 50.0).astype("i4")
    packed[2, 3] = -9999
    told = {"units": "nm", "scale_factor": 0.1, "add_offset": -5.0, "_FillValue": -9999}
    found = images.read(write(tmp_path / "a.h5", packed, **told), pixel_size=PIXEL)
    assert found.masked_pixels == 1
    assert found.mask[NY - 1 - 2, 3]
    whole = ~found.mask
    np.testing.assert_allclose(found.heights[whole], 1e-9 * NM[::-1][whole], rtol=1e-9, atol=1e-18)
    with pytest.raises(ReadError, match="scale_factor is 'ten', no number"):
        images.read(write(tmp_path / "b.h5", units="nm", scale_factor="ten"), pixel_size=PIXEL)


@pytest.mark.parametrize("y_rises", [True, False])
@pytest.mark.parametrize("x_falls", [True, False])
def test_axes_give_size_and_direction(y_rises: bool, x_falls: bool, tmp_path: Path) -> None:
    y, x = 100.0 * np.arange(NY), 50.0 * np.arange(NX)
    axes = {"y": (y if y_rises else y[::-1], "nm"), "x": (x[::-1] if x_falls else x, "nm")}
    path = write(tmp_path / "a.h5", axes=axes, units="nm")
    found = images.read(path)
    assert found.pixel_size == pytest.approx((1e-7, 5e-8))
    upwards = NM if y_rises else NM[::-1]
    np.testing.assert_allclose(found.heights, 1e-9 * (upwards[:, ::-1] if x_falls else upwards), rtol=1e-12)
    (listed,) = images.channels(path)
    assert (listed.shape, listed.unit) == ((NY, NX), "nm")
    assert listed.size == pytest.approx((8e-7, 6e-7))


def test_uneven_axes_are_refused_and_axes_without_a_length_say_nothing(tmp_path: Path) -> None:
    uneven = write(tmp_path / "a.h5", axes={"y": (np.arange(NY) ** 2.0, "nm"), "x": (np.arange(NX), "nm")}, units="nm")
    with pytest.raises(ReadError, match="the axis /y does not go in even steps"):
        images.read(uneven)
    bare = write(tmp_path / "b.h5", axes={"y": (np.arange(NY), "1"), "x": (np.arange(NX), "1")}, units="nm")
    with pytest.raises(ReadError, match="states no scan size"):
        images.read(bare)
    assert images.read(bare, pixel_size=PIXEL).pixel_size == (PIXEL, PIXEL)
